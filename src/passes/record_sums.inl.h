/* SPDX-License-Identifier: MIT */
/* Sums of targets whose pairs have their weights in memory. What they read of a source stands in
 * its record: x y z, and the numbers of the field behind them. Nothing else is read of it, V_j
 * least of all, which is in the weights. */

/* What is known when a loop is compiled. */
struct record_how {
    bool three, moments;
    bool apart; /* records hold no coordinates: offsets and factors stand in the tile */
    bool divergence, dense;
    sphg_shape shape; /* of the field; 0: there is none */
    enum sphgi_fold fold;
};

SPHGI_TEMPLATE int32_t record_axes(struct record_how how)
{
    return how.three ? 3 : 2;
}

/* Of the field, in a record. */
SPHGI_TEMPLATE int32_t numbers_of_record(struct record_how how)
{
    if (how.fold)
        return sphgi_folded_numbers(how.fold, record_axes(how)) + (how.dense ? 1 : 0);
    return !how.shape                 ? 0
           : how.shape == SPHG_SCALAR ? 1
                                      : components_of(how.shape, record_axes(how));
}

SPHGI_TEMPLATE int32_t sums_of_record(struct record_how how)
{
    const int32_t d = record_axes(how), numbers = numbers_of_record(how);
    if (how.fold)
        return how.fold == SPHGI_FOLDED_VECTOR ? 1 : d;
    return !how.divergence ? d * numbers : how.shape == SPHG_VECTOR ? 1 : d;
}

#if VECTOR_BYTES == 64 && !REAL_IS_F64
/* Two rows of a record at once: half as many loads. */
SPHGI_TEMPLATE vec two_records(const real *low, const real *high)
{
    const __m512d first = _mm512_castpd256_pd512(_mm256_castps_pd(_mm256_loadu_ps(low)));
    return (vec)_mm512_insertf64x4(first, _mm256_castps_pd(_mm256_loadu_ps(high)), 1);
}

SPHGI_TEMPLATE struct four eight_records(const real *records, const uint32_t *ids, size_t step)
{
    return turned(two_records(records + step * ids[0], records + step * ids[4]),
                  two_records(records + step * ids[1], records + step * ids[5]),
                  two_records(records + step * ids[2], records + step * ids[6]),
                  two_records(records + step * ids[3], records + step * ids[7]));
}

SPHGI_TEMPLATE void put_numbers(vec low, vec high, vec *v)
{
    v[0] = (vec)_mm512_shuffle_f32x4((__m512)low, (__m512)high, 0x88);
    v[4] = (vec)_mm512_shuffle_f32x4((__m512)low, (__m512)high, 0xdd);
}

SPHGI_TEMPLATE void gather_eight(const real *records, const uint32_t *ids, size_t step, vec *v)
{
    const struct four low = eight_records(records, ids, step);
    const struct four high = eight_records(records, ids + 8, step);
    put_numbers(low.x, high.x, v);
    put_numbers(low.y, high.y, v + 1);
    put_numbers(low.z, high.z, v + 2);
    put_numbers(low.w, high.w, v + 3);
}
#endif

/* The records of LANES particles, by the numbers of their rows times step / width. */
SPHGI_TEMPLATE void gather_records(const real *records, const uint32_t *ids, size_t step,
                                   int32_t width, vec *v)
{
    int32_t n = 0;
#if VECTOR_BYTES == 64 && !REAL_IS_F64
    for (; n + 8 <= width; n += 8)
        gather_eight(records + n, ids, step, v + n);
#endif
    for (; n < width; n += SPHGI_ROW) {
        const real *row[LANES];
        for (int l = 0; l < LANES; ++l)
            row[l] = records + step * ids[l] + n;
        const struct four numbers = transpose(row);
        v[n] = numbers.x;
        v[n + 1] = numbers.y;
        v[n + 2] = numbers.z;
        v[n + 3] = numbers.w;
    }
}

/* Coordinates in a record, before its numbers. */
SPHGI_TEMPLATE int32_t axes_in_record(struct record_how how)
{
    return how.apart ? 0 : record_axes(how);
}

SPHGI_TEMPLATE int32_t width_of_record(struct record_how how)
{
    return sphgi_record_width(axes_in_record(how), numbers_of_record(how));
}

/* What the sums subtract from A_j. */
SPHGI_TEMPLATE void own_of_records(const struct sphgi_record_sums *g, const int32_t *places,
                                   struct record_how how, vec *own)
{
    const int32_t numbers = numbers_of_record(how), width = width_of_record(how);
    clear(own, numbers);
    if (!g->own)
        return;
    vec v[16];
    gather_records(g->records, (const uint32_t *)places, (size_t)width, width, v);
    for (int32_t c = 0; c < numbers; ++c)
        own[c] = splat(R(g->own)) * v[axes_in_record(how) + c];
}

