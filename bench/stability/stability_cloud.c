/* SPDX-License-Identifier: MIT */
#include "stability_cloud.h"
#include "lattice.h"
#include "numbers.h"
#include <math.h>
#include <string.h>

static double draw(struct stability_cloud *cloud, double least, double most)
{
    return least + (most - least) * lattice_random(cloud->random++);
}

static void make_room(struct stability_cloud *cloud, int32_t more)
{
    double(*rows)[3] = allocate_held((size_t)(cloud->count + more), sizeof *rows);
    if (cloud->count > 0)
        memcpy(rows, cloud->x, (size_t)cloud->count * sizeof *rows);
    cloud->x = rows;
}

static void add_moved(struct stability_cloud *cloud, const double place[3], double reach)
{
    double *row = cloud->x[cloud->count++];
    for (int axis = 0; axis < 3; ++axis)
        row[axis] = place[axis] + draw(cloud, -reach, reach);
}

/* side^3 particles, each coordinate moved by up to `jitter`. */
static void add_block(struct stability_cloud *cloud, int32_t side, double jitter)
{
    make_room(cloud, side * side * side);
    for (int32_t i = 0; i < side * side * side; ++i) {
        const double place[3] = {i % side, i / side % side, (double)(i / side / side)};
        add_moved(cloud, place, jitter);
    }
}

/* Three layers, none above another's particles, pressed together: `thickness` is their distance at
 * one end and `end_thickness` at the other, geometrically between. */
static void add_slab(struct stability_cloud *cloud, int32_t length, int32_t width, double jitter,
                     double thickness, double end_thickness, double below)
{
    make_room(cloud, 3 * length * width);
    for (int32_t i = 0; i < 3 * length * width; ++i) {
        const int32_t layer = i / (length * width), column = i % length;
        const double place[3] = {column + layer / 3.0, i / length % width + layer * 2 / 3.0,
                                 layer - 1.0};
        add_moved(cloud, place, jitter);
        const double share = length > 1 ? column / (length - 1.0) : 0;
        double *height = &cloud->x[cloud->count - 1][2];
        *height = *height * thickness * pow(end_thickness / thickness, share) - below;
    }
}

/* Two layers, the upper one's particles above the gaps of the lower one. */
static void add_layers(struct stability_cloud *cloud, int32_t side, double jitter, double gap)
{
    make_room(cloud, 2 * side * side);
    for (int32_t i = 0; i < 2 * side * side; ++i) {
        const double layer = i / (side * side);
        const double place[3] = {i % side + layer / 2, i / side % side + layer / 2, 0};
        add_moved(cloud, place, jitter);
        cloud->x[cloud->count - 1][2] = layer * gap;
    }
}

static void add_in_ball(struct stability_cloud *cloud, const double middle[3], double radius)
{
    double offset[3], square;
    do {
        square = 0;
        for (int axis = 0; axis < 3; ++axis) {
            offset[axis] = draw(cloud, -1, 1);
            square += offset[axis] * offset[axis];
        }
    } while (square >= 1);
    double *row = cloud->x[cloud->count++];
    for (int axis = 0; axis < 3; ++axis)
        row[axis] = middle[axis] + radius * offset[axis];
}

/* Targets so far apart that each sees nothing but its own `neighbours`, anywhere in its reach, or
 * as many in each of `places`; 0: each for itself. */
static void add_balls(struct stability_cloud *cloud, int32_t balls, int32_t neighbours,
                      int32_t places)
{
    make_room(cloud, balls * (neighbours * (places > 0 ? places : 1) + 1));
    for (int32_t pass = 0; pass < 2; ++pass)
        for (int32_t ball = 0; ball < balls; ++ball) {
            const double apart = 4 * cloud->support;
            const double middle[3] = {apart * (ball % 4), apart * (ball / 4 % 4),
                                      apart * (ball / 16)};
            if (pass == 0)
                memcpy(cloud->x[cloud->count++], middle, sizeof middle);
            for (int32_t k = 0; pass == 1 && k < (places > 0 ? places : neighbours); ++k)
                add_in_ball(cloud, middle, 0.9999 * cloud->support);
            for (int32_t k = 0; pass == 1 && k < places * (neighbours - 1); ++k)
                memcpy(cloud->x[cloud->count], cloud->x[cloud->count - places], sizeof *cloud->x),
                    ++cloud->count;
        }
    cloud->target_count = balls;
}

