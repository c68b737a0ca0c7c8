/* SPDX-License-Identifier: MIT */
#include "oracle_matrix.h"

/* ---- Eigenvalues: cyclic Jacobi ------------------------------------------------------------- */

/* 0: nothing was left to turn. */
static int rotate(int n, oracle_matrix a, oracle_matrix vectors, int p, int q)
{
    /* So small beside the diagonal that it is less than a unit of its last place. */
    if (quad_abs(a[p][q]) <= 0x1p-130 * (quad_abs(a[p][p]) + quad_abs(a[q][q]))) {
        a[p][q] = a[q][p] = 0;
        return 0;
    }
    quad theta = (a[q][q] - a[p][p]) / (2 * a[p][q]);
    quad t = (theta < 0 ? -1 : 1) / (quad_abs(theta) + quad_sqrt(theta * theta + 1));
    quad c = 1 / quad_sqrt(t * t + 1), s = t * c;
    const quad change = t * a[p][q];
    a[p][p] -= change;
    a[q][q] += change;
    for (int k = 0; k < n; ++k) {
        quad left = a[k][p], right = a[k][q];
        if (k == p || k == q)
            continue;
        a[k][p] = a[p][k] = c * left - s * right;
        a[k][q] = a[q][k] = s * left + c * right;
    }
    for (int k = 0; k < n; ++k) {
        quad left = vectors[k][p], right = vectors[k][q];
        vectors[k][p] = c * left - s * right;
        vectors[k][q] = s * left + c * right;
    }
    a[p][q] = a[q][p] = 0;
    return 1;
}

/* Sweeps until nothing is left to turn: convergence is quadratic. */
static void diagonalise(int n, oracle_matrix a, oracle_matrix vectors)
{
    enum { sweeps = 20 };
    int turned = 1;
    for (int sweep = 0; sweep < sweeps && turned; ++sweep) {
        turned = 0;
        for (int p = 0; p < n; ++p)
            for (int q = p + 1; q < n; ++q)
                turned |= rotate(n, a, vectors, p, q);
    }
}

void oracle_eigen(int n, oracle_matrix a, quad *values, oracle_matrix vectors)
{
    oracle_matrix work;
    for (int i = 0; i < n; ++i)
        for (int j = 0; j < n; ++j) {
            work[i][j] = a[i][j];
            vectors[i][j] = i == j;
        }
    diagonalise(n, work, vectors);
    for (int i = 0; i < n; ++i)
        values[i] = work[i][i];
}

/* The same, for a norm of which nobody needs all digits. */
static void turn_roughly(int n, rough (*a)[oracle_rows], int p, int q)
{
    if (fabsl(a[p][q]) <= 0x1p-70L * (fabsl(a[p][p]) + fabsl(a[q][q])))
        return;
    const rough theta = (a[q][q] - a[p][p]) / (2 * a[p][q]);
    const rough t = (theta < 0 ? -1 : 1) / (fabsl(theta) + sqrtl(theta * theta + 1));
    const rough c = 1 / sqrtl(t * t + 1), s = t * c, change = t * a[p][q];
    a[p][p] -= change;
    a[q][q] += change;
    a[p][q] = a[q][p] = 0;
    for (int k = 0; k < n; ++k) {
        const rough left = a[k][p], right = a[k][q];
        if (k == p || k == q)
            continue;
        a[k][p] = a[p][k] = c * left - s * right;
        a[k][q] = a[q][k] = s * left + c * right;
    }
}

rough oracle_spectral_norm(int n, oracle_matrix a)
{
    enum { sweeps = 10 };
    rough largest = 0, work[oracle_rows][oracle_rows];
    for (int i = 0; i < n; ++i)
        for (int j = 0; j < n; ++j)
            work[i][j] = (rough)a[i][j];
    for (int sweep = 0; sweep < sweeps; ++sweep)
        for (int p = 0; p < n; ++p)
            for (int q = p + 1; q < n; ++q)
                turn_roughly(n, work, p, q);
    for (int k = 0; k < n; ++k)
        largest = rough_max(largest, fabsl(work[k][k]));
    return largest;
}

