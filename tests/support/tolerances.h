/* SPDX-License-Identifier: MIT */
/* Every tolerance of the tests, in one table: multiples of the unit roundoff u (2^-24 in f32 and
 * mixed, 2^-53 in f64), one number for all precisions. `measured` is the worst value seen when the
 * row was last set (all cases, GCC and Clang); the run prints what it measured beside the limit. */
#ifndef TESTS_SUPPORT_TOLERANCES_H
#define TESTS_SUPPORT_TOLERANCES_H

/* X(name, limit, measured, reason) */
#define TEST_TOLERANCES(X)                                                                         \
    /* The oracle on its own, in units of 2^-113 */                                                \
    X(quad_kernel, 32, 7, "quadrature of polynomials of degree 15, a hundred terms")               \
    X(quad_exactness, 2000, 328, "inverse of moments with condition up to 1e3")                    \
    X(quad_difference_quotient, 1e6, 1.3e5, "over step^2: a sixth of the third derivative")        \
    /* Against the oracle: |error| / D */                                                          \
    X(oracle_ratio_full, 10, 5.9, "gate at full rank; a value of one term is W, 7.7 off")          \
    X(oracle_ratio_touched, 16, 8.3, "gate where the threshold acts; a quotient of two W")         \
    X(kernel_constant, 4, 1.23, "sigma and mu2: a rounded fraction, a rounded 1/pi and a product") \
    X(kernel_integral, 16, 2.79, "weighted mean of kernel values, each a few roundings off")       \
    X(kernel_value, 10, 7.7, "over |f| + q |f'|: q is rounded first, then ten operations")         \
    X(kernel_slope, 16, 8.77,                                                                      \
      "two values of W at most W(0), and a quadrature of their difference")                        \
    X(solver_single, 10, 2.18, "eigen, svd in f32: double inside, so rounding of the outputs")     \
    X(solver_double, 64, 25.8, "eigen, svd in f64: sweeps of Jacobi rotations")                    \
    X(lapack_residual, 128, 23.4, "not ours: LAPACK's own backward error on the same matrices")    \
    X(solver_against_lapack, 128, 11.7, "Weyl: both residuals; dgesvd alone reaches 99 u")         \
    X(moment_inversion, 16, 3.88, "over u (|C| + |M| max f[.,.]): one perturbation of M, then f")  \
    X(order_of_summation, 256, 43.3, "random cloud: hundreds of terms, C up to 25 / eps")          \
    X(quadratic_ratio_full, 1, .13, "order 2: over D_g and D_h, nothing shifted")                  \
    X(quadratic_ratio_touched, 4, 1.9, "order 2: where the shift or the threshold acts")           \
    X(quadratic_two_sided, 4, .75, "order 2: G of both sides over their bounds")                   \
    X(borrowed_ratio, 4, .78, "borrowed curvature: over bounds of its own, lenders as given")      \
    X(borrowed_confidence, 2, .26, "c over what rounding of S and M2 makes of it")                 \
    X(diffusion_ratio_full, 4, .93, "sum k L dA over the bounds of G of both ends")                \
    X(diffusion_ratio_touched, 8, .77, "the same where the threshold acts on either end")          \
    X(value_ratio, 10, 1.4, "sum V W dA, also over sum V W: a value of one term is W")             \
    X(contraction_sum, 8, 3.3, "nine products and their sum, over the sum of their sizes")         \
    X(diffusion_symmetry, 64, 11, "L_ij from both ends; with radii over the largest of all")       \
    X(diffusion_sum, 8, .75, "sum f and <w, f(A)> - <A, f(w)>, relative to sum |f|")               \
    X(brookshaw, 64, 14, "a loop over W'/r in doubles, relative to the sum of sizes")              \
    /* Properties without the oracle, in units of u */                                             \
    X(linear_exactness, 32, 6.7, "times |J| / lambda_min: the condition of the moments")           \
    X(equal_terms, 10, 8.6, "20 000 times the same term, relative to their sum")                   \
    X(equal_terms_corrected, 32, 23.4, "the quotient of two such sums, and its decomposition")     \
    X(quadratic_exactness, 32, 5.1, "times the size of curvature / lambda_q, or |F|")              \
    X(lent_by_two_sets, 2048, 369, "sums in another order, over what is left of t with lenders")   \
    X(linear_with_lenders, 4096, 604, "rounding of b2 - K^T b1 over t, slopes around 3")           \
    X(linear_momentum, 8, 1.3, "random signs: a rounding per particle, relative to sum |f|")       \
    X(angular_momentum, 8, 0.7, "relative to sum |x| |f|; C M = 1 to the condition of M")          \
    X(second_over_radii, 64, 21,                                                                   \
      "order 2, the same three: P e and Q (e e) cancel where radii grow")                          \
    X(adjointness, 16, 4.8, "two sweeps rounded on their own, relative to the work of one")        \
    X(partition_of_unity, 32, 8, "classic: sum Phi - 1 cancels |y| |A|, the condition of A")       \
    X(gradients_of_unity, 512, 112, "classic: H sum grad Phi, terms as large as 8 each")           \
    X(shepard_value, 16, 4, "a mean of at most four numbers")                                      \
    X(linear_value, 32, 7.9, "classic: value and kept slopes, the condition of A")                 \
    X(equal_within_bound, 20, 0.67, "two results, each within 10 D of the exact one")              \
    X(policy_value, 16, 4, "C along the normal of a plane, in units of 1 / m_ref")                 \
    X(flat_exactness, 32, 9.4, "slopes within a plane, lambda around .3")                          \
    X(one_addition, 2, 1, "a stored gradient added to a stored number")                            \
    /* The examples' solver */                                                                     \
    X(full_friction, 4, 0, "two sums over forty wall particles and their ratio")                   \
    X(exact_iterations, 16, 1, "three steps of conjugate gradients, condition 3, |b| up to 1")

#endif
