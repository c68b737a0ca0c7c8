/* SPDX-License-Identifier: MIT */
/* w(q) and w'(q)/q of each kernel, for q >= 0; both vanish from q = 1 on. Written for vectors and
 * for plain numbers alike: the includer has defined vec, R, vmax, select, less, splat, plus and
 * minus. Close to q = 0 the splines use their inner polynomial: the sum of truncated powers would
 * cancel. */

/* q = r / H, and u = 1 - q or, beyond the cutoff, 0: of one product, so that both are rounded once.
 */
struct ratio {
    vec q, u;
};

SPHGI_TEMPLATE vec positive(vec v)
{
    return vmax(v, splat(R(0)));
}

SPHGI_TEMPLATE struct ratio ratio_of(vec r, vec inverse_h)
{
    return (struct ratio){inverse_h * r, positive(minus(splat(R(1)), inverse_h, r))};
}

/* a + b q */
SPHGI_TEMPLATE vec line(double a, double b, vec q)
{
    return plus(splat(R(a)), splat(R(b)), q);
}

/* a + q (b + c q) */
SPHGI_TEMPLATE vec parabola(double a, double b, double c, vec q)
{
    return plus(splat(R(a)), q, line(b, c, q));
}

/* a + q (b + q (c + d q)) */
SPHGI_TEMPLATE vec cubic(double a, double b, double c, double d, vec q)
{
    return plus(splat(R(a)), q, parabola(b, c, d, q));
}

SPHGI_TEMPLATE vec cubic_spline_w(struct ratio at)
{
    const vec u = at.u, h = positive(R(0.5) - at.q);
    return minus(R(2) * u * u * u, R(8) * h * h, h);
}

SPHGI_TEMPLATE vec cubic_spline_d(struct ratio at)
{
    const vec outer = R(-6) * at.u * at.u / at.q;
    return select(less(at.q, splat(R(0.5))), line(-12, 18, at.q), outer);
}

SPHGI_TEMPLATE vec power4(vec v)
{
    const vec square = v * v;
    return square * square;
}

/* The inner polynomial is the larger one for q < 1/3, by 15 (1 - 3q)^5, and the smaller one beyond.
 */
SPHGI_TEMPLATE vec quintic_spline_w(struct ratio at)
{
    const vec a = positive(line(3, -3, at.q)), b = positive(line(2, -3, at.q));
    const vec square = at.q * at.q;
    const vec inner = plus(splat(R(66)), square, plus(splat(R(-540)), square, R(810) * a));
    return vmax(inner, minus(power4(a) * a, R(6) * power4(b), b));
}

SPHGI_TEMPLATE vec quintic_spline_d(struct ratio at)
{
    const vec p = R(3) * at.q;
    const vec a = positive(R(3) - p), b = positive(R(2) - p);
    const vec inner = plus(splat(R(-1080)), p * p, line(1080, -450, p));
    const vec outer = minus(R(90) * power4(b), splat(R(15)), power4(a)) / at.q;
    return select(less(p, splat(R(1))), inner, outer);
}

SPHGI_TEMPLATE vec wendland_c2_w(struct ratio at)
{
    return power4(at.u) * line(1, 4, at.q);
}

SPHGI_TEMPLATE vec wendland_c2_d(struct ratio at)
{
    return R(-20) * at.u * at.u * at.u;
}

SPHGI_TEMPLATE vec wendland_c4_w(struct ratio at)
{
    return power4(at.u) * at.u * at.u * parabola(1, 6, 35.0 / 3, at.q);
}

SPHGI_TEMPLATE vec wendland_c4_d(struct ratio at)
{
    return R(-56.0 / 3) * power4(at.u) * at.u * line(1, 5, at.q);
}

SPHGI_TEMPLATE vec wendland_c6_w(struct ratio at)
{
    return power4(at.u * at.u) * cubic(1, 8, 25, 32, at.q);
}

SPHGI_TEMPLATE vec wendland_c6_d(struct ratio at)
{
    return R(-22) * power4(at.u) * at.u * at.u * at.u * parabola(1, 7, 16, at.q);
}

SPHGI_TEMPLATE vec poly6_w(struct ratio at)
{
    const vec t = at.u * (R(1) + at.q);
    return t * t * t;
}

SPHGI_TEMPLATE vec poly6_d(struct ratio at)
{
    const vec t = at.u * (R(1) + at.q);
    return R(-6) * t * t;
}

SPHGI_TEMPLATE vec spiky_w(struct ratio at)
{
    return at.u * at.u * at.u;
}

/* Unbounded towards q = 0, where a pair adds nothing: 0 there. */
SPHGI_TEMPLATE vec spiky_d(struct ratio at)
{
    const vec zero = splat(R(0));
    return select(less(zero, at.q), R(-3) * at.u * at.u / at.q, zero);
}

SPHGI_TEMPLATE vec kernel_w(sphg_kernel kernel, struct ratio at)
{
    switch (kernel) {
#define SPHGI_CASE(name, prefix, sigma2, sigma3, mu2_2, mu2_3)                                     \
    case SPHG_##name:                                                                              \
        return prefix##_w(at);
        SPHGI_KERNELS(SPHGI_CASE)
#undef SPHGI_CASE
    }
    return splat(R(0));
}

SPHGI_TEMPLATE vec kernel_d(sphg_kernel kernel, struct ratio at)
{
    switch (kernel) {
#define SPHGI_CASE(name, prefix, sigma2, sigma3, mu2_2, mu2_3)                                     \
    case SPHG_##name:                                                                              \
        return prefix##_d(at);
        SPHGI_KERNELS(SPHGI_CASE)
#undef SPHGI_CASE
    }
    return splat(R(0));
}