/* ---- Policies ------------------------------------------------------------------------------- */

/* f and f' of one eigenvalue; kept: f = 1/lambda exactly. */
typedef struct policy_value {
    quad f, derivative;
    int kept;
} policy_value;

static policy_value inverse_of(quad lambda)
{
    policy_value value = {1 / lambda, -1 / (lambda * lambda), 1};
    return value;
}

static policy_value constant(int below)
{
    policy_value value = {below, 0, 0};
    return value;
}

static policy_value blended(quad lambda, quad eps, int below)
{
    quad t = (lambda - eps) / (3 * eps);
    if (t >= 1)
        return inverse_of(lambda);
    if (t <= 0)
        return constant(below);
    quad w = t * t * (3 - 2 * t), rate = 6 * t * (1 - t) / (3 * eps);
    policy_value value = {w / lambda + (1 - w) * below,
                          rate * (1 / lambda - below) - w / (lambda * lambda), 0};
    return value;
}

static policy_value apply(sphg_policy policy, quad lambda, quad lambda_min, quad eps, int below)
{
    switch (policy) {
    case SPHG_BLEND:
        return blended(lambda, eps, below);
    case SPHG_REPLACE:
        return lambda > eps ? inverse_of(lambda) : constant(below);
    case SPHG_TRUNCATE:
        return lambda > eps ? inverse_of(lambda) : constant(0);
    default:
        return lambda_min > eps ? inverse_of(lambda) : constant(below);
    }
}

static quad smallest(int n, const quad *values)
{
    quad least = values[0];
    for (int k = 1; k < n; ++k)
        least = values[k] < least ? values[k] : least;
    return least;
}

/* The steepest f within `blur` of an eigenvalue. Beside a band of the policy that is hardly wider
 * than what rounding does to lambda, the slope at lambda itself says little. */
static rough steepest(sphg_policy policy, const oracle_filter *filter, int k, int below, quad blur)
{
    enum { steps = 8 };
    rough largest = 0;
    /* Above every band it is the lowest of them. */
    const int first = -steps, last = filter->lambda[k] - blur >= 4 * filter->eps ? first : steps;
    for (int step = first; step <= last; ++step) {
        quad near = filter->lambda[k] + blur * step / steps;
        policy_value value = apply(policy, near, filter->lambda_min, filter->eps, below);
        largest = rough_max(largest, rough_abs(value.derivative));
    }
    return largest;
}

oracle_filter oracle_filtered(int n, oracle_matrix normalised, sphg_policy policy, quad eps,
                              int below, quad blur)
{
    oracle_filter filter = {.n = n, .eps = eps};
    oracle_eigen(n, normalised, filter.lambda, filter.axes);
    filter.lambda_min = smallest(n, filter.lambda);
    for (int k = 0; k < n; ++k) {
        policy_value value = apply(policy, filter.lambda[k], filter.lambda_min, eps, below);
        filter.f[k] = value.f;
        filter.rank += value.kept;
    }
    for (int k = 0; k < n; ++k)
        for (int l = 0; l < n; ++l) {
            quad gap = filter.lambda[k] - filter.lambda[l];
            quad size = quad_abs(filter.lambda[k]) + quad_abs(filter.lambda[l]);
            filter.divided[k][l] = quad_abs(gap) <= size * 0x1p-50
                                       ? steepest(policy, &filter, k, below, blur)
                                       : rough_abs(filter.f[k] - filter.f[l]) / rough_abs(gap);
        }
    return filter;
}

void oracle_recompose(const oracle_filter *filter, oracle_matrix result)
{
    for (int a = 0; a < filter->n; ++a)
        for (int b = 0; b < filter->n; ++b) {
            result[a][b] = 0;
            for (int k = 0; k < filter->n; ++k)
                result[a][b] += filter->axes[a][k] * filter->f[k] * filter->axes[b][k];
        }
}
