/* SPDX-License-Identifier: MIT */
/* w(q) and w'(q)/q of each kernel, for q >= 0; both vanish from q = 1 on. Written for vectors and
 * for plain numbers alike: the includer has defined vec, R, vmax, select, less and splat.
 * Close to q = 0 the splines use their inner polynomial: the sum of truncated powers would cancel.
 */

SPHGI_TEMPLATE vec positive(vec v)
{
    return vmax(v, splat(R(0)));
}

SPHGI_TEMPLATE vec cubic_spline_w(vec q)
{
    const vec u = positive(R(1) - q), h = positive(R(0.5) - q);
    return R(2) * u * u * u - R(8) * h * h * h;
}

SPHGI_TEMPLATE vec cubic_spline_d(vec q)
{
    const vec u = positive(R(1) - q);
    return select(less(q, splat(R(0.5))), R(18) * q - R(12), R(-6) * u * u / q);
}

SPHGI_TEMPLATE vec power4(vec v)
{
    const vec square = v * v;
    return square * square;
}

/* The inner polynomial is the larger one for q < 1/3, by 15 (1 - 3q)^5, and the smaller one beyond.
 */
SPHGI_TEMPLATE vec quintic_spline_w(vec q)
{
    const vec a = positive(R(3) - R(3) * q), b = positive(R(2) - R(3) * q), square = q * q;
    const vec inner = R(66) + square * (square * (R(810) * a) - R(540));
    return vmax(inner, power4(a) * a - R(6) * power4(b) * b);
}

SPHGI_TEMPLATE vec quintic_spline_d(vec q)
{
    const vec p = R(3) * q;
    const vec a = positive(R(3) - p), b = positive(R(2) - p);
    const vec inner = R(-1080) + p * p * (R(1080) - R(450) * p);
    return select(less(p, splat(R(1))), inner, (R(90) * power4(b) - R(15) * power4(a)) / q);
}

SPHGI_TEMPLATE vec wendland_c2_w(vec q)
{
    return power4(positive(R(1) - q)) * (R(1) + R(4) * q);
}

SPHGI_TEMPLATE vec wendland_c2_d(vec q)
{
    const vec u = positive(R(1) - q);
    return R(-20) * u * u * u;
}

SPHGI_TEMPLATE vec wendland_c4_w(vec q)
{
    const vec u = positive(R(1) - q);
    return power4(u) * u * u * (R(1) + q * (R(6) + R(35.0 / 3) * q));
}

SPHGI_TEMPLATE vec wendland_c4_d(vec q)
{
    const vec u = positive(R(1) - q);
    return R(-56.0 / 3) * power4(u) * u * (R(1) + R(5) * q);
}

SPHGI_TEMPLATE vec wendland_c6_w(vec q)
{
    const vec u = positive(R(1) - q);
    return power4(u * u) * (R(1) + q * (R(8) + q * (R(25) + R(32) * q)));
}

SPHGI_TEMPLATE vec wendland_c6_d(vec q)
{
    const vec u = positive(R(1) - q);
    return R(-22) * power4(u) * u * u * u * (R(1) + q * (R(7) + R(16) * q));
}

SPHGI_TEMPLATE vec poly6_w(vec q)
{
    const vec t = positive(R(1) - q) * (R(1) + q);
    return t * t * t;
}

SPHGI_TEMPLATE vec poly6_d(vec q)
{
    const vec t = positive(R(1) - q) * (R(1) + q);
    return R(-6) * t * t;
}

SPHGI_TEMPLATE vec spiky_w(vec q)
{
    const vec u = positive(R(1) - q);
    return u * u * u;
}

/* Unbounded towards q = 0, where a pair adds nothing: 0 there. */
SPHGI_TEMPLATE vec spiky_d(vec q)
{
    const vec u = positive(R(1) - q), zero = splat(R(0));
    return select(less(zero, q), R(-3) * u * u / q, zero);
}

SPHGI_TEMPLATE vec kernel_w(sphg_kernel kernel, vec q)
{
    switch (kernel) {
#define SPHGI_CASE(name, prefix, sigma2, sigma3, mu2_2, mu2_3)                                     \
    case SPHG_##name:                                                                              \
        return prefix##_w(q);
        SPHGI_KERNELS(SPHGI_CASE)
#undef SPHGI_CASE
    }
    return splat(R(0));
}

SPHGI_TEMPLATE vec kernel_d(sphg_kernel kernel, vec q)
{
    switch (kernel) {
#define SPHGI_CASE(name, prefix, sigma2, sigma3, mu2_2, mu2_3)                                     \
    case SPHG_##name:                                                                              \
        return prefix##_d(q);
        SPHGI_KERNELS(SPHGI_CASE)
#undef SPHGI_CASE
    }
    return splat(R(0));
}
