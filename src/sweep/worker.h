/* SPDX-License-Identifier: MIT */
/* One worker's share of a sweep, and its memory: it takes groups of targets, gathers their pairs
 * tile by tile, sums, and finishes the group. */
#ifndef SPHGI_WORKER_H
#define SPHGI_WORKER_H
#include "search/find.h"
#include "plan/units.h"
#include "job.h"
#include "tally.h"

/* Targets whose results are written together. */
struct sphgi_bundle {
    int32_t count;  /* of them */
    int32_t summed; /* of these, whose sums are done */
    int32_t target[SPHGI_WIDTH];
    int32_t place[SPHGI_WIDTH];   /* in storage order */
    int64_t written[SPHGI_WIDTH]; /* pairs of each target so far, where pairs are wanted */
};

/* The targets of the bundle that are at work, and their pairs. */
struct sphgi_batch {
    int32_t first, width, targets;  /* the first of them, how many, and how many have a target */
    struct sphgi_lane_lists *lists; /* of the lanes: own_lists, or somebody else's */
    struct sphgi_lane_lists own_lists;
    const struct sphgi_lane_lists *coming; /* of the host, and read next; NULL: none */
    int32_t coming_longest;
    int32_t longest;  /* pairs of a list */
    unsigned summing; /* SPHGI_SUM_..., of this round over the pairs */
    int32_t tiles;    /* made ready since the lists were walked from their beginning */
    int32_t pairs[SPHGI_LANES_MOST]; /* of the tile, lane by lane, padding left out */
    int32_t spread_pairs;            /* of a tile that holds one list */
    bool drops;      /* summed in rounds, and some of its targets drop out afterwards */
    char *kept;      /* s_ij that stay between sweeps; NULL: none */
    bool kept_stand; /* they were written by a sweep before */
};

/* Tiles that stay until the next round. */
enum { SPHGI_TILES_HELD = 8 };
struct sphgi_held_tile {
    struct sphgi_tile tile;
    int32_t spread_pairs;
    int32_t pairs[SPHGI_LANES_MOST];
};
struct sphgi_held {
    int32_t room;      /* for so many of them; 0: there is one round */
    char *arrays;      /* of all ... */
    uint32_t *own_ids; /* ... and their ids */
    struct sphgi_held_tile *tile;
};

/* Vectors of targets on the classic methods' short way (classic_way.h): their moments are summed,
 * and their tiles stay; what comes next waits until it is done for all of them. */
struct sphgi_begun {
    int32_t first; /* of their targets, in the bundle */
    int32_t vectors, tiles;
    int32_t longest[SPHGI_TILES_HELD]; /* pairs of a list of each ... */
    int32_t end[SPHGI_TILES_HELD];     /* ... and tiles up to its last one */
};

/* Ids that wait until the lanes are full: lists of targets that follow one another, or the pairs of
 * one list that comes in pieces. */
struct sphgi_waiting {
    uint32_t *ids; /* SPHGI_WAITING_IDS */
    int32_t used;  /* by lists */
    int32_t pairs; /* of the list in pieces, yet to be summed ... */
    int32_t summed;
};

/* Sixteen targets whose lists stand side by side. */
struct sphgi_group {
    int32_t place;         /* of the first, in storage order ... */
    const int32_t *places; /* of a mixed group instead, of each. NULL: it is none */
    uint32_t active;       /* a bit for each whose results are wanted; of a mixed group for each */
    const uint32_t *ids;
    const uint16_t *lengths;
    bool kept; /* they stand in the neighbours' memory */
};

/* Groups that were found on the spot and wait in the memory of lists that do. */
enum { SPHGI_WOVEN_MOST = 16 };
struct sphgi_woven {
    int32_t count, used; /* groups, and their ids */
    struct sphgi_group group[SPHGI_WOVEN_MOST];
    uint16_t lengths[SPHGI_WOVEN_MOST][SPHGI_GROUP];
};

/* Rows that are copied one by one: the sources behind them, and where these stand in storage. */
struct sphgi_copies {
    int32_t count, items[SPHGI_TILE];
    uint32_t rows[SPHGI_TILE];
};

/* What a mixed group is put together from: some targets of a group, a bit for each. */
struct sphgi_part {
    const uint32_t *ids; /* of the group's lists */
    uint32_t active;
    int32_t count, steps; /* of the longest list */
};

/* A mixed group: targets of several groups, whose lists are laid side by side anew. */
struct sphgi_mixed_group {
    int32_t count, longest;
    uint32_t *ids; /* in the memory of lists that wait */
    int32_t places[SPHGI_GROUP];
    uint16_t lengths[SPHGI_GROUP];
    bool numbered; /* its rows are copied, and these numbered */
};

/* Some that wait, so that what they read can be asked for, and one that is not full yet. */
enum { SPHGI_MIXED_MOST = 3 };
struct sphgi_mixed {
    int32_t oldest, waiting;
    int32_t used; /* ids */
    struct sphgi_mixed_group group[SPHGI_MIXED_MOST];
    int32_t parts; /* of the one that is not full */
    struct sphgi_part part[SPHGI_GROUP];
};

