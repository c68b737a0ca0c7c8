/* SPDX-License-Identifier: MIT */
/* One line on a terminal that says how far things are; nothing at all in a pipe. */
#ifndef SPHGRAD_BENCH_PROGRESS_H
#define SPHGRAD_BENCH_PROGRESS_H

__attribute__((format(printf, 1, 2))) void progress_show(const char *format, ...);
void progress_clear(void);
#endif
