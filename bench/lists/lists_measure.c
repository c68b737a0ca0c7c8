/* SPDX-License-Identifier: MIT */
/* The measurements of lists. */
#include "lattice.h"
#include "library.h"
#include "lists.h"
#include "command_line.h"
#include "particles/linear_field.h"
#include "particles/particles.h"
#include "report/progress.h"
#include <stdlib.h>

const struct lists_export lists_exports[EXPORTS] = {
    {"lengths alone", false, false, false, 0},
    {"indices, sorted", true, false, false, 0},
    {"indices, any order", true, false, true, 0},
    {"indices and gradients, sorted", true, true, false, 0},
    {"indices and gradients, any order", true, true, true, 0},
    {"the same, sorted, 256 targets a call", true, true, false, 256},
    {"the same, any order, 256 targets a call", true, true, true, 256}};

struct stage {
    struct lists *lists;
    sphg_context *context;
    sphg_scheme scheme;
    sphg_neighbors *neighbors[SUPPLIES];
    struct particles particles;
    struct numbers field, corrections, jacobians;
    int64_t *offsets;     /* the host's lists: the library's, ascending ... */
    int32_t *indices;     /* ... which are not written to again */
    const int32_t **rows; /* where each begins */
    int32_t *lengths;
    struct sphg_pairs out; /* where exports go */
    struct numbers gradients;
};

static int32_t row_of(int32_t target, int32_t worker, const int32_t **indices, void *user)
{
    const struct stage *stage = user;
    (void)worker;
    *indices = stage->indices + stage->offsets[target];
    return (int32_t)(stage->offsets[target + 1] - stage->offsets[target]);
}

static sphg_lists lists_of(struct stage *stage, enum lists_supply supply)
{
    if (supply == SUPPLY_CSR)
        return (sphg_lists){.offsets = stage->offsets, .indices = stage->indices};
    if (supply == SUPPLY_COPIED)
        return (sphg_lists){.offsets = stage->offsets, .indices = stage->indices, .copy = 1};
    if (supply == SUPPLY_ROWS)
        return (sphg_lists){.rows = stage->rows, .lengths = stage->lengths};
    return (sphg_lists){.row = row_of, .user = stage};
}

static sphg_sources sources_of(const struct stage *stage, enum lists_supply supply)
{
    return (sphg_sources){.neighbors = stage->neighbors[supply],
                          .volume = numbers_view(&stage->particles.volumes)};
}

static void build(struct stage *stage, enum lists_supply supply)
{
    sphg_geometry geometry =
        library_geometry(&stage->particles.positions, field_type(stage->lists->settings.precision));
    geometry.list_free = supply == SUPPLY_LIST_FREE;
    const sphg_lists lists = lists_of(stage, supply);
    library_check(stage->context,
                  supply <= SUPPLY_LIST_FREE
                      ? sphg_neighbors_search(stage->context, stage->neighbors[supply],
                                              &stage->scheme, &geometry)
                      : sphg_neighbors_use_lists(stage->context, stage->neighbors[supply],
                                                 &stage->scheme, &geometry, &lists));
}

static void run(struct stage *stage, enum lists_supply supply, enum lists_work work)
{
    sphg_sources sources = sources_of(stage, supply);
    const sphg_view corrections = numbers_view(&stage->corrections);
    if (work == WORK_GRADIENT)
        sources.correction = corrections;
    if (work == WORK_BUILD)
        build(stage, supply);
    else if (work == WORK_MATRICES)
        library_correct(stage->context, &stage->scheme, &sources, corrections, NULL);
    else
        library_jacobian(stage->context, &stage->scheme, &sources, &stage->field,
                         &stage->jacobians);
}

/* All pairs that are asked for, block after block: a block's arrays are written over by the next.
 */
static void export_pairs(struct stage *stage, const struct lists_export *one)
{
    sphg_sources sources = sources_of(stage, SUPPLY_KEPT);
    sources.correction = numbers_view(&stage->corrections);
    const int32_t count = stage->particles.count, block = one->block ? one->block : count;
    for (int32_t begin = 0; begin < count; begin += block) {
        const int32_t end = begin + block < count ? begin + block : count;
        const sphg_subset subset = sphg_range(begin, end);
        sphg_pairs pairs = {.offsets = stage->out.offsets, .any_order = one->any_order};
        if (one->indices) {
            pairs.indices = stage->out.indices;
            pairs.capacity = stage->out.capacity;
        }
        if (one->gradients)
            pairs.gradient = numbers_view(&stage->gradients);
        library_check(stage->context, sphg_pair_gradients(stage->context, &stage->scheme, &sources,
                                                          &subset, sphg_absent(), &pairs));
    }
}

/* ---- Errors ---------------------------------------------------------------------------------- */

