/* Rows of the sources for the pairs of a block, of single pairs, or of everything. */
#ifndef SPHGI_STAGE_H
#define SPHGI_STAGE_H
#include "worker.h"

/* Rows of everything around a block, numbered as in its surroundings. */
void sphgi_stage_block(struct sphgi_worker *worker, const struct sphgi_surroundings *around);

/* Rows will be copied pair by pair. */
void sphgi_use_local_rows(struct sphgi_worker *worker);

/* Rows stand packed in storage order. */
void sphgi_use_packed_rows(struct sphgi_worker *worker);

/* Packs positions with volumes, and fields, into the context's memory. Gives OK or MEMORY; tells of
 * volumes that are not valid. */
sphg_result sphgi_pack(struct sphgi_sweep *sweep, bool *bad_volume);

#endif
