/* SPDX-License-Identifier: MIT */
#include "field_study.h"
#include "lattice.h"
#include "library.h"
#include <math.h>

static const int32_t boundary_layers = 2;

const char *study_field_name(enum study_field field)
{
    return field == FIELD_ROTATION ? "rotation" : "trigonometric";
}

const char *study_field_formula(enum study_field field)
{
    return field == FIELD_ROTATION ? "v = (-y, x)" : "v = (cos 2x, cos y - sin 3x)";
}

static sphg_scheme scheme_of(const struct study *study, sphg_method method)
{
    return (sphg_scheme){.dimension = 2,
                         .method = method,
                         .kernel = study->setting.kernel,
                         .support_radius = study->setting.support * study->spacing};
}

static void find_neighbors(struct study *study)
{
    const sphg_scheme scheme = scheme_of(study, SPHG_KGC);
    const sphg_geometry geometry =
        library_geometry(&study->positions, field_type(study->setting.precision));
    study->neighbors = library_neighbors(study->context);
    library_search(study->context, study->neighbors, &scheme, &geometry);
    library_volumes(study->context, &scheme, study->neighbors, &study->volumes);
}

struct study study_open(const struct study_setting *setting)
{
    const double spacing = 2.0 / setting->side;
    const struct lattice lattice = {.dimension = 2,
                                    .side = setting->side,
                                    .origin = -1 + 0.5 * spacing,
                                    .spacing = spacing,
                                    .jitter = setting->jitter};
    const int32_t count = lattice_count(&lattice);
    struct study study = {.setting = *setting, .count = count, .spacing = spacing};
    study.positions = numbers_create(position_type(setting->precision), count, 2);
    study.volumes = numbers_create(field_type(setting->precision), count, 1);
    lattice_fill(&lattice, &study.positions);
    study.context = library_open(0);
    find_neighbors(&study);
    return study;
}

void study_close(struct study *study)
{
    sphg_neighbors_destroy(study->neighbors);
    sphg_context_destroy(study->context);
    numbers_destroy(&study->positions);
    numbers_destroy(&study->volumes);
}

bool study_on_boundary(const struct study *study, int32_t particle)
{
    const int32_t side = study->setting.side;
    const int32_t column = particle % side, row = particle / side;
    const int32_t last = side - boundary_layers;
    return column < boundary_layers || column >= last || row < boundary_layers || row >= last;
}

void study_velocity(const struct study *study, enum study_field field, int32_t particle,
                    double velocity[2])
{
    const double x = numbers_get(&study->positions, particle, 0);
    const double y = numbers_get(&study->positions, particle, 1);
    const bool rotation = field == FIELD_ROTATION;
    velocity[0] = rotation ? -y : cos(2 * x);
    velocity[1] = rotation ? x : cos(y) - sin(3 * x);
}

/* Row-major: d v_a / d x_b at 2 a + b. */
static void true_jacobian(const struct study *study, enum study_field field, int32_t particle,
                          double jacobian[4])
{
    const double x = numbers_get(&study->positions, particle, 0);
    const double y = numbers_get(&study->positions, particle, 1);
    const bool rotation = field == FIELD_ROTATION;
    jacobian[0] = rotation ? 0 : -2 * sin(2 * x);
    jacobian[1] = rotation ? -1 : 0;
    jacobian[2] = rotation ? 1 : -3 * cos(3 * x);
    jacobian[3] = rotation ? 0 : -sin(y);
}

/* Jacobian and curl of the field in one sweep. */
static void compute(const struct study *study, enum study_field field, sphg_method method,
                    struct numbers *jacobians, struct numbers *curls)
{
    const sphg_scheme scheme = scheme_of(study, method);
    struct numbers velocities = numbers_create(study->volumes.type, study->count, 2);
    for (int32_t i = 0; i < study->count; ++i) {
        double velocity[2];
        study_velocity(study, field, i, velocity);
        numbers_set(&velocities, i, 0, velocity[0]);
        numbers_set(&velocities, i, 1, velocity[1]);
    }
    const sphg_view at_sources = numbers_view(&velocities);
    const sphg_sources sources = {.neighbors = study->neighbors,
                                  .volume = numbers_view(&study->volumes)};
    const sphg_field wanted = {.shape = SPHG_VECTOR,
                               .at_sources = &at_sources,
                               .gradient = numbers_view(jacobians),
                               .curl = numbers_view(curls)};
    const sphg_request request = {
        .sources = &sources, .set_count = 1, .fields = &wanted, .field_count = 1};
    library_check(study->context, sphg_evaluate(study->context, &scheme, &request));
    numbers_destroy(&velocities);
}

static double gradient_error(const struct numbers *jacobians, int32_t i, const double expected[4])
{
    double sum = 0;
    for (int32_t k = 0; k < 4; ++k) {
        const double difference = numbers_get(jacobians, i, k) - expected[k];
        sum += difference * difference;
    }
    return sqrt(sum);
}

struct study_errors study_measure(const struct study *study, enum study_field field,
                                  sphg_method method, double *gradient_errors, double *curl_errors)
{
    struct numbers jacobians = numbers_create(study->volumes.type, study->count, 4);
    struct numbers curls = numbers_create(study->volumes.type, study->count, 1);
    compute(study, field, method, &jacobians, &curls);
    struct study_errors errors = {0};
    int32_t boundary_count = 0;
    for (int32_t i = 0; i < study->count; ++i) {
        double expected[4];
        true_jacobian(study, field, i, expected);
        const double error = gradient_error(&jacobians, i, expected);
        const double curl = fabs(numbers_get(&curls, i, 0) - (expected[2] - expected[1]));
        const bool boundary = study_on_boundary(study, i);
        double *most = boundary ? &errors.boundary_max : &errors.inside_max;
        double *sum = boundary ? &errors.boundary_mean : &errors.inside_mean;
        *most = numbers_larger(*most, error);
        *sum += error;
        boundary_count += boundary;
        errors.curl_max = numbers_larger(errors.curl_max, curl);
        if (gradient_errors)
            gradient_errors[i] = error;
        if (curl_errors)
            curl_errors[i] = curl;
    }
    const int32_t inside_count = study->count - boundary_count;
    errors.boundary_mean /= boundary_count;
    errors.inside_mean /= inside_count > 0 ? inside_count : 1;
    numbers_destroy(&jacobians);
    numbers_destroy(&curls);
    return errors;
}
