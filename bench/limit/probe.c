/* SPDX-License-Identifier: MIT */
#include "probe.h"
#include "lattice.h"
#include "particles/errors.h"

/* Cells as wide as H, rows of them along x. */
static int32_t cell_of(const struct numbers *positions, int32_t i, int32_t cells)
{
    int32_t cell = 0;
    for (int32_t axis = 2; axis >= 0; --axis)
        cell = cell * cells + (int32_t)(numbers_get(positions, i, axis) + 1);
    return cell;
}

static struct numbers sorted(const struct numbers *positions, int32_t cells)
{
    const int32_t count = positions->count, all = cells * cells * cells;
    struct numbers rows = numbers_create(SPHG_F32, count, 3);
    int32_t *first = allocate_held((size_t)all + 1, sizeof *first);
    for (int32_t i = 0; i < count; ++i)
        first[cell_of(positions, i, cells) + 1]++;
    for (int32_t cell = 0; cell < all; ++cell)
        first[cell + 1] += first[cell];
    for (int32_t i = 0; i < count; ++i) {
        const int32_t row = first[cell_of(positions, i, cells)]++;
        for (int32_t axis = 0; axis < 3; ++axis)
            numbers_set(&rows, row, axis, numbers_get(positions, i, axis));
    }
    return rows;
}

struct probe *probe_create(sphg_context *context, int32_t side, double support, double jitter)
{
    const struct lattice lattice = {
        .dimension = 3, .side = side, .spacing = 1 / support, .jitter = jitter};
    const sphg_scheme scheme = {.support_radius = 1};
    const double volume = 1 / (support * support * support), sigma = 8 / 3.14159265358979323846;
    struct probe *probe = allocate_held(1, sizeof *probe);
    struct numbers positions = numbers_create(SPHG_F32, lattice_count(&lattice), 3),
                   volumes = numbers_create(SPHG_F32, 1, 1);
    const size_t count = (size_t)positions.count, room = count + PROBE_LANES_MOST;
    lattice_fill(&lattice, &positions);
    numbers_set(&volumes, 0, 0, volume);
    positions = sorted(&positions, (int32_t)(side / support) + 4);
    *probe = (struct probe){.count = positions.count,
                            .lanes = 4,
                            .passes = probe_passes_base,
                            .scene = scene_open(context, &scheme, positions, volumes),
                            .positions = allocate_lines(count, sizeof *probe->positions),
                            .fields = allocate_lines(count, sizeof *probe->fields),
                            .corrections = allocate_lines(room, 6 * sizeof(float)),
                            .jacobians = allocate_lines(room, 9 * sizeof(float))};
    for (int32_t i = 0; i < probe->count; ++i) {
        for (int32_t axis = 0; axis < 3; ++axis) {
            probe->positions[i][axis] = (float)numbers_get(&positions, i, axis);
            probe->fields[i][axis] = (float)numbers_get(&probe->scene.field, i, axis);
        }
        probe->positions[i][3] = (float)(6 * sigma * volume);
    }
    scene_run(&probe->scene, WORK_SEARCH);
    probe->lists = library_lists(context, &scheme, probe->scene.neighbors, probe->count);
#ifdef BENCH_HAVE_X86
    if (library_runs(SPHG_ISA_X86_V3)) {
        probe->lanes = 8;
        probe->passes = probe_passes_v3;
    }
#endif
    return probe;
}

double probe_pairs(const struct probe *probe)
{
    return (double)probe->lists.count / probe->count;
}

void probe_run(const struct probe *probe, enum probe_work work, int32_t threads)
{
    const int32_t lanes = PROBE_LANES_MOST;
    const int64_t vectors = (probe->count + lanes - 1) / lanes;
#pragma omp parallel for num_threads(threads) schedule(static, 1)
    for (int32_t share = 0; share < threads; ++share) {
        const int32_t begin = (int32_t)(vectors * share / threads) * lanes;
        const int32_t end = (int32_t)(vectors * (share + 1) / threads) * lanes;
        probe->passes[work](probe, begin, end < probe->count ? end : probe->count);
    }
}

/* Results as a table of 3 x 3 matrices. */
static struct numbers matrices_of(const struct probe *probe, const float *results, int32_t width)
{
    static const int symmetric[9] = {0, 1, 2, 1, 3, 4, 2, 4, 5};
    const int32_t lanes = probe->lanes;
    struct numbers table = numbers_create(SPHG_F32, probe->count, 9);
    for (int32_t i = 0; i < probe->count; ++i)
        for (int k = 0; k < 9; ++k) {
            const int32_t number = width == 6 ? symmetric[k] : k;
            const int64_t at = ((int64_t)(i / lanes) * width + number) * lanes + i % lanes;
            numbers_set(&table, i, k, (double)results[at]);
        }
    return table;
}

double probe_matrix_deviation(const struct probe *probe)
{
    struct held *mark = held_so_far();
    const struct numbers found = matrices_of(probe, probe->corrections, 6);
    const struct numbers *library = &probe->scene.corrections;
    uint8_t *ranks = allocate_held((size_t)probe->count, 1);
    double most = 0;
    scene_correct(&probe->scene, ranks);
    for (int32_t i = 0; i < probe->count; ++i) {
        double expected[9];
        for (int k = 0; k < 6; ++k) {
            static const int place[6] = {0, 1, 2, 4, 5, 8}, mirrored[6] = {0, 3, 6, 4, 7, 8};
            expected[place[k]] = expected[mirrored[k]] = numbers_get(library, i, k);
        }
        if (ranks[i] == 3)
            most = numbers_larger(most, relative_error(&found, i, expected));
    }
    release_held(mark);
    return most;
}

double probe_error(const struct probe *probe)
{
    struct held *mark = held_so_far();
    const struct numbers jacobians = matrices_of(probe, probe->jacobians, 9);
    const double error = linear_field_worst(&jacobians, NULL);
    release_held(mark);
    return error;
}
