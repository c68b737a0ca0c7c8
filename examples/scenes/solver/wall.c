/* SPDX-License-Identifier: MIT */
#include "wall.h"
#include "stopwatch.h"
#include <math.h>
#include <stdlib.h>
#include <string.h>

/* Matrices of the wall alone: a particle that sees too little of it for an exact normal (three in a
 * row, or a plane that it lies in) is better off without correction than with half of one. */
static sphg_scheme wall_scheme(const struct sph *sph, double threshold)
{
    sphg_scheme scheme = sph->corrected;
    scheme.policy = SPHG_IDENTITY;
    scheme.threshold = threshold;
    return scheme;
}

struct wall wall_new(const struct sph *sph, int32_t count, vector *x)
{
    struct wall wall = {.count = count, .x = x};
    const double one = 1;
    const sphg_view ones = everywhere(&one);
    sphg_neighbors *neighbors = sph_neighbors(sph);
    wall.v = array_new(count, sizeof *wall.v);
    wall.volume = array_new(count, sizeof *wall.volume);
    sph_search(sph, neighbors, count, x);
    const sphg_sources sources = {.neighbors = neighbors, .volume = ones};
    sphg_field field = direct_field(SPHG_SCALAR, &ones);
    field.value = scalars(wall.volume);
    sph_evaluate(sph, &sph->plain, &sources, sphg_absent(), 1, &field);
    for (int32_t k = 0; k < count; ++k)
        wall.volume[k] = 1 / wall.volume[k];
    sphg_neighbors_destroy(neighbors);
    return wall;
}

void wall_free(struct wall *wall)
{
    free(wall->x);
    free(wall->v);
    free(wall->volume);
}

struct contact contact_new(const struct sph *sph, const struct wall *wall, int32_t capacity)
{
    struct contact contact = {.wall = wall,
                              .threshold = 1e-9,
                              .skin = 0.25 * sph->plain.support_radius,
                              .neighbors = sph_neighbors(sph)};
    contact.filling = array_new(capacity, sizeof *contact.filling);
    contact.slope = array_new(capacity, sizeof *contact.slope);
    contact.approach = array_new(capacity, sizeof *contact.approach);
    contact.drag = array_new(capacity, sizeof *contact.drag);
    contact.touching = array_new(capacity, sizeof *contact.touching);
    contact.correction = array_new(capacity, 6 * sizeof *contact.correction);
    contact.target_volume = array_new(1, sizeof *contact.target_volume);
    contact.offsets = array_new(capacity + 1, sizeof *contact.offsets);
    contact.near = array_new(capacity, sizeof *contact.near);
    return contact;
}

void contact_free(struct contact *contact)
{
    sphg_neighbors_destroy(contact->neighbors);
    free(contact->filling);
    free(contact->slope);
    free(contact->approach);
    free(contact->drag);
    free(contact->touching);
    free(contact->correction);
    free(contact->target_volume);
    free(contact->offsets);
    free(contact->near);
}

static void find_pairs(const struct sph *sph, struct contact *contact,
                       const struct particles *fluid)
{
    sphg_geometry geometry = sphg_targets_apart(vectors(fluid->x), fluid->count,
                                                vectors(contact->wall->x), contact->wall->count);
    geometry.skin = contact->skin;
    const double start = stopwatch_now();
    sph_check(sph, sphg_neighbors_search(sph->context, contact->neighbors, &sph->plain, &geometry));
    sph->spent[SEARCH] += stopwatch_now() - start;
}

