/* SPDX-License-Identifier: MIT */
/* Pairs into the arrays of a tile: x_ij and |x_ij|, narrowed to OUT after the difference was
 * taken, and V_j in units of H^d. What is no pair gets a distance beyond the cutoff and finite
 * offsets: every weight is exactly 0 there.
 * Parameters: OUT, the type of the arrays; OUT_NAME(x), a name of its own for each. */

typedef OUT OUT_NAME(narrow) __attribute__((vector_size(sizeof(OUT) * VECTOR_BYTES / sizeof(real)),
                                            aligned(__alignof__(OUT)), may_alias));

SPHGI_TEMPLATE void OUT_NAME(put)(OUT *at, enum sphgi_array array, vec v)
{
    *(OUT_NAME(narrow) *)(at + array * SPHGI_TILE) = __builtin_convertvector(v, OUT_NAME(narrow));
}

/* What is known when a loop is compiled. */
struct OUT_NAME(how) {
    bool masked, periodic, three, scaled, volumes, keeps;
};

/* LANES of the tile's lanes, from `first` on. */
SPHGI_TEMPLATE void OUT_NAME(gather_lanes)(const struct sphgi_gather *g, const int32_t *targets,
                                           int32_t lanes, int32_t first, struct sphgi_tile *tile,
                                           struct OUT_NAME(how) how)
{
    const struct four own = target_rows(g, targets + first);
    vec unit = splat(R(g->unit)), radius = splat(R(g->cutoff));
    if (g->radii) {
        radius = own.w;
        unit = R(1) / radius;
    }
    const vec far = radius + radius, cutoff = square_of_cutoff(g, radius);
    const struct wraps w = wraps_of(g->period);
    const uint32_t *ids = tile->ids + first;
    const ptrdiff_t stride = tile->id_stride;
    uint32_t *kept = tile->own_ids + first;
    const ptrdiff_t ahead = tile->ids == tile->own_ids ? 0 : AHEAD * stride; /* those are here */
    const uint32_t *to_come = ids_ahead(tile) + first;
    const real *rows = g->rows, *also = sizeof(OUT) == sizeof(real) ? tile->also : NULL;
    if (!also)
        also = rows;
    OUT *at = (OUT *)tile->arrays + first;
    for (int32_t k = 0; k < tile->steps; ++k, at += lanes, ids += stride, kept += lanes) {
        __builtin_prefetch(ids + ahead);
        if (!how.masked)
            ask_for_rows(rows, also, to_come, tile->scattered);
        to_come += stride;
        const struct four row = gather_rows(rows, ids);
        vec dx = own.x - row.x, dy = own.y - row.y, dz = own.z - row.z;
        mask inside = first_lanes(0);
        if (how.periodic) {
            dx = wrapped(dx, w.axis[0]);
            dy = wrapped(dy, w.axis[1]);
            dz = wrapped(dz, w.axis[2]);
        }
        if (how.masked) {
            vec limit = cutoff;
            if (g->either)
                limit = vmax(radius * radius, row.w * row.w);
            inside = less(square_distance(dx, dy, dz), limit);
            keep_ids(inside, g->dummy, ids, kept);
            dx = where(inside, dx);
            dy = where(inside, dy);
            dz = where(inside, dz);
        }
        vec square = plus(dx * dx, dy, dy);
        if (how.three)
            square = plus(square, dz, dz);
        vec r = vsqrt(square);
        if (how.masked)
            r = select(inside, r, far);
        if (how.keeps) {
            OUT_NAME(put)(at, SPHGI_UX, dx);
            OUT_NAME(put)(at, SPHGI_UY, dy);
            OUT_NAME(put)(at, SPHGI_UZ, dz);
            OUT_NAME(put)(at, SPHGI_UR, r);
        }
        if (how.scaled) {
            dx *= unit;
            dy *= unit;
            dz *= unit;
            r *= unit;
        }
        OUT_NAME(put)(at, SPHGI_X, dx);
        OUT_NAME(put)(at, SPHGI_Y, dy);
        if (how.three)
            OUT_NAME(put)(at, SPHGI_Z, dz);
        OUT_NAME(put)(at, SPHGI_R, r);
        if (how.volumes)
            OUT_NAME(put)(at, SPHGI_V, how.masked ? where(inside, row.w) : row.w);
    }
}

SPHGI_TEMPLATE void OUT_NAME(gather_as)(const struct sphgi_gather *g, const int32_t *targets,
                                        int32_t lanes, struct sphgi_tile *tile,
                                        struct OUT_NAME(how) how)
{
    for (int32_t first = 0; first < lanes; first += LANES)
        OUT_NAME(gather_lanes)(g, targets, lanes, first, tile, how);
    if (how.masked) {
        tile->ids = tile->own_ids;
        tile->id_stride = lanes;
    }
}

/* Every combination; periodic ones are always masked. */
static void OUT_NAME(gather)(const struct sphgi_gather *g, const int32_t *targets, int32_t lanes,
                             struct sphgi_tile *tile)
{
#define GATHER                                                                                     \
    OUT_NAME(gather_as)                                                                            \
    (g, targets, lanes, tile,                                                                      \
     (struct OUT_NAME(how)){masked, periodic, three, scaled, volumes, keeps})
#define SHAPED                                                                                     \
    WITH(three, g->dimension == 3,                                                                 \
         WITH(scaled, g->unit != 1,                                                                \
              WITH(volumes, g->volumes, WITH(keeps, scaled && g->keeps, GATHER))))
    if (!g->masked) {
        enum { masked = false, periodic = false };
        SHAPED;
    } else {
        enum { masked = true };
        WITH(periodic, g->periodic, SHAPED);
    }
#undef SHAPED
#undef GATHER
}
