/* SPDX-License-Identifier: MIT */
/* Rows of the sources: packed in storage order, or copied for single pairs. */
#ifndef SPHGI_ROWS_H
#define SPHGI_ROWS_H
#include "worker.h"

/* Where the worker reads them: they stand packed, or will be copied. */
void sphgi_use_rows(struct sphgi_worker *worker);

/* How many arrays of rows a sweep reads: only sums of fields do. */
static inline int32_t sphgi_rows_read(const struct sphgi_sweep *sweep)
{
    return sweep->steps & SPHGI_SUM_FIELDS ? sweep->plan->row_count : 0;
}

/* The positions are read with volumes behind them. */
static inline bool sphgi_reads_volumes(const struct sphgi_sweep *sweep)
{
    return sweep->volumes && !(sweep->reads_records && sweep->weights_stand);
}

/* Packs positions with volumes, and fields, into the context's memory. Gives OK or MEMORY; tells of
 * volumes that are not valid. */
sphg_result sphgi_pack(struct sphgi_sweep *sweep, bool *bad_volume);

/* Rows of the sources order[begin] to order[end - 1] of the host, one array behind the other: each
 * starts `array` bytes after the one before. order NULL: of `begin` and so on themselves. False: a
 * volume is negative or not finite. */
bool sphgi_fill_rows(const struct sphgi_sweep *sweep, const int32_t *order, int64_t begin,
                     int64_t end, char *to, size_t array);

#endif
