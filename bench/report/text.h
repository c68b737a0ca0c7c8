/* How tables write numbers, and the lines that name the machine. */
#ifndef SPHGRAD_BENCH_TEXT_H
#define SPHGRAD_BENCH_TEXT_H
#include "timing.h"

enum { TEXT_SIZE = 64 };

/* 1234567 as "1 234 567". */
const char *text_grouped(int64_t value, char text[TEXT_SIZE]);

/* Four digits are more than two runs agree on. */
void text_time(double milliseconds, char text[TEXT_SIZE]);

/* "12.3 (11.9-14.0)": median, least and most; "-" if there are no samples. */
void text_median(const struct samples *samples, char text[TEXT_SIZE]);

void text_print_machine(int32_t threads);

/* One line if others kept the processors from the program while these samples were taken. */
void text_print_if_busy(const struct samples *samples, int32_t threads);
#endif