/* Also zeroes what the sums leave alone. */
static void count_pairs(const struct sph *sph, struct contact *contact, const sphg_sources *sources,
                        int32_t count)
{
    sphg_pairs pairs = {.offsets = contact->offsets};
    sph_check(sph,
              sphg_pair_gradients(sph->context, &sph->plain, sources, NULL, sphg_absent(), &pairs));
    contact->near_count = 0;
    for (int32_t i = 0; i < count; ++i) {
        contact->touching[i] = (int32_t)(contact->offsets[i + 1] - contact->offsets[i]);
        if (contact->touching[i])
            contact->near[contact->near_count++] = i;
    }
    memset(contact->filling, 0, (size_t)count * sizeof *contact->filling);
    memset(contact->slope, 0, (size_t)count * sizeof *contact->slope);
    memset(contact->approach, 0, (size_t)count * sizeof *contact->approach);
    memset(contact->drag, 0, (size_t)count * sizeof *contact->drag);
}

/* With no table given, the matrices are found, and kept, in the same sweep. Returns the seconds. */
static double sum(const struct sph *sph, const sphg_scheme *scheme, struct contact *contact,
                  const sphg_sources *sources, bool table_given)
{
    const double one = 1, start = stopwatch_now();
    const sphg_view ones = everywhere(&one), v = vectors(contact->wall->v);
    const sphg_view table = sphg_view_f64(contact->correction, 6 * sizeof *contact->correction);
    const sphg_subset near = sphg_listed(contact->near, contact->near_count);
    sphg_field fields[2] = {direct_field(SPHG_SCALAR, &ones), direct_field(SPHG_VECTOR, &v)};
    sphg_request request = {.sources = sources,
                            .set_count = 1,
                            .fields = fields,
                            .field_count = 2,
                            .subset = &near,
                            .target_volume = everywhere(contact->target_volume)};
    fields[0].value = scalars(contact->filling);
    fields[0].gradient = vectors(contact->slope);
    fields[1].value = vectors(contact->drag);
    fields[1].divergence = scalars(contact->approach);
    if (table_given)
        request.target_correction = table;
    else if (scheme->method != SPHG_PLAIN)
        request.correction = table;
    sph_check(sph, sphg_evaluate(sph->context, scheme, &request));
    return stopwatch_now() - start;
}

/* What the matrices cost shows only beside a sweep that has them already; both repeated, so that
 * both find the caches warm. Made now and then, it stands for all sweeps between. */
static void weigh_matrices(const struct sph *sph, const sphg_scheme *scheme,
                           struct contact *contact, const sphg_sources *sources)
{
    if (scheme->method == SPHG_PLAIN || contact->updates++ % UPDATES_PER_WEIGHING)
        return;
    const double given = sum(sph, scheme, contact, sources, true);
    const double fused = sum(sph, scheme, contact, sources, false);
    sph->spent[WALL_MATRICES] += UPDATES_PER_WEIGHING * (fused - given);
    sph->spent[PRESSURE] -= UPDATES_PER_WEIGHING * (fused - given);
    sph->spent[MEASURING] += fused + given;
}

void contact_update(const struct sph *sph, struct contact *contact, const struct particles *fluid)
{
    const sphg_scheme scheme = wall_scheme(sph, contact->threshold);
    const sphg_sources sources = {.neighbors = contact->neighbors,
                                  .volume = scalars(contact->wall->volume)};
    *contact->target_volume = fluid->rest_volume;
    find_pairs(sph, contact, fluid);
    const double start = stopwatch_now();
    count_pairs(sph, contact, &sources, fluid->count);
    sum(sph, &scheme, contact, &sources, false);
    sph->spent[PRESSURE] += stopwatch_now() - start;
    weigh_matrices(sph, &scheme, contact, &sources);
}

void contact_friction(const struct contact *contact, double strength, struct particles *fluid)
{
    for (int32_t i = 0; i < fluid->count; ++i) {
        const double share = strength * fluid->rest_density[i] / fluid->density[i];
        const double most = fmin(1, share * contact->filling[i]);
        const double scale = contact->filling[i] > 0 ? most / contact->filling[i] : 0;
        const double held[3] = {fluid->v[i][0], fluid->v[i][1], fluid->v[i][2]};
        add_scaled(fluid->v[i], scale, contact->drag[i]);
        add_scaled(fluid->v[i], -scale * contact->filling[i], held);
    }
}
