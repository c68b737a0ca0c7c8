/* SPDX-License-Identifier: MIT */
/* The measurements of table1. Each repetition goes once through everything: the search, then each
 * method's three calls. So a slow second of the machine hits all columns alike. */
#include "library.h"
#include "particles/linear_field.h"
#include "report/progress.h"
#include "settings.h"
#include "table1.h"
#include <math.h>
#include <stdlib.h>

/* What all measurements share. */
struct bench {
    struct table1 *table;
    sphg_context *context;
    sphg_neighbors *neighbors;
    sphg_neighbors *keeping; /* the same pairs, with room for weights */
    int with_weights;        /* which of both is swept */
    struct probe *probe;
    struct numbers corrections; /* room for the widest; each method uses the start of it */
    struct numbers jacobians;
    uint8_t *ranks;
};

static sphg_scheme scheme_of(const struct bench *bench, sphg_method method)
{
    return (sphg_scheme){.dimension = bench->table->particles.dimension,
                         .method = method,
                         .kernel = bench->table->settings.kernel,
                         .support_radius = bench->table->support_radius};
}

static sphg_sources sources_of(const struct bench *bench)
{
    return (sphg_sources){.neighbors = bench->with_weights ? bench->keeping : bench->neighbors,
                          .volume = numbers_view(&bench->table->particles.volumes),
                          .same_volumes = bench->with_weights};
}

static sphg_view correction_table(const struct bench *bench, sphg_method method)
{
    const sphg_scheme scheme = scheme_of(bench, method);
    struct numbers table = bench->corrections;
    table.width = sphg_correction_width(&scheme);
    return table.width > 0 ? numbers_view(&table) : sphg_absent();
}

static void search(struct bench *bench, sphg_neighbors *neighbors, int keep_weights)
{
    const struct particles *particles = &bench->table->particles;
    const sphg_scheme scheme = scheme_of(bench, SPHG_KGC);
    sphg_geometry geometry = library_geometry(&particles->positions, bench->jacobians.type);
    geometry.keep_weights = keep_weights;
    library_search(bench->context, neighbors, &scheme, &geometry);
}

static void compute_matrix(struct bench *bench, sphg_method method)
{
    const sphg_scheme scheme = scheme_of(bench, method);
    const sphg_sources sources = sources_of(bench);
    library_correct(bench->context, &scheme, &sources, correction_table(bench, method), NULL);
}

static void compute_gradient(struct bench *bench, sphg_method method, const struct numbers *field)
{
    const sphg_scheme scheme = scheme_of(bench, method);
    sphg_sources sources = sources_of(bench);
    sources.correction = correction_table(bench, method);
    library_jacobian(bench->context, &scheme, &sources, field, &bench->jacobians);
}

/* stats, ranks: wanted where they are not NULL. */
static void compute_fused(struct bench *bench, sphg_method method, const struct numbers *field,
                          sphg_stats *stats, uint8_t *ranks)
{
    const sphg_scheme scheme = scheme_of(bench, method);
    const sphg_sources sources = sources_of(bench);
    const sphg_view at_sources = numbers_view(field);
    const sphg_field wanted = {.shape = SPHG_VECTOR,
                               .form = SPHG_DIFFERENCE,
                               .at_sources = &at_sources,
                               .gradient = numbers_view(&bench->jacobians)};
    const sphg_request request = {.sources = &sources,
                                  .fields = &wanted,
                                  .set_count = 1,
                                  .field_count = 1,
                                  .rank = ranks ? sphg_view_u8(ranks, 1) : sphg_absent(),
                                  .stats = stats};
    library_check(bench->context, sphg_evaluate(bench->context, &scheme, &request));
}

static int64_t count_not_finite(const struct numbers *numbers)
{
    int64_t count = 0;
    for (int32_t i = 0; i < numbers->count; ++i)
        for (int32_t k = 0; k < numbers->width; ++k)
            count += !isfinite(numbers_get(numbers, i, k));
    return count;
}

/* Plain SPH corrects nothing and has no rank: all particles count. */
static double largest_error(const struct bench *bench, sphg_method method)
{
    return linear_field_worst(&bench->jacobians, method == SPHG_PLAIN ? NULL : bench->ranks);
}

static void measure_errors(struct bench *bench, struct table1_method *one,
                           const struct numbers *linear_field)
{
    const sphg_method method = one->method;
    const int corrected = method != SPHG_PLAIN;
    compute_fused(bench, method, linear_field, corrected ? &one->stats : NULL,
                  corrected ? bench->ranks : NULL);
    one->fused_error = largest_error(bench, method);
    one->not_finite += count_not_finite(&bench->jacobians);
    if (corrected)
        compute_matrix(bench, method);
    compute_gradient(bench, method, linear_field);
    one->gradient_error = largest_error(bench, method);
    one->not_finite += count_not_finite(&bench->jacobians);
    if (!table1_keeps_weights(one))
        return;
    bench->with_weights = 1;
    compute_matrix(bench, method); /* which keeps them */
    compute_gradient(bench, method, linear_field);
    one->kept_error = largest_error(bench, method);
    bench->with_weights = 0;
}

static void warm_up(struct bench *bench)
{
    const struct particles *particles = &bench->table->particles;
    struct numbers linear_field =
        numbers_create(particles->velocities.type, particles->count, particles->dimension);
    linear_field_fill(&particles->positions, &linear_field);
    for (int k = 0; k < TABLE1_METHODS; ++k) {
        struct table1_method *one = &bench->table->methods[k];
        progress_show("warm-up: %s", method_names[one->method]);
        measure_errors(bench, one, &linear_field);
        if (particles->own_velocities) {
            compute_gradient(bench, one->method, &particles->velocities);
            one->not_finite += count_not_finite(&bench->jacobians);
        }
    }
    numbers_destroy(&linear_field);
}

