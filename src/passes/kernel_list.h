/* SPDX-License-Identifier: MIT */
/* The smoothing kernels: one row here and one pair of functions in passes/kernels.inl.h each.
 * W(r) = sigma w(q) / H^d, q = r/H. Columns: name, the functions' prefix, sigma in 2D and 3D,
 * mu2 = (1/H^2) int W x_k^2 dV in 2D and 3D. Sources of w: cubic and quintic B-splines: Monaghan
 * and Lattanzio 1985, Morris 1996, with the support scaled to H; Wendland 1995 as tabulated by
 * Dehnen and Aly 2012; poly6 and spiky: Mueller, Charypar, Gross 2003. sigma and mu2 follow by
 * exact integration; tests/test_kernels.c repeats it by quadrature. */
#ifndef SPHGI_KERNEL_LIST_H
#define SPHGI_KERNEL_LIST_H

#define SPHGI_PI 3.14159265358979323846

// clang-format off
#define SPHGI_KERNELS(X)                                                                            \
    X(CUBIC_SPLINE,   cubic_spline,   40 / (7 * SPHGI_PI),   8 / SPHGI_PI,           31.0 / 392,     3.0 / 40)  \
    X(QUINTIC_SPLINE, quintic_spline, 63 / (478 * SPHGI_PI), 9 / (40 * SPHGI_PI),    2771.0 / 51624, 7.0 / 135) \
    X(WENDLAND_C2,    wendland_c2,    7 / SPHGI_PI,          21 / (2 * SPHGI_PI),    5.0 / 72,       1.0 / 15)  \
    X(WENDLAND_C4,    wendland_c4,    9 / SPHGI_PI,          495 / (32 * SPHGI_PI),  7.0 / 132,      2.0 / 39)  \
    X(WENDLAND_C6,    wendland_c6,    78 / (7 * SPHGI_PI),   1365 / (64 * SPHGI_PI), 3.0 / 70,       1.0 / 24)  \
    X(POLY6,          poly6,          4 / SPHGI_PI,          315 / (64 * SPHGI_PI),  1.0 / 10,       1.0 / 11)  \
    X(SPIKY,          spiky,          10 / SPHGI_PI,         15 / SPHGI_PI,          1.0 / 14,       1.0 / 14)
// clang-format on

#endif
