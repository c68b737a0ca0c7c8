/* SPDX-License-Identifier: MIT */
/* The command `scaling`: time a particle over sizes, threads, neighbours, orders and clouds. In
 * each group one thing changes; its cases are measured in turn, round by round. */
#include "commands.h"
#include "particles/errors.h"
#include "report/report.h"
#include "scaling_cloud.h"
#include "scene.h"
#include <math.h>
#include <string.h>

/* Members that are 0 here are as the settings say. */
struct scaling_case {
    const char *group, *label;
    double factor; /* of particles: the label is their number */
    struct cloud_setting cloud;
    int32_t threads;
    bool keeps_weights;
    sphg_method method;
    int32_t order;
    struct samples time[WORKS];
    int32_t count;
    double pairs, bytes; /* a particle */
    double deficient;    /* share of particles without full rank */
    double error;        /* largest |J_i - J|_F / |J|_F of a linear field where rank is full */
    int64_t not_finite;  /* numbers of Jacobians */
};

static const struct scaling_case all_cases[] = {
    {.group = "particles", .factor = 0.1},
    {.group = "particles", .factor = 0.3},
    {.group = "particles", .factor = 1},
    {.group = "particles", .factor = 3},
    {.group = "particles", .factor = 10},
    {.group = "particles", .factor = 30}, /* with --full */
    {.group = "threads", .threads = 1},   /* 1, 2, 4 and so on, and all */
    /* In 3D some 29, 57 and 100 neighbours, in 2D 12, 29 and 57. */
    {.group = "neighbours", .label = "3D, H = 2 spacings", .cloud = {.support = 2}},
    {.group = "neighbours", .label = "3D, H = 2.45 spacings", .cloud = {.support = 2.45}},
    {.group = "neighbours", .label = "3D, H = 2.95 spacings", .cloud = {.support = 2.95}},
    {.group = "neighbours", .label = "2D, H = 2 spacings", .cloud = {.support = 2, .dimension = 2}},
    {.group = "neighbours",
     .label = "2D, H = 3.1 spacings",
     .cloud = {.support = 3.1, .dimension = 2}},
    {.group = "neighbours",
     .label = "2D, H = 4.3 spacings",
     .cloud = {.support = 4.3, .dimension = 2}},
    {.group = "order", .label = "coherent"},
    {.group = "order", .label = "shuffled", .cloud = {.shuffled = true}},
    {.group = "cloud", .label = "lattice", .cloud = {.shape = CLOUD_LATTICE}},
    {.group = "cloud", .label = "jittered"},
    {.group = "cloud", .label = "jittered, rotated", .cloud = {.shape = CLOUD_ROTATED}},
    {.group = "cloud", .label = "thin sheets", .cloud = {.shape = CLOUD_SHEETS}},
    {.group = "cloud", .label = "spray", .cloud = {.shape = CLOUD_SPRAY}},
    {.group = "cloud", .label = "jittered, far away", .cloud = {.shape = CLOUD_FAR}},
    {.group = "method", .label = "KGC"},
    {.group = "method", .label = "KGC, order 2", .order = 2},
    {.group = "method", .label = "CMLS", .method = SPHG_CMLS},
    {.group = "method", .label = "CRKPM", .method = SPHG_CRKPM},
    {.group = "weights", .label = "formed each time"},
    {.group = "weights", .label = "kept, which matrices write", .keeps_weights = true},
    {.group = "radii", .label = "ratio 1", .cloud = {.shape = CLOUD_GRADED, .ratio = 1}},
    {.group = "radii", .label = "ratio 2", .cloud = {.shape = CLOUD_GRADED, .ratio = 2}},
    {.group = "radii", .label = "ratio 8", .cloud = {.shape = CLOUD_GRADED, .ratio = 8}},
    {.group = "radii", .label = "ratio 64", .cloud = {.shape = CLOUD_GRADED, .ratio = 64}}};
enum { CASES = sizeof all_cases / sizeof all_cases[0], POWERS_OF_TWO = 32 };

struct scaling {
    struct settings settings;
    bool full; /* up to 30 times the particles */
    int case_count;
    struct scaling_case cases[CASES + POWERS_OF_TWO];
};

/* ---- Cases ----------------------------------------------------------------------------------- */

static void add_case(struct scaling *scaling, const struct scaling_case *own, int32_t threads)
{
    const struct settings *settings = &scaling->settings;
    const double particles = (own->factor > 0 ? own->factor : 1) * settings->particles;
    if (particles < 1 || particles > 1e9 || (own->factor > 10 && !scaling->full))
        return;
    struct scaling_case *one = &scaling->cases[scaling->case_count++];
    *one = *own;
    one->threads = threads < settings->threads ? threads : settings->threads;
    one->cloud.particles = (int32_t)particles;
    one->cloud.jitter = settings->jitter;
    if (one->cloud.dimension == 0)
        one->cloud.dimension = 3;
    if (one->cloud.support <= 0)
        one->cloud.support = settings->support;
    if (!one->label)
        one->label =
            own->factor > 0 ? text_grouped(one->cloud.particles) : text_of("%d", one->threads);
}

