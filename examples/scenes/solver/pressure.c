/* SPDX-License-Identifier: MIT */
#include "pressure.h"
#include "stopwatch.h"
#include <math.h>
#include <stdlib.h>
#include <string.h>

enum { FEWEST_ITERATIONS = 2 };

/* Compression of a particle that shall feel no pressure: no displacement makes up for it. */
static const double never_compressed = -1e3;

/* The divergence of fewer neighbours says more about the surface than about compression. */
static int32_t fewest_neighbors(const struct sph *sph)
{
    return sph->plain.dimension == 2 ? 7 : 20;
}

struct pressure pressure_new(const struct sph *sph, struct contact *contact, int32_t capacity)
{
    struct pressure made = {.relaxation = 0.5,
                            .rate_error = 1e-3,
                            .density_error = 1e-4,
                            .fewest_iterations = 2,
                            .most_iterations = 100,
                            .sph = sph,
                            .contact = contact,
                            .neighbors = sph_neighbors(sph)};
    made.compression = array_new(capacity, sizeof *made.compression);
    made.offsets = array_new(capacity + 1, sizeof *made.offsets);
    made.slope = array_new(capacity, sizeof *made.slope);
    made.inverse_diagonal = array_new(capacity, sizeof *made.inverse_diagonal);
    made.potential = array_new(capacity, sizeof *made.potential);
    made.reached = array_new(capacity, sizeof *made.reached);
    made.stress = array_new(capacity, sizeof *made.stress);
    made.source = array_new(capacity, sizeof *made.source);
    made.change = array_new(capacity, sizeof *made.change);
    made.displacement = array_new(capacity, sizeof *made.displacement);
    return made;
}

void pressure_free(struct pressure *pressure)
{
    sphg_neighbors_destroy(pressure->neighbors);
    free(pressure->compression);
    free(pressure->offsets);
    free(pressure->slope);
    free(pressure->inverse_diagonal);
    free(pressure->potential);
    free(pressure->reached);
    free(pressure->stress);
    free(pressure->source);
    free(pressure->change);
    free(pressure->displacement);
}

static sphg_sources sources_of(const struct pressure *pressure, const struct particles *fluid)
{
    const sphg_sources sources = {.neighbors = pressure->neighbors,
                                  .volume = everywhere(&fluid->rest_volume)};
    return sources;
}

/* Compression sum V W and its slope sum V grad W, of fluid and wall; into inverse_diagonal the sum
 * of |V grad W|^2 / rest density, of the fluid. */
static void sum_compression(struct pressure *pressure, const struct particles *fluid)
{
    const double one = 1;
    double *lightness = pressure->change; /* nothing changes yet */
    const sphg_view ones = everywhere(&one), light = scalars(lightness);
    const sphg_sources sources = sources_of(pressure, fluid);
    const struct contact *contact = pressure->contact;
    sphg_field fields[2] = {direct_field(SPHG_SCALAR, &ones), direct_field(SPHG_SCALAR, &light)};
    for (int32_t i = 0; i < fluid->count; ++i)
        lightness[i] = 1 / fluid->rest_density[i];
    fields[0].value = scalars(pressure->compression);
    fields[0].gradient = vectors(pressure->slope);
    fields[1].square = scalars(pressure->inverse_diagonal);
    sph_evaluate(pressure->sph, &pressure->sph->plain, &sources, sphg_absent(), 2, fields);
    for (int32_t i = 0; contact && i < fluid->count; ++i) {
        pressure->compression[i] += contact->filling[i];
        add_scaled(pressure->slope[i], 1, contact->slope[i]);
    }
}

static void count_pairs(struct pressure *pressure, const struct particles *fluid)
{
    const sphg_sources sources = sources_of(pressure, fluid);
    sphg_pairs pairs = {.offsets = pressure->offsets};
    sph_check(pressure->sph, sphg_pair_gradients(pressure->sph->context, &pressure->sph->plain,
                                                 &sources, NULL, sphg_absent(), &pairs));
}

/* How much compression a unit of potential takes from its own particle: by moving that, and by
 * moving its neighbours, of other density perhaps. */
static double diagonal(const struct pressure *pressure, const struct particles *fluid, int32_t i)
{
    return dot(pressure->slope[i], pressure->slope[i]) +
           fluid->rest_density[i] * pressure->inverse_diagonal[i];
}

void pressure_prepare(struct pressure *pressure, struct particles *fluid)
{
    const double support_radius = pressure->sph->plain.support_radius;
    const double least = 1e-8 / (support_radius * support_radius); /* a lone particle: no wall */
    sph_search(pressure->sph, pressure->neighbors, fluid->count, fluid->x);
    if (pressure->contact)
        contact_update(pressure->sph, pressure->contact, fluid);
    const double start = stopwatch_now();
    sum_compression(pressure, fluid);
    count_pairs(pressure, fluid);
    for (int32_t i = 0; i < fluid->count; ++i) {
        const double sum = diagonal(pressure, fluid, i);
        pressure->inverse_diagonal[i] = sum > least ? 1 / sum : 0;
        fluid->density[i] = fluid->rest_density[i] * pressure->compression[i];
        fluid->volume[i] = fluid->mass[i] / fluid->density[i];
    }
    pressure->sph->spent[PRESSURE] += stopwatch_now() - start;
}

