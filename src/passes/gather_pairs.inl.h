/* Pairs into the arrays of a piece: x_ij in units of H and V_j in units of H^d, narrowed to OUT
 * after the difference was taken. Padding, and pairs of a superset beyond the cutoff, become
 * x_ij = (2, 0, 0) H: finite, and every weight is exactly 0 there.
 * Parameters: OUT, the type of the arrays; OUT_NAME(x), a name of its own for each. */

typedef OUT OUT_NAME(narrow) __attribute__((vector_size(sizeof(OUT) * VECTOR_BYTES / sizeof(real)),
                                            aligned(__alignof__(OUT)), may_alias));

SPHGI_TEMPLATE void OUT_NAME(put)(OUT *arrays, enum sphgi_array array, int32_t at, vec v)
{
    *(OUT_NAME(narrow) *)(arrays + array * SPHGI_PIECE + at) =
        __builtin_convertvector(v, OUT_NAME(narrow));
}

/* Ids of pairs beyond the cutoff are replaced by the dummy row: a field that is not finite there
 * must not enter through 0 * NaN. */
SPHGI_TEMPLATE void OUT_NAME(mask_ids)(const void *ids, bool wide, int32_t k, unsigned inside,
                                       uint32_t dummy, void *ids_out)
{
    for (int l = 0; l < LANES; ++l) {
        const bool keep = inside >> l & 1;
        if (wide)
            ((uint32_t *)ids_out)[k + l] = keep ? ((const uint32_t *)ids)[k + l] : dummy;
        else
            ((uint16_t *)ids_out)[k + l] = keep ? ((const uint16_t *)ids)[k + l] : (uint16_t)dummy;
    }
}

SPHGI_TEMPLATE void OUT_NAME(gather_as)(const struct sphgi_gather *g, const void *x_i,
                                        const void *ids, int32_t count, OUT *arrays, int32_t at,
                                        void *ids_out, bool wide, bool periodic, bool superset)
{
    const real *x = x_i;
    const vec xi = splat(x[0]), yi = splat(x[1]), zi = splat(x[2]);
    const vec inverse_h = splat(R(g->inverse_h)), cutoff = square_of(g->cutoff);
    const vec inverse_volume = splat(R(g->inverse_volume));
    const struct wraps w = wraps_of(g->period);
    const size_t id_size = wide ? 4 : 2;
    for (int32_t k = 0; k < count; k += LANES) {
        const struct four row = gather_rows(g->rows, (const char *)ids + id_size * (size_t)k, wide);
        vec dx = xi - row.x, dy = yi - row.y, dz = zi - row.z;
        if (periodic) {
            dx = wrapped(dx, w.axis[0]);
            dy = wrapped(dy, w.axis[1]);
            dz = wrapped(dz, w.axis[2]);
        }
        if (superset) {
            const mask inside = less(square_distance(dx, dy, dz), cutoff);
            OUT_NAME(mask_ids)(ids, wide, k, bits_of(inside), g->dummy, ids_out);
            dx = select(inside, dx * inverse_h, splat(R(2)));
            dy = where(inside, dy * inverse_h);
            dz = where(inside, dz * inverse_h);
        } else {
            dx *= inverse_h;
            dy *= inverse_h;
            dz *= inverse_h;
        }
        OUT_NAME(put)(arrays, SPHGI_X, at + k, dx);
        OUT_NAME(put)(arrays, SPHGI_Y, at + k, dy);
        OUT_NAME(put)(arrays, SPHGI_Z, at + k, dz);
        OUT_NAME(put)(arrays, SPHGI_V, at + k, row.w * inverse_volume);
    }
    for (int32_t k = count; k < (int32_t)sphgi_round_up((size_t)count, SPHGI_PAD); ++k) {
        const real nothing[4] = {R(2), R(0), R(0), R(0)};
        for (int a = 0; a < 4; ++a)
            arrays[(SPHGI_X + a) * SPHGI_PIECE + at + k] = (OUT)nothing[a];
        if (superset && wide)
            ((uint32_t *)ids_out)[k] = g->dummy;
        else if (superset)
            ((uint16_t *)ids_out)[k] = (uint16_t)g->dummy;
    }
}

SPHGI_TEMPLATE void OUT_NAME(gather_ids)(const struct sphgi_gather *g, const void *x_i,
                                         const void *ids, int32_t count, OUT *arrays, int32_t at,
                                         void *ids_out, bool wide)
{
    if (g->periodic && g->superset)
        OUT_NAME(gather_as)(g, x_i, ids, count, arrays, at, ids_out, wide, true, true);
    else if (g->periodic)
        OUT_NAME(gather_as)(g, x_i, ids, count, arrays, at, ids_out, wide, true, false);
    else if (g->superset)
        OUT_NAME(gather_as)(g, x_i, ids, count, arrays, at, ids_out, wide, false, true);
    else
        OUT_NAME(gather_as)(g, x_i, ids, count, arrays, at, ids_out, wide, false, false);
}

static void OUT_NAME(gather)(const struct sphgi_gather *g, const void *x_i, const void *ids,
                             bool wide, int32_t count, void *arrays, int32_t at, void *ids_out)
{
    if (wide)
        OUT_NAME(gather_ids)(g, x_i, ids, count, arrays, at, ids_out, true);
    else
        OUT_NAME(gather_ids)(g, x_i, ids, count, arrays, at, ids_out, false);
}

SPHGI_TEMPLATE void OUT_NAME(gather_all_as)(const struct sphgi_gather *g, int32_t lanes,
                                            const void *const *x, const void *const *ids,
                                            const int64_t *counts, struct sphgi_piece *piece,
                                            bool periodic)
{
    int32_t at = 0, p = 0;
    piece->wide = false;
    for (int32_t l = 0; l < lanes; ++l) {
        const int32_t count = (int32_t)counts[l];
        if (!count)
            continue;
        OUT_NAME(gather_as)
        (g, x[l], ids[l], count, piece->arrays, at, NULL, false, periodic, false);
        piece->lane[p] = l;
        piece->ids[p] = ids[l];
        piece->count[p] = count;
        piece->fresh[p] = true;
        at += (int32_t)sphgi_round_up((size_t)count, SPHGI_PAD);
        piece->begin[++p] = at;
    }
    piece->parts = p;
}

static void OUT_NAME(gather_all)(const struct sphgi_gather *g, int32_t lanes, const void *const *x,
                                 const void *const *ids, const int64_t *counts,
                                 struct sphgi_piece *piece)
{
    if (g->periodic)
        OUT_NAME(gather_all_as)(g, lanes, x, ids, counts, piece, true);
    else
        OUT_NAME(gather_all_as)(g, lanes, x, ids, counts, piece, false);
}
