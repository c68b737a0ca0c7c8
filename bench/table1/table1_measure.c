/* The measurements of table1. Each repetition goes once through everything: the search, then each
 * method's three calls. So a slow second of the machine hits all columns alike. */
#include "library.h"
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
                         .kernel = bench->table->options.kernel,
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
    const sphg_geometry geometry = {.sources = numbers_view(&particles->positions),
                                    .source_count = particles->count,
                                    .target_count = particles->count,
                                    .precision = bench->jacobians.type,
                                    .keep_weights = keep_weights};
    library_check(bench->context,
                  sphg_neighbors_search(bench->context, neighbors, &scheme, &geometry));
}

static void compute_matrix(struct bench *bench, sphg_method method)
{
    const sphg_scheme scheme = scheme_of(bench, method);
    const sphg_sources sources = sources_of(bench);
    library_check(bench->context, sphg_correction(bench->context, &scheme, &sources, NULL,
                                                  correction_table(bench, method), sphg_absent()));
}

static void compute_gradient(struct bench *bench, sphg_method method, const struct numbers *field)
{
    const sphg_scheme scheme = scheme_of(bench, method);
    sphg_sources sources = sources_of(bench);
    sources.correction = correction_table(bench, method);
    library_check(bench->context,
                  sphg_jacobian(bench->context, &scheme, &sources, NULL, numbers_view(field),
                                numbers_view(&bench->jacobians)));
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
    for (int32_t i = 0; i < numbers->count; i++)
        for (int32_t k = 0; k < numbers->width; k++)
            count += !isfinite(numbers_get(numbers, i, k));
    return count;
}

/* |J_i - J|_F / |J|_F of v = (-y, x, 2z), in 2D (-y, x). */
static double linear_field_error(const struct numbers *jacobians, int32_t i)
{
    static const double of_volume[9] = {0, -1, 0, 1, 0, 0, 0, 0, 2}, of_plane[4] = {0, -1, 1, 0};
    const double *expected = jacobians->width == 9 ? of_volume : of_plane;
    double difference = 0, size = 0;
    for (int32_t k = 0; k < jacobians->width; k++) {
        const double d = numbers_get(jacobians, i, k) - expected[k];
        difference += d * d;
        size += expected[k] * expected[k];
    }
    return sqrt(difference / size);
}

/* Plain SPH corrects nothing and has no rank: all particles count. NaN is not overlooked, and is
 * what comes out where no particle counts. */
static double largest_error(const struct bench *bench, sphg_method method)
{
    double most = -1;
    for (int32_t i = 0; i < bench->jacobians.count; i++) {
        if (method != SPHG_PLAIN && bench->ranks[i] < bench->table->particles.dimension)
            continue;
        const double error = linear_field_error(&bench->jacobians, i);
        most = numbers_larger(most, error);
    }
    return most < 0 ? NAN : most;
}

static void measure_errors(struct bench *bench, struct column *column,
                           const struct numbers *linear_field)
{
    const sphg_method method = column->method;
    const int corrected = method != SPHG_PLAIN;
    compute_fused(bench, method, linear_field, corrected ? &column->stats : NULL,
                  corrected ? bench->ranks : NULL);
    column->fused_error = largest_error(bench, method);
    column->not_finite += count_not_finite(&bench->jacobians);
    if (corrected)
        compute_matrix(bench, method);
    compute_gradient(bench, method, linear_field);
    column->gradient_error = largest_error(bench, method);
    column->not_finite += count_not_finite(&bench->jacobians);
    if (!table1_keeps_weights(column))
        return;
    bench->with_weights = 1;
    compute_matrix(bench, method); /* which keeps them */
    compute_gradient(bench, method, linear_field);
    column->kept_error = largest_error(bench, method);
    bench->with_weights = 0;
}

static void warm_up(struct bench *bench)
{
    const struct particles *particles = &bench->table->particles;
    struct numbers linear_field =
        numbers_create(particles->velocities.type, particles->count, particles->dimension);
    particles_linear_field(particles, &linear_field);
    for (int k = 0; k < TABLE1_COLUMNS; k++) {
        struct column *column = &bench->table->columns[k];
        progress_show("warm-up: %s", method_names[column->method]);
        measure_errors(bench, column, &linear_field);
        if (particles->own_velocities) {
            compute_gradient(bench, column->method, &particles->velocities);
            column->not_finite += count_not_finite(&bench->jacobians);
        }
    }
    numbers_destroy(&linear_field);
}

