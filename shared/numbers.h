/* SPDX-License-Identifier: MIT */
/* Tables of numbers whose precision is chosen at run time. */
#ifndef SHARED_NUMBERS_H
#define SHARED_NUMBERS_H
#include <sphgrad/sphgrad.h>

struct numbers {
    void *data; /* count x width, row-major */
    sphg_type type;
    int32_t count, width;
};

/* All zero, and held as below. Ends the program where memory runs out. */
struct numbers numbers_create(sphg_type type, int32_t count, int32_t width);

double numbers_get(const struct numbers *numbers, int32_t item, int32_t component);
void numbers_set(const struct numbers *numbers, int32_t item, int32_t component, double value);
sphg_view numbers_view(const struct numbers *numbers);

/* The larger; NaN if one is NaN, so that a maximum does not forget it. */
static inline double numbers_larger(double a, double b)
{
    return a != a || a > b ? a : b;
}

/* Zeros; ends the program where memory runs out. free() releases the first, the end of the program
 * the second, release_held() the third. */
void *allocate_or_exit(size_t count, size_t size);
void *allocate_to_the_end(size_t count, size_t size);
void *allocate_held(size_t count, size_t size);
void *allocate_lines(size_t count, size_t size); /* the third on a cache line of its own */

/* What a thread holds (memory, and objects with the function that releases them) is released back
 * to a mark, the last first; or at the end of the program. */
struct held;
void hold(void *object, void (*release)(void *object));
struct held *held_so_far(void);
void release_held(struct held *mark);
#endif
