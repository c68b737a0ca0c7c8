/* SPDX-License-Identifier: MIT */
#include "spectra.h"
#include <math.h>
#include <string.h>

#define SPECTRA_X(name) #name,
const char *const spectra_names[SPECTRA_COUNT] = {SPECTRA(SPECTRA_X)};
#undef SPECTRA_X

static double uniform(random_state *random)
{
    return random_between(random, -1, 1);
}

static double decade(random_state *random, double low, double high)
{
    return pow(10, random_between(random, low, high));
}

/* A random rotation: the matrix of a random unit quaternion, or of an angle. */
static void random_rotation(int d, random_state *random, double *q)
{
    double w = uniform(random), x = uniform(random), y = uniform(random), z = uniform(random);
    if (d == 2)
        x = y = 0;
    const double s = 2 / (w * w + x * x + y * y + z * z);
    const double m[9] = {1 - s * (y * y + z * z), s * (x * y - w * z),     s * (x * z + w * y),
                         s * (x * y + w * z),     1 - s * (x * x + z * z), s * (y * z - w * x),
                         s * (x * z - w * y),     s * (y * z + w * x),     1 - s * (x * x + y * y)};
    for (int k = 0; k < d * d; ++k)
        q[k] = m[k / d * 3 + k % d];
}

static void round_all(int count, int is_double, double *a)
{
    for (int k = 0; k < count && !is_double; ++k)
        a[k] = (double)(float)a[k];
}

/* U diag(values) V^T; U = V gives a matrix that is symmetric to the bit. */
static void product(int d, const double *u, const double *values, const double *v, double *a)
{
    for (int r = 0; r < d; ++r)
        for (int c = 0; c < d; ++c) {
            a[r * d + c] = 0;
            for (int k = 0; k < d; ++k)
                a[r * d + c] += values[k] * (u[r * d + k] * v[c * d + k]);
        }
}

void spectra_compose(int dimension, const double *values, int is_double, random_state *random,
                     double *a)
{
    double q[9];
    random_rotation(dimension, random, q);
    product(dimension, q, values, q, a);
    round_all(dimension * dimension, is_double, a);
}

/* I + size * symmetric noise. */
static void noisy_identity(int d, double size, random_state *random, double *a)
{
    for (int r = 0; r < d; ++r)
        for (int c = 0; c <= r; ++c)
            a[r * d + c] = a[c * d + r] = (r == c) + size * uniform(random);
}

/* D B D with a well-conditioned B and D graded to 1e-15. */
static void graded_rows(int d, random_state *random, double *a)
{
    double grade[3];
    for (int k = 0; k < d; ++k)
        grade[k] = decade(random, -15, 0);
    noisy_identity(d, 0.3, random, a);
    for (int k = 0; k < d * d; ++k)
        a[k] *= grade[k / d] * grade[k % d];
}

/* A sum of `rank` outer products of small integer vectors: the rank is exact in every precision. */
static void integer_rank(int d, int rank, int is_symmetric, random_state *random, double *a)
{
    memset(a, 0, (size_t)(d * d) * sizeof *a);
    for (int term = 0; term < rank; ++term) {
        double u[3], v[3];
        for (int k = 0; k < d; ++k) {
            u[k] = random_index(random, 17) - 8;
            v[k] = is_symmetric ? u[k] : random_index(random, 17) - 8;
        }
        for (int k = 0; k < d * d; ++k)
            a[k] += u[k / d] * v[k % d];
    }
}

static void axis_aligned(int d, random_state *random, double *a)
{
    memset(a, 0, (size_t)(d * d) * sizeof *a);
    for (int k = 0; k < d; ++k)
        a[k * d + k] = random_index(random, 2) ? decade(random, -3, 0) : 0;
}

/* Integers times the smallest positive number. */
static void denormal(int d, int is_double, random_state *random, double *a)
{
    for (int r = 0; r < d; ++r)
        for (int c = 0; c <= r; ++c)
            a[r * d + c] = a[c * d + r] =
                ldexp(random_index(random, 1 << 20) - (1 << 19), is_double ? -1074 : -149);
}

static void scale(int d, double factor, double *a)
{
    for (int k = 0; k < d * d; ++k)
        a[k] *= factor;
}

static void general(int d, int is_graded, random_state *random, double *a)
{
    double u[9], v[9], values[3];
    random_rotation(d, random, u);
    random_rotation(d, random, v);
    for (int k = 0; k < d; ++k)
        values[k] = is_graded ? decade(random, -30, 0) : uniform(random);
    product(d, u, values, v, a);
}

