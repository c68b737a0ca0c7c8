/* SPDX-License-Identifier: MIT */
#include "clouds.h"
#include "test.h"
#include <math.h>
#include <string.h>

static cloud cloud_make(int dimension, int count, double spacing)
{
    cloud points = {dimension, count, spacing, NULL};
    points.x = test_memory((size_t)(count * dimension) * sizeof *points.x);
    return points;
}

static int power(int base, int exponent)
{
    return exponent == 0 ? 1 : base * power(base, exponent - 1);
}

/* The points of a lattice in the first `axes` axes. */
static cloud lattice_in(int dimension, int axes, int per_axis, double spacing)
{
    cloud points = cloud_make(dimension, power(per_axis, axes), spacing);
    for (int i = 0; i < points.count; ++i)
        for (int k = 0; k < axes; ++k)
            points.x[i * dimension + k] = spacing * (i / power(per_axis, k) % per_axis);
    return points;
}

static void jitter_by(cloud *points, double reach, random_state *random)
{
    for (int k = 0; k < points->count * points->dimension; ++k)
        points->x[k] += random_between(random, -reach, reach);
}

cloud cloud_copy(const cloud *points)
{
    cloud copy = *points;
    const size_t bytes = (size_t)(points->count * points->dimension) * sizeof *points->x;
    copy.x = memcpy(test_memory(bytes), points->x, bytes);
    return copy;
}

cloud cloud_lattice(int dimension, int per_axis, double spacing)
{
    return lattice_in(dimension, dimension, per_axis, spacing);
}

cloud cloud_jittered(int dimension, int per_axis, double spacing, double jitter,
                     random_state *random)
{
    cloud points = cloud_lattice(dimension, per_axis, spacing);
    jitter_by(&points, jitter * spacing, random);
    return points;
}

cloud cloud_random(int dimension, int count, double side, random_state *random)
{
    cloud points = cloud_make(dimension, count, side / pow(count, 1.0 / dimension));
    for (int k = 0; k < count * dimension; ++k)
        points.x[k] = random_between(random, 0, side);
    return points;
}

cloud cloud_free_surface(int dimension, int per_axis, double spacing, random_state *random)
{
    cloud block = cloud_jittered(dimension, per_axis, spacing, .2, random);
    int kept = 0;
    for (int i = 0; i < block.count; ++i) {
        const double *x = block.x + i * dimension;
        double height = spacing * per_axis * (.6 + .2 * sin(2 * x[0] / spacing));
        int droplet = random_index(random, 16) == 0;
        if (x[dimension - 1] > height && !droplet)
            continue;
        for (int k = 0; k < dimension; ++k)
            block.x[kept * dimension + k] = x[k];
        ++kept;
    }
    block.count = kept;
    return block;
}

cloud cloud_corner(int dimension, double spacing, random_state *random)
{
    return cloud_jittered(dimension, 3, spacing, .15, random);
}

cloud cloud_plane(int dimension, int per_axis, double spacing)
{
    return lattice_in(dimension, dimension - 1, per_axis, spacing);
}

cloud cloud_tilted_plane(int dimension, int per_axis, double spacing, random_state *random)
{
    cloud points = cloud_plane(dimension, per_axis, spacing);
    cloud_rotate(&points, random);
    return points;
}

cloud cloud_line(int dimension, int count, double spacing)
{
    cloud points = cloud_make(dimension, count, spacing);
    for (int k = 0; k < count * dimension; ++k)
        points.x[k] = spacing * (k / dimension) * (k % dimension == 1 ? -.5 : .75);
    return points;
}

cloud cloud_pair(int dimension, double distance)
{
    static const double direction[2][3] = {{.6, -.8, 0}, {.48, -.6, .64}};
    cloud points = cloud_make(dimension, 2, distance);
    for (int k = 0; k < dimension; ++k)
        points.x[dimension + k] = distance * direction[dimension - 2][k];
    return points;
}

cloud cloud_single(int dimension)
{
    return cloud_make(dimension, 1, 1);
}

cloud cloud_coincident(int dimension, int copies, int beside, double spacing)
{
    cloud points = cloud_make(dimension, copies + (beside != 0), spacing);
    for (int k = 0; k < points.count * dimension; ++k)
        points.x[k] = k < copies * dimension ? .375 : .375 + spacing * (k % dimension == 0);
    return points;
}

cloud cloud_sheets(int dimension, int per_axis, double spacing, double gap)
{
    cloud sheet = cloud_plane(dimension, per_axis, spacing);
    cloud both = cloud_make(dimension, 2 * sheet.count, spacing);
    int numbers = sheet.count * dimension;
    for (int k = 0; k < 2 * numbers; ++k)
        both.x[k] = sheet.x[k % numbers];
    for (int i = sheet.count; i < both.count; ++i)
        both.x[i * dimension + dimension - 1] = gap;
    return both;
}

void cloud_round_to_single(cloud *points)
{
    for (int k = 0; k < points->count * points->dimension; ++k)
        points->x[k] = (double)(float)points->x[k];
}

void cloud_snap(cloud *points, double step)
{
    for (int k = 0; k < points->count * points->dimension; ++k)
        points->x[k] = step * nearbyint(points->x[k] / step);
}

void cloud_shift(cloud *points, const double *vector)
{
    for (int k = 0; k < points->count * points->dimension; ++k)
        points->x[k] += vector[k % points->dimension];
}

static void rotate_in(cloud *points, int a, int b, double angle)
{
    for (int i = 0; i < points->count; ++i) {
        double *x = points->x + i * points->dimension;
        double turned = cos(angle) * x[a] - sin(angle) * x[b];
        x[b] = sin(angle) * x[a] + cos(angle) * x[b];
        x[a] = turned;
    }
}

void cloud_rotate(cloud *points, random_state *random)
{
    for (int turn = 0; turn < 2 * points->dimension - 3; ++turn) {
        int a = turn % points->dimension;
        rotate_in(points, a, (a + 1) % points->dimension, random_between(random, .3, 2.8));
    }
}

double cloud_rounded(double number)
{
    int exponent;
    double fraction = frexp(number, &exponent);
    return ldexp((double)(float)fraction, exponent);
}

double *cloud_numbers(const cloud *points, double low, double high, random_state *random)
{
    double *numbers = test_memory((size_t)points->count * sizeof *numbers);
    for (int i = 0; i < points->count; ++i)
        numbers[i] = cloud_rounded(random_between(random, low, high));
    return numbers;
}

double *cloud_volumes(const cloud *points, double spread, random_state *random)
{
    double volume = pow(points->spacing, points->dimension);
    return cloud_numbers(points, (1 - spread) * volume, (1 + spread) * volume, random);
}

int cloud_middle(const cloud *points)
{
    int d = points->dimension, best = 0;
    double low[3], high[3], nearest = INFINITY;
    for (int k = 0; k < d; ++k)
        low[k] = INFINITY, high[k] = -INFINITY;
    for (int k = 0; k < points->count * d; ++k) {
        low[k % d] = fmin(low[k % d], points->x[k]);
        high[k % d] = fmax(high[k % d], points->x[k]);
    }
    for (int i = 0; i < points->count; ++i) {
        double square = 0;
        for (int k = 0; k < d; ++k)
            square += pow(points->x[i * d + k] - (low[k] + high[k]) / 2, 2);
        if (square < nearest)
            nearest = square, best = i;
    }
    return best;
}