static void run(struct bench *bench, sphg_method method, enum table1_work work)
{
    const struct numbers *field = &bench->table->particles.velocities;
    if (work == TABLE1_MATRIX)
        compute_matrix(bench, method);
    else if (work == TABLE1_GRADIENT)
        compute_gradient(bench, method, field);
    else
        compute_fused(bench, method, field, NULL, NULL);
}

/* Plain SPH has no matrix, and nothing to be fused. Weights of one scheme are kept at a time: those
 * of this method are formed first, untimed. */
static void time_method(struct bench *bench, struct table1_method *one, int kept)
{
    bench->with_weights = kept;
    if (kept)
        compute_matrix(bench, one->method);
    for (int work = 0; work < TABLE1_WORKS; ++work) {
        if (one->method == SPHG_PLAIN && work != TABLE1_GRADIENT)
            continue;
        const struct moment start = now();
        run(bench, one->method, (enum table1_work)work);
        samples_add(&one->times[kept][work], since(start));
    }
    bench->with_weights = 0;
}

/* A cube of as many particles, a million at most, whatever the table is about. */
static void prepare_probe(struct bench *bench)
{
    const int32_t most = 1000000, count = bench->table->particles.count;
    progress_show("warm-up: probe");
    bench->probe =
        probe_create(bench->context, settings_side(count < most ? count : most, 3), 2, 0.2);
    bench->table->probe_count = probe_count(bench->probe);
    for (int work = 0; work < PROBE_WORKS; ++work)
        probe_run(bench->probe, (enum probe_work)work, bench->table->settings.threads);
}

static void time_probe(struct bench *bench)
{
    for (int work = 0; work < PROBE_WORKS; ++work) {
        const struct moment start = now();
        probe_run(bench->probe, (enum probe_work)work, bench->table->settings.threads);
        samples_add(&bench->table->probe[work], since(start));
    }
}

static void repeat(struct bench *bench)
{
    struct table1 *table = bench->table;
    for (int32_t repetition = 0; repetition < table->settings.repetitions; ++repetition) {
        progress_show("repetition %d of %d", repetition + 1, table->settings.repetitions);
        const struct moment start = now();
        search(bench, bench->neighbors, 0);
        samples_add(&table->search, since(start));
        for (int k = 0; k < TABLE1_METHODS; ++k)
            time_method(bench, &table->methods[k], 0);
        for (int k = 0; k < TABLE1_METHODS; ++k)
            if (table1_keeps_weights(&table->methods[k]))
                time_method(bench, &table->methods[k], 1);
        time_probe(bench);
    }
    progress_clear();
}

static double median_ratio(const struct numbers *given, const struct numbers *expected)
{
    double *ratios = allocate_or_exit((size_t)given->count, sizeof *ratios);
    for (int32_t i = 0; i < given->count; ++i)
        ratios[i] = numbers_get(given, i, 0) / numbers_get(expected, i, 0);
    const double median = median_of(ratios, given->count);
    free(ratios);
    return median;
}

/* Volumes that neither lattice nor file gave; those of a file are compared with what would have
 * been taken without them. */
static void complete_volumes(struct bench *bench)
{
    struct particles *particles = &bench->table->particles;
    const sphg_scheme scheme = scheme_of(bench, SPHG_PLAIN);
    struct numbers volumes = numbers_create(bench->jacobians.type, particles->count, 1);
    bench->table->volume_ratio = 1;
    if (!particles->volumes.data || bench->table->source.input)
        library_volumes(bench->context, &scheme, bench->neighbors, &volumes);
    if (!particles->volumes.data) {
        particles->volumes = volumes;
        return;
    }
    if (bench->table->source.input)
        bench->table->volume_ratio = median_ratio(&particles->volumes, &volumes);
    numbers_destroy(&volumes);
}

static void first_search(struct bench *bench)
{
    progress_show("warm-up: search");
    const double start = now().wall;
    search(bench, bench->neighbors, 0);
    bench->table->first_search = now().wall - start;
    bench->table->neighbors = library_info(bench->context, bench->neighbors);
    search(bench, bench->keeping, 1);
}

void table1_measure(struct table1 *table)
{
    const int32_t dimension = table->particles.dimension;
    const sphg_scheme widest = {.dimension = dimension, .method = SPHG_CMLS, .support_radius = 1};
    const sphg_type type = table->particles.velocities.type;
    const int32_t count = table->particles.count;
    struct bench bench = {.table = table, .context = library_open(table->settings.threads)};
    bench.corrections = numbers_create(type, count, sphg_correction_width(&widest));
    bench.jacobians = numbers_create(type, count, dimension * dimension);
    bench.ranks = allocate_or_exit((size_t)count, 1);
    bench.neighbors = library_neighbors(bench.context);
    bench.keeping = library_neighbors(bench.context);
    first_search(&bench);
    complete_volumes(&bench);
    prepare_probe(&bench);
    warm_up(&bench);
    repeat(&bench);
    probe_destroy(bench.probe);
    sphg_neighbors_destroy(bench.neighbors);
    sphg_neighbors_destroy(bench.keeping);
    sphg_context_destroy(bench.context);
    numbers_destroy(&bench.corrections);
    numbers_destroy(&bench.jacobians);
    free(bench.ranks);
}
