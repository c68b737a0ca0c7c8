/* SPDX-License-Identifier: MIT */
/* How tables write numbers. */
#ifndef SPHGRAD_BENCH_TEXT_H
#define SPHGRAD_BENCH_TEXT_H
#include <stdint.h>

enum { TEXT_SIZE = 64 };

/* 1234567 as "1 234 567". */
const char *text_grouped(int64_t value, char text[TEXT_SIZE]);

/* Four digits are more than two runs agree on. */
void text_time(double milliseconds, char text[TEXT_SIZE]);
#endif
