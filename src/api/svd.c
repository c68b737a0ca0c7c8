/* SPDX-License-Identifier: MIT */
#include "svd.h"
#include <math.h>
#include <stdbool.h>
#include <string.h>

/* One-sided Jacobi: columns of B = A V are made orthogonal by rotations from the right. Five sweeps
 * converge to rounding on all spectra tried, two are margin. */
enum { SWEEPS = 7 };

struct columns {
    double b[3][3], v[3][3]; /* [column][row] */
};

static double dot(const double *x, const double *y)
{
    return x[0] * y[0] + x[1] * y[1] + x[2] * y[2];
}

static void rotate_pair(double *x, double *y, double c, double s)
{
    for (int k = 0; k < 3; ++k) {
        const double xk = x[k], yk = y[k];
        x[k] = c * xk - s * yk;
        y[k] = s * xk + c * yk;
    }
}

/* Of columns that are orthogonal to rounding the product is noise, and by it columns of one length
 * would be turned by any angle, sweep after sweep, each time a few roundings worse. */
static void orthogonalise(struct columns *m, int p, int q)
{
    const double product = dot(m->b[p], m->b[q]);
    const double square_p = dot(m->b[p], m->b[p]), square_q = dot(m->b[q], m->b[q]);
    if (product == 0 || fabs(product) <= 0x1p-53 * sqrt(square_p) * sqrt(square_q))
        return;
    const double zeta = (square_q - square_p) / (2 * product);
    const double t = (zeta < 0 ? -1 : 1) / (fabs(zeta) + sqrt(1 + zeta * zeta));
    const double c = 1 / sqrt(1 + t * t);
    rotate_pair(m->b[p], m->b[q], c, c * t);
    rotate_pair(m->v[p], m->v[q], c, c * t);
}

static void swap_columns(struct columns *m, int p, int q)
{
    double held[3];
    memcpy(held, m->b[p], sizeof held);
    memcpy(m->b[p], m->b[q], sizeof held);
    memcpy(m->b[q], held, sizeof held);
    memcpy(held, m->v[p], sizeof held);
    memcpy(m->v[p], m->v[q], sizeof held);
    memcpy(m->v[q], held, sizeof held);
}

static void sort_columns(struct columns *m)
{
    for (int pass = 0; pass < 2; ++pass)
        for (int k = 0; k < 2; ++k)
            if (dot(m->b[k], m->b[k]) < dot(m->b[k + 1], m->b[k + 1]))
                swap_columns(m, k, k + 1);
}

static void normalise(double *x)
{
    const double length = sqrt(dot(x, x));
    for (int k = 0; k < 3; ++k)
        x[k] /= length;
}

static void cross(const double *x, const double *y, double *z)
{
    for (int k = 0; k < 3; ++k)
        z[k] = x[(k + 1) % 3] * y[(k + 2) % 3] - x[(k + 2) % 3] * y[(k + 1) % 3];
}

/* The axis that x is farthest from, made perpendicular to the unit vector x. */
static void perpendicular_to(const double *x, double *y)
{
    int axis = fabs(x[0]) < fabs(x[1]) ? 0 : 1;
    if (fabs(x[2]) < fabs(x[axis]))
        axis = 2;
    for (int k = 0; k < 3; ++k)
        y[k] = (k == axis) - x[axis] * x[k];
    normalise(y);
}

/* Orthonormal columns along b, whatever vanishes: a column that is rounding beside the first gets
 * any direction that is left. */
static void directions_of(const double b[3][3], double u[3][3])
{
    const double largest = sqrt(dot(b[0], b[0]));
    memcpy(u, b, 9 * sizeof(double));
    if (largest == 0) {
        for (int k = 0; k < 9; ++k)
            u[k / 3][k % 3] = k % 4 == 0;
        return;
    }
    normalise(u[0]);
    const double along = dot(u[0], b[1]);
    for (int k = 0; k < 3; ++k)
        u[1][k] = b[1][k] - along * u[0][k];
    if (sqrt(dot(u[1], u[1])) > 0x1p-50 * largest) {
        normalise(u[1]);
        const double again = dot(u[0], u[1]); /* twice is enough */
        for (int k = 0; k < 3; ++k)
            u[1][k] -= again * u[0][k];
        normalise(u[1]);
    } else
        perpendicular_to(u[0], u[1]);
    cross(u[0], u[1], u[2]);
    if (dot(u[2], b[2]) < 0)
        for (int k = 0; k < 3; ++k)
            u[2][k] = -u[2][k];
}

/* The power of two that brings the largest entry into [1/2, 1). */
static int scale_of(const double *a)
{
    double largest = 0;
    int exponent = 0;
    for (int k = 0; k < 9; ++k)
        largest = fabs(a[k]) > largest ? fabs(a[k]) : largest;
    if (largest > 0 && isfinite(largest))
        frexp(largest, &exponent);
    return exponent;
}

void sphgi_svd(const double *a, double *u, double *sigma, double *v)
{
    struct columns m;
    double direction[3][3];
    const int exponent = scale_of(a);
    for (int k = 0; k < 9; ++k) {
        m.b[k % 3][k / 3] = ldexp(a[k], -exponent);
        m.v[k % 3][k / 3] = k % 4 == 0;
    }
    for (int sweep = 0; sweep < SWEEPS; ++sweep) {
        orthogonalise(&m, 0, 1);
        orthogonalise(&m, 0, 2);
        orthogonalise(&m, 1, 2);
    }
    sort_columns(&m);
    directions_of((const double(*)[3])m.b, direction);
    for (int c = 0; c < 3; ++c) {
        const double length = ldexp(fabs(dot(direction[c], m.b[c])), exponent);
        sigma[c] = c && length > sigma[c - 1] ? sigma[c - 1] : length; /* rounding may exchange */
        for (int r = 0; r < 3; ++r) {
            u[3 * r + c] = direction[c][r];
            v[3 * r + c] = m.v[c][r];
        }
    }
}
