/* SPDX-License-Identifier: MIT */
#include "fig2_trigonometric_measure.h"
#include "lattice.h"
#include "particles/errors.h"
#include <math.h>

static const int32_t boundary_layers = 2;

/* ---- Fields ---------------------------------------------------------------------------------- */

const char *study_field_name(enum study_field field)
{
    return field == FIELD_ROTATION ? "rotation" : "trigonometric";
}

const char *study_field_formula(enum study_field field)
{
    return field == FIELD_ROTATION ? "v = (-y, x)" : "v = (cos 2x, cos y - sin 3x)";
}

void study_exact_at(const struct scene *scene, enum study_field field, double wave,
                    int32_t particle, double v[3], double j[9])
{
    const int32_t d = scene->scheme.dimension;
    const double k = 2 * 3.14159265358979323846 / wave;
    const bool rotation = field == FIELD_ROTATION;
    double x[3] = {0, 0, 0};
    for (int32_t axis = 0; axis < d; ++axis)
        x[axis] = numbers_get(&scene->positions, particle, axis);
    for (int n = 0; n < 9; ++n)
        j[n] = 0;
    for (int32_t a = 0; a < d && field == FIELD_WAVES; ++a) {
        const int32_t b = (a + 1) % d;
        v[a] = sin(k * x[a]) * cos(k * x[b]);
        j[d * a + a] = k * cos(k * x[a]) * cos(k * x[b]);
        j[d * a + b] = -k * sin(k * x[a]) * sin(k * x[b]);
    }
    if (field == FIELD_WAVES)
        return;
    v[0] = rotation ? -x[1] : cos(2 * x[0]);
    v[1] = rotation ? x[0] : cos(x[1]) - sin(3 * x[0]);
    j[0] = rotation ? 0 : -2 * sin(2 * x[0]);
    j[1] = rotation ? -1 : 0;
    j[d] = rotation ? 1 : -3 * cos(3 * x[0]);
    j[d + 1] = rotation ? 0 : -sin(x[1]);
    if (d == 3) {
        v[2] = rotation ? 2 * x[2] : cos(2 * x[2]);
        j[8] = rotation ? 2 : -2 * sin(2 * x[2]);
    }
}

void study_fill_table(const struct scene *scene, enum study_field field, double wave,
                      struct numbers *velocities)
{
    double v[3], j[9];
    for (int32_t i = 0; i < scene->count; ++i) {
        study_exact_at(scene, field, wave, i, v, j);
        for (int32_t axis = 0; axis < velocities->width; ++axis)
            numbers_set(velocities, i, axis, v[axis]);
    }
}

static double wave_of(const struct study *study)
{
    return 10 * study->scene.scheme.support_radius;
}

void study_fill(struct study *study, enum study_field field)
{
    study->field = field;
    study_fill_table(&study->scene, field, wave_of(study), &study->scene.field);
}

/* ---- Particles ------------------------------------------------------------------------------- */

/* Volumes that are not given come from the positions. */
static struct study open_study(const struct study_setting *setting, struct numbers positions,
                               struct numbers volumes, double support_radius, struct held *mark)
{
    const sphg_type type = field_type(setting->precision);
    const int32_t d = setting->dimension, n = positions.count;
    const sphg_scheme scheme = {
        .dimension = d, .kernel = setting->kernel, .support_radius = support_radius};
    const bool given = volumes.data != NULL;
    if (!given)
        volumes = numbers_create(type, 1, 1);
    struct study study = {
        .setting = *setting,
        .scene = scene_open(library_open(setting->threads), &scheme, positions, volumes),
        .curls = numbers_create(type, n, 1),
        .lent = numbers_create(type, n, 1 + d * d * (d + 1) / 2),
        .groups = allocate_held((size_t)n, 1),
        .borrows = allocate_held((size_t)n, 1),
        .mark = mark};
    study_search(&study);
    if (!given)
        study.scene.volumes = scene_volumes(&study.scene);
    return study;
}

static bool is_on_boundary(const struct study_setting *setting, int32_t particle)
{
    const int32_t side = setting->side;
    for (int32_t axis = 0, rest = particle; axis < setting->dimension; ++axis, rest /= side)
        if (rest % side < boundary_layers || rest % side >= side - boundary_layers)
            return true;
    return false;
}

