/* SPDX-License-Identifier: MIT */
/* What one entry point does for another: objects and lists of pairs within a call that is under
 * way. */
#ifndef SPHGI_ENTRIES_H
#define SPHGI_ENTRIES_H
#include "core/check.h"
#include "search/neighbors.h"

/* An empty object, or NULL: no memory. */
sphg_neighbors *sphgi_neighbors_make(sphg_context *context);

/* CSR in memory of the context's allocator, sources ascending within a row. */
struct sphgi_rows {
    struct sphgi_buffer offsets; /* int64_t, targets + 1 of them */
    struct sphgi_buffer indices; /* int32_t */
};

/* All pairs with r < H. What it reserved is the caller's to free, after failures too. */
sphg_result sphgi_list_pairs(struct sphgi_checker checker, const struct sphgi_scheme *scheme,
                             const sphg_neighbors *neighbors, struct sphgi_rows *rows);

#endif
