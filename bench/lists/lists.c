/* SPDX-License-Identifier: MIT */
/* The command `lists`: time a pair where a host's own arrays meet the library. Sums over lists that
 * a host brings, and pairs that the library writes out for loops of a host's own. */
#include "commands.h"
#include "particles/errors.h"
#include "particles/particles.h"
#include "report/report.h"

/* Who says which pairs there are. */
enum supply {
    SUPPLY_KEPT,      /* the library's search, its lists kept */
    SUPPLY_LIST_FREE, /* the same search, pairs found anew by each sweep */
    SUPPLY_CSR,       /* the host's offsets and indices */
    SUPPLY_ROWS,      /* the host's pointer and length for each target */
    SUPPLY_FUNCTION,  /* a function of the host's, called for each target */
    SUPPLY_COPIED,    /* the host's offsets and indices, copied by the build */
    SUPPLIES
};
static const char *const supply_names[SUPPLIES] = {"kept lists",          "list-free",
                                                   "host's CSR",          "host's rows",
                                                   "host's row function", "host's CSR, copied"};

/* What sphg_pair_gradients is asked for. */
static const struct export
{
    const char *name;
    bool indices, gradients, any_order;
    int32_t targets; /* so many in one call; 0: all of them */
    int32_t block;   /* sphg_pairs.block */
}
exports[] = {{"lengths alone", false, false, false, 0, 0},
             {"indices, sorted", true, false, false, 0, 0},
             {"indices, any order", true, false, true, 0, 0},
             {"indices and gradients, sorted", true, true, false, 0, 0},
             {"indices and gradients, any order", true, true, true, 0, 0},
             {"the same, blocks of 8, any order", true, true, true, 0, 8},
             {"the same, sorted, 256 targets a call", true, true, false, 256, 0},
             {"the same, any order, 256 targets a call", true, true, true, 256, 0}};

enum { EXPORTS = sizeof exports / sizeof exports[0], SUMS = SUPPLIES * WORKS };

struct lists {
    struct scene scenes[SUPPLIES];
    struct library_lists host; /* the library's, ascending */
    const int32_t **rows;      /* where each of them begins */
    int32_t *lengths;
    sphg_pairs out; /* where exports go */
    struct numbers gradients;
};

/* ---- What is timed --------------------------------------------------------------------------- */

static int32_t row_of(int32_t target, int32_t worker, const int32_t **indices, void *user)
{
    const struct lists *lists = user;
    (void)worker;
    *indices = lists->rows[target];
    return lists->lengths[target];
}

static void use_lists(struct lists *lists, enum supply supply)
{
    const struct scene *scene = &lists->scenes[supply];
    sphg_lists host = {.row = row_of, .user = lists};
    if (supply == SUPPLY_ROWS)
        host = (sphg_lists){.rows = lists->rows, .lengths = lists->lengths};
    if (supply == SUPPLY_CSR || supply == SUPPLY_COPIED)
        host = (sphg_lists){.offsets = lists->host.offsets,
                            .indices = lists->host.indices,
                            .copy = supply == SUPPLY_COPIED};
    scene_use_lists(scene, &host);
}

static int32_t targets_of(const struct lists *lists, const struct export *one)
{
    return one->targets ? one->targets : lists->scenes[0].count;
}

/* All pairs that are asked for, call after call: the arrays of one are written over by the next. */
static void export_pairs(struct lists *lists, const struct export *one)
{
    const struct scene *scene = &lists->scenes[SUPPLY_KEPT];
    const int32_t count = scene->count, targets = targets_of(lists, one);
    sphg_sources sources = scene_sources(scene);
    sources.correction = scene_corrections(scene);
    for (int32_t begin = 0; begin < count; begin += targets) {
        const int32_t end = begin + targets < count ? begin + targets : count;
        const sphg_subset subset = sphg_range(begin, end);
        sphg_pairs pairs = {
            .offsets = lists->out.offsets, .any_order = one->any_order, .block = one->block};
        if (one->indices) {
            pairs.indices = lists->out.indices;
            pairs.capacity = lists->out.capacity;
        }
        if (one->gradients)
            pairs.gradient = numbers_view(&lists->gradients);
        library_check(scene->context, sphg_pair_gradients(scene->context, &scene->scheme, &sources,
                                                          &subset, sphg_absent(), &pairs));
    }
}

static double run(void *data, int32_t item)
{
    struct lists *lists = data;
    const enum supply supply = (enum supply)(item / WORKS);
    const enum work work = (enum work)(item % WORKS);
    if (item >= SUMS)
        export_pairs(lists, &exports[item - SUMS]);
    else if (work == WORK_SEARCH && supply > SUPPLY_LIST_FREE)
        use_lists(lists, supply);
    else
        scene_run(&lists->scenes[supply], work);
    return 1;
}

/* ---- Errors ---------------------------------------------------------------------------------- */

/* Component c of G_ij in place p. */
static double gradient_at(const struct lists *lists, int32_t block, int64_t p, int32_t c)
{
    const int64_t in = p % (block ? block : 1),
                  number = (p - in) * 3 + (block ? block * c : c) + in;
    return numbers_get(&lists->gradients, (int32_t)(number / 3), (int32_t)(number % 3));
}

