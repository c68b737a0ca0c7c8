/* SPDX-License-Identifier: MIT */
/* Corotated elasticity in 2D. Neighbours, weights and corrections are those of the rest
 * configuration. A step takes F over them, its rotation R, a stress P linear in R^T F - 1, and the
 * forces of R P: the stress is turned, never the correction. Prints the forces of a block that only
 * turned, and how far those of a bent one that turned are from those of the bent one, turned. */
#include <math.h>
#include <sphgrad/sphgrad.h>
#include <stdio.h>

enum { SIDE = 12, COUNT = SIDE * SIDE };

static double rest[COUNT][2], now[COUNT][2], force[3][COUNT][2], correction[COUNT][3];
static double f[COUNT][2][2], stress[COUNT][2][2]; /* f[i][a][b] = d x_a / d X_b */

/* Of a block bent by so much, then turned by this angle. */
static int find_forces(sphg_context *context, const sphg_scheme *scheme,
                       const sphg_sources *sources, double bend, double angle, double (*found)[2])
{
    const sphg_view stresses = sphg_view_f64(stress[0][0], sizeof stress[0]);
    for (int i = 0; i < COUNT; ++i) {
        const double bent = rest[i][0] + bend * rest[i][1] * rest[i][1];
        now[i][0] = cos(angle) * bent - sin(angle) * rest[i][1];
        now[i][1] = sin(angle) * bent + cos(angle) * rest[i][1];
    }
    int failed = sphg_jacobian(context, scheme, sources, NULL, sphg_view_f64(now[0], sizeof *now),
                               sphg_view_f64(f[0][0], sizeof f[0]));
    for (int i = 0; i < COUNT; ++i) {
        double(*g)[2] = f[i];
        const double by = atan2(g[1][0] - g[0][1], g[0][0] + g[1][1]);
        const double c = cos(by), s = sin(by); /* R = (c -s; s c), so that R^T F is symmetric */
        const double xx = c * g[0][0] + s * g[1][0] - 1, yy = c * g[1][1] - s * g[0][1] - 1;
        const double xy = c * g[0][1] + s * g[1][1], trace = xx + yy;
        const double p[2][2] = {{2 * xx + trace, 2 * xy}, {2 * xy, 2 * yy + trace}};
        for (int b = 0; b < 2; ++b) {
            stress[i][0][b] = c * p[0][b] - s * p[1][b];
            stress[i][1][b] = s * p[0][b] + c * p[1][b];
        }
    }
    return failed || sphg_force(context, scheme, sources, NULL, SPHG_TENSOR, stresses,
                                sphg_view_f64(found[0], sizeof *found));
}

int main(void)
{
    const double volume = 1, angle = 2;
    for (int i = 0; i < COUNT; ++i) /* a lattice with spacing 1 */
        rest[i][0] = i % SIDE, rest[i][1] = i / SIDE;
    const sphg_scheme scheme = {.dimension = 2, .support_radius = 2};
    sphg_geometry block = sphg_all(sphg_view_f64(rest[0], sizeof rest[0]), COUNT);
    block.keep_weights = 1;
    sphg_context *context = NULL;
    sphg_neighbors *neighbors = NULL;
    int failed = sphg_context_create(SPHG_VERSION, NULL, &context) ||
                 sphg_neighbors_create(context, &neighbors) ||
                 sphg_neighbors_search(context, neighbors, &scheme, &block);
    sphg_sources sources = {.neighbors = neighbors, .volume = sphg_same_f64(&volume)};
    sources.correction = sphg_view_f64(correction[0], sizeof correction[0]);
    failed = failed ||
             sphg_correction(context, &scheme, &sources, NULL, sources.correction, sphg_absent()) ||
             find_forces(context, &scheme, &sources, 0, angle, force[0]) ||
             find_forces(context, &scheme, &sources, .02, 0, force[1]) ||
             find_forces(context, &scheme, &sources, .02, angle, force[2]);
    double rigid = 0, error = 0, size = 0; /* sums, which keep what is not a number */
    for (int i = 0; i < COUNT; ++i) {
        const double *bent = force[1][i], *turned = force[2][i];
        rigid += hypot(force[0][i][0], force[0][i][1]);
        error += hypot(turned[0] - (cos(angle) * bent[0] - sin(angle) * bent[1]),
                       turned[1] - (sin(angle) * bent[0] + cos(angle) * bent[1]));
        size += hypot(bent[0], bent[1]);
    }
    if (failed)
        fprintf(stderr, "%s\n", context ? sphg_last_message(context) : "no context");
    printf("sums of |force|: turned %.0e, bent %.1f, bent and turned %.0e off\n", rigid, size,
           error);
    sphg_neighbors_destroy(neighbors);
    sphg_context_destroy(context);
    return failed || !(size > 1 && rigid < 1e-11 * size && error < 1e-11 * size);
}
