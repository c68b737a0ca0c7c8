/* SPDX-License-Identifier: MIT */
/* Pictures by gnuplot. */
#ifndef SOLVER_GNUPLOT_H
#define SOLVER_GNUPLOT_H
#include <stdbool.h>

/* Runs folder/script there. false: one line on stderr says why there is no picture. */
bool gnuplot_run(const char *folder, const char *script);
#endif
