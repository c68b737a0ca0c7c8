/* SPDX-License-Identifier: MIT */
#include "probe.h"
#include "lattice.h"
#include "team.h"
#include <math.h>
#include <stdlib.h>

enum { PADDING = 16 };

static const double pi = 3.14159265358979323846;

struct probe {
    int32_t count;
    float (*positions)[4], (*fields)[4];
    struct library_lists lists;
    float *corrections, *jacobians;
    probe_pass *passes[PROBE_WORKS], *pass;
};

/* Cells as wide as H, rows of them along x. */
static int32_t cell_of(const struct numbers *positions, int32_t i, int32_t cells)
{
    int32_t cell = 0;
    for (int32_t axis = 2; axis >= 0; --axis)
        cell = cell * cells + (int32_t)(numbers_get(positions, i, axis) + 1);
    return cell;
}

static void sort(struct probe *probe, const struct numbers *positions, int32_t cells, double volume)
{
    int32_t *first =
        allocate_or_exit((size_t)cells * (size_t)cells * (size_t)cells + 1, sizeof *first);
    for (int32_t i = 0; i < probe->count; ++i)
        first[cell_of(positions, i, cells) + 1]++;
    for (int32_t cell = 0; cell < cells * cells * cells; ++cell)
        first[cell + 1] += first[cell];
    for (int32_t i = 0; i < probe->count; ++i) {
        float *row = probe->positions[first[cell_of(positions, i, cells)]++];
        for (int32_t axis = 0; axis < 3; ++axis)
            row[axis] = (float)numbers_get(positions, i, axis);
        row[3] = (float)volume;
    }
    free(first);
}

static void set_fields(struct probe *probe)
{
    for (int32_t i = 0; i < probe->count; ++i) {
        const float *x = probe->positions[i];
        float *field = probe->fields[i];
        field[0] = -x[1], field[1] = x[0], field[2] = 2 * x[2], field[3] = 0;
    }
}

static const sphg_scheme probe_scheme = {.support_radius = 1};

static sphg_neighbors *search(const struct probe *probe, sphg_context *context)
{
    sphg_neighbors *neighbors = library_neighbors(context);
    const sphg_geometry geometry =
        sphg_all(sphg_view_f32(probe->positions[0], sizeof *probe->positions), probe->count);
    library_check(context, sphg_neighbors_search(context, neighbors, &probe_scheme, &geometry));
    return neighbors;
}

static void choose_passes(struct probe *probe)
{
    probe->passes[PROBE_MATRICES] = probe_matrices_base;
    probe->passes[PROBE_GRADIENT] = probe_gradient_base;
#ifdef BENCH_HAVE_X86
    if (library_runs(SPHG_ISA_X86_V3)) {
        probe->passes[PROBE_MATRICES] = probe_matrices_v3;
        probe->passes[PROBE_GRADIENT] = probe_gradient_v3;
    }
#endif
}

struct probe *probe_create(sphg_context *context, int32_t side, double support, double jitter)
{
    const struct lattice lattice = {
        .dimension = 3, .side = side, .spacing = 1 / support, .jitter = jitter};
    struct probe *probe = allocate_held(1, sizeof *probe);
    struct numbers positions = numbers_create(SPHG_F32, lattice_count(&lattice), 3);
    const int32_t count = probe->count = positions.count;
    lattice_fill(&lattice, &positions);
    probe->positions = allocate_lines((size_t)count, sizeof *probe->positions);
    probe->fields = allocate_lines((size_t)count, sizeof *probe->fields);
    probe->corrections = allocate_lines((size_t)count + PADDING, 6 * sizeof(float));
    probe->jacobians = allocate_lines((size_t)count + PADDING, 9 * sizeof(float));
    sort(probe, &positions, (int32_t)(side / support) + 4, 48 / pi / (support * support * support));
    set_fields(probe);
    probe->lists = library_lists(context, &probe_scheme, search(probe, context), count);
    choose_passes(probe);
    return probe;
}

int32_t probe_count(const struct probe *probe)
{
    return probe->count;
}

double probe_pairs(const struct probe *probe)
{
    return (double)probe->lists.count / probe->count;
}

struct probe_arrays probe_arrays(const struct probe *probe)
{
    return (struct probe_arrays){.positions = (const float(*)[4])probe->positions,
                                 .fields = (const float(*)[4])probe->fields,
                                 .offsets = probe->lists.offsets,
                                 .indices = probe->lists.indices,
                                 .corrections = probe->corrections,
                                 .jacobians = probe->jacobians};
}

static void run_share(void *data, int32_t begin, int32_t end)
{
    const struct probe *probe = data;
    const struct probe_arrays arrays = probe_arrays(probe);
    probe->pass(&arrays, begin, end, probe->count);
}

void probe_run(struct probe *probe, enum probe_work work, int32_t threads)
{
    probe->pass = probe->passes[work];
    team_run(threads, run_share, probe, probe->count, PROBE_LANES_MOST);
}

static int32_t lanes_of(const struct probe *probe)
{
    return probe->passes[PROBE_MATRICES] == probe_matrices_base ? 4 : 8;
}

static double matrix_deviation(const struct probe *probe, const float *expected, int32_t i)
{
    const int32_t lanes = lanes_of(probe);
    const float *found = probe->corrections + (int64_t)(i / lanes) * 6 * lanes + i % lanes;
    double difference = 0, size = 0;
    for (int k = 0; k < 6; ++k) { /* xx xy xz yy yz zz: what is off the diagonal stands twice */
        const double times = k == 1 || k == 2 || k == 4 ? 2 : 1;
        const double off = (double)found[k * lanes] - (double)expected[k];
        difference += times * off * off;
        size += times * (double)expected[k] * (double)expected[k];
    }
    return sqrt(difference / size);
}

double probe_matrix_deviation(const struct probe *probe, sphg_context *context)
{
    const float volume = probe->positions[0][3] * (float)(pi / 48); /* sigma is 8 / pi */
    const sphg_sources sources = {.neighbors = search(probe, context),
                                  .volume = sphg_same_f32(&volume)};
    float(*corrections)[6] = allocate_held((size_t)probe->count, sizeof *corrections);
    uint8_t *ranks = allocate_held((size_t)probe->count, 1);
    double most = 0;
    library_check(context, sphg_correction(context, &probe_scheme, &sources, NULL,
                                           sphg_view_f32(corrections[0], sizeof *corrections),
                                           sphg_view_u8(ranks, 1)));
    for (int32_t i = 0; i < probe->count; ++i)
        if (ranks[i] == 3)
            most = numbers_larger(most, matrix_deviation(probe, corrections[i], i));
    return most;
}

double probe_error(const struct probe *probe)
{
    static const double expected[9] = {0, -1, 0, 1, 0, 0, 0, 0, 2};
    const int32_t lanes = lanes_of(probe);
    double most = 0;
    for (int32_t i = 0; i < probe->count; ++i) {
        const float *jacobian = probe->jacobians + (int64_t)(i / lanes) * 9 * lanes + i % lanes;
        double squares = 0;
        for (int k = 0; k < 9; ++k) {
            const double d = (double)jacobian[k * lanes] - expected[k];
            squares += d * d / 6;
        }
        most = numbers_larger(most, sqrt(squares));
    }
    return most;
}