SPHGI_TEMPLATE void add_one_sided(const vec *a, const vec *own, const vec *gradient, vec *sum,
                                  struct record_how how)
{
    const int32_t d = record_axes(how), numbers = numbers_of_record(how);
    vec difference[9];
    for (int32_t c = 0; c < numbers; ++c)
        difference[c] = a[c] - own[c];
    if (how.divergence)
        add_contracted(how.shape, d, difference, gradient, sum);
    for (int32_t c = 0; c < numbers && !how.divergence; ++c)
        for (int32_t b = 0; b < d; ++b)
            sum[c * d + b] = plus(sum[c * d + b], difference[c], gradient[b]);
}

SPHGI_TEMPLATE void add_folded(const vec *b, const vec *gradient, vec *sum, vec *vectors,
                               struct record_how how)
{
    const int32_t d = record_axes(how);
    if (how.fold == SPHGI_FOLDED_NUMBER)
        for (int32_t a = 0; a < d; ++a)
            sum[a] = plus(sum[a], b[0], gradient[a]);
    else
        add_contracted(how.fold == SPHGI_FOLDED_VECTOR      ? SPHG_VECTOR
                       : how.fold == SPHGI_FOLDED_SYMMETRIC ? SPHG_SYM_TENSOR
                                                            : SPHG_TENSOR,
                       d, b, gradient, sum);
    for (int32_t a = 0; a < d; ++a)
        vectors[a] =
            plus_vector(vectors[a], gradient[a], how.dense ? &b[numbers_of_record(how) - 1] : NULL);
}

enum { RECORDS_AHEAD = 32 /* steps */ };

/* Fewer lanes where those beside each other read the same lines. */
SPHGI_TEMPLATE void ask_for_records(const real *records, const uint32_t *ids, size_t step,
                                    int32_t width)
{
    const int lanes = width > SPHGI_ROW ? 2 : 4;
    for (int l = 1; l < LANES; l += lanes)
        __builtin_prefetch(records + step * ids[l]);
}

/* Offsets and factors of the step that stands at place k; `v` is the record, or what there is of
 * it.
 */
SPHGI_TEMPLATE vec offsets_of_step(const struct sphgi_tile *tile, int32_t k, const real *kept,
                                   const vec *target, const vec *v, vec *x, struct record_how how)
{
    for (int32_t a = 0; a < record_axes(how); ++a)
        if (how.apart)
            x[a] = from(tile, (enum sphgi_array)(SPHGI_X + a), k);
        else
            x[a] = target[a] - v[a];
    if (how.apart)
        return from(tile, SPHGI_S, k);
    return load(kept);
}

SPHGI_TEMPLATE void chunk_of_records(const struct sphgi_record_sums *g,
                                     const struct sphgi_group_lists *lists,
                                     const struct sphgi_tile *tile, struct record_how how)
{
    const int32_t d = record_axes(how), width = width_of_record(how), axes = axes_in_record(how);
    const struct four row = target_rows(g->gather, lists->places);
    const vec target[3] = {row.x, row.y, row.z};
    vec moment[6], sum[9], vectors[3], own[9];
    clear(moment, how.moments ? 6 : 0);
    clear(sum, sums_of_record(how));
    clear(vectors, how.fold ? d : 0);
    if (how.shape && !how.fold)
        own_of_records(g, lists->places, how, own);
    const size_t step = (size_t)width / SPHGI_ID_STEP;
    const real *records = g->records, *kept = lists->kept;
    const uint32_t *ids = tile->ids, *to_come = ids_steps_ahead(tile, RECORDS_AHEAD);
    if (!how.apart)
        kept += ids - lists->ids;
    for (int32_t k = 0; k < tile->steps; ++k, ids += SPHGI_GROUP) {
        vec v[16], x[3], gradient[3];
        ask_for_records(records, to_come, step, width);
        to_come += SPHGI_GROUP;
        gather_records(records, ids, step, width, v);
        const vec s = offsets_of_step(tile, k * LANES, kept, target, v, x, how);
        if (!how.apart) {
            __builtin_prefetch(ids + AHEAD * SPHGI_GROUP);
            __builtin_prefetch(kept + AHEAD * SPHGI_GROUP);
            kept += SPHGI_GROUP;
        }
        for (int32_t a = 0; a < d; ++a)
            gradient[a] = s * x[a];
        if (how.moments)
            add_moments(gradient, x, moment, how.three);
        if (how.fold)
            add_folded(v + axes, gradient, sum, vectors, how);
        else if (how.shape)
            add_one_sided(v + axes, own, gradient, sum, how);
    }
    if (how.moments)
        end_chunk(tile, moment, how.three ? 6 : 3, sums_at(lists, g->moment_sums));
    if (how.shape)
        end_chunk(tile, sum, sums_of_record(how), sums_at(lists, g->sums));
    if (how.fold)
        end_chunk(tile, vectors, d, sums_at(lists, g->vectors));
}

