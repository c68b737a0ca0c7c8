/* SPDX-License-Identifier: MIT */
/* Units: between the tables of the host and coefficients in units of H. */
#ifndef SPHGI_UNITS_H
#define SPHGI_UNITS_H
#include "plan.h"

/* Factors between the host's table and coefficients in units of H: value for y, slope for z_k;
 * linearised methods have one factor for all. host = factor * ours. */
struct sphgi_scales sphgi_table_scales(const struct sphgi_scheme *scheme);
/* The same for targets of these radii. */
void sphgi_table_scales_at(const struct sphgi_scheme *scheme, int32_t count, const double *radius,
                           double *value, double *slope);

/* What |s_ij| is multiplied with besides V_j, times H: sigma, or sigma / mu2 in units of the
 * moments.
 */
double sphgi_factor_of_h(const struct sphgi_scheme *scheme);

/* The factor of some numbers of a table as mantissa times powers of two: multiplying with those is
 * exact, also where the factor itself is so large or small that no table could hold the result. */
struct sphgi_table_unit {
    int32_t first, count;
    double mantissa, power[2];
};

enum { SPHGI_TABLE_UNITS = 3 };

/* [0] of y, or of all numbers of a linearised method, [1] of z_k. Order 2: of its three blocks. */
void sphgi_table_units(const struct sphgi_plan *plan,
                       struct sphgi_table_unit units[SPHGI_TABLE_UNITS]);
/* Tables are in units of H; else the factor is 1. */
bool sphgi_has_units(const struct sphgi_scheme *scheme);

/* Of order 2: what its second block is shifted and scaled by. */
struct sphgi_second sphgi_second_of(const struct sphgi_scheme *scheme);

#endif
