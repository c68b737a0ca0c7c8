/* SPDX-License-Identifier: MIT */
/* Search among particles that have radii of their own: r < H_i, or r < max(H_i, H_j). As in
 * search.inl.h candidates are packed once for a few targets, each of which then tests them. */

/* Packs the sources [begin, end) behind the n candidates there are, and the squares of their radii;
 * returns their new number. */
SPHGI_TEMPLATE int32_t collect_with_radii(const struct sphgi_find *find, const struct candidates *c,
                                          const struct box *box, int32_t begin, int32_t end,
                                          int32_t n, const struct wraps *w, bool periodic)
{
    const real *rows = (const real *)find->rows + SPHGI_ROW * (ptrdiff_t)begin;
    const vec stretch = splat(R(find->stretch));
    mask near = {0};
    int32_t k = begin;
    for (; k < end; k += LANES, rows += SPHGI_ROW * LANES) {
        const real *row[LANES];
        for (int l = 0; l < LANES; ++l)
            row[l] = rows + SPHGI_ROW * l;
        const struct four v = transpose(row);
        const struct three at = {v.x, v.y, v.z};
        near = near_box(box, &at, w, periodic);
        const packing moved = packing_of(find, near);
        pack_numbers(c->x + n, at.x, moved);
        pack_numbers(c->y + n, at.y, moved);
        pack_numbers(c->z + n, at.z, moved);
        pack_numbers(c->squares + n, square_of_radius(v.w, stretch), moved);
        number_ids(c->ids + n, SPHGI_ID_STEP * (uint32_t)k, moved);
        n += lanes_in(near);
    }
    return n - lanes_in(near & ~first_lanes(LANES - (k - end))); /* read beyond the end */
}

SPHGI_TEMPLATE int32_t collect_part(const struct sphgi_find *find, const struct candidates *c,
                                    const struct box *box, int32_t begin, int32_t end, int32_t n,
                                    const struct wraps *w, bool periodic, bool mutual)
{
    return mutual ? collect_with_radii(find, c, box, begin, end, n, w, periodic)
                  : collect_run(find, c, box, begin, end, n, w, periodic);
}

SPHGI_TEMPLATE struct candidates collect_runs(const struct sphgi_find *find,
                                              const struct sphgi_runs *runs, struct box *box,
                                              int32_t self, const struct wraps *w, bool periodic,
                                              bool mutual)
{
    struct candidates c = carve(find->scratch, runs->candidates, true);
    int32_t n = 0;
    c.self = -1;
    for (int32_t run = 0; run < runs->count; ++run) {
        int32_t begin = runs->begin[run];
        const int32_t end = begin + runs->length[run];
        const double reach = runs->reach[run] * (1 + 0x1p-16) + 2 * find->slack;
        box->square_reach = splat(R(reach * reach));
        /* in two parts where the targets are among them, to see where they stand */
        const bool parted = self >= begin && self < end;
        for (int32_t part = parted ? 0 : 1; part < 2; ++part) {
            const int32_t last = part ? end : self;
            n = collect_part(find, &c, box, begin, last, n, w, periodic, mutual);
            c.self = parted && !part ? n : c.self;
            begin = last;
        }
    }
    c.count = (int32_t)sphgi_round_up((size_t)n, TESTED);
    const vec none = splat((real)__builtin_nan(""));
    for (int l = 0; l < TESTED; l += LANES) {
        store(c.x + n + l, none);
        store(c.y + n + l, none);
        store(c.z + n + l, none);
        store(c.squares + n + l, splat(R(0)));
    }
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

SPHGI_TEMPLATE void find_radii_as(const struct sphgi_find *find, const struct sphgi_runs *runs,
                                  const real *targets, int32_t count, int32_t self,
                                  uint32_t *const *lists, int32_t *lengths, bool periodic,
                                  bool mutual)
{
    const struct wraps w = wraps_of(find->period);
    struct box box = bounding_box(find, targets, count);
    const struct candidates c = collect_runs(find, runs, &box, self, &w, periodic, mutual);
    find_among(find, &c, targets, count, &w, lists, lengths, periodic, true, mutual);
    for (int32_t t = 0; find->selves && t < count; ++t)
        lengths[t] = without(find, lists[t], lengths[t], SPHGI_ID_STEP * (uint32_t)find->selves[t]);
}

static void find_by_radii(const struct sphgi_find *find, const struct sphgi_runs *runs,
                          const void *targets, int32_t count, int32_t self, uint32_t *const *lists,
                          int32_t *lengths)
{
    if (find->mutual && find->periodic)
        find_radii_as(find, runs, targets, count, self, lists, lengths, true, true);
    else if (find->mutual)
        find_radii_as(find, runs, targets, count, self, lists, lengths, false, true);
    else if (find->periodic)
        find_radii_as(find, runs, targets, count, self, lists, lengths, true, false);
    else
        find_radii_as(find, runs, targets, count, self, lists, lengths, false, false);
}
