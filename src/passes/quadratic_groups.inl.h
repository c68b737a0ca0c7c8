/* SPDX-License-Identifier: MIT */
/* Order 2's sums of targets whose lists stand side by side, from ids to sums in one call
 * (group_sums.inl.h). */

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
    gather_quadratic(g->gather, shape, lists->places, tile);
    if (g->moments)
        quadratic_moments_as(tile, sums_at(lists, g->moments), three);
    else
        products_as(tile, three);
    for (int32_t k = 0; k < g->fields; ++k)
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
