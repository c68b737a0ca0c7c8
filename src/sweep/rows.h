/* Rows of the sources: packed in storage order, or copied for single pairs. */
#ifndef SPHGI_ROWS_H
#define SPHGI_ROWS_H
#include "worker.h"

/* Where the worker reads them: they stand packed, or will be copied. */
void sphgi_use_rows(struct sphgi_worker *worker);

/* Packs positions with volumes, and fields, into the context's memory. Gives OK or MEMORY; tells of
 * volumes that are not valid. */
sphg_result sphgi_pack(struct sphgi_sweep *sweep, bool *bad_volume);

#endif
