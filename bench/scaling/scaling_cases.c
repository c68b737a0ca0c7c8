/* SPDX-License-Identifier: MIT */
/* The cases of scaling: in each group one thing changes. */
#include "scaling.h"
#include "report/table.h"

/* What a case has of its own; 0: as the settings say. */
static const struct own {
    const char *group, *label;
    double factor; /* of particles: the label is their number */
    int32_t dimension;
    double support;
    enum cloud_shape shape;
    bool shuffled;
    double ratio;
} owns[] = {
    {.group = "particles", .factor = 0.1},
    {.group = "particles", .factor = 0.3},
    {.group = "particles", .factor = 1},
    {.group = "particles", .factor = 3},
    {.group = "particles", .factor = 10},
    {.group = "particles", .factor = 30}, /* with --full */
    {.group = "threads"},
    /* In 3D some 29, 57 and 100 neighbours, in 2D 12, 29 and 57. */
    {.group = "neighbours", .label = "3D, H = 2 spacings", .support = 2},
    {.group = "neighbours", .label = "3D, H = 2.45 spacings", .support = 2.45},
    {.group = "neighbours", .label = "3D, H = 2.95 spacings", .support = 2.95},
    {.group = "neighbours", .label = "2D, H = 2 spacings", .support = 2, .dimension = 2},
    {.group = "neighbours", .label = "2D, H = 3.1 spacings", .support = 3.1, .dimension = 2},
    {.group = "neighbours", .label = "2D, H = 4.3 spacings", .support = 4.3, .dimension = 2},
    {.group = "order", .label = "coherent"},
    {.group = "order", .label = "shuffled", .shuffled = true},
    {.group = "cloud", .label = "lattice", .shape = CLOUD_LATTICE},
    {.group = "cloud", .label = "jittered"},
    {.group = "cloud", .label = "jittered, rotated", .shape = CLOUD_ROTATED},
    {.group = "cloud", .label = "thin sheets", .shape = CLOUD_SHEETS},
    {.group = "cloud", .label = "spray", .shape = CLOUD_SPRAY},
    {.group = "cloud", .label = "jittered, far away", .shape = CLOUD_FAR},
    {.group = "radii", .label = "largest / smallest 1", .shape = CLOUD_GRADED, .ratio = 1},
    {.group = "radii", .label = "largest / smallest 2", .shape = CLOUD_GRADED, .ratio = 2},
    {.group = "radii", .label = "largest / smallest 8", .shape = CLOUD_GRADED, .ratio = 8},
    {.group = "radii", .label = "largest / smallest 64", .shape = CLOUD_GRADED, .ratio = 64}};

static struct scaling_case *add(struct scaling *scaling, const struct own *own)
{
    const struct settings *settings = &scaling->settings;
    struct scaling_case *one = &scaling->cases[scaling->case_count++];
    *one = (struct scaling_case){
        .group = own->group,
        .label = own->label,
        .threads = settings->threads,
        .cloud = {.shape = own->shape,
                  .dimension = own->dimension ? own->dimension : 3,
                  .particles = settings->particles,
                  .support = own->support > 0 ? own->support : settings->support,
                  .jitter = settings->jitter,
                  .shuffled = own->shuffled,
                  .ratio = own->ratio}};
    return one;
}

static void add_size(struct scaling *scaling, const struct own *own)
{
    const double particles = own->factor * scaling->settings.particles;
    if (particles < 1 || particles > 1e9 || (own->factor > 10 && !scaling->full))
        return;
    struct scaling_case *one = add(scaling, own);
    one->cloud.particles = (int32_t)particles;
    one->label = text_grouped(one->cloud.particles);
}

/* 1, 2, 4 and so on, and all. */
static void add_threads(struct scaling *scaling, const struct own *own)
{
    for (int32_t threads = 1; threads < 2 * scaling->settings.threads; threads *= 2) {
        struct scaling_case *one = add(scaling, own);
        if (threads < scaling->settings.threads)
            one->threads = threads;
        one->label = table_text("%d", one->threads);
    }
}

void scaling_create_cases(struct scaling *scaling)
{
    enum { OWNS = sizeof owns / sizeof owns[0], THREADS_MOST = 32 /* powers of two */ };
    scaling->cases = allocate_to_the_end(OWNS + THREADS_MOST, sizeof *scaling->cases);
    for (int k = 0; k < OWNS; ++k)
        if (owns[k].factor > 0)
            add_size(scaling, &owns[k]);
        else if (owns[k].label)
            add(scaling, &owns[k]);
        else
            add_threads(scaling, &owns[k]);
}
