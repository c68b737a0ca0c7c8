/* SPDX-License-Identifier: MIT */
#include "conjugate_gradient.h"
#include <math.h>
#include <string.h>

static double product(int32_t count, const double *a, const double *b)
{
    double sum = 0;
    for (int32_t k = 0; k < count; ++k)
        sum += a[k] * b[k];
    return sum;
}

static void add(int32_t count, double *x, double factor, const double *y)
{
    for (int32_t k = 0; k < count; ++k)
        x[k] += factor * y[k];
}

int32_t conjugate_gradient(const struct conjugate_gradient *system, const double *b, double *x)
{
    const int32_t n = system->count;
    double *residual = system->work, *direction = residual + n, *image = direction + n;
    const double enough = system->tolerance * system->tolerance * product(n, b, b);
    int32_t iterations = 0;
    system->apply(system->data, x, image);
    for (int32_t k = 0; k < n; ++k)
        residual[k] = direction[k] = b[k] - image[k];
    double squares = product(n, residual, residual);
    while (squares > enough && iterations < system->most_iterations) {
        system->apply(system->data, direction, image);
        const double length = squares / product(n, direction, image);
        add(n, x, length, direction);
        add(n, residual, -length, image);
        const double next = product(n, residual, residual);
        for (int32_t k = 0; k < n; ++k)
            direction[k] = residual[k] + next / squares * direction[k];
        squares = next;
        ++iterations;
    }
    return iterations;
}
