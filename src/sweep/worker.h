/* One worker's share of a sweep: it takes groups of targets, gathers their pairs tile by tile,
 * sums, and finishes the group. */
#ifndef SPHGI_WORKER_H
#define SPHGI_WORKER_H
#include "search/find.h"
#include "search/weights.h"
#include "plan/plan.h"
#include "tally.h"
#include "plan/units.h"

/* What one sweep over one source set does. */
enum sphgi_step {
    SPHGI_SUM_MOMENTS = 1,
    SPHGI_SUM_FIELDS = 2,
    SPHGI_FINISH = 4 /* write results at once; otherwise add the sums to the arena */
};

/* Where pairs go that are wanted one by one (sphg_pair_gradients). */
struct sphgi_pair_sink {
    const int32_t *row_of_target; /* row of the output */
    int64_t *counts;              /* first round: pairs per row */
    const int64_t *offsets;       /* second round */
    int32_t *indices;
    struct sphgi_columns gradient; /* count 0: not wanted */
};

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
    struct sphgi_kept_weights kept;           /* s_ij that this sweep reads and writes */
    char *arena;                              /* sums, plan->sums numbers a target */
    const struct sphgi_columns *coefficients; /* table in units of H made by this call, or NULL */
    const struct sphgi_pair_sink *pairs;      /* NULL: results are summed */
    char *memory;
    size_t memory_each;
};

struct sphgi_group {
    int32_t lanes;
    int32_t target[SPHGI_WIDTH];
    int32_t place[SPHGI_WIDTH]; /* in storage order */
};

struct sphgi_worker {
    const struct sphgi_sweep *sweep;
    const struct sphgi_passes *passes;
    struct sphgi_gather gather;
    struct sphgi_shape shape;
    struct sphgi_threshold threshold;
    struct sphgi_second second;
    double inverse_h;
    double factor_of_h; /* w_scale, times H */
    struct sphgi_tile tile;
    struct sphgi_lane_lists lists; /* of the lanes at work */
    struct sphgi_group group;
    int32_t first, width, targets; /* the lanes of the group that are at work: first of them, how
                                      many, and how many of those have a target */
    int32_t summed;                /* lanes whose sums are done */
    struct sphgi_share share[SPHGI_SHARES]; /* of the table of corrections */
    const void **rows;                      /* the arrays of rows, packed or local */
    unsigned summing;                       /* SPHGI_SUM_..., of this pass over the group */
    uint8_t directions[SPHGI_WIDTH];        /* of curvature, that are resolved */
    uint8_t open[SPHGI_WIDTH];              /* 1: lenders could change what is resolved */
    bool scaled;                            /* moment_scale holds what moments are multiplied by */
    bool factors_at_once;            /* s_ij come with the pairs, for nobody asks for distances */
    char *kept;                      /* the group's s_ij, of the lanes at work; NULL: none */
    bool kept_stand;                 /* they were written by a sweep before */
    bool coefficients_first;         /* they must be known before fields can be summed */
    bool targets_loaded;             /* A_i, V_i, rho_i of the group */
    uint32_t targets_in_rows;        /* a bit per field: A_i stand in packed rows */
    int32_t tiles;                   /* evaluated in this round over the group's pairs */
    int32_t longest;                 /* pairs of a list, of the lanes at work */
    int32_t pairs[SPHGI_LANES_MOST]; /* of the tile, lane by lane, padding left out */
    int32_t spread_pairs;            /* of a tile that holds one list */
    int32_t waiting_ids_used;        /* by lists that wait for a vector of targets */
    int32_t streamed, waiting;    /* pairs of a list that comes bit by bit: summed, and yet to be */
    bool local;                   /* rows are copied pair by pair */
    const int32_t *items;         /* sources behind the rows; NULL: the rows are their numbers */
    int64_t written[SPHGI_WIDTH]; /* pairs of each target so far */

    /* Memory, in the order in which it is carved. */
    struct sphgi_tally *tally;
    char *local_positions, *local_rows, *arrays, *ids, *clean_ids, *local_items, *waiting_ids;
    char *reduced, *at_target, *opposite, *raw, *coefficients, *lambda_min, *volume, *density;
    char *self, *zeros, *jacobian, *contracted, *extra;
    char *ratio, *inverse, *inverse_square, *factor, *shares; /* of each lane's radius: H^d of the
                                                                 plan over its own, 1 / H_i, ... */
    char *share_kept, *hessian; /* order 2; Laplacians stand behind the Hessians */
    char *linear, *moment_scale, *confidence, *lent_confidence, *lent; /* for lenders and ... */
    char *borrowed, *prior, *transport;                                /* ... borrowers */
    char *finder_memory;
};

enum { SPHGI_HESSIANS = 54 };         /* numbers of all of a tensor's components */
enum { SPHGI_WAITING_IDS = 1 << 15 }; /* of lists that wait until the lanes are full */

/* s_ij can be formed as pairs are gathered: nobody asks for distances, nor for anything else that
 * is made of them. */
bool sphgi_forms_factors_alone(const struct sphgi_sweep *sweep);

/* Bytes of memory of one worker; 0 on overflow. */
size_t sphgi_worker_size(const struct sphgi_sweep *sweep);
void sphgi_worker_open(struct sphgi_worker *worker, const struct sphgi_sweep *sweep,
                       int32_t number);

/* Sums the targets whose lists stand in worker->lists, up to `lanes` of them. When no more follow,
 * the group is finished. */
void sphgi_group_run(struct sphgi_worker *worker);

/* Of the lanes that were summed last, those with a bit in `kept` stay; the others' targets drop
 * out. */
void sphgi_group_keep(struct sphgi_worker *worker, uint32_t kept);

/* The same for one target whose list comes bit by bit:
 *   begin; do { add ... } while (again); end. */
void sphgi_stream_begin(struct sphgi_worker *worker);
void sphgi_stream_add(struct sphgi_worker *worker, const uint32_t *ids, int32_t count);
bool sphgi_stream_again(struct sphgi_worker *worker);
void sphgi_stream_end(struct sphgi_worker *worker);

/* Writes the results; the group is empty again. */
void sphgi_group_finish(struct sphgi_worker *worker);

/* The same for a group whose sums stand in the arena already. */
void sphgi_group_finish_from_arena(struct sphgi_worker *worker);

/* What volumes are multiplied with: 1 / H^d. */
double sphgi_volume_unit(const struct sphgi_sweep *sweep);

/* Where value `number` of the first target at work stands in memory of the form
 * [number][SPHGI_WIDTH]. */
static inline char *sphgi_lane(const struct sphgi_worker *worker, char *base, int32_t number)
{
    const size_t size = sphgi_size_of_type(worker->sweep->plan->type);
    return base + ((size_t)number * SPHGI_WIDTH + (size_t)worker->first) * size;
}

/* The targets at work, and their rows. */
static inline const int32_t *sphgi_targets(const struct sphgi_worker *worker)
{
    return worker->group.target + worker->first;
}

static inline const int32_t *sphgi_places(const struct sphgi_worker *worker)
{
    return worker->group.place + worker->first;
}

#endif
