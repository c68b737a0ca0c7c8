/* SPDX-License-Identifier: MIT */
/* Search among particles that have radii of their own: r < H_i, or r < max(H_i, H_j). As in
 * search.inl.h candidates are packed once for a few targets, each of which then tests them. */

/* Squares of the radii that count, rounded like those of distances. */
SPHGI_TEMPLATE vec square_of_radius(vec radius, vec stretch)
{
    const vec reach = rounded(radius * stretch);
    return rounded(reach * reach);
}

/* Packs the sources [begin, end) behind the n candidates there are, and the squares of their radii;
 * returns their new number. */
SPHGI_TEMPLATE int32_t collect_with_radii(const struct sphgi_find *find, const struct candidates *c,
                                          real *squares, const struct box *box, int32_t begin,
                                          int32_t end, int32_t n, const struct wraps *w,
                                          bool periodic)
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
        pack_numbers(squares + n, square_of_radius(v.w, stretch), moved);
        number_ids(c->ids + n, SPHGI_ID_STEP * (uint32_t)k, moved);
        n += lanes_in(near);
    }
    return n - lanes_in(near & ~first_lanes(LANES - (k - end))); /* read beyond the end */
}

SPHGI_TEMPLATE int32_t collect_part(const struct sphgi_find *find, const struct candidates *c,
                                    real *squares, const struct box *box, int32_t begin,
                                    int32_t end, int32_t n, const struct wraps *w, bool periodic,
                                    bool mutual)
{
    return mutual ? collect_with_radii(find, c, squares, box, begin, end, n, w, periodic)
                  : collect_run(find, c, box, begin, end, n, w, periodic);
}

SPHGI_TEMPLATE struct candidates collect_runs(const struct sphgi_find *find,
                                              const struct sphgi_runs *runs, struct box *box,
                                              int32_t self, real **squares, const struct wraps *w,
                                              bool periodic, bool mutual)
{
    const size_t room = sphgi_round_up((size_t)runs->candidates + 2 * TESTED, SPHGI_ALIGNMENT);
    *squares = find->scratch;
    struct candidates c = carve(*squares + room, runs->candidates);
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
            n = collect_part(find, &c, *squares, box, begin, last, n, w, periodic, mutual);
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
        store(*squares + n + l, splat(R(0)));
    }
    return c;
}

/* Which of the candidates are neighbours of a target. */
SPHGI_TEMPLATE void test_radii(const struct candidates *c, const real *squares, const vec *x,
                               vec square, const struct wraps *w, bool periodic, bool mutual)
{
    uint16_t *bits = c->bits;
    for (int32_t k = 0; k < c->count; k += TESTED) {
        mask within[TESTED / LANES];
        for (int l = 0; l < TESTED; l += LANES) {
            vec dx = x[0] - load(c->x + k + l);
            vec dy = x[1] - load(c->y + k + l);
            vec dz = x[2] - load(c->z + k + l);
            if (periodic) {
                dx = wrapped(dx, w->axis[0]);
                dy = wrapped(dy, w->axis[1]);
                dz = wrapped(dz, w->axis[2]);
            }
            const vec reach = mutual ? vmax(square, load(squares + k + l)) : square;
            within[l / LANES] = less(square_distance(dx, dy, dz), reach);
        }
        *bits++ = bits_of_tested(within);
    }
}

/* Takes an id out of a list, if it is there. Returns where the list ends. */
SPHGI_TEMPLATE const uint32_t *without(const struct sphgi_find *find, uint32_t *list,
                                       const uint32_t *end, uint32_t id)
{
    while (list < end && *list != id)
        ++list;
    if (list == end)
        return end;
    for (; list + 1 < end; ++list)
        list[0] = list[1];
    *list = find->dummy;
    return end - 1;
}

SPHGI_TEMPLATE int64_t find_radii_as(const struct sphgi_find *find, const struct sphgi_runs *runs,
                                     const real *targets, int32_t count, int32_t self,
                                     uint32_t *ids, int32_t *lengths, bool periodic, bool mutual)
{
    const struct wraps w = wraps_of(find->period);
    const vec stretch = splat(R(find->stretch));
    struct box box = bounding_box(find, targets, count);
    real *squares;
    const struct candidates c =
        collect_runs(find, runs, &box, self, &squares, &w, periodic, mutual);
    uint32_t *out = ids;
    for (int32_t t = 0; t < count; ++t, targets += SPHGI_ROW) {
        const vec x[3] = {splat(targets[0]), splat(targets[1]), splat(targets[2])};
        const vec square = square_of_radius(splat(targets[3]), stretch);
        test_radii(&c, squares, x, square, &w, periodic, mutual);
        if (c.self >= 0)
            c.bits[(c.self + t) / TESTED] &= (uint16_t) ~(1u << (c.self + t) % TESTED);
        const uint32_t *end = pack(find, &c, out);
        if (find->selves)
            end = without(find, out, end, SPHGI_ID_STEP * (uint32_t)find->selves[t]);
        lengths[t] = (int32_t)(end - out);
        out += sphgi_round_up((size_t)(end - out), SPHGI_PAD);
    }
    return out - ids;
}

static int64_t find_by_radii(const struct sphgi_find *find, const struct sphgi_runs *runs,
                             const void *targets, int32_t count, int32_t self, uint32_t *ids,
                             int32_t *lengths)
{
    if (find->mutual)
        return find->periodic
                   ? find_radii_as(find, runs, targets, count, self, ids, lengths, true, true)
                   : find_radii_as(find, runs, targets, count, self, ids, lengths, false, true);
    return find->periodic
               ? find_radii_as(find, runs, targets, count, self, ids, lengths, true, false)
               : find_radii_as(find, runs, targets, count, self, ids, lengths, false, false);
}
