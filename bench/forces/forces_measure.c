/* SPDX-License-Identifier: MIT */
/* The measurements of forces. */
#include "forces.h"
#include "library.h"
#include "lattice.h"
#include "particles/linear_field.h"
#include "particles/particles.h"
#include "report/progress.h"
#include <math.h>

const struct force_case force_cases[FORCE_CASES] = {
    {"stress, adjoint", SPHG_KGC, SPHG_ADJOINT, SPHG_SYM_TENSOR, false},
    {"stress, adjoint", SPHG_MLS, SPHG_ADJOINT, SPHG_SYM_TENSOR, false},
    {"stress, adjoint", SPHG_PLAIN, SPHG_ADJOINT, SPHG_SYM_TENSOR, false},
    {"pressure, adjoint", SPHG_KGC, SPHG_ADJOINT, SPHG_SCALAR, false},
    {"pressure, adjoint", SPHG_CMLS, SPHG_ADJOINT, SPHG_SCALAR, false},
    {"pressure, adjoint", SPHG_PLAIN, SPHG_ADJOINT, SPHG_SCALAR, false},
    {"pressure, symmetric", SPHG_KGC, SPHG_SYMMETRIC, SPHG_SCALAR, false},
    {"pressure, symmetric", SPHG_PLAIN, SPHG_SYMMETRIC, SPHG_SCALAR, false},
    {"divergence, adjoint", SPHG_KGC, SPHG_ADJOINT, SPHG_VECTOR, true},
    {"divergence, difference", SPHG_KGC, SPHG_DIFFERENCE, SPHG_VECTOR, true},
    {"divergence, difference", SPHG_PLAIN, SPHG_DIFFERENCE, SPHG_VECTOR, true}};

enum { METHODS = SPHG_PLAIN + 1 };

struct stage {
    struct forces *forces;
    sphg_context *context;
    sphg_scheme scheme[METHODS];
    sphg_neighbors *neighbors[FORCE_SUPPLIES];
    struct particles particles;
    struct numbers velocities, tensors, densities;
    struct numbers corrections[METHODS]; /* count 0: not needed */
    struct numbers results[2];           /* numbers, vectors */
};

/* ---- One case -------------------------------------------------------------------------------- */

static bool is_vector(const struct force_case *one)
{
    return !one->divergence;
}

static void run(struct stage *stage, const struct force_case *one, int supply)
{
    const struct numbers *given =
        one->shape == SPHG_VECTOR ? &stage->velocities : &stage->tensors; /* p: a component */
    const sphg_view view = numbers_view(given);
    const sphg_view result = numbers_view(&stage->results[is_vector(one)]);
    sphg_field field = {.shape = one->shape, .form = one->form, .at_sources = &view};
    if (one->shape == SPHG_SCALAR)
        field.gradient = result;
    else
        field.divergence = result;
    sphg_sources sources = {.neighbors = stage->neighbors[supply],
                            .volume = numbers_view(&stage->particles.volumes),
                            .density = numbers_view(&stage->densities),
                            .same_volumes = 1};
    if (stage->corrections[one->method].count)
        sources.correction = numbers_view(&stage->corrections[one->method]);
    const sphg_request request = {
        .sources = &sources, .fields = &field, .set_count = 1, .field_count = 1};
    library_check(stage->context,
                  sphg_evaluate(stage->context, &stage->scheme[one->method], &request));
}

/* div (-y, x, 2z) = 2 */
static double divergence_error(const struct numbers *results)
{
    double most = 0;
    for (int32_t i = 0; i < results->count; ++i)
        most = numbers_larger(most, fabs(numbers_get(results, i, 0) / 2 - 1));
    return most;
}

/* |sum f| / sum |f|, component by component, the largest. */
static double momentum_error(const struct numbers *results)
{
    double most = 0;
    for (int32_t c = 0; c < results->width; ++c) {
        double sum = 0, size = 0;
        for (int32_t i = 0; i < results->count; ++i) {
            const double f = numbers_get(results, i, c);
            sum += f;
            size += fabs(f);
        }
        most = numbers_larger(most, fabs(sum) / size);
    }
    return most;
}

static double error_of(struct stage *stage, const struct force_case *one)
{
    const struct numbers *results = &stage->results[is_vector(one)];
    return one->form == SPHG_DIFFERENCE ? divergence_error(results) : momentum_error(results);
}

/* ---- The whole ------------------------------------------------------------------------------- */

