/* SPDX-License-Identifier: MIT */
/* Search among particles that have radii of their own: r < H_i, or r < max(H_i, H_j). Cells are up
 * to twice as wide as the radii in them, so candidates are packed twice: once for all targets of a
 * cell, and from these for a few that stand close together, each of which then tests what is left
 * as in search.inl.h. */

static void bounds(const void *rows, int32_t count, double *low, double *high)
{
    const real *row = rows;
    quad least = *(const quad *)row, largest = least;
    for (int32_t k = 1; k < count; ++k) {
        row += SPHGI_ROW;
        lower_quad(&least, (const quad *)row);
        raise_quad(&largest, (const quad *)row);
    }
    for (int a = 0; a < SPHGI_ROW; ++a) {
        low[a] = (double)least[a];
        high[a] = (double)largest[a];
    }
}

/* Those of a cell keep, where radii of others count, how far these reach in place of its square. */
SPHGI_TEMPLATE struct candidates carve_wide(const struct sphgi_find *find,
                                            const struct sphgi_packed *packed, bool mutual)
{
    return carve(find->scratch, packed->most, mutual);
}

/* The square of a reach, with the margins that boxes need. */
SPHGI_TEMPLATE vec square_with_margin(const struct sphgi_find *find, vec reach)
{
    const vec wide = plus(splat(R(2 * find->slack)), reach, splat(R(1 + 0x1p-16)));
    return wide * wide;
}

/* Around some targets, and how far the largest of them reaches. */
struct reached {
    struct box box;
    vec reach;
};

SPHGI_TEMPLATE struct reached reached_by(const struct sphgi_find *find, const real *targets,
                                         int32_t count)
{
    struct reached s = {.box = bounding_box(find, targets, count)};
    s.reach = splat(s.box.radius) * splat(R(find->stretch));
    s.box.square_reach = square_with_margin(find, s.reach);
    return s;
}

/* Which of LANES sources may be neighbours. reach: theirs, if that counts */
SPHGI_TEMPLATE mask may_be_reached(const struct sphgi_find *find, const struct reached *s,
                                   const struct three *at, vec reach, const struct wraps *w,
                                   bool periodic, bool mutual)
{
    if (!mutual)
        return near_box(&s->box, at, w, periodic);
    return within_reach(&s->box, at, square_with_margin(find, vmax(s->reach, reach)), w, periodic);
}

/* ---- The targets of a cell ------------------------------------------------------------------- */

/* Packs the sources [begin, end) behind the n candidates there are; returns their new number. */
SPHGI_TEMPLATE int32_t pack_run(const struct sphgi_find *find, const struct candidates *c,
                                const struct reached *s, int32_t begin, int32_t end, int32_t n,
                                const struct wraps *w, bool periodic, bool mutual)
{
    const real *rows = (const real *)find->rows + SPHGI_ROW * (ptrdiff_t)begin;
    mask near = {0};
    int32_t k = begin;
    for (; k < end; k += LANES, rows += SPHGI_ROW * LANES) {
        struct three at;
        vec reach = s->reach;
        if (mutual) {
            const real *row[LANES];
            for (int l = 0; l < LANES; ++l)
                row[l] = rows + SPHGI_ROW * l;
            const struct four v = transpose(row);
            at = (struct three){v.x, v.y, v.z};
            reach = v.w * splat(R(find->stretch));
        } else {
            at = coordinates_of(rows);
        }
        near = may_be_reached(find, s, &at, reach, w, periodic, mutual);
        const packing moved = packing_of(find, near);
        pack_places(c, n, &at, moved);
        if (mutual)
            pack_numbers(c->squares + n, reach, moved);
        number_ids(c->ids + n, SPHGI_ID_STEP * (uint32_t)k, moved);
        n += lanes_in(near);
    }
    return n - lanes_in(near & ~first_lanes(LANES - (k - end))); /* read beyond the end */
}

SPHGI_TEMPLATE void pack_as(const struct sphgi_find *find, const struct sphgi_runs *runs,
                            const real *targets, int32_t count, int32_t self,
                            struct sphgi_packed *packed, bool periodic, bool mutual)
{
    const struct wraps w = wraps_of(find->period);
    const struct reached s = reached_by(find, targets, count);
    *packed = (struct sphgi_packed){.most = runs->candidates, .self = -1};
    const struct candidates c = carve_wide(find, packed, mutual);
    int32_t n = 0;
    for (int32_t run = 0; run < runs->count; ++run) {
        int32_t begin = runs->begin[run];
        const int32_t end = begin + runs->length[run];
        if (self >= begin && self + count <= end) { /* in two parts, to see where they stand */
            n = pack_run(find, &c, &s, begin, self, n, &w, periodic, mutual);
            packed->self = n;
            begin = self;
        }
        n = pack_run(find, &c, &s, begin, end, n, &w, periodic, mutual);
    }
    packed->count = n;
    pad_candidates(&c, n);
}

