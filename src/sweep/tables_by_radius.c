/* SPDX-License-Identifier: MIT */
#include "tables_by_radius.h"
#include "core/kernel.h"
#include "plan/units.h"

/* ---- Radii ---------------------------------------------------------------------------------- */

static double number_at(const struct sphgi_sweep *sweep, const void *numbers, int32_t k)
{
    return sweep->plan->type == SPHG_F64 ? ((const double *)numbers)[k]
                                         : (double)((const float *)numbers)[k];
}

/* Order 2: KGC has V_j sigma w' / q, the others w; tables of RKPM are in units of 1 / H^2, those of
 * MLS, which has V_j elsewhere, in units of H^(d - 2). */
static double factor_of(const struct sphgi_plan *plan, double ratio, double volume)
{
    const double c = sphgi_factor_of_h(&plan->scheme), power = sphgi_power(ratio, plan->dimension);
    if (plan->scheme.method == SPHG_KGC)
        return c * (volume * power) * ratio;
    return -c * (plan->scheme.method == SPHG_MLS ? power : volume * power) / ratio;
}

static void put_radius(const struct sphgi_plan *plan, double radius, double volume, char *row)
{
    const double ratio = plan->scheme.radius / radius;
    const double numbers[SPHGI_ROW] = {ratio, 1 / radius, radius,
                                       plan->quadratic ? factor_of(plan, ratio, volume) : 0};
    for (int32_t k = 0; k < SPHGI_ROW; ++k)
        if (plan->type == SPHG_F64)
            ((double *)(void *)row)[k] = numbers[k];
        else
            ((float *)(void *)row)[k] = (float)numbers[k];
}

/* A number a source, of either type. */
struct numbers {
    double volume[SPHGI_WIDTH], ratio[SPHGI_WIDTH], inverse[SPHGI_WIDTH];
    double value[SPHGI_WIDTH], slope[SPHGI_WIDTH];
    bool by_ratio; /* coefficients meet the ratio first: products in between stay near 1 */
};

static int32_t width_of(const struct sphgi_sweep *sweep, int32_t count)
{
    return (int32_t)sphgi_round_up((size_t)count, (size_t)sweep->passes->lanes);
}

static void read_volumes(const struct sphgi_sweep *sweep, const int32_t *order, int32_t first,
                         int32_t count, int32_t width, struct numbers *to)
{
    const struct sphgi_passes *p = sweep->passes;
    int32_t items[SPHGI_WIDTH];
    for (int32_t k = 0; k < width; ++k) {
        const int32_t item = first + (k < count ? k : 0);
        items[k] = order ? order[item] : item;
    }
    p->load_lanes(width, &sweep->set->volume, items, to->volume);
    p->scale(width, 1, to->volume, sphgi_volume_unit(sweep), NULL, to->volume);
}

static void read_radii(const struct sphgi_sweep *sweep, int32_t first, int32_t count, int32_t width,
                       struct numbers *to)
{
    const struct sphgi_scheme *scheme = &sweep->plan->scheme;
    const sphg_neighbors *n = sweep->set->neighbors;
    const struct sphgi_lane_units units = {.largest = scheme->radius,
                                           .dimension = scheme->dimension};
    double radius[SPHGI_WIDTH], square[SPHGI_WIDTH], factor[SPHGI_WIDTH];
    for (int32_t k = 0; k < width; ++k)
        radius[k] = sphgi_row_radius(n, n->sources.rows.data, first + (k < count ? k : 0));
    sweep->passes->lane_units(width, &units, radius, to->ratio, to->inverse, square, factor);
}

void sphgi_fill_radii(const struct sphgi_sweep *sweep, const int32_t *order, int32_t begin,
                      int32_t end, char *rows)
{
    const sphg_neighbors *n = sweep->set->neighbors;
    const size_t row = SPHGI_ROW * sphgi_size_of_type(sweep->plan->type);
    struct numbers of;
    for (int32_t at = begin; at < end; at += SPHGI_WIDTH) {
        const int32_t count = sphgi_min32(end - at, SPHGI_WIDTH);
        if (sweep->plan->quadratic)
            read_volumes(sweep, order, at, count, width_of(sweep, count), &of);
        for (int32_t k = 0; k < count; ++k, rows += row)
            put_radius(sweep->plan, sphgi_row_radius(n, n->sources.rows.data, at + k),
                       sweep->plan->quadratic ? number_at(sweep, of.volume, k) : 0, rows);
    }
}

/* ---- Classic tables ------------------------------------------------------------------------- */

/* With y = ours u, z = ours u / H_j, the terms of j in units of H are (theory.md, section 10)
 *   CMLS   u = H_j^d    V_j / H^d H / H_j (D x (p.y) - S (p.z))
 *   CRKPM  u = 1        V_j / H_j^d H / H_j (...), V_i / H^d follows
 * H over H_j to the d takes either to units of H. */
static void form_factors(const struct sphgi_sweep *sweep, int32_t width, struct numbers *of)
{
    const struct sphgi_passes *p = sweep->passes;
    const struct sphgi_scheme *scheme = &sweep->plan->scheme;
    const double h = scheme->radius, sigma = sphgi_kernel_sigma(scheme->kernel, scheme->dimension);
    of->by_ratio = !sweep->plan->weighted;
    if (sweep->plan->weighted)
        p->scale(width, 1, of->volume, sigma * h, of->ratio, of->slope);
    else
        p->scale(width, 1, of->volume, sigma * h * sphgi_volume_unit(sweep), NULL, of->slope);
    p->scale(width, 1, of->slope, 1, of->inverse, of->value);
}

void sphgi_scale_tables(const struct sphgi_sweep *sweep, const int32_t *order, int32_t begin,
                        int32_t end, char *rows, size_t array)
{
    const struct sphgi_passes *p = sweep->passes;
    const size_t row = SPHGI_ROW * sphgi_size_of_type(sweep->plan->type);
    struct numbers of;
    for (int32_t at = begin; at < end; at += SPHGI_WIDTH, rows += SPHGI_WIDTH * row) {
        const int32_t count = sphgi_min32(end - at, SPHGI_WIDTH);
        const int32_t width = width_of(sweep, count);
        read_volumes(sweep, order, at, count, width, &of);
        read_radii(sweep, at, count, width, &of);
        form_factors(sweep, width, &of);
        for (int32_t m = 0; m <= sweep->plan->dimension; ++m)
            p->scale_rows(count, of.by_ratio ? of.ratio : NULL, m ? of.slope : of.value,
                          rows + (size_t)m * array);
    }
}
