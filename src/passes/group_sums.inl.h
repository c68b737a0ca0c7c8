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
SPHGI_TEMPLATE void own_numbers(const struct sphgi_group_field *field,
                                const struct sphgi_group_lists *lists, int32_t numbers, vec *own)
{
    clear(own, SPHGI_ROW);
    if (field->at_target) {
        const real *from = (const real *)field->at_target + lists->first;
        for (int32_t c = 0; c < numbers; ++c)
            own[c] = load(from + c * SPHGI_WIDTH);
        return;
    }
    if (!field->own)
        return;
    const real *row[LANES];
    for (int l = 0; l < LANES; ++l)
        row[l] = (const real *)field->rows + SPHGI_ROW * (ptrdiff_t)lists->places[l];
    const struct four values = transpose(row);
    const vec sign = splat(R(field->own));
    own[0] = sign * values.x;
    own[1] = sign * values.y;
    own[2] = sign * values.z;
    own[3] = sign * values.w;
}

SPHGI_TEMPLATE real *sums_at(const struct sphgi_group_lists *lists, void *sums)
{
    return (real *)sums + lists->first;
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

/* ---- At once --------------------------------------------------------------------------------- */

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
    const struct sphgi_group_field *of = g->field;
    const real *rows = g->gather->rows, *field = of->rows;
    vec moment[6], sum[3 * SPHGI_ROW], own[SPHGI_ROW];
    clear(moment, sums_of_moments(how));
    clear(sum, how.numbers ? sums_of_field(how) : 0);
    if (how.numbers)
        own_numbers(of, lists, how.numbers, own);
    const uint32_t *ids = tile->ids, *to_come = ids_ahead(tile);
    real *factor = tile->arrays;
    const ptrdiff_t step = lists->kept ? SPHGI_GROUP : 0;
    if (lists->kept)
        factor = (real *)lists->kept + (ids - lists->ids);
    for (int32_t k = 0; k < tile->steps; ++k, ids += SPHGI_GROUP, factor += step) {
        __builtin_prefetch(ids + AHEAD * SPHGI_GROUP);
        ask_for_rows(rows, how.numbers ? field : NULL, to_come, tile->scattered);
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
        end_chunk(tile, moment, sums_of_moments(how), sums_at(lists, g->moments));
    if (how.numbers)
        end_chunk(tile, sum, sums_of_field(how), sums_at(lists, of->sums));
}

/* ---- By way of the tile, for any method ------------------------------------------------------ */

static void fill_tile(const struct sphgi_gather *gather, const struct sphgi_shape *shape,
                      const struct sphgi_group_lists *lists, struct sphgi_tile *tile)
{
    real *factors = lists->kept;
    if (factors)
        factors += tile->ids - lists->ids;
    if (lists->kept_stand) {
        gather_offsets(gather, factors, lists->places, tile);
        return;
    }
    gather_factors(gather, shape, lists->places, tile);
    if (factors)
        keep_factors(tile, factors);
}

SPHGI_TEMPLATE void chunk_by_tile(const struct sphgi_group_sums *g, const struct sphgi_shape *shape,
                                  const struct sphgi_group_lists *lists, struct sphgi_tile *tile,
                                  struct group_how how)
{
    const struct sphgi_group_field *field = g->field;
    real at_target[SPHGI_ROW * SPHGI_WIDTH];
    vec own[SPHGI_ROW];
    fill_tile(g->gather, shape, lists, tile);
    if (how.moments)
        moments_as(tile, sums_at(lists, g->moments), how.three);
    if (!how.numbers)
        return;
    own_numbers(field, lists, how.numbers, own);
    for (int32_t c = 0; c < SPHGI_ROW; ++c)
        store(at_target + c * SPHGI_WIDTH, own[c]);
    real *sums = sums_at(lists, field->sums);
    if (how.divergence)
        divergence_as(tile, SPHG_VECTOR, SPHGI_FACTORS, &field->rows, at_target, sums, how.three);
    else
        field_as(tile, SPHGI_FACTORS, field->rows, at_target, sums, how.numbers, how.three);
}

/* ---- Several fields -------------------------------------------------------------------------- */

static void moments_or_field(const struct sphgi_group_lists *lists, const struct sphgi_tile *tile,
                             void *moments, const struct sphgi_group_field *field,
                             int32_t dimension)
{
    if (moments) {
        sum_moments(tile, dimension, sums_at(lists, moments));
        return;
    }
    const real *at_target = (const real *)field->at_target + lists->first;
    real *sums = sums_at(lists, field->sums);
    if (field->divergence)
        sum_divergence(tile, dimension, SPHG_VECTOR, SPHGI_FACTORS, &field->rows, at_target, sums);
    else
        sum_field(tile, dimension, SPHGI_FACTORS, field->rows, field->numbers, at_target, sums);
}

/* The sums of one field beside moments, or of two: the products s_ij x_ij are formed once. */
SPHGI_TEMPLATE void two_of_tile(const struct sphgi_group_lists *lists,
                                const struct sphgi_tile *tile, void *moments,
                                const struct sphgi_group_field *one, struct group_how a,
                                const struct sphgi_group_field *two, struct group_how b)
{
    vec moment[6], sum[2][3 * SPHGI_ROW], own[2][SPHGI_ROW];
    clear(moment, sums_of_moments(a));
    clear(sum[0], sums_of_field(a));
    clear(sum[1], b.numbers ? sums_of_field(b) : 0);
    own_numbers(one, lists, a.numbers, own[0]);
    if (b.numbers)
        own_numbers(two, lists, b.numbers, own[1]);
    for (int32_t k = 0; k < places_of(tile); k += LANES) {
        const vec x[3] = {from(tile, SPHGI_X, k), from(tile, SPHGI_Y, k),
                          a.three ? from(tile, SPHGI_Z, k) : splat(R(0))};
        const vec s = from(tile, SPHGI_S, k), gradient[3] = {s * x[0], s * x[1], s * x[2]};
        struct four numbers = gather_rows(one->rows, ids_at(tile, k));
        if (a.moments)
            add_moments(gradient, x, moment, a.three);
        add_field(&numbers, own[0], gradient, sum[0], a);
        if (b.numbers) {
            numbers = gather_rows(two->rows, ids_at(tile, k));
            add_field(&numbers, own[1], gradient, sum[1], b);
        }
    }
    if (a.moments)
        end_chunk(tile, moment, sums_of_moments(a), sums_at(lists, moments));
    end_chunk(tile, sum[0], sums_of_field(a), sums_at(lists, one->sums));
    if (b.numbers)
        end_chunk(tile, sum[1], sums_of_field(b), sums_at(lists, two->sums));
}

/* Moments and the next fields, as many as fit the registers; returns how many fields. */
SPHGI_TEMPLATE int32_t tile_in(const struct sphgi_group_lists *lists, const struct sphgi_tile *tile,
                               void *moments, const struct sphgi_group_field *field, int32_t left,
                               bool three)
{
    const int32_t d = three ? 3 : 2;
    const struct group_how none = {three, false, false, 0}, scalar = {three, false, false, 1},
                           vector = {three, false, false, d};
    const bool together = SUMS_IN_REGISTERS > 6 && left > !moments && !field->divergence &&
                          (moments || !field[1].divergence);
    if (!together) {
        moments_or_field(lists, tile, moments, field, three ? 3 : 2);
        return !moments;
    }
    if (moments && field->numbers == 1)
        two_of_tile(lists, tile, moments, field, (struct group_how){three, true, false, 1}, NULL,
                    none);
    else if (moments)
        two_of_tile(lists, tile, moments, field, (struct group_how){three, true, false, d}, NULL,
                    none);
    else if (field->numbers == 1 && field[1].numbers == 1)
        two_of_tile(lists, tile, NULL, field, scalar, field + 1, scalar);
    else if (field->numbers == 1)
        two_of_tile(lists, tile, NULL, field + 1, vector, field, scalar);
    else if (field[1].numbers == 1)
        two_of_tile(lists, tile, NULL, field, vector, field + 1, scalar);
    else
        two_of_tile(lists, tile, NULL, field, vector, field + 1, vector);
    return moments ? 1 : 2;
}

static void chunk_of_fields(const struct sphgi_group_sums *g, const struct sphgi_shape *shape,
                            const struct sphgi_group_lists *lists, struct sphgi_tile *tile)
{
    void *moments = g->moments;
    fill_tile(g->gather, shape, lists, tile);
    for (int32_t k = 0; k < g->fields || moments; moments = NULL)
        WITH(three, g->three,
             k += tile_in(lists, tile, moments, g->field + k, g->fields - k, three));
}

/* ---- All chunks ------------------------------------------------------------------------------ */

SPHGI_TEMPLATE void first_chunk(const struct sphgi_group_lists *lists, struct sphgi_tile *tile)
{
    tile->ids = lists->ids;
    tile->id_stride = SPHGI_GROUP;
    tile->spread = false;
    tile->carries = lists->steps > SPHGI_PLAIN_CHUNKS * SPHGI_CHUNK;
    tile->chunk = 0;
    tile->steps = sphgi_min32(lists->steps, SPHGI_CHUNK);
}

/* Where lists go on behind a chunk: false at their end. */
SPHGI_TEMPLATE bool next_chunk(const struct sphgi_group_lists *lists, struct sphgi_tile *tile)
{
    const int32_t done = ++tile->chunk * SPHGI_CHUNK;
    tile->ids = lists->ids + (ptrdiff_t)done * SPHGI_GROUP;
    tile->steps = sphgi_min32(lists->steps - done, SPHGI_CHUNK);
    return tile->steps > 0;
}

/* True: it is done. Of those at once, sums that fit the registers; of the others, all. */
SPHGI_TEMPLATE bool group_if(const struct sphgi_group_sums *g, const struct sphgi_shape *shape,
                             const struct sphgi_group_lists *lists, struct sphgi_tile *tile,
                             sphg_kernel kernel, bool at_once, struct group_how how)
{
    const int32_t sums = sums_of_moments(how) + (how.numbers ? sums_of_field(how) : 0);
    if (at_once && sums > SUMS_IN_REGISTERS)
        return false;
    do
        if (at_once)
            chunk_at_once(g, shape, lists, tile, kernel, how);
        else
            chunk_by_tile(g, shape, lists, tile, how);
    while (next_chunk(lists, tile));
    return true;
}

SPHGI_TEMPLATE bool group_as(const struct sphgi_group_sums *g, const struct sphgi_shape *shape,
                             const struct sphgi_group_lists *lists, struct sphgi_tile *tile,
                             sphg_kernel kernel, bool at_once, bool three)
{
    const int32_t numbers = g->fields ? g->field->numbers : 0;
#define GROUP(...)                                                                                 \
    return group_if(g, shape, lists, tile, kernel, at_once, (struct group_how){three, __VA_ARGS__})
    if (!numbers)
        GROUP(true, false, 0);
    if (g->field->divergence)
        GROUP(false, true, three ? 3 : 2);
    if (numbers == 1)
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
    first_chunk(lists, tile);
    if (g->fields > 1) {
        do
            chunk_of_fields(g, shape, lists, tile);
        while (next_chunk(lists, tile));
        return;
    }
    if (!lists->kept_stand && shape->method == SPHG_KGC) /* else: record_sums.inl.h */
        group_at_once(g, shape, lists, tile, &done);
    if (!done)
        WITH(three, g->three,
             (void)group_as(g, shape, lists, tile, SPHG_CUBIC_SPLINE, false, three));
}
