/* SPDX-License-Identifier: MIT */
/* Sweeps whose weights are all kept read of each source one record and nothing else: position and
 * field, or b_j, side by side. */
#ifndef SPHGI_RECORDS_H
#define SPHGI_RECORDS_H
#include "selection.h"
#include "worker.h"

/* The sums of the sweep are such as the pass over records knows. Then there is memory for it
 * whether it comes to that or not: what is kept depends on where the particles are. */
bool sphgi_may_read_records(const struct sphgi_sweep *sweep,
                            const struct sphgi_selection *selection);
size_t sphgi_record_bytes(const struct sphgi_sweep *sweep);

/* Nearly all groups have weights, too. Those without are left to a sweep that comes after it. */
bool sphgi_reads_records(const struct sphgi_sweep *sweep);

/* Has any group no weights? */
bool sphgi_lacks_weights(const struct sphgi_sweep *sweep);

/* Writes them into the context's memory. Gives OK or MEMORY; tells of volumes that are not valid.
 */
sphg_result sphgi_pack_records(struct sphgi_sweep *sweep, bool *bad_volume);

/* What their pass is told. */
struct sphgi_record_sums sphgi_record_sums(const struct sphgi_worker *worker);

#endif
