/* SPDX-License-Identifier: MIT */
/* Second order: a quadratic field, whose Laplacian is 12 everywhere, on a block with a free
 * surface. Prints the largest errors of gradient and Laplacian by order 1, by order 2, and by order
 * 2 when particles that cannot resolve curvature take it from neighbours that can: twice, since
 * those next to a corner have no such neighbours before the first time. */
#include <math.h>
#include <sphgrad/sphgrad.h>
#include <stdio.h>

enum { SIDE = 10, COUNT = SIDE * SIDE * SIDE };

static double x[COUNT][3], a[COUNT]; /* positions, and a = x^2 + 2 y^2 + 3 z^2 + x y */
static double gradient[COUNT][3], laplacian[COUNT];
static double lent[2][COUNT][7]; /* c and c times the Hessian: before and after a call */
static uint8_t borrows[COUNT];   /* 1 where lenders change the result */

/* NaN if one is. */
static double larger(double p, double q)
{
    return p > q || isnan(p) ? p : q;
}

static double gradient_error(void)
{
    double most = 0;
    for (int i = 0; i < COUNT; ++i) {
        const double *p = x[i];
        const double expected[3] = {2 * p[0] + p[1], 4 * p[1] + p[0], 6 * p[2]};
        for (int k = 0; k < 3; ++k)
            most = larger(most, fabs(gradient[i][k] - expected[k]));
    }
    return most;
}

int main(void)
{
    for (int i = 0; i < COUNT; ++i) { /* a lattice with spacing 1 */
        const double p[3] = {i % SIDE, i / SIDE % SIDE, i / SIDE / SIDE};
        for (int k = 0; k < 3; ++k)
            x[i][k] = p[k];
        a[i] = p[0] * p[0] + 2 * p[1] * p[1] + 3 * p[2] * p[2] + p[0] * p[1];
    }
    const double volume = 1;
    const sphg_geometry block = sphg_all(sphg_view_f64(x[0], sizeof x[0]), COUNT);
    sphg_scheme scheme = {.support_radius = 2};
    sphg_context *context = NULL;
    sphg_neighbors *neighbors = NULL;
    int failed = sphg_context_create(SPHG_VERSION, NULL, &context) ||
                 sphg_neighbors_create(context, &neighbors) ||
                 sphg_neighbors_search(context, neighbors, &scheme, &block);
    const sphg_sources sources = {.neighbors = neighbors, .volume = sphg_same_f64(&volume)};
    const sphg_view values = sphg_view_f64(a, sizeof *a);
    sphg_field field = {.shape = SPHG_SCALAR, .at_sources = &values};
    field.gradient = sphg_view_f64(gradient[0], sizeof gradient[0]);
    sphg_request request = {
        .sources = &sources, .fields = &field, .set_count = 1, .field_count = 1};
    failed = failed || sphg_evaluate(context, &scheme, &request);
    const char *const names[] = {"order 1", "order 2", "lent once", "lent twice"};
    double error[4] = {gradient_error()}, curvature[4] = {12}; /* order 1 has no Laplacian: 0 */

    scheme.order = 2;
    field.laplacian = sphg_view_f64(laplacian, sizeof *laplacian);
    request.borrows = sphg_view_u8(borrows, 1);
    for (int call = 1; call < 4; ++call) { /* all targets each time; a mask would save time */
        const sphg_view lenders = sphg_view_f64(lent[call % 2][0], sizeof lent[0][0]);
        field.curvature = sphg_view_f64(lent[(call + 1) % 2][0], sizeof lent[0][0]);
        field.lenders = call > 1 ? &lenders : NULL;
        failed = failed || sphg_evaluate(context, &scheme, &request);
        error[call] = gradient_error();
        for (int i = 0; i < COUNT; ++i)
            curvature[call] = larger(curvature[call], fabs(laplacian[i] - 12));
    }
    if (failed)
        fprintf(stderr, "%s\n", sphg_last_message(context));
    for (int call = 0; call < 4 && !failed; ++call)
        printf("%-10s largest errors: gradient %.1e, Laplacian %.1e\n", names[call], error[call],
               curvature[call]);
    sphg_neighbors_destroy(neighbors);
    sphg_context_destroy(context);
    return failed || error[1] < .1 || !(error[3] < 1e-9 && curvature[3] < 1e-9);
}