/* Where records hold no coordinates the tile is filled first. */
SPHGI_TEMPLATE void records_as(const struct sphgi_record_sums *g, const struct sphgi_shape *shape,
                               const struct sphgi_group_lists *lists, struct sphgi_tile *tile,
                               struct record_how how)
{
    do {
        if (how.apart)
            fill_tile(g->gather, shape, lists, tile);
        chunk_of_records(g, lists, tile, how);
    } while (next_chunk(lists, tile));
}

#define RECORDS(...)                                                                               \
    records_as(g, shape, lists, tile, (struct record_how){.three = three, __VA_ARGS__})

/* Fields whose other side is in b_j. */
SPHGI_TEMPLATE void folded_records(const struct sphgi_record_sums *g,
                                   const struct sphgi_shape *shape,
                                   const struct sphgi_group_lists *lists, struct sphgi_tile *tile,
                                   bool three, bool dense)
{
    if (dense && g->fold == SPHGI_FOLDED_NUMBER)
        RECORDS(.dense = true, .shape = SPHG_SCALAR, .fold = SPHGI_FOLDED_NUMBER);
    else if (g->fold == SPHGI_FOLDED_VECTOR)
        RECORDS(.dense = dense, .shape = SPHG_SCALAR, .fold = SPHGI_FOLDED_VECTOR);
    else if (g->fold == SPHGI_FOLDED_SYMMETRIC)
        RECORDS(.dense = dense, .shape = SPHG_SCALAR, .fold = SPHGI_FOLDED_SYMMETRIC);
    else
        RECORDS(.dense = dense, .shape = SPHG_SCALAR, .fold = SPHGI_FOLDED_MATRIX);
}

SPHGI_TEMPLATE void records_in(const struct sphgi_record_sums *g, const struct sphgi_shape *shape,
                               const struct sphgi_group_lists *lists, struct sphgi_tile *tile,
                               bool three)
{
    if (g->fold)
        WITH(dense, g->dense, folded_records(g, shape, lists, tile, three, dense));
    else if (!g->shape)
        RECORDS(.moments = true);
    else if (g->divergence && g->shape == SPHG_VECTOR)
        RECORDS(.divergence = true, .shape = SPHG_VECTOR);
    else if (g->divergence)
        RECORDS(.divergence = true, .shape = SPHG_SYM_TENSOR);
    else if (g->shape == SPHG_SCALAR)
        WITH(moments, g->moments, RECORDS(.moments = moments, .shape = SPHG_SCALAR));
    else
        WITH(moments, g->moments, RECORDS(.moments = moments, .shape = SPHG_VECTOR));
}
#undef RECORDS

/* Records of more than a row, whose weights are yet to be formed: in 3D alone. */
SPHGI_TEMPLATE void records_apart(const struct sphgi_record_sums *g,
                                  const struct sphgi_shape *shape,
                                  const struct sphgi_group_lists *lists, struct sphgi_tile *tile)
{
#define RECORDS(...)                                                                               \
    records_as(g, shape, lists, tile,                                                              \
               (struct record_how){.three = true, .apart = true, __VA_ARGS__})
    if (!g->fold)
        RECORDS(.divergence = true, .shape = SPHG_SYM_TENSOR);
    else if (g->fold == SPHGI_FOLDED_SYMMETRIC)
        WITH(more, g->dense,
             RECORDS(.dense = more, .shape = SPHG_SCALAR, .fold = SPHGI_FOLDED_SYMMETRIC));
    else
        WITH(more, g->dense,
             RECORDS(.dense = more, .shape = SPHG_SCALAR, .fold = SPHGI_FOLDED_MATRIX));
#undef RECORDS
}

static void sum_records(const struct sphgi_record_sums *g, const struct sphgi_shape *shape,
                        const struct sphgi_group_lists *lists, struct sphgi_tile *tile)
{
    first_chunk(lists, tile);
    if (g->apart)
        records_apart(g, shape, lists, tile);
    else
        WITH(three, g->dimension == 3, records_in(g, shape, lists, tile, three));
}
