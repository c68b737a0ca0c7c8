/* SPDX-License-Identifier: MIT */
/* Which of a list's ids are neighbours, by the same test as a search: for lists of the host that
 * are copied. */

/* A bit for each of TESTED ids. mutual: the radii of sources count, too. */
SPHGI_TEMPLATE uint16_t bits_near(const struct sphgi_find *find, const uint32_t *ids, const vec *x,
                                  vec square_reach, const struct wraps *w, bool periodic,
                                  bool mutual)
{
    mask within[TESTED / LANES];
    for (int l = 0; l < TESTED; l += LANES) {
        const struct four row = gather_rows(find->rows, ids + l);
        vec dx = x[0] - row.x, dy = x[1] - row.y, dz = x[2] - row.z;
        if (periodic) {
            dx = wrapped(dx, w->axis[0]);
            dy = wrapped(dy, w->axis[1]);
            dz = wrapped(dz, w->axis[2]);
        }
        vec limit = square_reach;
        if (mutual)
            limit = vmax(limit, square_of_radius(row.w, splat(R(find->stretch))));
        within[l / LANES] = less(square_distance(dx, dy, dz), limit);
    }
    return bits_of_tested(within);
}

/* What has moved to the front lies before what is read next. */
SPHGI_TEMPLATE int32_t keep_as(const struct sphgi_find *find, const real *target, uint32_t *ids,
                               int32_t count, bool pack, bool periodic, bool mutual)
{
    const struct wraps w = wraps_of(find->period);
    const vec x[3] = {splat(target[0]), splat(target[1]), splat(target[2])};
    const vec square_reach = find->radii
                                 ? square_of_radius(splat(target[3]), splat(R(find->stretch)))
                                 : square_of(find->reach);
    uint32_t *to = ids;
    for (int32_t l = 0; l < TESTED; ++l)
        ids[count + l] = find->dummy;
    for (int32_t k = 0; k < count; k += TESTED) {
        const uint16_t bits = bits_near(find, ids + k, x, square_reach, &w, periodic, mutual);
        if (pack)
            to = pack_tested(find, to, ids + k, bits);
        else
            for (int l = 0; l < TESTED; ++l)
                ids[k + l] = bits >> l & 1 ? ids[k + l] : find->dummy;
    }
    if (!pack)
        return count;
    for (int32_t l = 0; l < TESTED; ++l)
        to[l] = find->dummy;
    return (int32_t)(to - ids);
}

static int32_t keep_near(const struct sphgi_find *find, const void *target, uint32_t *ids,
                         int32_t count, bool pack)
{
    int32_t kept = 0;
    WITH(mutual, find->mutual,
         WITH(periodic, find->periodic,
              kept = keep_as(find, target, ids, count, pack, periodic, mutual)));
    return kept;
}