/* Where the rows of the sources are read. */
struct sphgi_source_rows {
    const void **at;             /* the arrays of rows, packed or copied */
    bool local;                  /* rows are copied pair by pair */
    const int32_t *items;        /* sources behind the rows; NULL: the rows are their numbers */
    char *positions, *numbers;   /* copies */
    int32_t *own_items;          /* the sources behind them */
    struct sphgi_copies *copies; /* of each mixed group, and of a list */
    uint32_t *clean_ids;         /* SPHGI_CHUNK ids a lane, made of the host's numbers */
};

/* What the targets bring: A_i, V_i, rho_i. */
struct sphgi_own {
    bool loaded;
    uint32_t in_rows; /* a bit per field: A_i stand in packed rows */
    char *field, *opposite, *volume, *density;
};

/* What takes the place of H, H^d of the plan over that of the target, and so on, where each target
 * has a radius of its own. */
struct sphgi_lane_radii {
    char *ratio, *inverse, *inverse_square, *factor, *table_units;
};

/* Of order 2. */
struct sphgi_curvature {
    uint8_t directions[SPHGI_WIDTH]; /* that are resolved */
    char *share_kept;
    char *hessian; /* Laplacians stand behind the Hessians */
};

/* What lenders and borrowers of curvature keep. */
struct sphgi_lending {
    uint8_t open[SPHGI_WIDTH]; /* 1: lenders could change what is resolved */
    bool scaled;               /* moment_scale holds what moments are multiplied by */
    char *linear, *moment_scale, *confidence, *lent_confidence, *lent;
    char *borrowed, *prior, *transport;
};

struct sphgi_worker {
    const struct sphgi_sweep *sweep;
    const struct sphgi_passes *passes;

    /* The scheme, in the units of the sums. */
    struct sphgi_gather gather;
    struct sphgi_gather both; /* the same for pairs that are weighed with both radii */
    struct sphgi_gather near; /* ... and for those of them that are within the target's own */
    struct sphgi_shape shape;
    struct sphgi_threshold threshold;
    struct sphgi_second second;
    double inverse_h;
    double factor_of_h;                                     /* w_scale, times H */
    struct sphgi_table_unit table_units[SPHGI_TABLE_UNITS]; /* of the table of corrections */
    bool factors_at_once;    /* s_ij come with the pairs, for nobody asks for distances */
    const uint32_t *ids_end; /* of the lists that are kept */
    bool is_short;           /* whole groups are summed by one pass, which is told ... */
    struct sphgi_group_sums short_way;
    struct sphgi_record_sums by_records; /* instead, where the sweep has records */
    bool both_as_gathered;               /* pairs that count with two radii are weighed then, too */
    bool near_as_gathered;               /* ... and those within the target's own among them */
    bool coefficients_first; /* they must be known before all that this sweep sums can be: it comes
                                in rounds, or they are there */

    struct sphgi_source_rows rows;
    struct sphgi_bundle bundle;
    struct sphgi_batch batch;
    struct sphgi_waiting waiting;
    struct sphgi_tile tile;
    struct sphgi_held held;
    struct sphgi_begun begun;
    struct sphgi_own own;
    struct sphgi_lane_radii radii;
    struct sphgi_curvature curvature;
    struct sphgi_lending lending;
    struct sphgi_tally *tally;
    char *finder_memory;
    struct sphgi_woven woven;
    struct sphgi_mixed mixed;

    /* Numbers of the bundle, [number][SPHGI_WIDTH]: from sums to results. */
    char *reduced, *raw, *coefficients, *lambda_min, *jacobian, *contracted;
    char *self, *extra, *zeros;
};

enum { SPHGI_HESSIANS = 54 };         /* numbers of all of a tensor's components */
enum { SPHGI_WAITING_IDS = 1 << 15 }; /* of lists that wait until the lanes are full */

/* Corrections come in the same sweep before other sums that need them: its pairs are summed in
 * rounds. */
bool sphgi_is_summed_in_rounds(const struct sphgi_sweep *sweep);
/* There is memory for so many tiles. Copied rows are those of one. */
int32_t sphgi_tiles_of(const struct sphgi_sweep *sweep);

/* Bytes of memory of one worker; 0 on overflow. */
size_t sphgi_worker_size(const struct sphgi_sweep *sweep);
void sphgi_worker_open(struct sphgi_worker *worker, const struct sphgi_sweep *sweep,
                       int32_t number);

/* Where value `number` of the first target at work stands in memory of the form
 * [number][SPHGI_WIDTH]. */
static inline char *sphgi_lane(const struct sphgi_worker *worker, char *base, int32_t number)
{
    const size_t size = sphgi_size_of_type(worker->sweep->plan->type);
    return base + ((size_t)number * SPHGI_WIDTH + (size_t)worker->batch.first) * size;
}

/* The targets at work, and their rows. */
static inline const int32_t *sphgi_targets(const struct sphgi_worker *worker)
{
    return worker->bundle.target + worker->batch.first;
}

static inline const int32_t *sphgi_places(const struct sphgi_worker *worker)
{
    return worker->bundle.place + worker->batch.first;
}

#endif
