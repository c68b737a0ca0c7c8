/* A rotating block of particles: dvx/dy at its corner is -1. Plain SPH finds -0.36. */
#include <sphgrad/sphgrad.h>
#include <stdio.h>
enum { n = 1000 };
static float x[n][3], v[n][3], J[n][3][3]; /* J[a][b] = d v_a / d x_b */
int main(void)
{
    for (int i = 0; i < n; i++) { /* 10 x 10 x 10, spacing 1, v = (-y, x, 0) */
        x[i][0] = v[i][1] = (float)(i % 10), x[i][2] = (float)(i / 100);
        x[i][1] = (float)(i / 10 % 10), v[i][0] = -x[i][1];
    }
    const float volume = 1;                           /* stride 0: the same for all */
    const sphg_scheme scheme = {.support_radius = 2}; /* 0 elsewhere: 3D, KGC, cubic spline */
    const sphg_view x_view = sphg_view_f32(x[0], sizeof *x),
                    v_view = sphg_view_f32(v[0], sizeof *v);
    const sphg_geometry geometry = {.sources = x_view, .source_count = n, .target_count = n};
    sphg_context *context = NULL;
    sphg_neighbors *neighbors = NULL;
    int failed = sphg_context_create(SPHG_VERSION, NULL, &context) ||
                 sphg_neighbors_create(context, &neighbors) ||
                 sphg_neighbors_search(context, neighbors, &scheme, &geometry);
    const sphg_sources sources = {.neighbors = neighbors, .volume = sphg_view_f32(&volume, 0)};
    const sphg_view J_view = sphg_view_f32(J[0][0], sizeof *J);
    failed = failed || sphg_jacobian(context, &scheme, &sources, NULL, v_view, J_view);
    printf("dvx/dy = %.7f %s\n", (double)J[0][0][1], sphg_last_message(context));
    sphg_neighbors_destroy(neighbors);
    sphg_context_destroy(context);
    return failed;
}
