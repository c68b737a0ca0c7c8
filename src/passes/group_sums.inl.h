/* SPDX-License-Identifier: MIT */
/* All sums of targets whose lists stand side by side, from ids to sums in one call: what most
 * sweeps do. Each number is what the passes over a tile make of it, rounded as there. */

/* A pair's rows are read, weighed and summed in one loop where the sums fit the registers; else by
 * way of the tile. */
#if defined(__AVX512F__) || defined(__aarch64__)
enum { SUMS_IN_REGISTERS = 15 };
#else
enum { SUMS_IN_REGISTERS = 6 };
#endif

/* What is known when a loop is compiled. */
struct group_how {
    bool three; /* dimensions */
    bool moments, divergence;
    int32_t numbers; /* of a field; 0: there is none */
};

SPHGI_TEMPLATE int32_t sums_of_moments(struct group_how how)
{
    return !how.moments ? 0 : how.three ? 6 : 3;
}

SPHGI_TEMPLATE int32_t sums_of_field(struct group_how how)
{
    return how.divergence ? 1 : (how.three ? 3 : 2) * how.numbers;
}

SPHGI_TEMPLATE void add_moments(const vec *g, const vec *x, vec *m, bool three)
{
    const int32_t d = three ? 3 : 2;
    for (int32_t a = 0; a < d; ++a)
        for (int32_t b = a; b < d; ++b, ++m)
            *m = minus(*m, g[a], x[b]);
}

SPHGI_TEMPLATE void add_field(const struct four *row, const vec *own, const vec *g, vec *sum,
                              struct group_how how)
{
    vec difference[SPHGI_ROW] = {row->x, row->y, row->z, row->w};
    const int32_t d = how.three ? 3 : 2;
    for (int32_t c = 0; c < how.numbers; ++c)
        difference[c] -= own[c];
    if (how.divergence)
        add_contracted(SPHG_VECTOR, d, difference, g, sum);
    else
        for (int32_t c = 0; c < how.numbers; ++c)
            for (int32_t b = 0; b < d; ++b)
                sum[c * d + b] = plus(sum[c * d + b], difference[c], g[b]);
}

/* What the sums subtract from A_j: A_i, -A_i or 0. */
SPHGI_TEMPLATE void own_numbers(const struct sphgi_group_sums *g,
                                const struct sphgi_group_lists *lists, int32_t numbers, vec *own)
{
    clear(own, SPHGI_ROW);
    if (g->at_target) {
        const real *from = (const real *)g->at_target + lists->first;
        for (int32_t c = 0; c < numbers; ++c)
            own[c] = load(from + c * SPHGI_WIDTH);
        return;
    }
    if (!g->own)
        return;
    const real *row[LANES];
    for (int l = 0; l < LANES; ++l)
        row[l] = (const real *)g->field + SPHGI_ROW * (ptrdiff_t)lists->places[l];
    const struct four values = transpose(row);
    const vec sign = splat(R(g->own));
    own[0] = sign * values.x;
    own[1] = sign * values.y;
    own[2] = sign * values.z;
    own[3] = sign * values.w;
}

/* What a chunk comes to. Lists of several chunks are few: their code stands apart. */
static __attribute__((noinline)) void add_chunks(const struct sphgi_tile *tile, const vec *v,
                                                 int32_t count, void *sums)
{
    end_tile(tile, v, count, sums);
}

SPHGI_TEMPLATE void end_chunk(const struct sphgi_tile *tile, const vec *v, int32_t count,
                              void *sums)
{
    if (tile->chunk == 0) {
        for (int32_t c = 0; c < count; ++c)
            add_chunk(tile, 0, v[c], (real *)sums + c * SPHGI_WIDTH);
    } else {
        vec copy[3 * SPHGI_ROW]; /* v stays in registers */
        for (int32_t c = 0; c < count; ++c)
            copy[c] = v[c];
        add_chunks(tile, copy, count, sums);
    }
}

/* A chunk of the lists, in one loop. */
SPHGI_TEMPLATE void chunk_at_once(const struct sphgi_group_sums *g, const struct sphgi_shape *shape,
                                  const struct sphgi_group_lists *lists,
                                  const struct sphgi_tile *tile, sphg_kernel kernel,
                                  struct group_how how)
{
    const struct four target = target_rows(g->gather, lists->places);
    const vec scale = factor_scale(shape, SPHG_KGC), inverse_h = inverse_radius(shape);
    const vec volume = splat(R(g->gather->volume));
    const mask volumes = first_lanes(g->gather->volumes ? LANES : 0);
    const real *rows = g->gather->rows, *field = g->field;
    vec moment[6], sum[3 * SPHGI_ROW], own[SPHGI_ROW];
    clear(moment, sums_of_moments(how));
    clear(sum, how.numbers ? sums_of_field(how) : 0);
    if (how.numbers)
        own_numbers(g, lists, how.numbers, own);
    const uint32_t *ids = tile->ids, *to_come = ids_ahead(tile);
    real *factor = tile->arrays;
    const ptrdiff_t step = lists->kept ? SPHGI_GROUP : 0;
    if (lists->kept)
        factor = (real *)lists->kept + (ids - lists->ids);
    for (int32_t k = 0; k < tile->steps; ++k, ids += SPHGI_GROUP, factor += step) {
        __builtin_prefetch(ids + AHEAD * SPHGI_GROUP);
        ask_for_rows(rows, how.numbers ? field : NULL, to_come);
        to_come += SPHGI_GROUP;
        const struct four row = gather_rows(rows, ids);
        const vec x[3] = {target.x - row.x, target.y - row.y, target.z - row.z};
        const vec plane = plus(x[0] * x[0], x[1], x[1]);
        const vec square = how.three ? plus(plane, x[2], x[2]) : plane;
        const vec s = factor_of(scale, inverse_h, vsqrt(square), select(volumes, row.w, volume),
                                kernel, SPHG_KGC);
        store(factor, s);
        const vec gradient[3] = {s * x[0], s * x[1], s * x[2]};
        if (how.moments)
            add_moments(gradient, x, moment, how.three);
        if (how.numbers) {
            const struct four numbers = gather_rows(field, ids);
            add_field(&numbers, own, gradient, sum, how);
        }
    }
    if (how.moments)
        end_chunk(tile, moment, sums_of_moments(how), lists->moments);
    if (how.numbers)
        end_chunk(tile, sum, sums_of_field(how), lists->sums);
}