/* Spacing, radii and volumes grow along x, so many times over the block, which becomes a fan. */
static void grade(struct stability_cloud *cloud, int32_t side, double ratio)
{
    const double factor = pow(ratio, 1 / (side - 1.0));
    cloud->radius = allocate_held((size_t)cloud->count, sizeof *cloud->radius);
    for (int32_t i = 0; i < cloud->count; ++i) {
        double *x = cloud->x[i];
        const double column = i % side, wide = pow(factor, column);
        cloud->radius[i] = (double)(float)(cloud->support * wide);
        x[0] = (ratio > 1 ? (wide - 1) / (factor - 1) : column) + (x[0] - column) * wide;
        x[1] = (x[1] - side / 2.0) * wide;
        x[2] = (x[2] - side / 2.0) * wide;
    }
}

/* Onto axes that are none of the coordinates': an orthogonal matrix of ninths. */
static void turn(struct stability_cloud *cloud)
{
    for (int32_t i = 0; i < cloud->count; ++i) {
        double *x = cloud->x[i];
        const double turned[3] = {(x[0] + 8 * x[1] - 4 * x[2]) / 9,
                                  (-4 * x[0] + 4 * x[1] + 7 * x[2]) / 9,
                                  (8 * x[0] + x[1] + 4 * x[2]) / 9};
        for (int axis = 0; axis < 3; ++axis)
            x[axis] = turned[axis];
    }
}

/* All 1, but for sweeps that change them. */
static void fill_volumes(struct stability_cloud *cloud, enum stability_sweep sweep, double at)
{
    const double ball = 4 * 3.14159265358979323846 / 3 * pow(cloud->support, 3);
    cloud->volume = allocate_held((size_t)cloud->count, sizeof *cloud->volume);
    for (int32_t i = 0; i < cloud->count; ++i) {
        cloud->volume[i] = 1;
        if (sweep == SWEEP_NEIGHBOURS)
            cloud->volume[i] = ball / (at + 1);
        if (sweep == SWEEP_CROWDS)
            cloud->volume[i] = ball / (5 * at + 1);
        if (sweep == SWEEP_GRADING)
            cloud->volume[i] = pow(cloud->radius[i] / cloud->support, 3);
        if (sweep == SWEEP_VOLUMES)
            cloud->volume[i] = pow(at, draw(cloud, -0.5, 0.5));
    }
}

static void add_particles(struct stability_cloud *cloud, const struct settings *settings,
                          enum stability_sweep sweep, double at)
{
    const int32_t side = settings_side(settings->particles, 3);
    const double jitter = settings->jitter;
    switch (sweep) {
    case SWEEP_SLAB:
    case SWEEP_THINNING:
        add_slab(cloud, side, side, jitter, 1 / sqrt(at), 1 / sqrt(at), 0);
        break;
    case SWEEP_THRESHOLD:
    case SWEEP_CURVATURE: /* a block with corners, and a wedge: smallest moments of any size */
        add_block(cloud, side / 2 + 2, 0.4);
        add_slab(cloud, 4 * side, side, jitter, 1, 1e-4, 8 * cloud->support);
        break;
    case SWEEP_NEIGHBOURS:
        add_balls(cloud, side * 4, (int32_t)at, 0);
        return;
    case SWEEP_CROWDS:
        add_balls(cloud, side * 4, (int32_t)at, 5);
        return;
    case SWEEP_MERGING:
        add_layers(cloud, side, jitter, at * cloud->support);
        break;
    default:
        add_block(cloud, side, sweep == SWEEP_JITTER ? at : jitter);
    }
    if (sweep == SWEEP_GRADING)
        grade(cloud, side, at);
    cloud->target_count = cloud->count;
}

/* Places in the sequence of random numbers: 2^32 for each sweep of each round; those that run alone
 * share the next round's. */
static int64_t first_random(int32_t seed, int32_t round, enum stability_sweep sweep)
{
    enum { ROUNDS_MOST = 10000 };
    return (((int64_t)seed * ROUNDS_MOST + round) * SWEEPS + sweep) << 32;
}

struct stability_cloud stability_cloud_create(const struct stability *stability,
                                              enum stability_sweep sweep, double at, int32_t round)
{
    const struct settings *settings = &stability->settings;
    static const double direction[3] = {0.75, 0.5, -0.4330127018922193}; /* a unit vector */
    struct stability_cloud cloud = {.support = (double)(float)settings->support,
                                    .random = first_random(stability->seed, round, sweep)};
    add_particles(&cloud, settings, sweep, at);
    if (sweep != SWEEP_JITTER) /* a lattice without jitter has its shells at the same distance */
        turn(&cloud);
    fill_volumes(&cloud, sweep, at);
    for (int axis = 0; axis < 3 && sweep == SWEEP_OFFSET; ++axis)
        cloud.shift[axis] = at * cloud.support * direction[axis];
    return cloud;
}
