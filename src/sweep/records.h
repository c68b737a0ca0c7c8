/* SPDX-License-Identifier: MIT */
/* Sweeps of one field whose groups stand side by side read of each source one record: where weights
 * are kept, position and field, or b_j, and nothing else; where they are formed, b_j alone. */
#ifndef SPHGI_RECORDS_H
#define SPHGI_RECORDS_H
#include "selection.h"
#include "worker.h"

/* The sums of the sweep are such as the pass over records knows. Then there is memory for it
 * whether it comes to that or not: how lists are kept depends on where the particles are. */
bool sphgi_may_read_records(const struct sphgi_sweep *sweep,
                            const struct sphgi_selection *selection);
size_t sphgi_record_bytes(const struct sphgi_sweep *sweep);

/* Nearly all groups can go that way, too: those with weights, which sets sweep->weights_stand, or
 * all whose lists stand side by side. sweep->groups_left is how many are left to a sweep that comes
 * after it. */
bool sphgi_reads_records(struct sphgi_sweep *sweep);

static inline bool sphgi_goes_by_records(const struct sphgi_sweep *sweep, int32_t group)
{
    const sphg_neighbors *n = sweep->set->neighbors;
    if (sweep->weights_stand)
        return sweep->kept.marks[group] == sweep->kept.number;
    return sphgi_is_kept(n, group) && sphgi_kept_steps(n, group) != SPHGI_APART &&
           sphgi_targets_in(n, group) == SPHGI_GROUP;
}

/* Those of the sources order[begin] to order[end - 1] of the host. False: a volume is negative or
 * not finite. */
bool sphgi_fill_records(const struct sphgi_sweep *sweep, const int32_t *order, int64_t begin,
                        int64_t end, char *to);
size_t sphgi_record_size(const struct sphgi_sweep *sweep);
/* Behind the last one; returns the first. */
char *sphgi_put_dummy_record(const struct sphgi_sweep *sweep, char *records);

/* What their pass is told. */
struct sphgi_record_sums sphgi_record_sums(const struct sphgi_worker *worker);

#endif