/* J_i = sum_j (v_j - v_i) G_ij over the pairs of the last call, its last targets. */
static double exported_error(const struct lists *lists, const struct export *one)
{
    const struct numbers *field = &lists->scenes[0].field;
    const int32_t count = field->count, targets = targets_of(lists, one);
    const int32_t begin = (count - 1) / targets * targets;
    struct numbers jacobian = numbers_create(SPHG_F64, 1, 9);
    double *sums = jacobian.data, most = 0;
    for (int32_t i = begin; i < count; ++i) {
        for (int32_t k = 0; k < 9; ++k)
            sums[k] = 0;
        for (int64_t p = lists->out.offsets[i - begin]; p < lists->out.offsets[i - begin + 1]; ++p)
            for (int32_t k = 0; k < 9; ++k)
                sums[k] += (numbers_get(field, lists->out.indices[p], k / 3) -
                            numbers_get(field, i, k / 3)) *
                           gradient_at(lists, one->block, p, k % 3);
        most = numbers_larger(most, linear_field_error(&jacobian, 0));
    }
    return most;
}

/* What an item comes to, which also warms it up. */
static double error_of(struct lists *lists, int32_t item)
{
    run(lists, item);
    if (item < SUMS)
        return linear_field_worst(&lists->scenes[0].jacobians, NULL);
    return exports[item - SUMS].gradients ? exported_error(lists, &exports[item - SUMS]) : 0;
}

/* ---- The whole ------------------------------------------------------------------------------- */

static struct lists open_scenes(const struct settings *settings)
{
    const struct scene scene = scene_of_lattice(library_open(settings->threads), settings, 3);
    const size_t count = (size_t)scene.count;
    struct lists lists = {.rows = allocate_held(count, sizeof *lists.rows),
                          .lengths = allocate_held(count, sizeof *lists.lengths)};
    for (int supply = 0; supply < SUPPLIES; ++supply)
        lists.scenes[supply] = scene_beside(&scene);
    lists.scenes[SUPPLY_LIST_FREE].geometry.list_free = 1;
    scene_run(&lists.scenes[SUPPLY_KEPT], WORK_SEARCH);
    lists.host = library_lists(scene.context, &scene.scheme, lists.scenes[SUPPLY_KEPT].neighbors,
                               scene.count);
    if (lists.host.count > INT32_MAX - 8 * (int64_t)scene.count)
        command_line_refuse("--particles: more pairs than fit into an index");
    for (size_t i = 0; i < count; ++i) {
        lists.rows[i] = lists.host.indices + lists.host.offsets[i];
        lists.lengths[i] = (int32_t)(lists.host.offsets[i + 1] - lists.host.offsets[i]);
    }
    const size_t pairs = (size_t)lists.host.count + 8 * count; /* in blocks, too */
    lists.out = (sphg_pairs){.offsets = allocate_held(count + 1, sizeof *lists.out.offsets),
                             .indices = allocate_held(pairs, sizeof *lists.out.indices),
                             .capacity = (int64_t)pairs};
    lists.gradients = numbers_create(scene.field.type, (int32_t)pairs, 3);
    return lists;
}

static struct cell cell_per_pair(const char *name, const struct samples *time, int64_t pairs)
{
    return cell_time(name, time, 1e6 / (double)pairs, "ns_per_pair");
}

static int show(const struct settings *settings, const struct lists *lists,
                const struct samples *times, const double *errors)
{
    const int64_t pairs = lists->host.count;
    report_open("lists", settings);
    report_lattice(settings, lists->scenes[0].count, scene_pairs(&lists->scenes[0]));
    table_begin("lists/sums");
    for (int k = 0; k < SUMS; k += WORKS)
        TABLE_ROW(cell_text("supply", supply_names[k / WORKS]),
                  cell_per_pair("build", &times[k + WORK_SEARCH], pairs),
                  cell_per_pair("matrices", &times[k + WORK_MATRICES], pairs),
                  cell_per_pair("gradient", &times[k + WORK_GRADIENT], pairs),
                  cell_per_pair("fused", &times[k + WORK_FUSED], pairs),
                  cell_number("error_max", errors[k + WORK_FUSED]), cell_count("pairs", pairs));
    table_begin("lists/pairs");
    for (int k = 0; k < EXPORTS; ++k)
        TABLE_ROW(cell_text("what", exports[k].name), cell_per_pair("", &times[SUMS + k], pairs),
                  cell_if(exports[k].gradients, cell_number("error_max", errors[SUMS + k])));
    return report_close();
}

int command_lists(int argc, char **argv)
{
    enum { ITEMS = SUMS + EXPORTS };
    struct settings settings = settings_default(100000, 15, NULL);
    struct samples times[ITEMS] = {{0}};
    double errors[ITEMS];
    settings_read(&settings, TAKES_LATTICE | TAKES_RUN | TAKES_PRECISION, NULL,
                  "Times a pair of sums over the library's lists and over a host's (arrays, "
                  "pointers, a function), and of pairs that are written out: indices, gradients, "
                  "sorted or in any order. Takes some seconds.",
                  argc, argv);
    struct lists lists = open_scenes(&settings);
    for (int32_t item = 0; item < ITEMS; ++item)
        errors[item] = error_of(&lists, item);
    rounds_measure(&(struct rounds){"lists", settings.repetitions, ITEMS, run, NULL, &lists},
                   times);
    return show(&settings, &lists, times, errors);
}
