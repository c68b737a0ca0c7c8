/* SPDX-License-Identifier: MIT */
/* Distances between particles: differences in the precision of the positions, periodic images, and
 * the neighbour predicate. */

struct wrap {
    vec period, inverse, half;
};

SPHGI_TEMPLATE struct wrap wrap_of(double period)
{
    const real length = R(period);
    const bool open = !(period > 0);
    return (struct wrap){splat(open ? R(0) : length), splat(open ? R(0) : R(1) / length),
                         splat(open ? (real)__builtin_inf() : length / 2)};
}

/* fl(fl(x_i - x_j) + kL) with the whole k that makes it smallest. Adding and subtracting
 * 1.5 2^(digits - 1) rounds to a whole number. */
SPHGI_TEMPLATE vec wrapped(vec difference, struct wrap w)
{
    const vec magic = splat(REAL_IS_F64 ? R(0x1.8p52) : R(0x1.8p23));
    const vec turns = plus(magic, difference, w.inverse) - magic;
    const vec near = difference - turns * w.period;
    const vec more =
        where(less(w.half, near), splat(R(1))) - where(less(near, -w.half), splat(R(1)));
    return difference - (turns + more) * w.period;
}

struct wraps {
    struct wrap axis[3];
};

SPHGI_TEMPLATE struct wraps wraps_of(const double *period)
{
    return (struct wraps){{wrap_of(period[0]), wrap_of(period[1]), wrap_of(period[2])}};
}

/* r^2 as docs/theory.md section 1 defines it: every product and sum rounded on its own. */
SPHGI_TEMPLATE vec square_distance(vec dx, vec dy, vec dz)
{
    return (dx * dx + dy * dy) + dz * dz;
}

SPHGI_TEMPLATE vec square_of(double length)
{
    return splat(R(length)) * splat(R(length));
}

/* What r^2 of neighbours is less than. */
SPHGI_TEMPLATE vec square_of_cutoff(const struct sphgi_gather *g, vec radius)
{
    if (g->all)
        return splat((real)__builtin_inf());
    return radius * radius;
}

enum { AHEAD = 64 /* steps: ids come from memory, those to come are asked for */ };

/* Rows come from far, those to come are asked for, too: ids behind the tile's are those of targets
 * that follow. Lanes beside each other read the same lines. */
enum { ROWS_AHEAD = 24 /* steps */, LANES_A_LINE = 2 };

/* The first ids whose rows are asked for, so many steps ahead; where memory ends before, they are
 * those that are read. */
SPHGI_TEMPLATE const uint32_t *ids_steps_ahead(const struct sphgi_tile *tile, ptrdiff_t ahead)
{
    const ptrdiff_t steps = tile->steps + ahead;
    const bool there = tile->ids_end && tile->ids_end - tile->ids >= steps * tile->id_stride;
    const uint32_t *ids = tile->ids + (there ? ahead * tile->id_stride : 0);
    __asm__("" : "+r"(ids)); /* else GCC keeps a register for each lane's distance from tile->ids */
    return ids;
}

SPHGI_TEMPLATE const uint32_t *ids_ahead(const struct sphgi_tile *tile)
{
    return ids_steps_ahead(tile, ROWS_AHEAD);
}

SPHGI_TEMPLATE void ask_for_lanes_from(int first, const real *rows, const real *also,
                                       const uint32_t *ids)
{
    for (int l = first; l < LANES; l += LANES_A_LINE) {
        const size_t at = SPHGI_ROW / SPHGI_ID_STEP * (size_t)ids[l];
        __builtin_prefetch(rows + at);
        if (also)
            __builtin_prefetch(also + at);
    }
}

/* also NULL: there is one array of rows. scattered: lanes beside each other read other lines. */
SPHGI_TEMPLATE void ask_for_rows(const real *rows, const real *also, const uint32_t *ids,
                                 bool scattered)
{
    ask_for_lanes_from(LANES_A_LINE - 1, rows, also, ids);
    __asm__("" : "+r"(scattered)); /* else GCC makes two loops of the one around */
    if (scattered)
        ask_for_lanes_from(0, rows, also, ids);
}

/* Rows of the arrays behind the first: fewer lanes of each, lest asking takes the time it saves. */
SPHGI_TEMPLATE void ask_for_more_rows(const struct sphgi_tile *tile, const uint32_t *ids)
{
    enum { LANES_ASKED = 4 };
    const real *rows = tile->also;
    for (int32_t k = 1; k < tile->also_arrays; ++k) {
        rows += tile->also_numbers;
        for (int l = LANES_ASKED - 1; l < LANES; l += LANES_ASKED)
            __builtin_prefetch(rows + SPHGI_ROW / SPHGI_ID_STEP * (size_t)ids[l]);
    }
}

/* LANES ids: those of what is no pair become the dummy's, for a field that is not finite must not
 * enter through 0 * NaN. */
SPHGI_TEMPLATE void keep_ids(mask inside, uint32_t dummy, const uint32_t *ids, uint32_t *to)
{
#if VECTOR_BYTES == 64 && REAL_IS_F64
    _mm256_storeu_epi32(
        to, _mm256_mask_loadu_epi32(_mm256_set1_epi32((int)dummy), (__mmask8)inside, ids));
#elif VECTOR_BYTES == 64
    _mm512_storeu_epi32(
        to, _mm512_mask_loadu_epi32(_mm512_set1_epi32((int)dummy), (__mmask16)inside, ids));
#else
    typedef uint32_t lane_ids __attribute__((vector_size(4 * LANES), aligned(4), may_alias));
    const lane_ids keep = __builtin_convertvector(inside, lane_ids);
    *(lane_ids *)to = (*(const lane_ids *)ids & keep) | (((lane_ids){0} + dummy) & ~keep);
#endif
}

/* The rows of LANES targets. */
SPHGI_TEMPLATE struct four target_rows(const struct sphgi_gather *g, const int32_t *targets)
{
    const real *row[LANES];
    for (int l = 0; l < LANES; ++l)
        row[l] = (const real *)g->target_rows + SPHGI_ROW * (ptrdiff_t)targets[l];
    return transpose(row);
}

/* What offsets are multiplied with, where radii of their own stand in the rows of the targets. */
SPHGI_TEMPLATE vec unit_of_offsets(const struct sphgi_gather *g, vec radius)
{
    if (g->radii)
        return R(1) / radius;
    return splat(R(g->unit));
}

/* Of loops that gather pairs and weigh them (by_kernel.inl.h). */
#define GATHER_PARAMETERS                                                                          \
    (const struct sphgi_gather *gather, const struct sphgi_shape *shape, const int32_t *targets,   \
     struct sphgi_tile *tile)
