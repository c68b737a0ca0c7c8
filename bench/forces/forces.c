/* SPDX-License-Identifier: MIT */
/* The command `forces`: time of the operators that a solver iterates, forces and divergences, with
 * lists alone and with weights that neighbours keep. */
#include "commands.h"
#include "particles/particles.h"
#include "report/report.h"
#include <math.h>

struct force_case {
    const char *name;
    sphg_method method;
    sphg_form form;
    sphg_shape shape;
    bool divergence; /* of a vector; else the gradient, of a tensor its divergence */
};

static const struct force_case cases[] = {
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

enum {
    METHODS = SPHG_PLAIN + 1,
    CASES = sizeof cases / sizeof cases[0],
    SUPPLIES = 2, /* lists; lists and weights */
    ITEMS = CASES * SUPPLIES
};

struct forces {
    struct scene scenes[METHODS][SUPPLIES];
    struct numbers tensors, densities;
    struct numbers results[2]; /* numbers, vectors */
};

/* ---- One case -------------------------------------------------------------------------------- */

static double run(void *data, int32_t item)
{
    const struct forces *forces = data;
    const struct force_case *one = &cases[item / SUPPLIES];
    const struct scene *scene = &forces->scenes[one->method][item % SUPPLIES];
    const sphg_view given = numbers_view(
        one->shape == SPHG_VECTOR ? &scene->field : &forces->tensors); /* pressure: a component */
    const sphg_view result = numbers_view(&forces->results[!one->divergence]);
    sphg_field field = {.shape = one->shape, .form = one->form, .at_sources = &given};
    *(one->shape == SPHG_SCALAR ? &field.gradient : &field.divergence) = result;
    sphg_sources sources = scene_sources(scene);
    sources.density = numbers_view(&forces->densities);
    sources.correction = scene_corrections(scene);
    const sphg_request request = {
        .sources = &sources, .fields = &field, .set_count = 1, .field_count = 1};
    scene_evaluate(scene, &request);
    return 1;
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

/* Conservation makes sums of forces 0; differences are exact on a linear field. */
static double error_of(struct forces *forces, int32_t item)
{
    const struct force_case *one = &cases[item / SUPPLIES];
    const struct numbers *results = &forces->results[!one->divergence];
    run(forces, item);
    return one->form == SPHG_DIFFERENCE ? divergence_error(results) : momentum_error(results);
}

/* ---- The whole ------------------------------------------------------------------------------- */

static void fill_fields(struct forces *forces, const struct numbers *positions, sphg_type type)
{
    forces->tensors = numbers_create(type, positions->count, 6);
    forces->densities = numbers_create(type, positions->count, 1);
    for (int32_t i = 0; i < positions->count; ++i) {
        for (int32_t c = 0; c < 6; ++c)
            numbers_set(&forces->tensors, i, c,
                        1 + cos((3 + c) * numbers_get(positions, i, c % 3)));
        numbers_set(&forces->densities, i, 0, 1000);
    }
}

static struct forces open_scenes(const struct settings *settings)
{
    struct scene scene = scene_of_lattice(library_open(settings->threads), settings, 3);
    const sphg_type type = scene.field.type;
    struct forces forces = {
        .results = {numbers_create(type, scene.count, 1), numbers_create(type, scene.count, 3)}};
    scene_run(&scene, WORK_SEARCH);
    const struct scene weighted = scene_keeping_weights(&scene);
    fill_fields(&forces, &scene.positions, type);
    for (int method = 0; method < METHODS; ++method) {
        struct scene *scenes = forces.scenes[method];
        scenes[0] = scene;
        scenes[0].scheme.method = (sphg_method)method;
        scenes[0].corrections =
            numbers_create(type, scene.count, sphg_correction_width(&scenes[0].scheme));
        if (method != SPHG_PLAIN)
            scene_run(&scenes[0], WORK_MATRICES);
        scenes[1] = scenes[0];
        scenes[1].neighbors = weighted.neighbors;
        scenes[1].same_volumes = true;
    }
    return forces;
}

static int show(const struct settings *settings, const struct forces *forces,
                const struct samples times[ITEMS], const double errors[CASES])
{
    report_open("forces", settings);
    report_lattice(settings, forces->results[0].count, scene_pairs(&forces->scenes[0][0]));
    table_begin("forces");
    for (int k = 0; k < CASES; ++k)
        TABLE_ROW(cell_text("operator", cases[k].name),
                  cell_text("method", method_names[cases[k].method]),
                  cell_ms("lists", &times[k * SUPPLIES]),
                  cell_ms("lists and weights", &times[k * SUPPLIES + 1]),
                  cell_number("error", errors[k]));
    return report_close();
}

int command_forces(int argc, char **argv)
{
    struct settings settings = settings_default(1000000, 9, NULL);
    struct samples times[ITEMS] = {{0}};
    double errors[CASES] = {0};
    settings_read(&settings, TAKES_LATTICE | TAKES_RUN | TAKES_PRECISION, NULL,
                  "Times the operators that a solver iterates: forces in the adjoint and the "
                  "symmetric form and divergences, with lists alone and with weights that "
                  "neighbours keep. Takes some ten seconds.",
                  argc, argv);
    struct forces forces = open_scenes(&settings);
    for (int32_t item = 0; item < ITEMS; ++item)
        errors[item / SUPPLIES] = numbers_larger(errors[item / SUPPLIES], error_of(&forces, item));
    /* Weights are written by the first sweep, and belong to the scheme of the last. */
    rounds_measure(&(struct rounds){"forces", settings.repetitions, ITEMS, run, run, &forces},
                   times);
    return show(&settings, &forces, times, errors);
}