/* J_i = sum_j (v_j - v_i) G_ij over the pairs of the last call, the last `block` targets. */
static double exported_error(const struct stage *stage, const struct lists_export *one)
{
    const int32_t count = stage->particles.count, block = one->block ? one->block : count;
    const int32_t begin = (count - 1) / block * block;
    struct numbers jacobian = numbers_create(SPHG_F64, 1, 9);
    double *sums = jacobian.data, most = 0;
    for (int32_t i = begin; i < count; ++i) {
        for (int32_t k = 0; k < 9; ++k)
            sums[k] = 0;
        for (int64_t p = stage->out.offsets[i - begin]; p < stage->out.offsets[i - begin + 1]; ++p)
            for (int32_t k = 0; k < 9; ++k)
                sums[k] += (numbers_get(&stage->field, stage->out.indices[p], k / 3) -
                            numbers_get(&stage->field, i, k / 3)) *
                           numbers_get(&stage->gradients, (int32_t)p, k % 3);
        most = numbers_larger(most, linear_field_error(&jacobian, 0));
    }
    numbers_destroy(&jacobian);
    return most;
}

/* ---- The whole ------------------------------------------------------------------------------- */

static void take_lists(struct stage *stage)
{
    const size_t count = (size_t)stage->particles.count;
    build(stage, SUPPLY_KEPT);
    const sphg_neighbors_info info = library_info(stage->context, stage->neighbors[SUPPLY_KEPT]);
    stage->lists->pairs = stage->out.capacity = info.pairs;
    stage->offsets = allocate_or_exit(count + 1, sizeof *stage->offsets);
    stage->indices = allocate_or_exit((size_t)info.pairs, sizeof *stage->indices);
    stage->rows = allocate_or_exit(count, sizeof *stage->rows);
    stage->lengths = allocate_or_exit(count, sizeof *stage->lengths);
    stage->out.offsets = allocate_or_exit(count + 1, sizeof *stage->offsets);
    stage->out.indices = allocate_or_exit((size_t)info.pairs, sizeof *stage->indices);
    const sphg_sources sources = sources_of(stage, SUPPLY_KEPT);
    sphg_pairs pairs = {
        .offsets = stage->offsets, .indices = stage->indices, .capacity = info.pairs};
    library_check(stage->context, sphg_pair_gradients(stage->context, &stage->scheme, &sources,
                                                      NULL, sphg_absent(), &pairs));
    for (size_t i = 0; i < count; ++i) {
        stage->rows[i] = stage->indices + stage->offsets[i];
        stage->lengths[i] = (int32_t)(stage->offsets[i + 1] - stage->offsets[i]);
    }
}

static struct stage open_stage(struct lists *lists)
{
    const struct particle_source source = {.side = settings_side(lists->settings.particles, 3),
                                           .jitter = lists->settings.jitter,
                                           .precision = lists->settings.precision};
    struct stage stage = {
        .lists = lists,
        .context = library_open(lists->settings.threads),
        .scheme = {.dimension = 3, .support_radius = lists->settings.support * lattice_spacing},
        .particles = particles_create(&source)};
    const int32_t count = lists->count = stage.particles.count;
    const sphg_type type = field_type(lists->settings.precision);
    stage.field = numbers_create(type, count, 3);
    stage.corrections = numbers_create(type, count, sphg_correction_width(&stage.scheme));
    stage.jacobians = numbers_create(type, count, 9);
    linear_field_fill(&stage.particles.positions, &stage.field);
    for (int supply = 0; supply < SUPPLIES; ++supply)
        stage.neighbors[supply] = library_neighbors(stage.context);
    return stage;
}

static void close_stage(struct stage *stage)
{
    for (int supply = 0; supply < SUPPLIES; ++supply)
        sphg_neighbors_destroy(stage->neighbors[supply]);
    sphg_context_destroy(stage->context);
    particles_destroy(&stage->particles);
    numbers_destroy(&stage->field);
    numbers_destroy(&stage->corrections);
    numbers_destroy(&stage->jacobians);
    numbers_destroy(&stage->gradients);
    free(stage->offsets);
    free(stage->indices);
    free(stage->rows);
    free(stage->lengths);
    free(stage->out.offsets);
    free(stage->out.indices);
}

/* A round through everything; the first warms up and shows the errors. */
static void measure_round(struct stage *stage, bool is_first)
{
    struct lists *lists = stage->lists;
    for (int supply = 0; supply < SUPPLIES; ++supply) {
        for (int work = 0; work < LISTS_WORKS; ++work) {
            const struct moment start = now();
            run(stage, (enum lists_supply)supply, (enum lists_work)work);
            if (!is_first)
                samples_add(&lists->supplied[supply][work], since(start));
        }
        if (is_first)
            lists->supplied_error[supply] = linear_field_worst(&stage->jacobians, NULL);
    }
    for (int k = 0; k < EXPORTS; ++k) {
        const struct moment start = now();
        export_pairs(stage, &lists_exports[k]);
        if (!is_first)
            samples_add(&lists->exported[k], since(start));
        else
            lists->exported_error[k] =
                lists_exports[k].gradients ? exported_error(stage, &lists_exports[k]) : NO_ERROR;
    }
}

void lists_measure(struct lists *lists)
{
    struct stage stage = open_stage(lists);
    const int32_t rounds = lists->settings.repetitions;
    take_lists(&stage);
    if (lists->pairs > INT32_MAX)
        command_line_refuse("--particles: more pairs than fit into an index");
    stage.gradients =
        numbers_create(field_type(lists->settings.precision), (int32_t)lists->pairs, 3);
    for (int32_t round = 0; round <= rounds; ++round) {
        progress_show("lists: round %d of %d", round, rounds);
        measure_round(&stage, round == 0);
    }
    progress_clear();
    close_stage(&stage);
}
