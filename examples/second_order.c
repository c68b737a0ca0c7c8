/* Second order: a quadratic field, whose Laplacian is 12 everywhere, on a block with a free
 * surface. Prints the largest error of the gradient for order 1 and for order 2, the largest error
 * of the Laplacian, and how many particles can resolve curvature. */
#include <math.h>
#include <sphgrad/sphgrad.h>
#include <stdio.h>

enum { SIDE = 10, COUNT = SIDE * SIDE * SIDE };

static double x[COUNT][3], a[COUNT]; /* positions, and a = x^2 + 2 y^2 + 3 z^2 + x y */
static double gradient[COUNT][3], laplacian[COUNT];
static uint8_t rank[COUNT]; /* 9 where all first and second derivatives are known */

/* Where rank is 9; of order 1, which has no such rank, everywhere. */
static double gradient_error(int order)
{
    double most = 0;
    for (int i = 0; i < COUNT; i++) {
        const double *p = x[i];
        const double expected[3] = {2 * p[0] + p[1], 4 * p[1] + p[0], 6 * p[2]};
        for (int k = 0; k < 3 && (order == 1 || rank[i] == 9); k++)
            most = fmax(most, fabs(gradient[i][k] - expected[k]));
    }
    return most;
}

int main(void)
{
    for (int i = 0; i < COUNT; i++) { /* a lattice with spacing 1 */
        const double p[3] = {i % SIDE, i / SIDE % SIDE, i / SIDE / SIDE};
        for (int k = 0; k < 3; k++)
            x[i][k] = p[k];
        a[i] = p[0] * p[0] + 2 * p[1] * p[1] + 3 * p[2] * p[2] + p[0] * p[1];
    }
    const double volume = 1;
    const sphg_geometry block = sphg_all(sphg_view_f64(x[0], sizeof x[0]), COUNT);
    sphg_scheme scheme = {.support_radius = 3};

    sphg_context *context = NULL;
    sphg_neighbors *neighbors = NULL;
    int failed = sphg_context_create(SPHG_VERSION, NULL, &context) ||
                 sphg_neighbors_create(context, &neighbors) ||
                 sphg_neighbors_search(context, neighbors, &scheme, &block);
    const sphg_sources sources = {.neighbors = neighbors, .volume = sphg_same_f64(&volume)};
    const sphg_view values = sphg_view_f64(a, sizeof *a);
    sphg_field field = {.shape = SPHG_SCALAR,
                        .at_sources = &values,
                        .gradient = sphg_view_f64(gradient[0], sizeof gradient[0])};
    sphg_request request = {
        .sources = &sources, .fields = &field, .set_count = 1, .field_count = 1};
    failed = failed || sphg_evaluate(context, &scheme, &request);
    const double first = gradient_error(1);

    scheme.order = 2;
    field.laplacian = sphg_view_f64(laplacian, sizeof *laplacian);
    request.rank = sphg_view_u8(rank, 1);
    failed = failed || sphg_evaluate(context, &scheme, &request);
    int resolved = 0;
    double second = gradient_error(2), curvature = 0;
    for (int i = 0; i < COUNT && !failed; i++)
        if (rank[i] == 9) {
            resolved++;
            curvature = fmax(curvature, fabs(laplacian[i] - 12));
        }
    if (failed)
        fprintf(stderr, "%s\n", sphg_last_message(context));
    else
        printf("gradient: error %.2g by order 1, %.1e by order 2\n"
               "Laplacian: error %.1e where curvature is resolved, %d of %d particles\n",
               first, second, curvature, resolved, COUNT);

    sphg_neighbors_destroy(neighbors);
    sphg_context_destroy(context);
    return failed || second > 1e-9 || curvature > 1e-9 || resolved < COUNT / 2;
}
