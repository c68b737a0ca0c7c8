/* SPDX-License-Identifier: MIT */
/* Heat in a plate with free edges: an implicit step (1 - k Laplace) u = f by conjugate gradients,
 * for which u = cos(pi x) cos(pi y) is known. The Laplacian of the adjoint form makes the system
 * symmetric and positive; nothing flows through the edges, and no boundary condition is set. Prints
 * the error of u, the root of its mean square. */
#include <math.h>
#include <sphgrad/sphgrad.h>
#include <stdio.h>

enum { SIDE = 40, COUNT = SIDE * SIDE };

static double x[COUNT][2], exact[COUNT], correction[COUNT][3];
static double u[COUNT], r[COUNT], p[COUNT], flow[COUNT];

static double dot(const double *a, const double *b)
{
    double sum = 0;
    for (int i = 0; i < COUNT; ++i)
        sum += a[i] * b[i];
    return sum;
}

int main(void)
{
    const double pi = acos(-1), spacing = 2. / SIDE, volume = spacing * spacing, k = .1;
    for (int i = 0; i < COUNT; ++i) { /* a lattice in [-1, 1]^2; u begins as 0, r = p = V f */
        x[i][0] = (i % SIDE + .5) * spacing - 1;
        x[i][1] = (i / SIDE + .5) * spacing - 1;
        exact[i] = cos(pi * x[i][0]) * cos(pi * x[i][1]);
        p[i] = r[i] = volume * (1 + 2 * pi * pi * k) * exact[i];
    }
    const sphg_scheme scheme = {.dimension = 2, .support_radius = 2 * spacing};
    const sphg_geometry plate = sphg_all(sphg_view_f64(x[0], sizeof x[0]), COUNT);
    const sphg_view conductivity = sphg_same_f64(&k), direction = sphg_view_f64(p, sizeof *p);
    sphg_context *context = NULL;
    sphg_neighbors *neighbors = NULL;
    int failed = sphg_context_create(SPHG_VERSION, NULL, &context) ||
                 sphg_neighbors_create(context, &neighbors) ||
                 sphg_neighbors_search(context, neighbors, &scheme, &plate);
    sphg_sources sources = {.neighbors = neighbors, .volume = sphg_same_f64(&volume)};
    sources.correction = sphg_view_f64(correction[0], sizeof correction[0]);
    failed = failed ||
             sphg_correction(context, &scheme, &sources, NULL, sources.correction, sphg_absent());
    const sphg_field heat = {.shape = SPHG_SCALAR,
                             .form = SPHG_ADJOINT,
                             .at_sources = &direction,
                             .coefficient = &conductivity,
                             .laplacian = sphg_view_f64(flow, sizeof *flow)};
    const sphg_request request = {
        .sources = &sources, .fields = &heat, .set_count = 1, .field_count = 1};

    double square = dot(r, r);
    for (int steps = 0; steps < 40 && !failed; ++steps) {
        failed = sphg_evaluate(context, &scheme, &request);
        for (int i = 0; i < COUNT; ++i)
            flow[i] = volume * p[i] - flow[i]; /* the matrix is V - k Laplace */
        const double step = square / dot(p, flow), before = square;
        for (int i = 0; i < COUNT; ++i)
            u[i] += step * p[i], r[i] -= step * flow[i];
        square = dot(r, r);
        for (int i = 0; i < COUNT; ++i)
            p[i] = r[i] + square / before * p[i];
    }
    if (failed)
        fprintf(stderr, "%s\n", context ? sphg_last_message(context) : "no context");
    for (int i = 0; i < COUNT; ++i)
        u[i] -= exact[i];
    const double error = sqrt(dot(u, u) / COUNT);
    printf("%d x %d particles: error %.5f\n", SIDE, SIDE, error);
    sphg_neighbors_destroy(neighbors);
    sphg_context_destroy(context);
    return failed || !(fabs(error - .00265) < 1e-5);
}
