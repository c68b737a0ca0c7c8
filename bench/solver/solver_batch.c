/* SPDX-License-Identifier: MIT */
/* Batches of matrices with chosen spectra. */
#include "lattice.h"
#include "numbers.h"
#include "solver.h"
#include <math.h>
#include <string.h>

const struct solver_case solver_cases[SOLVER_CASES] = {
    {SOLVER_INVERSION, "copy", SOLVER_COPIED, 0},
    {SOLVER_INVERSION, "all certified", SOLVER_MOMENTS, 0},
    {SOLVER_INVERSION, "1 % fall back", SOLVER_MOMENTS, 0.01},
    {SOLVER_INVERSION, "8.5 % fall back", SOLVER_MOMENTS, 0.085},
    {SOLVER_INVERSION, "all fall back", SOLVER_MOMENTS, 1},
    {SOLVER_EIGEN, "copy", SOLVER_COPIED, 0},
    {SOLVER_EIGEN, "random", SOLVER_RANDOM, 0},
    {SOLVER_EIGEN, "near the identity", SOLVER_NEAR, 0},
    {SOLVER_EIGEN, "graded", SOLVER_GRADED, 0},
    {SOLVER_SVD, "copy", SOLVER_COPIED, 0},
    {SOLVER_SVD, "random", SOLVER_RANDOM, 0},
    {SOLVER_SVD, "near a rotation", SOLVER_NEAR, 0},
    {SOLVER_SVD, "graded", SOLVER_GRADED, 0},
};

/* As many differ, larger batches repeat them. */
enum { DIFFERENT = 65536 };

struct solver_widths solver_widths_of(enum solver_work work, int32_t d)
{
    const int32_t symmetric = d * (d + 1) / 2;
    switch (work) {
    case SOLVER_INVERSION:
        return (struct solver_widths){symmetric, {symmetric, 0, 0}};
    case SOLVER_EIGEN:
        return (struct solver_widths){symmetric, {d, d * d, 0}};
    default:
        return (struct solver_widths){d * d, {d * d, d, d * d}};
    }
}

bool solver_has(const struct solver_group *group, int k)
{
    return group->dimension == 3 || solver_cases[k].work != SOLVER_SVD;
}

/* Numbers in [0, 1) that belong to one matrix. */
struct draw {
    int64_t next;
};

static double random_of(struct draw *draw)
{
    return lattice_random(draw->next++);
}

/* Turns by any angle in each coordinate plane. */
static void rotation(struct draw *draw, int32_t d, double q[3][3])
{
    for (int k = 0; k < 9; ++k)
        q[k / 3][k % 3] = k % 4 == 0;
    for (int32_t a = 0; a < d; ++a)
        for (int32_t b = a + 1; b < d; ++b) {
            const double angle = 2 * 3.14159265358979323846 * random_of(draw);
            for (int32_t k = 0; k < d; ++k) {
                const double x = q[k][a], y = q[k][b];
                q[k][a] = cos(angle) * x - sin(angle) * y;
                q[k][b] = sin(angle) * x + cos(angle) * y;
            }
        }
}

/* p diag(values) q^T */
static void compose(int32_t d, double p[3][3], const double values[3], double q[3][3],
                    double a[3][3])
{
    for (int32_t r = 0; r < d; ++r)
        for (int32_t c = 0; c < d; ++c) {
            a[r][c] = 0;
            for (int32_t k = 0; k < d; ++k)
                a[r][c] += p[r][k] * values[k] * q[c][k];
        }
}

/* Eigenvalues: around 1 inside, one direction below the threshold's reach, 4 eps, at a surface. */
static void moments(struct draw *draw, int32_t d, double share, double values[3])
{
    for (int32_t k = 0; k < d; ++k)
        values[k] = 0.5 + 0.7 * random_of(draw);
    if (random_of(draw) < share)
        values[d - 1] = 0.039 * pow(1e-3, random_of(draw));
}

/* p p^T for symmetric ones: lest two rotations make them none. */
static void matrix(const struct solver_case *one, struct draw *draw, int32_t d, double a[3][3])
{
    const bool symmetric = one->work != SOLVER_SVD;
    double p[3][3], q[3][3], values[3] = {1, 1, 1};
    rotation(draw, d, p);
    rotation(draw, d, q);
    if (one->spectrum == SOLVER_MOMENTS)
        moments(draw, d, one->share, values);
    for (int32_t k = 0; one->spectrum == SOLVER_GRADED && k < d; ++k)
        values[k] = pow(1e-3, k) * (0.5 + random_of(draw));
    const bool identity = symmetric && one->spectrum == SOLVER_NEAR;
    compose(d, p, values, symmetric ? p : q, a);
    for (int32_t r = 0; r < d; ++r)
        for (int32_t c = 0; c < d; ++c) {
            const double noise = 2 * random_of(draw) - 1;
            if (one->spectrum == SOLVER_RANDOM)
                a[r][c] = noise;
            else if (one->spectrum == SOLVER_NEAR)
                a[r][c] = (identity ? r == c : a[r][c]) + 1e-3 * noise;
        }
}

static void store(struct numbers *batch, int32_t item, bool symmetric, int32_t d, double a[3][3])
{
    int32_t n = 0;
    for (int32_t r = 0; r < d; ++r)
        for (int32_t c = symmetric ? r : 0; c < d; ++c)
            numbers_set(batch, item, n++, a[r][c]);
}

struct numbers solver_batch(const struct solver_case *one, sphg_type type, int32_t dimension,
                            int32_t count)
{
    enum { DRAWN = 32 /* numbers a matrix, at most */ };
    const int32_t width = solver_widths_of(one->work, dimension).in;
    struct numbers batch = numbers_create(type, count, width);
    const size_t size = (size_t)width * (type == SPHG_F64 ? sizeof(double) : sizeof(float));
    for (int32_t i = 0; i < count && i < DIFFERENT; ++i) {
        struct draw draw = {(int64_t)DRAWN * i};
        double a[3][3];
        matrix(one, &draw, dimension, a);
        store(&batch, i, one->work != SOLVER_SVD, dimension, a);
    }
    for (int32_t done = DIFFERENT; done < count; done += DIFFERENT) {
        const int32_t left = count - done;
        memcpy((char *)batch.data + (size_t)done * size, batch.data,
               size * (size_t)(left < DIFFERENT ? left : DIFFERENT));
    }
    return batch;
}