/* The same by way of the tile, for any method. */
SPHGI_TEMPLATE void chunk_by_tile(const struct sphgi_group_sums *g, const struct sphgi_shape *shape,
                                  const struct sphgi_group_lists *lists, struct sphgi_tile *tile,
                                  struct group_how how)
{
    real at_target[SPHGI_ROW * SPHGI_WIDTH], *factors = lists->kept;
    if (factors)
        factors += tile->ids - lists->ids;
    if (lists->kept_stand) {
        gather_offsets(g->gather, factors, lists->places, tile);
    } else {
        gather_factors(g->gather, shape, lists->places, tile);
        if (factors)
            keep_factors(tile, factors);
    }
    if (how.moments)
        moments_as(tile, lists->moments, how.three);
    if (!how.numbers)
        return;
    vec own[SPHGI_ROW];
    own_numbers(g, lists, how.numbers, own);
    for (int32_t c = 0; c < SPHGI_ROW; ++c)
        store(at_target + c * SPHGI_WIDTH, own[c]);
    if (how.divergence)
        divergence_as(tile, SPHG_VECTOR, SPHGI_FACTORS, &g->field, at_target, lists->sums,
                      how.three);
    else
        field_as(tile, SPHGI_FACTORS, g->field, at_target, lists->sums, how.numbers, how.three);
}

/* Goes through the chunks; at once: unless the sums are too many. */
SPHGI_TEMPLATE void group_in(const struct sphgi_group_sums *g, const struct sphgi_shape *shape,
                             const struct sphgi_group_lists *lists, struct sphgi_tile *tile,
                             sphg_kernel kernel, bool at_once, struct group_how how)
{
    for (int32_t left = lists->steps;; left -= SPHGI_CHUNK) {
        tile->steps = sphgi_min32(left, SPHGI_CHUNK);
        if (at_once)
            chunk_at_once(g, shape, lists, tile, kernel, how);
        else
            chunk_by_tile(g, shape, lists, tile, how);
        if (left <= SPHGI_CHUNK)
            break;
        tile->ids += SPHGI_CHUNK * SPHGI_GROUP;
        ++tile->chunk;
    }
}

/* True: it is done. Of those at once, sums that fit the registers; of the others, all. */
SPHGI_TEMPLATE bool group_if(const struct sphgi_group_sums *g, const struct sphgi_shape *shape,
                             const struct sphgi_group_lists *lists, struct sphgi_tile *tile,
                             sphg_kernel kernel, bool at_once, struct group_how how)
{
    const int32_t sums = sums_of_moments(how) + (how.numbers ? sums_of_field(how) : 0);
    if (at_once && sums > SUMS_IN_REGISTERS)
        return false;
    group_in(g, shape, lists, tile, kernel, at_once, how);
    return true;
}

SPHGI_TEMPLATE bool group_as(const struct sphgi_group_sums *g, const struct sphgi_shape *shape,
                             const struct sphgi_group_lists *lists, struct sphgi_tile *tile,
                             sphg_kernel kernel, bool at_once, bool three)
{
#define GROUP(...)                                                                                 \
    return group_if(g, shape, lists, tile, kernel, at_once, (struct group_how){three, __VA_ARGS__})
    if (!g->numbers)
        GROUP(true, false, 0);
    if (g->divergence)
        GROUP(false, true, three ? 3 : 2);
    if (g->numbers == 1)
        WITH(moments, g->moments, GROUP(moments, false, 1));
    WITH(moments, g->moments, GROUP(moments, false, three ? 3 : 2));
#undef GROUP
}

#define BY_KERNEL group_at_once
#define PARAMETERS                                                                                 \
    (const struct sphgi_group_sums *g, const struct sphgi_shape *shape,                            \
     const struct sphgi_group_lists *lists, struct sphgi_tile *tile, bool *done)
#define ARGUMENTS (g, shape, lists, tile, done)
#define CALL(kernel)                                                                               \
    WITH(three, g->three, *done = group_as(g, shape, lists, tile, kernel, true, three))
#include "by_kernel.inl.h"

static void sum_group(const struct sphgi_group_sums *g, const struct sphgi_shape *shape,
                      const struct sphgi_group_lists *lists, struct sphgi_tile *tile)
{
    bool done = false;
    tile->ids = lists->ids;
    tile->id_stride = SPHGI_GROUP;
    tile->spread = false;
    tile->chunk = 0;
    if (!lists->kept_stand && shape->method == SPHG_KGC) /* else: record_sums.inl.h */
        group_at_once(g, shape, lists, tile, &done);
    if (!done)
        WITH(three, g->three,
             (void)group_as(g, shape, lists, tile, SPHG_CUBIC_SPLINE, false, three));
}
