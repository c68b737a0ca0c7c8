/* SPDX-License-Identifier: MIT */
/* Order 2's sums of targets whose lists stand side by side, from ids to sums in one call
 * (group_sums.inl.h). Each number is what the passes over a tile make of it. */

/* ---- Sums as pairs are read ------------------------------------------------------------------ */

/* KGC in 3D with 32 registers: what gather_quadratic puts into the tile, with the moments of second
 * order and the first sums of a vector field, whose differences stay. */
SPHGI_TEMPLATE void sums_as_read(const struct sphgi_group_sums *of, const struct sphgi_shape *shape,
                                 const struct sphgi_group_lists *lists,
                                 const struct sphgi_tile *tile, sphg_kernel kernel,
                                 struct group_how how)
{
    const struct sphgi_gather *g = of->gather;
    const struct sphgi_group_field *field = of->field;
    const struct four target = target_rows(g, lists->places);
    const vec scale = factor_scale(shape, SPHG_KGC), inverse_h = inverse_radius(shape);
    const vec volume = splat(R(g->volume)), unit = unit_of_offsets(g, target.w);
    const mask in_rows = first_lanes(g->volumes ? LANES : 0);
    const real *rows = g->rows;
    vec moment[6], sum[9], own[SPHGI_ROW];
    clear(moment, sums_of_moments(how));
    clear(sum, sums_of_field(how));
    if (how.numbers)
        own_numbers(field, lists, how.numbers, own);
    const uint32_t *ids = tile->ids, *to_come = ids_ahead(tile);
    real *at = tile->arrays;
    for (int32_t k = 0; k < tile->steps; ++k, at += LANES, ids += SPHGI_GROUP) {
        __builtin_prefetch(ids + AHEAD * SPHGI_GROUP);
        ask_for_rows(rows, how.numbers ? field->rows : NULL, to_come, tile->scattered);
        to_come += SPHGI_GROUP;
        const struct four row = gather_rows(rows, ids);
        const vec dx = target.x - row.x, dy = target.y - row.y, dz = target.z - row.z;
        const vec square = plus(plus(dx * dx, dy, dy), dz, dz);
        const vec x[3] = {dx * unit, dy * unit, dz * unit};
        const vec s = factor_of(scale, inverse_h, vsqrt(square) * unit,
                                select(in_rows, row.w, volume), kernel, SPHG_KGC);
        for (int32_t a = 0; a < 3; ++a)
            store(at + (SPHGI_X + a) * SPHGI_TILE, x[a]);
        store(at + SPHGI_S * SPHGI_TILE, s);
        const vec gradient[3] = {s * x[0], s * x[1], s * x[2]};
        if (how.moments)
            add_moments(gradient, x, moment, true);
        if (how.numbers) {
            const struct four numbers = gather_rows(field->rows, ids);
            const vec difference[3] = {numbers.x - own[0], numbers.y - own[1], numbers.z - own[2]};
            for (int32_t c = 0; c < 3; ++c) {
                store(at + (SPHGI_GX + c) * SPHGI_TILE, difference[c]);
                for (int32_t b = 0; b < 3; ++b)
                    sum[3 * c + b] = plus(sum[3 * c + b], difference[c], gradient[b]);
            }
        }
    }
    if (how.moments)
        end_chunk(tile, moment, sums_of_moments(how), sums_at(lists, of->moments));
    if (how.numbers)
        end_chunk(tile, sum, sums_of_field(how), sums_at(lists, field->sums));
}

SPHGI_TEMPLATE void as_read_by_sums(const struct sphgi_group_sums *of,
                                    const struct sphgi_shape *shape,
                                    const struct sphgi_group_lists *lists,
                                    const struct sphgi_tile *tile, sphg_kernel kernel)
{
    const struct group_how moments = {true, true, false, 0};
    if (KEEPS_PRODUCTS)
        return;
    if (!of->fields)
        sums_as_read(of, shape, lists, tile, kernel, moments);
    else
        WITH(
            both, of->moments,
            sums_as_read(of, shape, lists, tile, kernel, (struct group_how){true, both, false, 3}));
}

#define BY_KERNEL quadratic_as_read
#define PARAMETERS                                                                                 \
    (const struct sphgi_group_sums *of, const struct sphgi_shape *shape,                           \
     const struct sphgi_group_lists *lists, const struct sphgi_tile *tile)
#define ARGUMENTS    (of, shape, lists, tile)
#define CALL(kernel) as_read_by_sums(of, shape, lists, tile, kernel)
#include "by_kernel.inl.h"

/* Is there such a loop, and is it done? What it leaves out is summed over the tile. */
static bool is_summed_as_read(const struct sphgi_group_sums *g, const struct sphgi_shape *shape,
                              const struct sphgi_group_lists *lists, const struct sphgi_tile *tile)
{
    const bool vector = g->fields > 0 && g->field->numbers == 3;
    if (KEEPS_PRODUCTS || !g->three || shape->method != SPHG_KGC ||
        (g->fields ? !vector : !g->moments))
        return false;
    quadratic_as_read(g, shape, lists, tile);
    if (g->moments)
        higher_moments_as(tile, sums_at(lists, g->moments));
    if (vector)
        second_sums_as(tile, 0, 3, sums_at(lists, g->field->second), true);
    return true;
}

/* ---- Sums over the tile ---------------------------------------------------------------------- */

SPHGI_TEMPLATE void quadratic_field_in(const struct sphgi_group_field *field,
                                       const struct sphgi_group_lists *lists,
                                       const struct sphgi_tile *tile, int32_t count, bool three)
{
    real at_target[SPHGI_ROW * SPHGI_WIDTH];
    vec own[SPHGI_ROW];
    own_numbers(field, lists, count, own);
    for (int32_t c = 0; c < SPHGI_ROW; ++c)
        store(at_target + c * SPHGI_WIDTH, own[c]);
    quadratic_field_as(tile, field->rows, count, at_target, sums_at(lists, field->sums),
                       sums_at(lists, field->second), three);
}

SPHGI_TEMPLATE void quadratic_chunk(const struct sphgi_group_sums *g,
                                    const struct sphgi_shape *shape,
                                    const struct sphgi_group_lists *lists, struct sphgi_tile *tile,
                                    bool three)
{
    const bool begun = is_summed_as_read(g, shape, lists, tile);
    if (!begun)
        gather_quadratic(g->gather, shape, lists->places, tile);
    if (!begun && g->moments)
        quadratic_moments_as(tile, sums_at(lists, g->moments), three);
    else if (!begun)
        products_as(tile, three);
    for (int32_t k = begun; k < g->fields; ++k)
        if (g->field[k].numbers == 1)
            quadratic_field_in(g->field + k, lists, tile, 1, three);
        else
            quadratic_field_in(g->field + k, lists, tile, three ? 3 : 2, three);
}

static void sum_quadratic_group(const struct sphgi_group_sums *g, const struct sphgi_shape *shape,
                                const struct sphgi_group_lists *lists, struct sphgi_tile *tile)
{
    first_chunk(lists, tile);
    do
        WITH(three, g->three, quadratic_chunk(g, shape, lists, tile, three));
    while (next_chunk(lists, tile));
}
