/* SPDX-License-Identifier: MIT */
/* Heat in a plate with free edges: an implicit step (1 - k Laplace) u = f by conjugate gradients,
 * for which u = cos(pi x) cos(pi y) is known. The Laplacian of the adjoint form makes the system
 * symmetric and positive; nothing flows through the edges, and no boundary condition is set. Prints
 * the errors of plain SPH, which is Brookshaw's Laplacian, and of KGC. */
#include <math.h>
#include <sphgrad/sphgrad.h>
#include <stdio.h>

enum { MOST = 40 * 40 };

static const double conductivity = .1;
static double x[MOST][2], volume[MOST], correction[MOST][3], flow[MOST];
static double u[MOST], f[MOST], r[MOST], p[MOST];

static double dot(const double *a, const double *b, int n)
{
    double sum = 0;
    for (int i = 0; i < n; ++i)
        sum += a[i] * b[i];
    return sum;
}

/* u from f, given the request that turns p into flow; the matrix is V - flow. */
static int solve(sphg_context *context, const sphg_scheme *scheme, const sphg_request *request,
                 int n)
{
    int failed = 0;
    for (int i = 0; i < n; ++i)
        u[i] = 0, p[i] = r[i] = volume[i] * f[i];
    double square = dot(r, r, n);
    const double end = 1e-24 * square;
    for (int steps = 0; square > end && steps < 500 && !failed; ++steps) {
        failed = sphg_evaluate(context, scheme, request);
        for (int i = 0; i < n; ++i)
            flow[i] = volume[i] * p[i] - flow[i];
        const double step = square / dot(p, flow, n), before = square;
        for (int i = 0; i < n; ++i)
            u[i] += step * p[i], r[i] -= step * flow[i];
        square = dot(r, r, n);
        for (int i = 0; i < n; ++i)
            p[i] = r[i] + square / before * p[i];
    }
    return failed;
}

/* Root of the mean square error on side x side particles; NaN if a call failed. */
static double error_of(sphg_context *context, sphg_neighbors *neighbors, sphg_method method,
                       int side)
{
    const int n = side * side;
    const double pi = acos(-1), spacing = 2. / side, one = 1;
    const sphg_scheme scheme = {.dimension = 2, .method = method, .support_radius = 2 * spacing};
    for (int i = 0; i < n; ++i)
        x[i][0] = (i % side + .5) * spacing - 1, x[i][1] = (i / side + .5) * spacing - 1;
    sphg_geometry plate = sphg_all(sphg_view_f64(x[0], sizeof x[0]), n);
    plate.keep_weights = 1; /* read by the products instead of formed again */
    sphg_sources sources = {.neighbors = neighbors, .volume = sphg_same_f64(&one)};
    const sphg_view ones = sphg_same_f64(&one),
                    table = sphg_view_f64(correction[0], sizeof correction[0]);
    sphg_field sum = {.shape = SPHG_SCALAR, .form = SPHG_DIRECT, .at_sources = &ones};
    sphg_request request = {.sources = &sources, .fields = &sum, .set_count = 1, .field_count = 1};
    sum.value = sphg_view_f64(volume, sizeof *volume); /* particles in a unit of area */
    int failed = sphg_neighbors_search(context, neighbors, &scheme, &plate) ||
                 sphg_evaluate(context, &scheme, &request);
    for (int i = 0; i < n; ++i) {
        volume[i] = 1 / volume[i];
        f[i] = (1 + 2 * pi * pi * conductivity) * cos(pi * x[i][0]) * cos(pi * x[i][1]);
    }
    sources.volume = sphg_view_f64(volume, sizeof *volume);
    if (method != SPHG_PLAIN)
        failed = failed || sphg_correction(context, &scheme, &sources, NULL, table, sphg_absent());
    sources.correction = method == SPHG_PLAIN ? sphg_absent() : table;
    sources.same_volumes = 1; /* from one product to the next */

    const sphg_view vector = sphg_view_f64(p, sizeof *p), k = sphg_same_f64(&conductivity);
    const sphg_field laplacian = {.shape = SPHG_SCALAR,
                                  .form = SPHG_ADJOINT,
                                  .at_sources = &vector,
                                  .laplacian = sphg_view_f64(flow, sizeof *flow),
                                  .coefficient = &k};
    request.fields = &laplacian;
    failed = failed || solve(context, &scheme, &request, n);
    double square = 0;
    for (int i = 0; i < n; ++i)
        square += pow(u[i] - cos(pi * x[i][0]) * cos(pi * x[i][1]), 2) / n;
    return failed ? NAN : sqrt(square);
}

int main(void)
{
    sphg_context *context = NULL;
    sphg_neighbors *neighbors = NULL;
    int good = !sphg_context_create(SPHG_VERSION, NULL, &context) &&
               !sphg_neighbors_create(context, &neighbors);
    for (int side = 20; side <= 40 && good; side *= 2) {
        const double plain = error_of(context, neighbors, SPHG_PLAIN, side);
        const double kgc = error_of(context, neighbors, SPHG_KGC, side);
        printf("%d x %d particles: error %.5f by plain SPH, %.5f by KGC\n", side, side, plain, kgc);
        good = kgc > 0 && kgc < plain && plain < .0085 * 40 / side;
    }
    if (!good)
        fprintf(stderr, "%s\n", context ? sphg_last_message(context) : "no context");
    sphg_neighbors_destroy(neighbors);
    sphg_context_destroy(context);
    return !good;
}