static void time_method(struct bench *bench, struct column *column)
{
    const struct numbers *field = &bench->table->particles.velocities;
    if (column->method != SPHG_PLAIN) {
        const struct moment matrix_start = now();
        compute_matrix(bench, column->method);
        samples_add_since(&column->matrix, matrix_start);
    }
    const struct moment gradient_start = now();
    compute_gradient(bench, column->method, field);
    samples_add_since(&column->gradient, gradient_start);
    if (column->method == SPHG_PLAIN)
        return;
    const struct moment fused_start = now();
    compute_fused(bench, column->method, field, NULL, NULL);
    samples_add_since(&column->fused, fused_start);
}

/* Weights of one scheme are kept at a time: those of this method are formed first, untimed. */
static void time_kept(struct bench *bench, struct column *column)
{
    const struct numbers *field = &bench->table->particles.velocities;
    bench->with_weights = 1;
    compute_matrix(bench, column->method);
    const struct moment matrix_start = now();
    compute_matrix(bench, column->method);
    samples_add_since(&column->matrix_kept, matrix_start);
    const struct moment gradient_start = now();
    compute_gradient(bench, column->method, field);
    samples_add_since(&column->gradient_kept, gradient_start);
    const struct moment fused_start = now();
    compute_fused(bench, column->method, field, NULL, NULL);
    samples_add_since(&column->fused_kept, fused_start);
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
    for (int work = 0; work < PROBE_WORKS; work++)
        probe_run(bench->probe, (enum probe_work)work, bench->table->options.threads);
}

static void time_probe(struct bench *bench)
{
    for (int work = 0; work < PROBE_WORKS; work++) {
        const struct moment start = now();
        probe_run(bench->probe, (enum probe_work)work, bench->table->options.threads);
        samples_add_since(&bench->table->probe[work], start);
    }
}

static void repeat(struct bench *bench)
{
    struct table1 *table = bench->table;
    for (int32_t repetition = 0; repetition < table->options.repetitions; repetition++) {
        progress_show("repetition %d of %d", repetition + 1, table->options.repetitions);
        const struct moment start = now();
        search(bench, bench->neighbors, 0);
        samples_add_since(&table->search, start);
        for (int k = 0; k < TABLE1_COLUMNS; k++)
            time_method(bench, &table->columns[k]);
        for (int k = 0; k < TABLE1_COLUMNS; k++)
            if (table1_keeps_weights(&table->columns[k]))
                time_kept(bench, &table->columns[k]);
        time_probe(bench);
    }
    progress_clear();
}

static int order_of_numbers(const void *a, const void *b)
{
    const double first = *(const double *)a, second = *(const double *)b;
    return (first > second) - (first < second);
}

static double median_ratio(const struct numbers *given, const struct numbers *expected)
{
    double *ratios = allocate_or_exit((size_t)given->count, sizeof *ratios);
    for (int32_t i = 0; i < given->count; i++)
        ratios[i] = numbers_get(given, i, 0) / numbers_get(expected, i, 0);
    qsort(ratios, (size_t)given->count, sizeof *ratios, order_of_numbers);
    const double median = ratios[given->count / 2];
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
    if (!particles->volumes.data || bench->table->options.source.input)
        library_volumes(bench->context, &scheme, bench->neighbors, &volumes);
    if (!particles->volumes.data) {
        particles->volumes = volumes;
        return;
    }
    if (bench->table->options.source.input)
        bench->table->volume_ratio = median_ratio(&particles->volumes, &volumes);
    numbers_destroy(&volumes);
}

static void first_search(struct bench *bench)
{
    progress_show("warm-up: search");
    const double start = now().wall;
    search(bench, bench->neighbors, 0);
    bench->table->first_search = now().wall - start;
    library_check(bench->context, sphg_neighbors_get_info(bench->context, bench->neighbors,
                                                          &bench->table->neighbors));
    search(bench, bench->keeping, 1);
}

void table1_measure(struct table1 *table)
{
    const int32_t dimension = table->particles.dimension;
    const sphg_scheme widest = {.dimension = dimension, .method = SPHG_CMLS, .support_radius = 1};
    const sphg_type type = table->particles.velocities.type;
    const int32_t count = table->particles.count;
    struct bench bench = {.table = table, .context = library_open(table->options.threads)};
    bench.corrections = numbers_create(type, count, sphg_correction_width(&widest));
    bench.jacobians = numbers_create(type, count, dimension * dimension);
    bench.ranks = allocate_or_exit((size_t)count, 1);
    library_check(bench.context, sphg_neighbors_create(bench.context, &bench.neighbors));
    library_check(bench.context, sphg_neighbors_create(bench.context, &bench.keeping));
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
