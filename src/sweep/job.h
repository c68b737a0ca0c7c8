/* SPDX-License-Identifier: MIT */
/* One sweep over one source set: what it is to do, the same for all its workers. */
#ifndef SPHGI_JOB_H
#define SPHGI_JOB_H
#include "search/weights.h"
#include "pair_numbers.h"
#include "plan/plan.h"

/* What one sweep over one source set does. */
enum sphgi_step {
    SPHGI_SUM_MOMENTS = 1,
    SPHGI_SUM_SLOPES = 2, /* classic: of the weights times p.y, which the moments give */
    SPHGI_SUM_FIELDS = 4,
    SPHGI_SUMS = SPHGI_SUM_MOMENTS | SPHGI_SUM_SLOPES | SPHGI_SUM_FIELDS,
    SPHGI_FINISH = 8 /* write results, else put the sums away for the sweep that does */
};

/* Sums of several source sets: those of the sets before, of targets that have pairs there. */
struct sphgi_put_away {
    char *sums;     /* plan->sums numbers a target, where it has a mark */
    uint8_t *marks; /* a byte a target; all 0 between calls. NULL: there is only one set */
};

/* Classic methods and several source sets: targets with pairs in others than the last set wait for
 * the sums of these, step by step; those without go through all steps at once. */
struct sphgi_turn {
    const uint8_t *waits; /* a byte a target; NULL: everybody's turn */
    uint8_t whose;        /* of the bytes */
};

/* Where the sums of some steps stand among those of the plan. */
struct sphgi_sums {
    int32_t first, count;
};
struct sphgi_sums sphgi_sums_of(const struct sphgi_plan *plan, unsigned steps);

/* Where pairs go that are wanted one by one (sphg_pair_gradients). */
struct sphgi_pair_sink {
    const int32_t *row_of_target; /* row of the output */
    int64_t *counts;              /* first round: pairs per row */
    const int64_t *offsets;       /* second round */
    int32_t *indices;
    struct sphgi_pair_numbers gradient;
};

/* Which groups a sweep goes through. */
enum sphgi_groups { SPHGI_ALL_GROUPS, SPHGI_GROUPS_BY_RECORDS, SPHGI_OTHER_GROUPS };

/* A sweep, the same for all its workers. */
struct sphgi_sweep {
    sphg_context *context;
    const struct sphgi_plan *plan;
    const struct sphgi_set_plan *set;
    int32_t set_number;
    unsigned steps;
    const struct sphgi_passes *passes, *position_passes; /* of fields; of positions */
    bool packed;                  /* fields stand as rows in storage order; else rows are copied */
    const char *packed_positions; /* x y z V, source_count + 1 rows */
    const char *packed_rows;      /* plan->row_count arrays of as many rows each */
    bool volumes;                 /* V_j differ: they are the 4th numbers of the positions */
    double volume;                /* V / H^d of all sources otherwise */
    struct sphgi_kept_weights kept;       /* s_ij that this sweep reads and writes */
    bool may_read_records, reads_records; /* in the place of rows ... */
    bool weights_stand;                   /* ... with coordinates, since nothing is formed */
    const void *records;                  /* of the sources; NULL: rows are read */
    int32_t groups_left;                  /* without them */
    enum sphgi_groups groups;             /* that are swept */
    struct sphgi_put_away put_away;
    struct sphgi_turn turn;
    const struct sphgi_columns *coefficients; /* table in units of H made by this call, or NULL */
    const struct sphgi_pair_sink *pairs;      /* NULL: results are summed */
    char *memory;
    size_t memory_each;
};

static inline bool sphgi_is_turn(const struct sphgi_sweep *sweep, int32_t target)
{
    return !sweep->turn.waits || sweep->turn.waits[target] == sweep->turn.whose;
}

/* What volumes are multiplied with: 1 / H^d. */
double sphgi_volume_unit(const struct sphgi_sweep *sweep);

/* Targets without pairs in this source set must be gone through all the same: they bring nothing to
 * what is put away. */
bool sphgi_must_finish(const struct sphgi_sweep *sweep);

/* s_ij can be formed as pairs are gathered: nobody asks for distances, nor for anything else that
 * is made of them. */
bool sphgi_forms_factors_alone(const struct sphgi_sweep *sweep);

/* Of fields of two radii: their pairs are weighed as they are gathered. */
bool sphgi_weighs_both_at_once(const struct sphgi_sweep *sweep);

/* Those within the target's own radius, which are sorted out afterwards, are. */
bool sphgi_weighs_near_at_once(const struct sphgi_sweep *sweep);

/* Lists hold more, those of a skin, beside the pairs that the radius of either end reaches: these
 * are sorted out before anything else is done with them, where that does not come by the way. */
bool sphgi_sorts_out_pairs(const struct sphgi_sweep *sweep);

/* Lists may hold pairs with r >= H: these are cut. */
bool sphgi_is_superset(const struct sphgi_sweep *sweep);
/* Pairs that are none of this sweep must be told from others by looking at each. */
bool sphgi_is_masked(const struct sphgi_sweep *sweep);

#endif
