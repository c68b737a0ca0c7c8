/* SPDX-License-Identifier: MIT */
/* A request, checked and turned into what has to be summed: which rows are read, which sums are
 * formed, where the results go. */
#ifndef SPHGI_PLAN_H
#define SPHGI_PLAN_H
#include "core/check.h"
#include "search/neighbors.h"

/* Up to SPHGI_ROW components of one array, read as rows. columns.count 0: zeros. */
struct sphgi_stream {
    struct sphgi_columns columns;
    int32_t first, count;
    bool mirrored; /* of a field: A_j = A_i, the rows are zeros */
};

struct sphgi_set_plan {
    const sphg_neighbors *neighbors;
    struct sphgi_columns volume;
    bool same_volumes;                  /* the host says so: those of the sweep before */
    const struct sphgi_stream *streams; /* sphgi_plan.stream_count of them */
};

struct sphgi_field_plan {
    sphg_shape shape;
    sphg_form form;
    bool accumulate, differentiates; /* gradient, divergence, curl or square is wanted */
    bool one_sided;                  /* summed over G_ij; else over G_ji, too */
    bool antisymmetric;              /* PLAIN, adjoint: V_i sum (A_j + A_i) G_ij */
    bool diffuses;                   /* the Laplacian of the adjoint form is wanted */
    bool sums_divergence;            /* the divergence is summed as such */
    bool sums_gradient;              /* what gradient and curl are made of is summed */
    bool mirrors;                    /* at any set */
    enum sphgi_fold fold;            /* of a divergence, or a scalar's gradient */
    int32_t components;
    int32_t stream, streams;         /* A_j as the host has it ... */
    int32_t row, rows;               /* ... as the passes read it; rows 0: they do not ... */
    int32_t folded_row, folded_rows; /* ... and b_j */
    int32_t sum;                     /* first of components * d sums of A times a gradient */
    int32_t divergence_sum;        /* first of 1 (vector) or d (tensor) sums, if sums_divergence */
    int32_t square_sum;            /* of A G G^T its trace, or its triangle where C_i is to come */
    int32_t value_sum;             /* first of components sums of A Phi, -1: not wanted */
    int32_t second_sum;            /* order 2: first of components times pairs of axes */
    int32_t lent_stream, lent_row; /* what lenders offer, as the host has it, and in rows ... */
    int32_t lent_rows;             /* ... so many; 0: nobody lends */
    int32_t lent_sum;              /* first of 1 + components times pairs of axes */
    bool normalises;               /* the value is divided by the sum of its weights ... */
    int32_t filling_sum;           /* ... which is this one */
    int32_t volume_stream, volume_row; /* V_j of the value, as the host has them and in rows; -1:
                                          the sets' */
    int32_t coefficient_stream, coefficient_row; /* k_j, as the host has them and in rows; -1: 1 */
    int32_t diffusion_sum;            /* first of components sums of k_ij L_ij (A_j - A_i) */
    int32_t at_target;                /* first of the lanes that hold A_i */
    int32_t coefficient_at_target;    /* the lane that holds k_i */
    struct sphgi_columns target;      /* A_i */
    struct sphgi_columns coefficient; /* k_i */
    struct sphgi_columns own_volume;  /* V_i of the value, of targets as sources */
    struct sphgi_columns tensor, contraction; /* T_i, and J : T_i */
    struct sphgi_columns value, gradient, divergence, curl, square, laplacian;
    struct sphgi_columns hessian[3]; /* of each component */
    struct sphgi_columns curvature;  /* what targets lend */
};

struct sphgi_plan {
    struct sphgi_scheme scheme;
    sphg_type type;
    int32_t dimension, target_count;
    int32_t set_count, field_count;
    int32_t stream_count; /* what is read of the sources ... */
    int32_t row_count;    /* ... and what of it, or made of it, stands in rows */
    struct sphgi_set_plan *sets;
    struct sphgi_field_plan *fields;
    int32_t own_set; /* that the targets are part of, or -1 */

    struct sphgi_columns target_volume, target_density, target_correction;
    struct sphgi_columns own_volume; /* V of the targets as sources */
    struct sphgi_columns correction, rank, lambda_min, borrows;
    sphg_stats *stats;

