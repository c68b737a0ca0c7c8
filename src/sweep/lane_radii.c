/* SPDX-License-Identifier: MIT */
#include "lane_radii.h"
#include "core/kernel.h"

/* ---- Units ---------------------------------------------------------------------------------- */

/* [0] the mantissas of a unit, [1] and [2] its powers. */
static char *table_unit_lanes(const struct sphgi_worker *w, int32_t unit, int32_t which)
{
    return sphgi_lane(w, w->radii.table_units, 3 * unit + which);
}

static void put_units(struct sphgi_worker *w, const double *radius)
{
    const struct sphgi_plan *plan = w->sweep->plan;
    const struct sphgi_lane_units units = {.largest = plan->scheme.radius,
                                           .factor_of_h = w->factor_of_h,
                                           .dimension = plan->dimension,
                                           .with_volume = plan->scheme.method != SPHG_MLS,
                                           .in_radii = plan->quadratic};
    w->passes->lane_units(w->batch.width, &units, radius, sphgi_lane(w, w->radii.ratio, 0),
                          sphgi_lane(w, w->radii.inverse, 0),
                          sphgi_lane(w, w->radii.inverse_square, 0),
                          sphgi_lane(w, w->radii.factor, 0));
}

/* Numbers of order 2 have units in any table. */
static bool has_units(const struct sphgi_worker *w)
{
    return w->sweep->plan->quadratic || sphgi_has_units(&w->sweep->plan->scheme);
}

/* A table's units, as sphgi_table_units has them, lane by lane: mantissa and two powers of each. */
static void put_table_units(struct sphgi_worker *w, const double *radius)
{
    double factor[SPHGI_TABLE_UNITS][SPHGI_WIDTH];
    sphgi_table_scales_at(&w->sweep->plan->scheme, w->batch.width, radius, factor[0], factor[1]);
    for (int32_t l = 0; w->sweep->plan->quadratic && l < w->batch.width; ++l) {
        factor[1][l] = factor[0][l] / radius[l];
        factor[2][l] = factor[1][l] / radius[l];
    }
    for (int32_t k = 0; k < SPHGI_TABLE_UNITS && w->table_units[k].count; ++k)
        w->passes->lane_table_units(w->batch.width, factor[k], table_unit_lanes(w, k, 0),
                                    table_unit_lanes(w, k, 1), table_unit_lanes(w, k, 2));
}

static void radii_at(const sphg_neighbors *n, const int32_t *places, int32_t count, double *radius)
{
    const sphg_type type = n->position_type;
    const char *rows = sphgi_target_row(n, 0);
    for (int32_t l = 0; l < count; ++l)
        radius[l] = sphgi_radius_in(rows, type, places[l]);
}

static void read_radii(struct sphgi_worker *w, const int32_t *places)
{
    const int32_t width = w->batch.width;
    const bool units = has_units(w);
    double radius[SPHGI_WIDTH];
    radii_at(w->sweep->set->neighbors, places, width, radius);
    put_units(w, radius);
    if (units)
        put_table_units(w, radius);
    if (w->gather.unit == 1) /* else offsets are in units of it */
        w->shape.inverse_lanes = sphgi_lane(w, w->radii.inverse, 0);
    if (!w->sweep->plan->classic)
        w->shape.factor_lanes = sphgi_lane(w, w->radii.factor, 0);
}

void sphgi_read_lane_radii(struct sphgi_worker *w)
{
    if (w->sweep->plan->graded)
        read_radii(w, sphgi_places(w));
}

void sphgi_keep_lane_radii(struct sphgi_worker *w, uint32_t kept)
{
    char *const each[] = {w->radii.ratio, w->radii.inverse, w->radii.inverse_square,
                          w->radii.factor};
    if (!w->sweep->plan->graded)
        return;
    for (int32_t k = 0; k < 4; ++k)
        w->passes->pack_lanes(kept, 1, sphgi_lane(w, each[k], 0));
    if (has_units(w))
        w->passes->pack_lanes(kept, 3 * SPHGI_TABLE_UNITS, sphgi_lane(w, w->radii.table_units, 0));
}

/* ---- Numbers -------------------------------------------------------------------------------- */

void sphgi_scale_volumes(struct sphgi_worker *w)
{
    const size_t size = sphgi_size_of_type(w->sweep->plan->type);
    if (!w->sweep->plan->graded || !w->sweep->plan->classic)
        return;
    if (!w->sweep->volumes)
        w->passes->fill(w->tile.steps * w->passes->lanes, w->sweep->volume,
                        (char *)w->tile.arrays + SPHGI_V * SPHGI_TILE * size);
    w->passes->scale_pairs(&w->tile, SPHGI_V, 1, sphgi_lane(w, w->radii.ratio, 0));
}

void sphgi_scale_values(struct sphgi_worker *w)
{
    if (w->sweep->plan->graded)
        w->passes->scale_pairs(&w->tile, SPHGI_PHI, 1, sphgi_lane(w, w->radii.ratio, 0));
}

void sphgi_weigh_other_side(struct sphgi_worker *w)
{
    struct sphgi_shape shape = w->shape;
    shape.inverse_lanes = shape.factor_lanes = NULL;
    w->passes->shape_other(&shape, &w->tile, w->rows.at[w->sweep->plan->radius_row]);
}

/* ---- Tables --------------------------------------------------------------------------------- */

static void divide(struct sphgi_worker *w, const struct sphgi_table_unit *unit, int32_t k,
                   char *coefficients)
{
    for (int32_t c = unit->first; c < unit->first + unit->count; ++c)
        w->passes->quotient(w->batch.width, sphgi_lane(w, w->raw, c), table_unit_lanes(w, k, 0),
                            sphgi_lane(w, coefficients, c));
}

void sphgi_round_by_radius(struct sphgi_worker *w, char *coefficients, bool wanted)
{
    const bool units = has_units(w);
    for (int32_t k = 0; k < SPHGI_TABLE_UNITS && w->table_units[k].count; ++k) {
        const struct sphgi_table_unit *unit = &w->table_units[k];
        char *ours = sphgi_lane(w, coefficients, unit->first);
        char *raw = sphgi_lane(w, w->raw, unit->first);
        if (units || wanted)
            w->passes->scale(w->batch.width, unit->count, ours, 1,
                             units ? table_unit_lanes(w, k, 0) : NULL, raw);
        if (units)
            divide(w, unit, k, coefficients);
        for (int32_t p = 1; units && wanted && p < 3; ++p)
            w->passes->scale(w->batch.width, unit->count, raw, 1, table_unit_lanes(w, k, p), raw);
    }
}

void sphgi_take_by_radius(struct sphgi_worker *w)
{
    const bool units = has_units(w);
    for (int32_t k = 0; k < SPHGI_TABLE_UNITS && w->table_units[k].count; ++k) {
        const struct sphgi_table_unit *unit = &w->table_units[k];
        char *raw = sphgi_lane(w, w->raw, unit->first);
        for (int32_t p = 1; units && p < 3; ++p) {
            w->passes->quotient(w->batch.width, NULL, table_unit_lanes(w, k, p), w->extra);
            w->passes->scale(w->batch.width, unit->count, raw, 1, w->extra, raw);
        }
        if (units)
            divide(w, unit, k, w->coefficients);
        else
            w->passes->scale(w->batch.width, unit->count, raw, 1, NULL,
                             sphgi_lane(w, w->coefficients, unit->first));
    }
}