/* Eigenvalues of the sets that are composed of them. */
static void choose_values(spectrum set, int d, random_state *random, double *values)
{
    const double small = decade(random, -8, 0);
    for (int k = 0; k < d; ++k) {
        const int last = k == d - 1;
        switch (set) {
        case SPECTRA_one_one_small:
            values[k] = last ? small : 1;
            break;
        case SPECTRA_one_small_small:
            values[k] = k ? small : 1;
            break;
        case SPECTRA_graded:
            values[k] = decade(random, -30, 0);
            break;
        case SPECTRA_near_threshold:
            values[k] = k && random_index(random, 2)
                            ? random_between(random, 0.1, 1)
                            : SPECTRA_THRESHOLD * (1 + uniform(random) * decade(random, -7, 0));
            break;
        case SPECTRA_indefinite:
            values[k] = uniform(random);
            break;
        default:
            values[k] = random_between(random, 0.1, 1);
        }
    }
}

static void composed(spectrum set, int d, int is_double, random_state *random, double *a)
{
    double values[3];
    choose_values(set, d, random, values);
    spectra_compose(d, values, 1, random, a);
    if (set == SPECTRA_tiny)
        scale(d, is_double ? 1e-150 : 1e-30, a);
    if (set == SPECTRA_huge)
        scale(d, is_double ? 1e150 : 1e30, a);
}

void spectra_matrix(spectrum set, int dimension, int is_double, random_state *random, double *a)
{
    const int d = dimension;
    switch (set) {
    case SPECTRA_near_identity:
        noisy_identity(d, 1e-2, random, a);
        break;
    case SPECTRA_identity_and_small_noise:
        noisy_identity(d, 1e-4, random, a);
        break;
    case SPECTRA_identity_and_rounding_noise:
        noisy_identity(d, is_double ? 0x1p-51 : 0x1p-22, random, a);
        break;
    case SPECTRA_graded_rows:
        graded_rows(d, random, a);
        break;
    case SPECTRA_integer_rank_two:
    case SPECTRA_integer_rank_one:
        integer_rank(d, set == SPECTRA_integer_rank_two ? 2 : 1, 1, random, a);
        break;
    case SPECTRA_axis_aligned:
        axis_aligned(d, random, a);
        break;
    case SPECTRA_denormal:
        denormal(d, is_double, random, a);
        break;
    case SPECTRA_general:
    case SPECTRA_general_graded:
        general(d, set == SPECTRA_general_graded, random, a);
        break;
    case SPECTRA_rotation:
        random_rotation(d, random, a);
        break;
    case SPECTRA_general_rank_two:
    case SPECTRA_general_rank_one:
        integer_rank(d, set == SPECTRA_general_rank_two ? 2 : 1, 0, random, a);
        break;
    default:
        composed(set, d, is_double, random, a);
    }
    round_all(d * d, is_double, a);
}

/* Rotates rows and columns p, q of the symmetric matrix so that a[p][q] vanishes. */
static void annihilate(int d, int p, int q, long double *a, long double *v)
{
    const long double off = a[p * d + q];
    if (off == 0)
        return;
    const long double theta = (a[q * d + q] - a[p * d + p]) / (2 * off);
    const long double t = (theta < 0 ? -1 : 1) / (fabsl(theta) + hypotl(theta, 1));
    const long double c = 1 / hypotl(t, 1), s = t * c;
    for (int k = 0; k < d; ++k) {
        const long double left = a[k * d + p], right = a[k * d + q];
        a[k * d + p] = c * left - s * right;
        a[k * d + q] = s * left + c * right;
    }
    for (int k = 0; k < d; ++k) {
        const long double upper = a[p * d + k], lower = a[q * d + k];
        a[p * d + k] = c * upper - s * lower;
        a[q * d + k] = s * upper + c * lower;
        const long double left = v[k * d + p], right = v[k * d + q];
        v[k * d + p] = c * left - s * right;
        v[k * d + q] = s * left + c * right;
    }
}

static void swap_pairs(int d, int j, int k, long double *values, long double *vectors)
{
    const long double value = values[j];
    values[j] = values[k];
    values[k] = value;
    for (int row = 0; row < d; ++row) {
        const long double number = vectors[row * d + j];
        vectors[row * d + j] = vectors[row * d + k];
        vectors[row * d + k] = number;
    }
}

void spectra_eigen(int dimension, const double *a, long double *values, long double *vectors)
{
    const int d = dimension;
    long double work[9];
    for (int k = 0; k < d * d; ++k) {
        work[k] = a[k];
        vectors[k] = k / d == k % d;
    }
    for (int sweep = 0; sweep < 8; ++sweep)
        for (int p = 0; p < d; ++p)
            for (int q = p + 1; q < d; ++q)
                annihilate(d, p, q, work, vectors);
    for (int k = 0; k < d; ++k)
        values[k] = work[k * d + k];
    for (int j = 0; j < d; ++j)
        for (int k = j + 1; k < d; ++k)
            if (values[k] > values[j])
                swap_pairs(d, j, k, values, vectors);
}
