/* SPDX-License-Identifier: MIT */
#include "scenes.h"

static cloud block(int d, random_state *random)
{
    return cloud_jittered(d, d == 2 ? 7 : 4, .125, .2, random);
}

static cloud wild_block(int d, random_state *random)
{
    return cloud_jittered(d, d == 2 ? 7 : 4, .125, .4, random);
}

static cloud large_block(int d, random_state *random)
{
    return cloud_jittered(d, d == 2 ? 14 : 6, .125, .2, random);
}

static cloud near_block(int d, random_state *random)
{
    cloud points = block(d, random);
    cloud_shift(&points, (const double[]){311, -290, 173});
    return points;
}

static cloud far_block(int d, random_state *random)
{
    cloud points = block(d, random);
    cloud_shift(&points, (const double[]){30111, -29000, 11733});
    return points;
}

static cloud surface(int d, random_state *random)
{
    return cloud_free_surface(d, d == 2 ? 7 : 4, .125, random);
}

static cloud sheets_apart(int d, random_state *random, double gap)
{
    cloud points = cloud_sheets(d, d == 2 ? 12 : 4, .125, gap * .125);
    cloud_rotate(&points, random);
    return points;
}

static cloud sheets_third(int d, random_state *random)
{
    return sheets_apart(d, random, .3);
}

static cloud sheets_hundredth(int d, random_state *random)
{
    return sheets_apart(d, random, 1e-2);
}

static cloud sheets_closed(int d, random_state *random)
{
    return sheets_apart(d, random, 1e-4);
}

static cloud tilted_plane(int d, random_state *random)
{
    return cloud_tilted_plane(d, d == 2 ? 12 : 5, .125, random);
}

static cloud scattered(int d, random_state *random)
{
    return cloud_random(d, 48, 1, random);
}

/* Pairs at H (1 - 2^-k), far from one another: W is all rounding of 1 - q. */
static cloud rim_pairs(int d, random_state *random)
{
    enum { pairs = 8 };
    cloud points = cloud_line(d, 2 * pairs, 1);
    for (int p = 0; p < pairs; ++p) {
        double distance = .5 * (1 - ldexp(1, -2 * p - 2)), angle = random_between(random, 0, 6);
        double *first = points.x + 2 * p * d, *second = first + d;
        for (int k = 0; k < d; ++k) {
            first[k] = k == 0 ? 2 * p : .125;
            second[k] = first[k];
        }
        second[0] += distance * cos(angle);
        second[1] += distance * sin(angle);
    }
    return points;
}

const scene_entry scenes_hard[] = {
    {"block", block, 2.5},
    {"large block", large_block, 3.5},
    {"wild block", wild_block, 2},
    {"block 1e3 H away", near_block, 2.5},
    {"block 1e5 H away", far_block, 2.5},
    {"free surface", surface, 2},
    {"sheets .3 spacings apart", sheets_third, 2},
    {"sheets 1e-2 spacings apart", sheets_hundredth, 2},
    {"sheets 1e-4 spacings apart", sheets_closed, 2},
    {"tilted plane", tilted_plane, 2},
    {"scattered, few neighbours", scattered, 1.2},
    {"scattered, many neighbours", scattered, 2.5},
    {"pairs near the rim", rim_pairs, .5},
};
const int scenes_hard_count = sizeof scenes_hard / sizeof *scenes_hard;

comparison comparison_of_scene(const test_case *test, const scene_entry *entry)
{
    random_state random = random_seeded(1234);
    cloud points = entry->make(test->dimension, &random);
    return comparison_of(test, entry->name, points, entry->support * points.spacing);
}
