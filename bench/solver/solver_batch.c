/* SPDX-License-Identifier: MIT */
#include "solver_batch.h"
#include "lattice.h"
#include <math.h>

/* As many differ, larger batches repeat them. Each draws its numbers in [0, 1) from a place of its
 * own. */
enum { DIFFERENT = 65536, DRAWN_MOST = 32 };

static double draw(int64_t *next)
{
    return lattice_random((*next)++);
}

/* Turns by any angle in each coordinate plane. */
static void rotation(int64_t *next, int32_t d, double q[3][3])
{
    for (int k = 0; k < 9; ++k)
        q[k / 3][k % 3] = k % 4 == 0;
    for (int32_t a = 0; a < d; ++a)
        for (int32_t b = a + 1; b < d; ++b) {
            const double angle = 2 * 3.14159265358979323846 * draw(next);
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

/* Moments: around 1 inside, one direction below the threshold's reach, 4 eps, at a surface. */
static void draw_values(int64_t *next, int32_t d, enum spectrum spectrum, double share,
                        double values[3])
{
    for (int32_t k = 0; k < d; ++k)
        if (spectrum == SPECTRUM_MOMENTS)
            values[k] = 0.5 + 0.7 * draw(next);
        else if (spectrum == SPECTRUM_GRADED)
            values[k] = pow(1e-3, k) * (0.5 + draw(next));
    if (spectrum == SPECTRUM_MOMENTS && draw(next) < share)
        values[d - 1] = 0.039 * pow(1e-3, draw(next));
}

/* p p^T for symmetric ones: lest two rotations make them none. */
static void draw_matrix(int64_t next, int32_t d, enum spectrum spectrum, double share,
                        bool symmetric, double a[3][3])
{
    double p[3][3], q[3][3], values[3] = {1, 1, 1};
    rotation(&next, d, p);
    rotation(&next, d, q);
    draw_values(&next, d, spectrum, share, values);
    compose(d, p, values, symmetric ? p : q, a);
    for (int32_t r = 0; r < d; ++r)
        for (int32_t c = 0; c < d; ++c) {
            const double noise = 2 * draw(&next) - 1;
            if (spectrum == SPECTRUM_RANDOM)
                a[r][c] = noise;
            else if (spectrum == SPECTRUM_NEAR)
                a[r][c] = (symmetric ? r == c : a[r][c]) + 1e-3 * noise;
        }
}

struct numbers batch_create(enum spectrum spectrum, double share, bool symmetric, sphg_type type,
                            int32_t d, int32_t count)
{
    struct numbers batch = numbers_create(type, count, symmetric ? d * (d + 1) / 2 : d * d);
    for (int32_t i = 0; i < count; ++i) {
        double a[3][3];
        int32_t n = 0;
        if (i < DIFFERENT)
            draw_matrix((int64_t)DRAWN_MOST * i, d, spectrum, share, symmetric, a);
        for (int32_t r = 0; r < d; ++r)
            for (int32_t c = symmetric ? r : 0; c < d; ++c, ++n)
                numbers_set(&batch, i, n,
                            i < DIFFERENT ? a[r][c] : numbers_get(&batch, i - DIFFERENT, n));
    }
    return batch;
}

void batch_matrix(const struct numbers *table, int32_t item, int32_t d, double a[3][3])
{
    const bool symmetric = table->width < d * d;
    int32_t n = 0;
    for (int32_t r = 0; r < d; ++r)
        for (int32_t c = symmetric ? r : 0; c < d; ++c) {
            a[r][c] = numbers_get(table, item, n++);
            if (symmetric)
                a[c][r] = a[r][c];
        }
}
