/* SPDX-License-Identifier: MIT */
/* A wall of particles is a second source set. A block of fluid stands on a floor, and its pressure
 * falls by 1 per unit of height. Prints dp/dz in the lowest layer for two kinds of walls: particles
 * that have a pressure give -1; particles that mirror the fluid's add no difference, and halve it.
 */
#include <sphgrad/sphgrad.h>
#include <math.h>
#include <stdio.h>
#include <stdlib.h>

enum { SIDE = 8, FLUID = SIDE * SIDE * SIDE, FLOOR = 2 * SIDE * SIDE };

static double x[FLUID][3], p[FLUID], dp[FLUID][3]; /* fluid: positions, pressure, its gradient */
static double y[FLOOR][3], q[FLOOR];               /* floor: positions, pressure */
static sphg_context *context;
static const sphg_scheme scheme = {.support_radius = 2};

static void check(sphg_result result)
{
    if (result != SPHG_OK) {
        fprintf(stderr, "%s\n", sphg_last_message(context));
        exit(EXIT_FAILURE);
    }
}

/* dp/dz in the middle of the lowest layer. */
static double slope(const sphg_sources sets[2], sphg_view pressure_of_floor, int32_t mirror)
{
    const sphg_view pressures[2] = {sphg_view_f64(p, sizeof p[0]), pressure_of_floor};
    const sphg_field pressure = {.shape = SPHG_SCALAR,
                                 .at_sources = pressures,
                                 .mirror = mirror,
                                 .gradient = sphg_view_f64(dp[0], sizeof dp[0])};
    const sphg_request request = {
        .sources = sets, .set_count = 2, .fields = &pressure, .field_count = 1};
    check(sphg_evaluate(context, &scheme, &request));
    return dp[SIDE / 2 * SIDE + SIDE / 2][2];
}

int main(void)
{
    for (int i = 0; i < FLUID + FLOOR; ++i) { /* a lattice with spacing 1; the floor is below 0 */
        double *position = i < FLUID ? x[i] : y[i - FLUID];
        position[0] = i % SIDE;
        position[1] = i / SIDE % SIDE;
        position[2] = i < FLUID ? i / SIDE / SIDE : SIDE - 1 - i / SIDE / SIDE;
        *(i < FLUID ? &p[i] : &q[i - FLUID]) = 10 - position[2];
    }
    const double volume = 1;
    const sphg_view fluid = sphg_view_f64(x[0], sizeof x[0]);
    const sphg_geometry inside = sphg_all(fluid, FLUID);
    const sphg_geometry beside =
        sphg_targets_apart(fluid, FLUID, sphg_view_f64(y[0], sizeof y[0]), FLOOR);
    sphg_neighbors *in_fluid = NULL, *in_floor = NULL;
    check(sphg_context_create(SPHG_VERSION, NULL, &context));
    check(sphg_neighbors_create(context, &in_fluid));
    check(sphg_neighbors_create(context, &in_floor));
    check(sphg_neighbors_search(context, in_fluid, &scheme, &inside));
    check(sphg_neighbors_search(context, in_floor, &scheme, &beside));
    const sphg_sources sets[2] = {{.neighbors = in_fluid, .volume = sphg_same_f64(&volume)},
                                  {.neighbors = in_floor, .volume = sphg_same_f64(&volume)}};

    const double known = slope(sets, sphg_view_f64(q, sizeof q[0]), 0);
    const double mirrored = slope(sets, sphg_absent(), 1);
    printf("pressure of its own: dp/dz = %.7f, error %.0e\n", known, fabs(known + 1));
    printf("mirrored pressure:   dp/dz = %.7f, half of it is missing\n", mirrored);
    sphg_neighbors_destroy(in_fluid);
    sphg_neighbors_destroy(in_floor);
    sphg_context_destroy(context);
    return fabs(known + 1) > 1e-12 || fabs(mirrored + 0.5) > 1e-12;
}
