/* SPDX-License-Identifier: MIT */
/* The reference: every result by brute force in quadruple precision, written from docs/theory.md
 * and sharing no code with the library, on the same rounded inputs. Beside each result stands
 * its bound D (docs/theory.md, errors): what one rounding of everything could do to it. Tests and
 * sphgrad-bench stability compare |error| / D with a gate. */
#ifndef TESTS_SUPPORT_ORACLE_H
#define TESTS_SUPPORT_ORACLE_H
#include "oracle_kernel.h"
#include "oracle_matrix.h"
#include <stddef.h>

/* One source set; its first target_count particles are the targets unless `targets` is set. */
typedef struct oracle_scene {
    sphg_scheme scheme;
    double unit;          /* u of fields and results */
    int single_positions; /* 1: neighbours are decided in f32 */
    double period[3];
    int source_count, target_count;
    const double *sources, *targets;
    const double *volume, *density;               /* at sources; NULL: absent */
    const double *target_volume, *target_density; /* NULL: those of the sources if part of them */
    const double *support; /* H_i of the targets; NULL: the scheme's for all */
    int mutual;            /* pairs are those with r < max(H_i, H_j), of particles that are both */
} oracle_scene;

typedef struct oracle_pair {
    int j;
    quad x[3], r; /* x_ij */
    quad s;       /* linearised: s_ij; classic: the weight w_j */
    quad slope;   /* classic: (W'/r) [V_j] */
    rough spread; /* linearised: |s| + r |ds/dr|; classic: w + r |w'| */
    rough slope_spread;
    quad gradient[3]; /* G_ij */
    rough bound;      /* D of G_ij */
} oracle_pair;

/* Everything about one target. */
typedef struct oracle_point {
    int pair_count;
    oracle_pair *pairs;
    int has_self;   /* the target is one of the sources */
    int undecided;  /* an eigenvalue so near the threshold that rounding decides */
    double support; /* H_i */
    quad volume;    /* V_i, negative where absent */
    quad scale;     /* m_ref; classic: S0 mu2 */
    rough spread;   /* T = sum a r^2 */
    oracle_filter filter;
    int rank;
    rough correction_norm;  /* |C_i| */
    rough correction_bound; /* D of C_i */
    oracle_matrix moment, correction;
    /* classic */
    quad mass;        /* S0 */
    quad self_weight; /* w_0 */
    quad y[oracle_rows], z[3][oracle_rows];
    quad self_gradient[3];
    rough self_bound;
    rough y_norm, z_norm, condition;
    rough y_bound; /* (1 + k) |y| and what the threshold adds */
    rough z_bound; /* (1 + k) |z|, what cancels in z, and what the threshold adds */
} oracle_point;

/* Zeroed memory, never NULL: each program that links the oracle has one, and releases it when it
 * is done with the references. */
void *oracle_memory(size_t bytes);

typedef struct oracle oracle;
/* The scene is copied, the arrays are borrowed. */
oracle *oracle_of(const oracle_scene *scene);
/* Target i, solved on first use. */
const oracle_point *oracle_at(oracle *reference, int i);

/* An eigenvalue so near a limit of the policy that it may be judged either way. */
int oracle_rank_is_open(const oracle_scene *scene, const oracle_point *point);

typedef struct oracle_field {
    sphg_shape shape;
    sphg_form form;
    const double *at_sources; /* items of the shape's width */
    const double *at_targets; /* NULL: the targets are sources */
} oracle_field;

typedef struct oracle_result {
    quad gradient[9], divergence[3], curl[3], value[9], square;
    rough bound, value_bound, square_bound;
    int touched;   /* a threshold acted on a particle involved */
    int undecided; /* one of them is undecided: do not compare */
} oracle_result;

oracle_result oracle_apply(oracle *reference, const oracle_field *field, int i);
/* |found - exact| / bound of `width` numbers; NaN where one found is not a number. */
double oracle_ratio(int width, const double *found, const quad *exact, quad bound);

/* G_ij for target i's neighbour given as a pair of its list, from coefficients of `point`; used
 * for G_ji with the pair seen from the other side. */
rough oracle_gradient_of(const oracle_scene *scene, const oracle_point *point, oracle_pair *pair);

#endif
