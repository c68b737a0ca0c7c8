/* SPDX-License-Identifier: MIT */
/* What a sweep hands to its passes: tiles of pairs, how they are gathered and weighed, what becomes
 * of their sums.
 *
 * Words used throughout:
 *   row     4 numbers of one particle: x y z V, or up to 4 components of a field
 *   lanes   numbers that an instruction works on
 *   group   up to SPHGI_WIDTH targets that are corrected and written together, summed `lanes` at a
 *           time. What belongs to targets stands as [number][SPHGI_WIDTH].
 *   tile    pairs of `lanes` targets, gathered into arrays that stay in the L1 cache: [step][lane],
 *           a lane for each target, its pairs one after the other
 *   chunk   SPHGI_CHUNK pairs that follow one another in the list of a target
 *   sums    what is accumulated over the pairs of a target: in a register along a chunk, then chunk
 * by chunk in memory, so that neither the length of vectors nor that of tiles changes a bit */
#ifndef SPHGI_PASSES_SUMS_H
#define SPHGI_PASSES_SUMS_H
#include "internal.h"

enum {
    SPHGI_ROW = 4,         /* numbers in a row */
    SPHGI_PAD = 8,         /* lists are padded to a multiple of this */
    SPHGI_ID_STEP = 2,     /* ids are numbers of rows times this: a row of f32 then stands at
                              base + 8 * id [byte], which needs no shift */
    SPHGI_LANES_MOST = 16, /* of any scalar type and instruction set */
    SPHGI_CHUNK = 64,      /* pairs: twice the usual number of neighbours. A sum is rounded like one
                              of so many terms */
    SPHGI_PLAIN_CHUNKS = 4, /* of a list; what is added beyond these is compensated */
    SPHGI_SECTIONS = 3,     /* of sums: they, their carries, what spread chunks come to */
    SPHGI_TILE = SPHGI_CHUNK * SPHGI_LANES_MOST + 16, /* numbers in an array: no power of two, lest
                                                         the arrays share lines of the cache */
    SPHGI_WIDTH = 32,                                 /* targets that are finished together */
    SPHGI_GROUP = 16,                                 /* targets whose lists stand side by side */
    SPHGI_FIND_MOST = 16,                             /* targets that share one set of candidates */
    SPHGI_FIND_PAD = 2 * SPHGI_LANES_MOST,            /* dummies behind each list that is found */
    SPHGI_FIND_SLACK = SPHGI_FIND_PAD /* candidates, and ids, that are written beyond the last */
};

/* Arrays of a tile, SPHGI_TILE numbers each. */
enum sphgi_array {
    SPHGI_X, /* x_ij, times sphgi_gather.unit */
    SPHGI_Y,
    SPHGI_Z,
    SPHGI_R,  /* |x_ij|, times unit */
    SPHGI_V,  /* V_j / H^d */
    SPHGI_S,  /* s_ij / H; before that, and for the classic methods, w_j */
    SPHGI_D,  /* (dw_j / dr) / r */
    SPHGI_GX, /* G_ij: classic, and gradients pair by pair */
    SPHGI_GY,
    SPHGI_GZ,
    SPHGI_TX, /* minus the gradient seen from j, weighted: the other half of adjoint and symmetric
               */
    SPHGI_TY,
    SPHGI_TZ,
    SPHGI_PHI, /* weight of the value: V_j W, classic Phi_j */
    SPHGI_P,   /* order 2: products s_ij x_a x_b of all pairs of axes, up to six arrays */
    SPHGI_UX = SPHGI_P + 6, /* x_ij itself, where it is to be scaled by the radius of j, too */
    SPHGI_UY,
    SPHGI_UZ,
    SPHGI_UR, /* |x_ij| */
    SPHGI_ARRAYS,
    SPHGI_L = SPHGI_GX, /* L_ij of diffusion, which no G_ij stand beside */
    SPHGI_W = SPHGI_D   /* W of linearised methods, where fields have volumes of their own */
};

