/* A rotating block of particles: dvx/dy at its corner is -1. Plain SPH finds -0.36. */
#include <sphgrad/sphgrad.h>
#include <stdio.h>
static float x[1000][3], v[1000][3], J[1000][3][3]; /* J[a][b] = d v_a / d x_b */
int main(void)
{
    for (int i = 0; i < 1000; i++) /* 10 x 10 x 10, spacing 1, v = (-y, x, 0) */
        x[i][0] = v[i][1] = (float)(i % 10), x[i][1] = (float)(i / 10 % 10),
        x[i][2] = (float)(i / 100), v[i][0] = -x[i][1];
    const sphg_scheme scheme = {.support_radius = 2}; /* 0 elsewhere: 3D, KGC, cubic spline */
    const sphg_view positions = sphg_view_f32(x[0], 12), velocities = sphg_view_f32(v[0], 12);
    const sphg_geometry block = sphg_all(positions, 1000);
    sphg_context *context = NULL;
    sphg_neighbors *neighbors = NULL;
    int failed = sphg_context_create(SPHG_VERSION, NULL, &context) ||
                 sphg_neighbors_create(context, &neighbors) ||
                 sphg_neighbors_search(context, neighbors, &scheme, &block);
    const sphg_sources sources = {.neighbors = neighbors, .volume = sphg_same_f32(&(float){1})};
    const sphg_view gradients = sphg_view_f32(J[0][0], 36);
    failed = failed || sphg_jacobian(context, &scheme, &sources, NULL, velocities, gradients);
    printf("dvx/dy = %.7f %s\n", (double)J[0][0][1], sphg_last_message(context));
    sphg_neighbors_destroy(neighbors), sphg_context_destroy(context);
    return failed;
}
