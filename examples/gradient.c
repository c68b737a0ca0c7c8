/* A rotating block of particles: dvx/dy at its corner, which is -1, plain and corrected. */
#include <sphgrad/sphgrad.h>
#include <stdio.h>
#include <stdlib.h>

enum { SIDE = 10, N = SIDE * SIDE * SIDE };
static double x[N][3], v[N][3], J[N][3][3]; /* J[a][b] = d v_a / d x_b */

int main(void)
{
    for (int i = 0; i < N; i++) { /* spacing 1 and jitter; v = (-y, x, 0) */
        for (int a = 0, cell = i; a < 3; a++, cell /= SIDE)
            x[i][a] = cell % SIDE + 0.2 * rand() / RAND_MAX;
        v[i][0] = -x[i][1], v[i][1] = x[i][0];
    }
    const double volume = 1; /* stride 0: the same for all */
    const sphg_view x_view = sphg_view_f64(x[0], sizeof x[0]);
    const sphg_view v_view = sphg_view_f64(v[0], sizeof v[0]);
    const sphg_view J_view = sphg_view_f64(J[0][0], sizeof J[0]);
    const sphg_geometry geometry = {.sources = x_view, .source_count = N, .target_count = N};
    sphg_scheme scheme = {.support_radius = 2};
    sphg_context *context = NULL;
    sphg_neighbors *neighbors = NULL;
    int failed = sphg_context_create(SPHG_VERSION, NULL, &context) ||
                 sphg_neighbors_create(context, &neighbors) ||
                 sphg_neighbors_search(context, neighbors, &scheme, &geometry);
    const sphg_sources sources = {.neighbors = neighbors, .volume = sphg_view_f64(&volume, 0)};
    for (int corrected = 0; corrected < 2 && !failed; corrected++) {
        scheme.method = corrected ? SPHG_KGC : SPHG_PLAIN;
        failed = sphg_jacobian(context, &scheme, &sources, NULL, v_view, J_view) != SPHG_OK;
        printf("%-10s%.15f\n", corrected ? "corrected" : "plain", J[0][0][1]);
    }
    if (failed)
        fprintf(stderr, "%s\n", sphg_last_message(context));
    sphg_neighbors_destroy(neighbors);
    sphg_context_destroy(context);
    return failed;
}
