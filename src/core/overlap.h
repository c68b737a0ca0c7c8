/* SPDX-License-Identifier: MIT */
/* The rule that outputs overlap nothing. */
#ifndef SPHGI_OVERLAP_H
#define SPHGI_OVERLAP_H
#include "check.h"

/* Memory that items of columns occupy. */
struct sphgi_extent {
    const char *name;
    struct sphgi_columns columns;
    int32_t count;
    size_t number_size;
    bool output;
};
/* Of columns of numbers of that size. */
struct sphgi_extent sphgi_extent_of(const char *name, const struct sphgi_columns *columns,
                                    int32_t count, size_t number_size, bool output);
sphg_result sphgi_check_overlap(struct sphgi_checker checker, const struct sphgi_extent *extents,
                                int32_t count);

#endif