/* change = d compression / dt where particles move with u, and walls with theirs or not at all. */
static void compression_rate(struct pressure *pressure, const struct particles *fluid, vector *u,
                             bool walls_move)
{
    const struct contact *contact = pressure->contact;
    const sphg_sources sources = sources_of(pressure, fluid);
    sph_check(pressure->sph,
              sphg_divergence(pressure->sph->context, &pressure->sph->plain, &sources, NULL,
                              vectors(u), scalars(pressure->change)));
    for (int32_t i = 0; i < fluid->count; ++i) {
        pressure->change[i] = -pressure->change[i];
        if (contact)
            pressure->change[i] +=
                dot(u[i], contact->slope[i]) - (walls_move ? contact->approach[i] : 0);
    }
}

/* Where the potential moves the particles. The adjoint of the divergence above, so it keeps the
 * fluid's momentum; stress in units of density, since what one particle of a pair gains in momentum
 * the other one loses. */
static void displace(struct pressure *pressure, const struct particles *fluid)
{
    const sphg_sources sources = sources_of(pressure, fluid);
    for (int32_t i = 0; i < fluid->count; ++i)
        pressure->stress[i] = fluid->rest_density[i] * pressure->potential[i];
    sph_check(pressure->sph,
              sphg_force(pressure->sph->context, &pressure->sph->plain, &sources, NULL, SPHG_SCALAR,
                         scalars(pressure->stress), vectors(pressure->displacement)));
    for (int32_t i = 0; i < fluid->count; ++i) {
        for (int k = 0; k < 3; ++k)
            pressure->displacement[i][k] /= -fluid->mass[i];
        if (pressure->contact)
            add_scaled(pressure->displacement[i], -pressure->potential[i],
                       pressure->contact->slope[i]);
    }
}

/* One Jacobi step towards source + change = 0, without pulling, and from what it reached on by
 * `momentum` times the way from what the step before reached. Returns the mean compression left
 * before it. */
static double relax(struct pressure *pressure, const struct particles *fluid, double momentum)
{
    double left = 0;
    displace(pressure, fluid);
    compression_rate(pressure, fluid, pressure->displacement, false);
    for (int32_t i = 0; i < fluid->count; ++i) {
        const double residual = pressure->source[i] + pressure->change[i];
        const double step = pressure->relaxation * residual * pressure->inverse_diagonal[i];
        const double reached = fmax(0, pressure->potential[i] + step);
        const double way = reached - pressure->reached[i];
        pressure->potential[i] = fmax(0, reached + momentum * way);
        pressure->reached[i] = reached;
        left += fmax(0, residual);
    }
    return left / fluid->count;
}

/* Nesterov's acceleration, begun anew where it overshoots: less is left of an error of long wave,
 * which plain iterations pass on from neighbour to neighbour. */
static int32_t iterate(struct pressure *pressure, const struct particles *fluid, double error)
{
    int32_t iterations = 0;
    double inertia = 1, before = INFINITY;
    while (iterations < pressure->most_iterations) {
        const double next = 0.5 * (1 + sqrt(1 + 4 * inertia * inertia));
        const double left = relax(pressure, fluid, (inertia - 1) / next);
        if (++iterations >= pressure->fewest_iterations && left < error)
            break;
        inertia = left > before ? 1 : next;
        before = left;
    }
    return iterations;
}

static int32_t solve(struct pressure *pressure, struct particles *fluid, double dt, double error)
{
    const size_t size = (size_t)fluid->count * sizeof *pressure->potential;
    memcpy(pressure->reached, pressure->potential, size);
    const int32_t iterations = iterate(pressure, fluid, error);
    memcpy(pressure->potential, pressure->reached, size);
    displace(pressure, fluid);
    for (int32_t i = 0; i < fluid->count; ++i)
        add_scaled(fluid->v[i], 1 / dt, pressure->displacement[i]);
    return iterations;
}

static void start_from_source(struct pressure *pressure, int32_t count)
{
    for (int32_t i = 0; i < count; ++i)
        pressure->potential[i] =
            pressure->relaxation * fmax(0, pressure->source[i]) * pressure->inverse_diagonal[i];
}

static int32_t count_neighbors(const struct pressure *pressure, int32_t i)
{
    const int64_t *offsets = pressure->offsets;
    return (int32_t)(offsets[i + 1] - offsets[i]) +
           (pressure->contact ? pressure->contact->touching[i] : 0);
}

void pressure_stop_compression(struct pressure *pressure, struct particles *fluid, double dt)
{
    const double start = stopwatch_now();
    compression_rate(pressure, fluid, fluid->v, true);
    for (int32_t i = 0; i < fluid->count; ++i)
        pressure->source[i] = count_neighbors(pressure, i) < fewest_neighbors(pressure->sph)
                                  ? never_compressed
                                  : fmax(0, dt * pressure->change[i]);
    start_from_source(pressure, fluid->count);
    pressure->rate_iterations += solve(pressure, fluid, dt, pressure->rate_error);
    pressure->sph->spent[PRESSURE] += stopwatch_now() - start;
}

void pressure_keep_density(struct pressure *pressure, struct particles *fluid, double dt)
{
    const double start = stopwatch_now();
    compression_rate(pressure, fluid, fluid->v, true);
    for (int32_t i = 0; i < fluid->count; ++i)
        pressure->source[i] = pressure->compression[i] + dt * pressure->change[i] - 1;
    start_from_source(pressure, fluid->count);
    for (int32_t i = 0; i < fluid->count; ++i)
        pressure->potential[i] = fmax(pressure->potential[i], pressure->kept * fluid->potential[i]);
    pressure->density_iterations += solve(pressure, fluid, dt, pressure->density_error);
    memcpy(fluid->potential, pressure->potential, (size_t)fluid->count * sizeof *fluid->potential);
    pressure->sph->spent[PRESSURE] += stopwatch_now() - start;
}