struct study study_open(const struct study_setting *setting)
{
    struct held *mark = held_so_far();
    const double spacing = 2.0 / setting->side;
    const struct lattice lattice = {.dimension = setting->dimension,
                                    .side = setting->side,
                                    .origin = -1 + 0.5 * spacing,
                                    .spacing = spacing,
                                    .jitter = setting->jitter};
    struct numbers positions = numbers_create(position_type(setting->precision),
                                              lattice_count(&lattice), setting->dimension);
    lattice_fill(&lattice, &positions);
    struct study study =
        open_study(setting, positions, (struct numbers){0}, setting->support * spacing, mark);
    for (int32_t i = 0; i < positions.count; ++i)
        study.groups[i] = is_on_boundary(setting, i) ? STUDY_BOUNDARY : STUDY_INSIDE;
    return study;
}

struct study study_of_particles(const struct study_setting *setting, struct numbers positions,
                                struct numbers volumes)
{
    struct study study = open_study(setting, positions, volumes, setting->support, held_so_far());
    struct scene scene = study.scene;
    const sphg_sources sources = scene_sources(&scene);
    const sphg_request ranks = {
        .sources = &sources, .set_count = 1, .rank = sphg_view_u8(study.groups, 1)};
    const int32_t d = setting->dimension, full = d * (d + 3) / 2;
    scene.scheme.order = 2;
    scene_evaluate(&scene, &ranks);
    for (int32_t i = 0; i < scene.count; ++i)
        study.groups[i] = study.groups[i] == full ? STUDY_CURVATURE
                          : study.groups[i] >= d  ? STUDY_SLOPES
                                                  : STUDY_NEITHER;
    return study;
}

void study_close(struct study *study)
{
    release_held(study->mark);
}

/* ---- Derivatives ----------------------------------------------------------------------------- */

void study_search(const struct study *study)
{
    scene_run(&study->scene, WORK_SEARCH);
}

void study_derive(const struct study *study, const struct study_way *way)
{
    struct scene scene = study->scene;
    const sphg_view at_sources = numbers_view(&scene.field), lent = numbers_view(&study->lent);
    const sphg_subset borrowers = sphg_masked(study->borrows, scene.count);
    const sphg_sources sources = scene_sources(&scene);
    sphg_field wanted = {.shape = SPHG_VECTOR,
                         .at_sources = &at_sources,
                         .gradient = numbers_view(&scene.jacobians),
                         .curl = study->setting.dimension == 2 ? numbers_view(&study->curls)
                                                               : sphg_absent(),
                         .curvature = way->lent ? lent : sphg_absent()};
    sphg_request request = {.sources = &sources,
                            .set_count = 1,
                            .fields = &wanted,
                            .field_count = 1,
                            .borrows = way->lent ? sphg_view_u8(study->borrows, 1) : sphg_absent()};
    scene.scheme.method = way->method;
    scene.scheme.order = way->order;
    scene_evaluate(&scene, &request);
    if (!way->lent)
        return;
    wanted.curvature = request.borrows = sphg_absent();
    wanted.lenders = &lent;
    request.subset = &borrowers;
    scene_evaluate(&scene, &request);
}

struct study_errors study_compare(const struct study *study, double *gradient_errors,
                                  double *curl_errors)
{
    struct study_errors errors = {.curl_max = 0};
    for (int32_t i = 0; i < study->scene.count; ++i) {
        double v[3], expected[9];
        study_exact_at(&study->scene, study->field, wave_of(study), i, v, expected);
        const double error = norm_of(&study->scene.jacobians, i, expected);
        const double curl =
            study->setting.dimension == 2
                ? fabs(numbers_get(&study->curls, i, 0) - (expected[2] - expected[1]))
                : 0;
        const int group = study->groups[i];
        errors.most[group] = numbers_larger(errors.most[group], error);
        errors.mean[group] += error;
        ++errors.counts[group];
        errors.curl_max = numbers_larger(errors.curl_max, curl);
        if (gradient_errors)
            gradient_errors[i] = error;
        if (curl_errors)
            curl_errors[i] = curl;
    }
    for (int group = 0; group < STUDY_GROUPS; ++group)
        errors.mean[group] /= errors.counts[group] > 0 ? errors.counts[group] : 1;
    return errors;
}