static void fill_fields(struct stage *stage)
{
    for (int32_t i = 0; i < stage->particles.count; ++i) {
        for (int32_t c = 0; c < 6; ++c) {
            const double x = numbers_get(&stage->particles.positions, i, c % 3);
            numbers_set(&stage->tensors, i, c, 1 + cos((3 + c) * x));
        }
        numbers_set(&stage->densities, i, 0, 1000);
    }
    linear_field_fill(&stage->particles.positions, &stage->velocities);
}

static void search(struct stage *stage, int supply)
{
    sphg_geometry geometry = library_geometry(&stage->particles.positions,
                                              field_type(stage->forces->settings.precision));
    geometry.keep_weights = supply;
    stage->neighbors[supply] = library_neighbors(stage->context);
    library_search(stage->context, stage->neighbors[supply], &stage->scheme[0], &geometry);
}

/* Corrections of the methods that some case asks for. */
static void correct(struct stage *stage, sphg_method method)
{
    const sphg_sources sources = {.neighbors = stage->neighbors[0],
                                  .volume = numbers_view(&stage->particles.volumes)};
    const int32_t width = sphg_correction_width(&stage->scheme[method]);
    if (stage->corrections[method].count || !width)
        return;
    stage->corrections[method] = numbers_create(field_type(stage->forces->settings.precision),
                                                stage->particles.count, width);
    library_correct(stage->context, &stage->scheme[method], &sources,
                    numbers_view(&stage->corrections[method]), NULL);
}

static struct stage open_stage(struct forces *forces)
{
    const struct particle_source source = {.side = settings_side(forces->settings.particles, 3),
                                           .jitter = forces->settings.jitter,
                                           .precision = forces->settings.precision};
    struct stage stage = {.forces = forces,
                          .context = library_open(forces->settings.threads),
                          .particles = particles_create(&source)};
    const int32_t count = forces->count = stage.particles.count;
    const sphg_type type = field_type(forces->settings.precision);
    for (int method = 0; method < METHODS; ++method)
        stage.scheme[method] =
            (sphg_scheme){.method = (sphg_method)method,
                          .dimension = 3,
                          .support_radius = forces->settings.support * lattice_spacing};
    stage.velocities = numbers_create(type, count, 3);
    stage.tensors = numbers_create(type, count, 6);
    stage.densities = numbers_create(type, count, 1);
    stage.results[0] = numbers_create(type, count, 1);
    stage.results[1] = numbers_create(type, count, 3);
    fill_fields(&stage);
    for (int supply = 0; supply < FORCE_SUPPLIES; ++supply)
        search(&stage, supply);
    for (int k = 0; k < FORCE_CASES; ++k)
        correct(&stage, force_cases[k].method);
    return stage;
}

static void close_stage(struct stage *stage)
{
    for (int supply = 0; supply < FORCE_SUPPLIES; ++supply)
        sphg_neighbors_destroy(stage->neighbors[supply]);
    sphg_context_destroy(stage->context);
    particles_destroy(&stage->particles);
    numbers_destroy(&stage->velocities);
    numbers_destroy(&stage->tensors);
    numbers_destroy(&stage->densities);
    for (int method = 0; method < METHODS; ++method)
        numbers_destroy(&stage->corrections[method]);
    for (int k = 0; k < 2; ++k)
        numbers_destroy(&stage->results[k]);
}

/* Supplies take turns. Each is run once untimed before: weights are written by the first sweep, and
 * belong to the scheme of the last. */
static void measure_round(struct stage *stage, bool is_first)
{
    struct forces *forces = stage->forces;
    for (int k = 0; k < FORCE_CASES; ++k)
        for (int supply = 0; supply < FORCE_SUPPLIES; ++supply) {
            run(stage, &force_cases[k], supply);
            const struct moment start = now();
            run(stage, &force_cases[k], supply);
            if (!is_first)
                samples_add(&forces->times[k][supply], since(start));
            else
                forces->error[k] =
                    numbers_larger(forces->error[k], error_of(stage, &force_cases[k]));
        }
}

void forces_measure(struct forces *forces)
{
    struct stage stage = open_stage(forces);
    const int32_t rounds = forces->settings.repetitions;
    forces->pairs =
        (double)library_info(stage.context, stage.neighbors[0]).pairs / stage.particles.count;
    for (int32_t round = 0; round <= rounds; ++round) {
        progress_show("forces: round %d of %d", round, rounds);
        measure_round(&stage, round == 0);
    }
    progress_clear();
    close_stage(&stage);
}
