/* SPDX-License-Identifier: MIT */
/* The gradient of a velocity field. A block of particles rotates like a rigid body, so that dvx/dy
 * is -1 everywhere. Prints what the corrected gradient and plain SPH find at a corner of the block,
 * where most of the neighbours are missing. */
#include <sphgrad/sphgrad.h>
#include <stdio.h>

enum { SIDE = 10, COUNT = SIDE * SIDE * SIDE };

static double x[COUNT][3], v[COUNT][3];                   /* positions, velocities */
static double corrected[COUNT][3][3], plain[COUNT][3][3]; /* [i][a][b] = d v_a / d x_b at i */

int main(void)
{
    for (int i = 0; i < COUNT; ++i) { /* a lattice with spacing 1, and v = (-y, x, 0) */
        x[i][0] = i % SIDE;
        x[i][1] = i / SIDE % SIDE;
        x[i][2] = i / SIDE / SIDE;
        v[i][0] = -x[i][1];
        v[i][1] = x[i][0];
    }
    const double volume = 1;                       /* of each particle */
    const sphg_scheme kgc = {.support_radius = 2}; /* 0 elsewhere: 3D, KGC, cubic spline */
    const sphg_scheme sph = {.support_radius = 2, .method = SPHG_PLAIN};
    const sphg_geometry block = sphg_all(sphg_view_f64(x[0], sizeof x[0]), COUNT);
    const sphg_view velocities = sphg_view_f64(v[0], sizeof v[0]);

    sphg_context *context = NULL;
    sphg_neighbors *neighbors = NULL;
    int failed = sphg_context_create(SPHG_VERSION, NULL, &context) ||
                 sphg_neighbors_create(context, &neighbors) ||
                 sphg_neighbors_search(context, neighbors, &kgc, &block);
    const sphg_sources sources = {.neighbors = neighbors, .volume = sphg_same_f64(&volume)};
    failed = failed ||
             sphg_jacobian(context, &kgc, &sources, NULL, velocities,
                           sphg_view_f64(corrected[0][0], sizeof corrected[0])) ||
             sphg_jacobian(context, &sph, &sources, NULL, velocities,
                           sphg_view_f64(plain[0][0], sizeof plain[0]));
    if (failed)
        fprintf(stderr, "%s\n", sphg_last_message(context));
    else
        printf("dvx/dy = %.7f corrected, %.2f by plain SPH\n", corrected[0][0][1], plain[0][0][1]);

    sphg_neighbors_destroy(neighbors);
    sphg_context_destroy(context);
    const double error = corrected[0][0][1] + 1;
    return failed || error * error > 1e-20;
}