static void pack_by_radii(const struct sphgi_find *find, const struct sphgi_runs *runs,
                          const void *targets, int32_t count, int32_t self,
                          struct sphgi_packed *packed)
{
    WITH(mutual, find->mutual,
         WITH(periodic, find->periodic,
              pack_as(find, runs, targets, count, self, packed, periodic, mutual)));
}

/* ---- A few of them --------------------------------------------------------------------------- */

/* Packs the candidates [begin, end) of the cell behind the n that there are of these targets. */
SPHGI_TEMPLATE int32_t pack_some(const struct sphgi_find *find, const struct candidates *wide,
                                 const struct candidates *c, const struct reached *s, int32_t begin,
                                 int32_t end, int32_t n, const struct wraps *w, bool periodic,
                                 bool mutual)
{
    mask near = {0};
    int32_t k = begin;
    for (; k < end; k += LANES) {
        const struct three at = {load(wide->x + k), load(wide->y + k), load(wide->z + k)};
        const vec reach = mutual ? load(wide->squares + k) : s->reach;
        near = may_be_reached(find, s, &at, reach, w, periodic, mutual);
        const packing moved = packing_of(find, near);
        pack_places(c, n, &at, moved);
        if (mutual)
            pack_numbers(c->squares + n, reach * reach, moved);
        pack_ids_of_lanes(c->ids + n, wide->ids + k, moved);
        n += lanes_in(near);
    }
    return n - lanes_in(near & ~first_lanes(LANES - (k - end))); /* read beyond the end */
}

SPHGI_TEMPLATE struct candidates pick(const struct sphgi_find *find,
                                      const struct sphgi_packed *packed, const real *targets,
                                      int32_t count, int32_t self, const struct wraps *w,
                                      bool periodic, bool mutual)
{
    const struct candidates wide = carve_wide(find, packed, mutual);
    const struct reached s = reached_by(find, targets, count);
    struct candidates c = carve(wide.bits, packed->count, mutual);
    int32_t n = 0;
    c.self = -1;
    if (self >= 0)
        n = c.self = pack_some(find, &wide, &c, &s, 0, self, n, w, periodic, mutual);
    n = pack_some(find, &wide, &c, &s, self >= 0 ? self : 0, packed->count, n, w, periodic, mutual);
    c.count = (int32_t)sphgi_round_up((size_t)n, TESTED);
    pad_candidates(&c, n);
    return c;
}

/* Takes an id out of a list of that length, if it is there; returns its length then. */
SPHGI_TEMPLATE int32_t without(const struct sphgi_find *find, uint32_t *list, int32_t length,
                               uint32_t id)
{
    int32_t k = 0;
    while (k < length && list[k] != id)
        ++k;
    if (k == length)
        return length;
    for (; k + 1 < length; ++k)
        list[k] = list[k + 1];
    list[k] = find->dummy;
    return k;
}

SPHGI_TEMPLATE void find_radii_as(const struct sphgi_find *find, const struct sphgi_packed *packed,
                                  const real *targets, int32_t count, int32_t self,
                                  uint32_t *const *lists, int32_t *lengths, bool periodic,
                                  bool mutual)
{
    const struct wraps w = wraps_of(find->period);
    const struct candidates c = pick(find, packed, targets, count, self, &w, periodic, mutual);
    find_among(find, &c, targets, count, &w, lists, lengths, periodic, true, mutual);
    for (int32_t t = 0; find->selves && t < count; ++t)
        lengths[t] = without(find, lists[t], lengths[t], SPHGI_ID_STEP * (uint32_t)find->selves[t]);
}

static void find_by_radii(const struct sphgi_find *find, const struct sphgi_packed *packed,
                          const void *targets, int32_t count, int32_t self, uint32_t *const *lists,
                          int32_t *lengths)
{
    WITH(mutual, find->mutual,
         WITH(periodic, find->periodic,
              find_radii_as(find, packed, targets, count, self, lists, lengths, periodic, mutual)));
}
