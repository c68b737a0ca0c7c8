/* SPDX-License-Identifier: MIT */
/* Smoothing kernels, number by number: constants and values in double. */
#ifndef SPHGI_KERNEL_H
#define SPHGI_KERNEL_H
#include "internal.h"

bool sphgi_kernel_exists(sphg_kernel kernel);
double sphgi_kernel_sigma(sphg_kernel kernel, int32_t dimension);
double sphgi_kernel_mu2(sphg_kernel kernel, int32_t dimension);
/* (1/H^4) int W x_a^2 x_b^2 dV, a and b different axes. */
double sphgi_kernel_mu4(sphg_kernel kernel, int32_t dimension);
double sphgi_kernel_w(sphg_kernel kernel, double q); /* w(q) */

/* scale^power, power >= 0: exact for powers of two. */
double sphgi_power(double scale, int32_t power);

#endif