static void create_cases(struct scaling *scaling)
{
    for (int k = 0; k < CASES; ++k)
        if (all_cases[k].threads == 0)
            add_case(scaling, &all_cases[k], scaling->settings.threads);
        else
            for (int32_t threads = 1; threads < 2 * scaling->settings.threads; threads *= 2)
                add_case(scaling, &all_cases[k], threads);
}

/* ---- Measuring ------------------------------------------------------------------------------- */

static struct scene open_scene(const struct scaling_case *one)
{
    const struct cloud cloud = cloud_create(&one->cloud);
    const sphg_scheme scheme = {.dimension = one->cloud.dimension,
                                .method = one->method,
                                .order = one->order,
                                .support_radius = cloud.support_radius};
    struct scene scene =
        scene_open(library_open(one->threads), &scheme, cloud.positions, cloud.volumes);
    if (cloud.radii.count)
        scene.geometry.source_support = numbers_view(&cloud.radii);
    scene.geometry.keep_weights = one->keeps_weights;
    scene.same_volumes = one->keeps_weights;
    return scene;
}

static double run(void *scenes, int32_t item)
{
    scene_run((struct scene *)scenes + item / WORKS, (enum work)(item % WORKS));
    return 1;
}

/* Warms up on the way. */
static void measure_error(struct scene *scene, struct scaling_case *one)
{
    uint8_t *ranks = allocate_held((size_t)scene->count, 1);
    int32_t deficient = 0;
    for (int work = 0; work < WORKS; ++work)
        scene_run(scene, (enum work)work);
    scene_correct(scene, ranks);
    const sphg_neighbors_info info = library_info(scene->context, scene->neighbors);
    one->count = scene->count;
    one->pairs = (double)info.pairs / one->count;
    one->bytes = (double)info.bytes / one->count;
    for (int32_t i = 0; i < one->count; ++i) {
        one->not_finite += !isfinite(linear_field_error(&scene->jacobians, i));
        deficient += ranks[i] < scene->positions.width;
    }
    one->error = deficient < one->count ? linear_field_worst(&scene->jacobians, ranks) : 0;
    one->deficient = (double)deficient / one->count;
}

/* The cases of one group: its memory is released before that of the next is taken. */
static void measure_group(const struct settings *settings, struct scaling_case *cases, int count)
{
    struct held *mark = held_so_far();
    struct scene scenes[CASES + POWERS_OF_TWO];
    struct samples times[(CASES + POWERS_OF_TWO) * WORKS] = {{0}};
    for (int k = 0; k < count; ++k) {
        scenes[k] = open_scene(&cases[k]);
        measure_error(&scenes[k], &cases[k]);
    }
    rounds_measure(
        &(struct rounds){cases[0].group, settings->repetitions, count * WORKS, run, NULL, scenes},
        times);
    for (int k = 0; k < count * WORKS; ++k)
        cases[k / WORKS].time[k % WORKS] = times[k];
    release_held(mark);
}

static void measure(struct scaling *scaling)
{
    for (int begin = 0, end; begin < scaling->case_count; begin = end) {
        struct scaling_case *first = &scaling->cases[begin];
        end = begin + 1;
        while (end < scaling->case_count && strcmp(scaling->cases[end].group, first->group) == 0)
            ++end;
        measure_group(&scaling->settings, first, end - begin);
    }
}

/* ---- The whole ------------------------------------------------------------------------------- */

static struct cell cell_per_particle(const char *name, const struct scaling_case *one,
                                     enum work work)
{
    return cell_time(name, &one->time[work], 1e6 / one->count, "ns_per_particle");
}

static int show(const struct scaling *scaling)
{
    report_open("scaling", &scaling->settings);
    report_number("particles", scaling->settings.particles);
    table_begin("scaling");
    for (int k = 0; k < scaling->case_count; ++k) {
        const struct scaling_case *one = &scaling->cases[k];
        TABLE_ROW(cell_text("group", one->group), cell_text("label", one->label),
                  cell_count("particles", one->count), cell_count("case_threads", one->threads),
                  cell_count("dimension", one->cloud.dimension),
                  cell_number("pairs_per_particle", one->pairs),
                  cell_number("bytes_per_particle", one->bytes),
                  cell_per_particle("search", one, WORK_SEARCH),
                  cell_per_particle("matrices", one, WORK_MATRICES),
                  cell_per_particle("gradient", one, WORK_GRADIENT),
                  cell_per_particle("fused", one, WORK_FUSED),
                  cell_number("deficient_share", one->deficient),
                  cell_number("error_max", one->error), cell_count("not_finite", one->not_finite));
    }
    return report_close();
}

int command_scaling(int argc, char **argv)
{
    struct scaling scaling = {.settings = settings_default(1000000, 5, "scaling")};
    const struct command_option options[] = {
        {"output", 0, "FOLDER", "where CSV, script and picture go (scaling)",
         AS_FOLDER(scaling.settings.output)},
        {"full", 0, NULL,
         "sizes up to 30 times the particles, not 10; some 250 bytes of memory each",
         AS_FLAG(scaling.full)},
        {0}};
    settings_read(&scaling.settings, TAKES_LATTICE | TAKES_RUN, options,
                  "Times search, matrices, gradient and both in one call for a tenth to ten times "
                  "the particles, for threads, neighbour counts, orders in memory, shapes of the "
                  "cloud, methods and radii.",
                  argc, argv);
    create_cases(&scaling);
    measure(&scaling);
    return show(&scaling);
}