/* The vectors that a sum over pairs contains. */
enum sphgi_vectors {
    SPHGI_FACTORS,   /* s_ij x_ij */
    SPHGI_GRADIENTS, /* G_ij */
    SPHGI_TRANSPOSED /* T_ij */
};

struct sphgi_tile {
    void *arrays;
    const uint32_t *ids;     /* of rows: [step][lane]; the dummy's where there is no pair */
    ptrdiff_t id_stride;     /* from step to step */
    const uint32_t *ids_end; /* of the memory they stand in; NULL: they are the tile's own */
    const void *also;        /* rows that are read by the same ids afterwards; NULL: none */
    int32_t also_arrays;     /* of them, one behind the other ... */
    ptrdiff_t also_numbers;  /* ... of so many numbers each */
    uint32_t *own_ids;       /* SPHGI_TILE: room for ids that do not stand like this in memory */
    int32_t steps;           /* SPHGI_CHUNK at most */
    int32_t chunk;           /* of the lists, that the tile holds: 0 starts the sums */
    bool spread;             /* the lanes hold one list, a chunk each */
    bool carries;            /* lists have more chunks than are added as they are */
    bool scattered;          /* targets of lanes beside each other do not stand so in storage */
    bool weighed;            /* classic: V_j is in both weights already, if they want it */
    ptrdiff_t section; /* numbers from a sum to its carry, and on to what a spread chunk comes to */
};

/* Lists to be laid side by side, one for each lane. */
struct sphgi_lane_lists {
    const uint32_t *ids[SPHGI_LANES_MOST];
    int32_t count[SPHGI_LANES_MOST];
    int32_t stride[SPHGI_LANES_MOST]; /* from one id to the next */
    bool numbers;                     /* of the host's sources, yet to become ids; strides of 1 */
    bool side_by_side;                /* they stand as the tile wants them, dummies included */
};

/* How pairs become x_ij. Padding is a pair with row `dummy`: farther away than the cutoff, so that
 * its weight is 0, and with fields of 0. Masked ones test each pair; their dummy may be NaN. */
struct sphgi_gather {
    const void *rows;        /* x y z V of the sources */
    const void *target_rows; /* x y z . */
    double unit;             /* what x_ij is multiplied with: 1, classic 1 / H */
    double cutoff;           /* H, for supersets */
    double period[3];        /* 0: open */
    bool periodic, superset;
    bool masked;   /* periodic, superset, or no dummy is far enough */
    bool volumes;  /* V_j differ: gather the 4th number of the rows */
    bool radii;    /* cutoff and unit are those of the targets: the 4th number of theirs */
    bool all;      /* ... but everybody in the list counts */
    bool either;   /* ... or whom either radius reaches: rows hold those of the sources */
    bool keeps;    /* what is scaled stays beside it as it was */
    double volume; /* V_j otherwise */
    int32_t dimension;
    uint32_t dummy; /* id of the row that a pair beyond the cutoff is sent to */
};

/* Terms of the sources in adjoint and symmetric sums that are multiplied out before the sweep, once
 * a particle instead of once a pair: b_j = weight_j C_j A_j (theory.md, section 5). What a pair
 * adds is then ... */
enum sphgi_fold {
    SPHGI_NOT_FOLDED,
    SPHGI_FOLDED_NUMBER,    /* b s_ij x_ij */
    SPHGI_FOLDED_VECTOR,    /* b . s_ij x_ij */
    SPHGI_FOLDED_SYMMETRIC, /* b s_ij x_ij, b a symmetric matrix */
    SPHGI_FOLDED_MATRIX
};

