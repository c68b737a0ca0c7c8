/* SPDX-License-Identifier: MIT */
/* Small matrices that break solvers: random and adversarial spectra, and the long double
 * eigendecomposition they are judged by. */
#ifndef TESTS_SUPPORT_SPECTRA_H
#define TESTS_SUPPORT_SPECTRA_H
#include "random.h"

/* X(name): the first SPECTRA_SYMMETRIC are symmetric, the rest general. */
#define SPECTRA(X)                                                                                 \
    X(near_identity)                                                                               \
    X(tenth_to_one)                                                                                \
    X(identity_and_small_noise)                                                                    \
    X(identity_and_rounding_noise)                                                                 \
    X(one_one_small)                                                                               \
    X(one_small_small)                                                                             \
    X(graded)                                                                                      \
    X(graded_rows)                                                                                 \
    X(integer_rank_two)                                                                            \
    X(integer_rank_one)                                                                            \
    X(axis_aligned)                                                                                \
    X(near_threshold)                                                                              \
    X(indefinite)                                                                                  \
    X(denormal)                                                                                    \
    X(tiny)                                                                                        \
    X(huge)                                                                                        \
    X(general)                                                                                     \
    X(rotation)                                                                                    \
    X(general_graded)                                                                              \
    X(general_rank_two)                                                                            \
    X(general_rank_one)

#define SPECTRA_X(name) SPECTRA_##name,
typedef enum spectrum { SPECTRA(SPECTRA_X) SPECTRA_COUNT } spectrum;
#undef SPECTRA_X

enum { SPECTRA_SYMMETRIC = SPECTRA_general };

extern const char *const spectra_names[SPECTRA_COUNT];

/* Around which eigenvalue near_threshold gathers. */
#define SPECTRA_THRESHOLD 1e-2

/* A d x d matrix of the set, row-major, every number representable in f32 or f64. */
void spectra_matrix(spectrum set, int dimension, int is_double, random_state *random, double *a);

/* Q diag(values) Q^T with a random Q, rounded. */
void spectra_compose(int dimension, const double *values, int is_double, random_state *random,
                     double *a);

/* A = Q diag(values) Q^T by Jacobi's method to convergence; values descending, vectors the
 * columns of Q. */
void spectra_eigen(int dimension, const double *a, long double *values, long double *vectors);

#endif
