/* SPDX-License-Identifier: MIT */
/* A wall of particles is a second source set. A block of fluid stands on a floor, and its pressure
 * falls by 1 per unit of height. Prints dp/dz in the lowest layer for three walls: layers that have
 * a pressure, and a single one whose volumes stand for what is behind it, give -1; layers that
 * mirror the fluid's pressure add no difference, and halve it. A wall without particles:
 * wall_points.c. */
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

/* dp/dz in the middle of the lowest layer, beside so many layers of the floor, of this volume each.
 */
static double slope(const sphg_neighbors *in_fluid, sphg_neighbors *in_floor, int layers,
                    double volume, int32_t mirror)
{
    const double one = 1;
    const sphg_geometry beside =
        sphg_targets_apart(sphg_view_f64(x[0], sizeof x[0]), FLUID,
                           sphg_view_f64(y[0], sizeof y[0]), layers * SIDE * SIDE);
    check(sphg_neighbors_search(context, in_floor, &scheme, &beside));
    const sphg_sources sets[2] = {{.neighbors = in_fluid, .volume = sphg_same_f64(&one)},
                                  {.neighbors = in_floor, .volume = sphg_same_f64(&volume)}};
    const sphg_view pressures[2] = {sphg_view_f64(p, sizeof p[0]),
                                    mirror ? sphg_absent() : sphg_view_f64(q, sizeof q[0])};
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
    const sphg_geometry inside = sphg_all(sphg_view_f64(x[0], sizeof x[0]), FLUID);
    sphg_neighbors *in_fluid = NULL, *in_floor = NULL;
    check(sphg_context_create(SPHG_VERSION, NULL, &context));
    check(sphg_neighbors_create(context, &in_fluid));
    check(sphg_neighbors_create(context, &in_floor));
    check(sphg_neighbors_search(context, in_fluid, &scheme, &inside));

    const double known = slope(in_fluid, in_floor, 2, 1, 0);
    const double single = slope(in_fluid, in_floor, 1, 1.43, 0); /* 1 / sum W of the layer */
    const double mirrored = slope(in_fluid, in_floor, 2, 1, 1);
    printf("two layers with a pressure: dp/dz = %.7f, error %.0e\n", known, fabs(known + 1));
    printf("one layer, larger volumes:  dp/dz = %.7f, error %.0e\n", single, fabs(single + 1));
    printf("mirrored pressure:          dp/dz = %.7f, half of it is missing\n", mirrored);
    sphg_neighbors_destroy(in_fluid);
    sphg_neighbors_destroy(in_floor);
    sphg_context_destroy(context);
    return fabs(known + 1) > 1e-12 || fabs(single + 1) > 1e-12 || fabs(mirrored + 0.5) > 1e-12;
}
