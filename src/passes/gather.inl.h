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
    const vec turns = (difference * w.inverse + magic) - magic;
    const vec near = difference - rounded(turns * w.period);
    const vec more = where(near > w.half, splat(R(1))) - where(near < -w.half, splat(R(1)));
    return difference - rounded((turns + more) * w.period);
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
    return rounded(rounded(dx * dx) + rounded(dy * dy)) + rounded(dz * dz);
}

SPHGI_TEMPLATE vec square_of(double length)
{
    return rounded(splat(R(length)) * splat(R(length)));
}

static bool is_neighbor(const void *a, const void *b, double reach, const double *period,
                        int32_t dimension)
{
    const real *x = a, *y = b;
    const struct wraps w = wraps_of(period);
    vec d[3];
    for (int k = 0; k < 3; ++k)
        d[k] = wrapped(splat(k < dimension ? x[k] - y[k] : R(0)), w.axis[k]);
    return bits_of(less(square_distance(d[0], d[1], d[2]), square_of(reach))) & 1;
}

/* Ids [k, k + LANES) of pairs that are none are replaced by the dummy row: a field that is not
 * finite there must not enter through 0 * NaN. */
SPHGI_TEMPLATE void keep_ids(mask inside, const void *ids, int32_t k, uint32_t dummy, void *out,
                             bool wide)
{
    const unsigned bits = bits_of(inside);
    for (int l = 0; l < LANES; ++l) {
        const bool keep = bits >> l & 1;
        if (wide)
            ((uint32_t *)out)[k + l] = keep ? ((const uint32_t *)ids)[k + l] : dummy;
        else
            ((uint16_t *)out)[k + l] = keep ? ((const uint16_t *)ids)[k + l] : (uint16_t)dummy;
    }
}