/* All sums of targets whose lists stand side by side: moments, and those of some fields. */
enum { SPHGI_GROUP_FIELDS = 8 };
struct sphgi_group_field {
    int32_t numbers;       /* 1 or as many as axes */
    bool divergence;       /* of a vector is summed; else gradients */
    const void *rows;      /* A_j */
    const void *at_target; /* what is subtracted from A_j, [number][SPHGI_WIDTH]. NULL, of one field
                              alone: A_i stands among the rows at the targets' places, and
                              A_j - A_i is wanted ... */
    int32_t own;           /* ... for 1, A_j + A_i for -1, A_j for 0 */
    void *sums;            /* [sum][SPHGI_WIDTH] */
    void *second;          /* of order 2, those over products of offsets */
};
struct sphgi_group_sums {
    const struct sphgi_gather *gather;
    bool three;    /* dimensions */
    void *moments; /* [sum][SPHGI_WIDTH]; NULL: none */
    int32_t fields;
    struct sphgi_group_field field[SPHGI_GROUP_FIELDS];
};
struct sphgi_group_lists {
    const uint32_t *ids;
    int32_t steps;
    bool kept_stand;       /* what is kept is read, not written */
    const int32_t *places; /* of the targets, a lane each */
    int32_t first;         /* the lane of the first, of SPHGI_WIDTH */
    void *kept;            /* s_ij of the first target's list; NULL: none */
};

/* The same where all s_ij are there: of a source nothing is read but its record, its coordinates
 * along the axes and, behind them, the numbers of the field. Where s_ij are formed, records hold
 * these numbers alone. */
struct sphgi_record_sums {
    const struct sphgi_gather *gather; /* for the rows of the targets */
    const void *records;               /* those of the targets, too, where own is not 0 */
    int32_t dimension;
    bool apart; /* s_ij are formed; of more than a row of b_j or of a symmetric tensor, in 3D */
    bool moments, divergence; /* divergence: of the field, instead of its gradient */
    sphg_shape shape;         /* of the field; 0: there is none */
    int32_t own;              /* as in sphgi_group_sums */
    enum sphgi_fold fold;     /* the numbers are b_j ... */
    bool dense;               /* ... and what stands behind them */
    void *moment_sums, *sums; /* [sum][SPHGI_WIDTH] */
    void *vectors;            /* of fields that are folded: what stands before A_i */
};

/* Numbers in a record, whole rows. */
static inline int32_t sphgi_record_width(int32_t dimension, int32_t numbers)
{
    return (dimension + numbers + SPHGI_ROW - 1) / SPHGI_ROW * SPHGI_ROW;
}

/* What becomes of the host's numbers of sources; the dummy is the row behind these. */
struct sphgi_cleaning {
    uint32_t mask, sources, self;
};

/* Where lists of the host's numbers become ids, a chunk of each; and what is read next, so that the
 * memory can be asked for it. */
struct sphgi_slots {
    struct sphgi_cleaning how;
    const int32_t *targets;       /* a list may name its own; NULL: they are no sources */
    uint32_t *ids;                /* SPHGI_CHUNK a lane */
    const uint32_t *const *ahead; /* lists, a lane each; NULL: nothing is asked for */
    int32_t ahead_begin;          /* the first number of these that is read, */
    int32_t ahead_count;          /* and how many are of the longest */
};

/* Asks the memory for the numbers of a list of usual length, or for more if it may be longer: how
 * many lines each list takes nobody could foresee. */
static inline void sphgi_ask_for_numbers(uintptr_t list, int32_t count)
{
    enum { LINE = SPHGI_ALIGNMENT, USUAL = 2 /* lines */ };
    const uintptr_t bytes = (uintptr_t)count * sizeof(int32_t);
    for (uintptr_t line = 0; line < USUAL; ++line)
        __builtin_prefetch((const void *)(list + line * LINE));
    for (uintptr_t line = USUAL; line < (bytes + LINE / 2) / LINE; ++line)
        __builtin_prefetch((const void *)(list + line * LINE));
}

/* A smoothing kernel with everything multiplied into its two factors. */
struct sphgi_shape {
    sphg_kernel kernel;
    sphg_method method;
    int32_t dimension;
    double inverse_h;   /* from the unit of the offsets to q = r / H */
    double w_scale;     /* sigma / H; RKPM and MLS sigma / (mu2 H) */
    double value_scale; /* sigma */
    const void *inverse_lanes,
        *factor_lanes; /* instead of inverse_h and w_scale, a number per lane,
                          where targets have radii of their own; or NULL */
};

