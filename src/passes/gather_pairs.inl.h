/* Pairs into the arrays of a piece: x_ij and |x_ij|, narrowed to OUT after the difference was
 * taken, and V_j in units of H^d. What is no pair gets a distance beyond the cutoff and finite
 * offsets: every weight is exactly 0 there.
 * Parameters: OUT, the type of the arrays; OUT_NAME(x), a name of its own for each. */

typedef OUT OUT_NAME(narrow) __attribute__((vector_size(sizeof(OUT) * VECTOR_BYTES / sizeof(real)),
                                            aligned(__alignof__(OUT)), may_alias));

SPHGI_TEMPLATE void OUT_NAME(put)(OUT *at, enum sphgi_array array, vec v)
{
    *(OUT_NAME(narrow) *)(at + array * SPHGI_PIECE) = __builtin_convertvector(v, OUT_NAME(narrow));
}

/* What is known when a loop is compiled. */
struct OUT_NAME(how) {
    bool wide, guarded, periodic, three, scaled, volumes;
};

/* One part: pairs of the target at x, `at` is where they begin in the arrays. padded: their number
 * there. */
SPHGI_TEMPLATE void OUT_NAME(gather_part)(const struct sphgi_gather *g, const real *x,
                                          struct listed list, int32_t padded, OUT *at, char *masked,
                                          struct OUT_NAME(how) how)
{
    const vec xi = splat(x[0]), yi = splat(x[1]), zi = splat(x[2]);
    const vec unit = splat(R(g->unit)), cutoff = square_of(g->cutoff);
    const vec far = splat(R(2 * g->cutoff));
    const struct wraps w = wraps_of(g->period);
    for (int32_t k = 0; k < padded; k += LANES, at += LANES, list = after(list, LANES)) {
        const struct four row = gather_rows(g->rows, list);
        vec dx = xi - row.x, dy = yi - row.y, dz = zi - row.z;
        mask inside = first_lanes(0);
        if (how.periodic) {
            dx = wrapped(dx, w.axis[0]);
            dy = wrapped(dy, w.axis[1]);
            dz = wrapped(dz, w.axis[2]);
        }
        if (how.guarded) {
            inside = less(square_distance(dx, dy, dz), cutoff);
            keep_ids(inside, list, masked);
            masked += LANES * (how.wide ? 4 : 2);
            dx = where(inside, dx);
            dy = where(inside, dy);
            dz = where(inside, dz);
        }
        vec square = dx * dx + dy * dy;
        if (how.three)
            square += dz * dz;
        vec r = vsqrt(square);
        if (how.guarded)
            r = select(inside, r, far);
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
        if (how.guarded ? g->volumes : how.volumes)
            OUT_NAME(put)(at, SPHGI_V, how.guarded ? where(inside, row.w) : row.w);
    }
}

SPHGI_TEMPLATE void OUT_NAME(gather_as)(const struct sphgi_gather *g, const void *const *x,
                                        struct sphgi_piece *piece, int32_t first, char *masked,
                                        struct OUT_NAME(how) how)
{
    for (int k = 0; k < SPHGI_PAD; ++k)
        piece->dummies[k] = g->dummy;
    for (int32_t p = first; p < piece->parts; ++p) {
        const int32_t begin = piece->begin[p];
        char *kept = masked + (how.wide ? 4 : 2) * (size_t)begin;
        OUT_NAME(gather_part)
        (g, x[piece->lane[p]], first_listed(piece, p, how.wide), piece->begin[p + 1] - begin,
         (OUT *)piece->arrays + begin, kept, how);
        if (how.guarded)
            piece->ids[p] = kept;
    }
}

SPHGI_TEMPLATE void OUT_NAME(gather_guarded)(const struct sphgi_gather *g, const void *const *x,
                                             struct sphgi_piece *piece, int32_t first, char *masked,
                                             struct OUT_NAME(how) how)
{
    how.guarded = true;
    how.wide = true;
    if (piece->wide) {
        OUT_NAME(gather_as)(g, x, piece, first, masked, how);
        return;
    }
    how.wide = false;
    OUT_NAME(gather_as)(g, x, piece, first, masked, how);
}

/* Every combination; whether volumes differ the guarded ones ask as they go. */
static void OUT_NAME(gather)(const struct sphgi_gather *g, const void *const *x,
                             struct sphgi_piece *piece, int32_t first, void *masked)
{
    const bool guarded = g->guarded || piece->wide, last = guarded ? g->periodic : g->volumes;
    const int way = (guarded ? 8 : 0) | (g->dimension == 3 ? 4 : 0) | (g->unit != 1 ? 2 : 0) | last;
    switch (way) {
#define WAY(number)                                                                                \
    case number:                                                                                   \
        OUT_NAME(gather_as)                                                                        \
        (g, x, piece, first, masked,                                                               \
         (struct OUT_NAME(how)){                                                                   \
             .three = number >> 2 & 1, .scaled = number >> 1 & 1, .volumes = number & 1});         \
        break;
        WAY(0)
        WAY(1)
        WAY(2) WAY(3) WAY(4) WAY(5) WAY(6) WAY(7)
#undef WAY
#define WAY(number)                                                                                \
    case 8 + number:                                                                               \
        OUT_NAME(gather_guarded)                                                                   \
        (g, x, piece, first, masked,                                                               \
         (struct OUT_NAME(how)){                                                                   \
             .three = number >> 2 & 1, .scaled = number >> 1 & 1, .periodic = number & 1});        \
        break;
            WAY(0) WAY(1) WAY(2) WAY(3) WAY(4) WAY(5) WAY(6) WAY(7)
#undef WAY
    }
}
