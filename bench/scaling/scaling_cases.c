/* SPDX-License-Identifier: MIT */
/* The cases of scaling: in each group one thing changes. */
#include "scaling.h"
#include "report/table.h"

enum { CASES_MOST = 64 };

static struct scaling_case *add(struct scaling *scaling, const char *group)
{
    struct scaling_case *one = &scaling->cases[scaling->case_count++];
    *one = (struct scaling_case){.group = group,
                                 .threads = scaling->settings.threads,
                                 .cloud = {.shape = CLOUD_JITTERED,
                                           .dimension = 3,
                                           .particles = scaling->settings.particles,
                                           .support = scaling->settings.support,
                                           .jitter = scaling->settings.jitter}};
    return one;
}

static void add_sizes(struct scaling *scaling)
{
    static const double factors[] = {0.1, 0.3, 1, 3, 10, 30};
    for (int k = 0; k < (scaling->full ? 6 : 5); ++k) {
        const double particles = factors[k] * scaling->settings.particles;
        if (particles < 1 || particles > 1e9)
            continue;
        struct scaling_case *one = add(scaling, "particles");
        one->cloud.particles = (int32_t)particles;
        one->label = text_grouped(one->cloud.particles);
    }
}

/* 1, 2, 4 and so on, and all. */
static void add_threads(struct scaling *scaling)
{
    for (int32_t threads = 1; threads < 2 * scaling->settings.threads; threads *= 2) {
        struct scaling_case *one = add(scaling, "threads");
        if (threads < scaling->settings.threads)
            one->threads = threads;
        one->label = table_text("%d", one->threads);
    }
}

static void add_neighbours(struct scaling *scaling, int32_t dimension, const char *group)
{
    /* In 3D some 29, 57 and 100 neighbours, in 2D 12, 29 and 57. */
    static const double supports[2][3] = {{2, 3.1, 4.3}, {2, 2.45, 2.95}};
    for (int k = 0; k < 3; ++k) {
        struct scaling_case *one = add(scaling, group);
        one->cloud.dimension = dimension;
        one->cloud.support = supports[dimension - 2][k];
        one->label = table_text("%dD, H = %g spacings", dimension, one->cloud.support);
    }
}

static void add_orders(struct scaling *scaling)
{
    for (int shuffled = 0; shuffled < 2; ++shuffled) {
        struct scaling_case *one = add(scaling, "order");
        one->cloud.shuffled = shuffled;
        one->label = shuffled ? "shuffled" : "coherent";
    }
}

static void add_clouds(struct scaling *scaling)
{
    static const char *const names[] = {"lattice",     "jittered", "jittered, rotated",
                                        "thin sheets", "spray",    "jittered, far away"};
    for (int shape = CLOUD_LATTICE; shape <= CLOUD_FAR; ++shape) {
        struct scaling_case *one = add(scaling, "cloud");
        one->cloud.shape = (enum cloud_shape)shape;
        one->label = names[shape];
    }
}

static void add_radii(struct scaling *scaling)
{
    static const double ratios[] = {1, 2, 8, 64};
    for (int k = 0; k < 4; ++k) {
        struct scaling_case *one = add(scaling, "radii");
        one->cloud.shape = CLOUD_GRADED;
        one->cloud.ratio = ratios[k];
        one->label = table_text("largest / smallest %g", ratios[k]);
    }
}

void scaling_create_cases(struct scaling *scaling)
{
    scaling->cases = allocate_to_the_end(CASES_MOST, sizeof *scaling->cases);
    add_sizes(scaling);
    add_threads(scaling);
    add_neighbours(scaling, 3, "neighbours");
    add_neighbours(scaling, 2, "neighbours");
    add_orders(scaling);
    add_clouds(scaling);
    add_radii(scaling);
}
