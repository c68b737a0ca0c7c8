/* SPDX-License-Identifier: MIT */
/* How tables write numbers, and the lines that name the machine. */
#ifndef SPHGRAD_BENCH_TEXT_H
#define SPHGRAD_BENCH_TEXT_H
#include "settings.h"
#include "timing.h"

enum { TEXT_SIZE = 64 };

/* 1234567 as "1 234 567". */
const char *text_grouped(int64_t value, char text[TEXT_SIZE]);

/* Four digits are more than two runs agree on. */
void text_time(double milliseconds, char text[TEXT_SIZE]);

/* "4 096, lattice jittered by ...": the particles of these settings. */
void text_print_lattice(const struct settings *settings, int32_t count, double pairs);
void text_print_machine(int32_t threads);

/* One line if others kept the processors from the program while these samples were taken. */
void text_print_if_busy(const struct samples *samples, int32_t threads);
#endif