struct sphgi_threshold {
    sphg_policy policy;
    double eps;
    int32_t dimension;
    double unit;            /* of the linearised moments: 1 / H */
    const void *unit_lanes; /* instead, a number per target, or NULL */
};

/* What the units of targets with radii of their own are made of. */
struct sphgi_lane_units {
    double largest;     /* H of the plan, in whose units volumes stand */
    double factor_of_h; /* w_scale times H */
    int32_t dimension;
    bool with_volume; /* s_ij holds V_j */
    bool in_radii;    /* offsets are in units of the target's radius: no 1 / H is left in s_ij */
};

/* The second block of order 2 (theory.md, section 9). */
struct sphgi_second {
    sphg_policy policy;
    double eps;                  /* eps_q */
    double high;                 /* eps, below which curvature is borrowed */
    double off, diagonal, trace; /* whitening of products of offsets: of x_a x_b, of x_a x_a, and of
                                    the sum of these */
    bool whole; /* R is wanted, the part of a correction that gives second derivatives */
};

/* Curvature taken from neighbours (theory.md, section 9). Memory of lanes. */
struct sphgi_borrowing {
    const void *lent;   /* sums of w c, w c hess A ..; NULL: nobody lends */
    const void *linear; /* C; read, as what follows it is written, where somebody does */
    void *prior, *transport;
    void *confidence; /* c */
    uint8_t *open;    /* 1 where lenders could change results; written for whole vectors */
};

/* What a source's term in adjoint and symmetric sums is multiplied with. */
enum sphgi_weight {
    SPHGI_WEIGHT_ONE,
    SPHGI_WEIGHT_V,
    SPHGI_WEIGHT_PER_DENSITY,
    SPHGI_WEIGHT_V_PER_DENSITY
};

/* How the adjoint and the symmetric form of targets are made of sums over both sides. */
struct sphgi_two_sided {
    double unit;         /* from the sources' terms to units of H ... */
    double factor;       /* ... and from these to the unit of the result */
    const void *volume;  /* V_i */
    const void *density; /* rho_i; NULL: the adjoint form */
    bool holds_volume;   /* the sources' terms hold V_i, which has been left out of the sums */
};

/* What `square` adds up to: sums, of a triangle that C_i goes around unless that is NULL; and of
 * classic methods the target's own pair, G_ii and A_i, or NULL. */
struct sphgi_square {
    const void *correction;
    double factor;
    const void *each; /* times the factor; NULL: 1 */
    const void *self, *value;
};

/* What the classic methods and order 2 read of sources that have radii of their own: coefficients;
 * H / H_j, 1 / H_j, H_j and, of order 2, a factor behind them in `radii`; rho_j or NULL. */
struct sphgi_other_side {
    const void *table[6], *radii, *density;
    enum sphgi_weight weight; /* of order 2 */
};

/* Numbers of b_j. */
static inline int32_t sphgi_folded_numbers(enum sphgi_fold fold, int32_t dimension)
{
    switch (fold) {
    case SPHGI_FOLDED_NUMBER:
        return 1;
    case SPHGI_FOLDED_VECTOR:
        return dimension;
    case SPHGI_FOLDED_SYMMETRIC:
        return dimension * (dimension + 1) / 2;
    default:
        return dimension * dimension;
    }
}

/* The host's table is ours times these: value all of a linearised one, or y; slope z_k. */
struct sphgi_scales {
    double value, slope;
};

/* What became of the matrices of a group. A bit per lane. */
struct sphgi_verdict {
    int32_t count;         /* in: so many count */
    uint32_t decomposed;   /* the others have full rank */
    uint32_t empty;        /* no neighbour, or none that counts */
    double largest_square; /* of |A^-1|_F over the lanes that were not decomposed */
    void *kept; /* of decomposed lanes: the product of what is kept of each direction, 1 where all
                   are full; NULL: not wanted */
    uint8_t rank[SPHGI_WIDTH];      /* of the decomposed lanes */
    double lambda_min[SPHGI_WIDTH]; /* of the decomposed lanes */
};

#endif