    bool computes;          /* corrections, in this call */
    bool corrects;          /* results are multiplied with a correction, computed or given */
    bool classic, weighted; /* weighted: V_j stands in the classic weight */
    bool quadratic;         /* order 2 */
    bool lends;             /* ... and any field lends or borrows, or who would is asked for */
    bool graded;  /* targets have radii of their own; that of the scheme is the largest there is */
    double least; /* ... and the smallest */
    bool differentiates, adjoint; /* any field */
    bool transposes[2];           /* any field is summed over G_ji; [0] adjoint, [1] symmetric */
    bool wants_value;
    bool values_by_volume;                     /* any value with the volumes of the sets ... */
    bool values_by_own;                        /* ... and with those of its field */
    bool diffuses;                             /* any field */
    bool mirrors;                              /* any field, at any set */
    bool mean_volume;                          /* MLS without volumes at the targets */
    int32_t correction_stream, density_stream; /* -1: not needed */
    int32_t correction_row, density_row;       /* -1: no pair needs them */
    bool sums_transposed[2]; /* adjoint, symmetric: A_j of any field is read with T */
    bool both_sides;         /* both ends of a pair have radii of their own, and either counts */
    bool both_at_once;  /* any field is folded then: its pairs are weighed with both at once ... */
    bool both_alone;    /* ... and nothing else is summed */
    bool narrows;       /* beside these, something is summed over pairs with r < H_i alone */
    bool both_first;    /* pairs are not weighed before the fields of both sides are summed */
    int32_t radius_row; /* of each source's radius, for the fields that are not folded then; -1 */
    int32_t carrier[2]; /* the folded field that sums folded_sum on its way, -1: none */
    int32_t sums;
    int32_t moment_sums; /* all that corrections need: they stand first */
    int32_t moment_sum, volume_sum;
    int32_t slope_sum; /* classic: first of those that follow once y is known; they stand last of
                          what corrections need */
    int32_t vector_sum[2]; /* of adjoint and symmetric: sum G_ij, sum rho_j G_ij ... */
    int32_t folded_sum[2]; /* ... and those of folded fields: the same, unless both_at_once */
    int32_t target_lanes;  /* numbers of all A_i */
};

enum sphgi_purpose {
    SPHGI_FOR_RESULTS,
    SPHGI_FOR_PAIRS,         /* which there are */
    SPHGI_FOR_PAIR_GRADIENTS /* ... and their G_ij */
};

/* From the fields and views of a plan to all that its second half holds. */
void sphgi_plan_decide(struct sphgi_plan *plan, enum sphgi_purpose purpose);

/* Numbers of a correction. */
/* Linear corrections are symmetric matrices; other tables are flat. */
static inline sphg_shape sphgi_shape_of_table(const struct sphgi_plan *plan)
{
    const bool linear = plan->scheme.method <= SPHG_RKPM && !plan->quadratic;
    return linear ? SPHG_SYM_TENSOR : (sphg_shape)0;
}

static inline int32_t sphgi_plan_width(const struct sphgi_plan *plan)
{
    return sphgi_correction_width(plan->scheme.method, plan->dimension, plan->scheme.order);
}

/* Rows that the correction of a source stands in: of order 2 its P and Q. */
static inline int32_t sphgi_correction_rows(const struct sphgi_plan *plan)
{
    const int32_t d = plan->dimension, pairs = d * (d + 1) / 2;
    return plan->classic     ? d + 1
           : plan->quadratic ? (pairs + d * pairs + SPHGI_ROW - 1) / SPHGI_ROW
                             : d - 1;
}

/* Where the sums of one derivative begin. */
static inline int32_t sphgi_first_sum(const struct sphgi_field_plan *field)
{
    return field->sums_divergence ? field->divergence_sum : field->sum;
}

/* Sums of moments of order 2: of second, third and fourth order. */
static inline int32_t sphgi_quadratic_moments(int32_t dimension)
{
    return dimension == 3 ? 6 + 10 + 15 : 3 + 4 + 5;
}

/* Numbers that `square` of a field is summed in. */
int32_t sphgi_square_sums(const struct sphgi_plan *plan);

#endif
