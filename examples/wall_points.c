/* SPDX-License-Identifier: MIT */
/* A wall without particles, as volume maps describe it. Each fluid particle near the floor sees one
 * point of it, with the volume of the floor that its support holds; the points are a second source
 * set with lists of the host. Prints dp/dz in the lowest layer, which should be -1. */
#include <sphgrad/sphgrad.h>
#include <math.h>
#include <stdio.h>
#include <stdlib.h>

enum { SIDE = 8, COUNT = SIDE * SIDE * SIDE };

static double x[COUNT][3], p[COUNT], dp[COUNT][3]; /* fluid: positions, pressure, its gradient */
static double point[COUNT][3], q[COUNT], share[COUNT]; /* the floor as each particle sees it */
static int64_t offsets[COUNT + 1];
static int32_t seen[COUNT]; /* particle i sees point i alone */
static sphg_context *context;

static void check(sphg_result result)
{
    if (result != SPHG_OK) {
        fprintf(stderr, "%s\n", sphg_last_message(context));
        exit(EXIT_FAILURE);
    }
}

int main(void)
{
    for (int i = 0; i < COUNT; ++i) { /* a lattice with spacing 1; the floor begins at z = -0.5 */
        point[i][0] = x[i][0] = i % SIDE;
        point[i][1] = x[i][1] = i / SIDE % SIDE;
        x[i][2] = i / SIDE / SIDE;
        point[i][2] = -1;
        share[i] = x[i][2] < 1.5 ? 5.3 : 0; /* [L^3], 0 where the floor is out of reach */
        p[i] = 10 - x[i][2];
        q[i] = 10 - point[i][2];
        seen[i] = i;
        offsets[i + 1] = i + 1;
    }
    const double volume = 1;
    const sphg_scheme scheme = {.support_radius = 2};
    const sphg_view fluid = sphg_view_f64(x[0], sizeof x[0]);
    const sphg_geometry inside = sphg_all(fluid, COUNT);
    const sphg_geometry beside =
        sphg_targets_apart(fluid, COUNT, sphg_view_f64(point[0], sizeof point[0]), COUNT);
    const sphg_lists lists = {.offsets = offsets, .indices = seen};
    sphg_neighbors *in_fluid = NULL, *on_floor = NULL;
    check(sphg_context_create(SPHG_VERSION, NULL, &context));
    check(sphg_neighbors_create(context, &in_fluid));
    check(sphg_neighbors_create(context, &on_floor));
    check(sphg_neighbors_search(context, in_fluid, &scheme, &inside));
    check(sphg_neighbors_use_lists(context, on_floor, &scheme, &beside, &lists));

    const sphg_sources sets[2] = {
        {.neighbors = in_fluid, .volume = sphg_same_f64(&volume)},
        {.neighbors = on_floor, .volume = sphg_view_f64(share, sizeof share[0])}};
    const sphg_view pressures[2] = {sphg_view_f64(p, sizeof p[0]), sphg_view_f64(q, sizeof q[0])};
    const sphg_field field = {.shape = SPHG_SCALAR,
                              .at_sources = pressures,
                              .gradient = sphg_view_f64(dp[0], sizeof dp[0])};
    const sphg_request request = {
        .sources = sets, .set_count = 2, .fields = &field, .field_count = 1};
    check(sphg_evaluate(context, &scheme, &request));
    const double found = dp[SIDE / 2 * SIDE + SIDE / 2][2];
    printf("dp/dz = %.7f, error %.0e\n", found, fabs(found + 1));
    sphg_neighbors_destroy(in_fluid);
    sphg_neighbors_destroy(on_floor);
    sphg_context_destroy(context);
    return fabs(found + 1) > 1e-12;
}
