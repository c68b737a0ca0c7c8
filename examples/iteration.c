/* SPDX-License-Identifier: MIT */
/* An implicit step of diffusion by conjugate gradients. Neighbours, corrections and the weights of
 * pairs are computed once and kept through the iteration; the difference and the adjoint form make
 * the system symmetric. A wave in a closed box should shrink by 1 / (1 + k q^2): prints by how much
 * it does, and how the total changes. */
#include <sphgrad/sphgrad.h>
#include <math.h>
#include <stdio.h>

enum { SIDE = 24, COUNT = SIDE * SIDE }; /* 2D */

static double x[COUNT][2], correction[COUNT][3], slope[COUNT][2], flux[COUNT];
static double u[COUNT], p[COUNT], r[COUNT], q[COUNT], one[COUNT], mode[COUNT];
static const sphg_scheme scheme = {.dimension = 2, .support_radius = 3};
static const double k = 8, volume = 1;
static sphg_context *context;
static int failed, turns;

/* out = V (1 - k div grad) a, with the kept neighbours and corrections. */
static void multiply(const sphg_sources *sources, const double *a, double *out)
{
    const sphg_view slopes = sphg_view_f64(slope[0], sizeof slope[0]);
    sphg_field field = {.shape = SPHG_VECTOR, .form = SPHG_ADJOINT, .at_sources = &slopes};
    field.divergence = sphg_view_f64(flux, sizeof flux[0]);
    const sphg_request request = {
        .sources = sources, .set_count = 1, .fields = &field, .field_count = 1};
    failed |= sphg_gradient(context, &scheme, sources, NULL, sphg_view_f64(a, sizeof a[0]), slopes);
    failed |= sphg_evaluate(context, &scheme, &request);
    for (int i = 0; i < COUNT; ++i)
        out[i] = volume * a[i] - k * flux[i];
}

static double dot(const double *a, const double *b)
{
    double sum = 0;
    for (int i = 0; i < COUNT; ++i)
        sum += a[i] * b[i];
    return sum;
}

int main(void)
{
    const double wave = acos(-1) / SIDE; /* half a wave: its slope is 0 at both ends */
    for (int i = 0; i < COUNT; ++i) {    /* a lattice with spacing 1, shifted here and there */
        x[i][0] = i % SIDE + 0.2 * sin(3.0 * i);
        x[i][1] = i / SIDE + 0.2 * cos(5.0 * i);
        one[i] = 1;
        mode[i] = cos(wave * (x[i][0] + 0.5));
        p[i] = r[i] = volume * (1 + mode[i]); /* u begins as 0 */
    }
    sphg_geometry box = sphg_all(sphg_view_f64(x[0], sizeof x[0]), COUNT);
    box.keep_weights = 1; /* read by the products instead of formed again */
    sphg_neighbors *neighbors = NULL;
    failed = sphg_context_create(SPHG_VERSION, NULL, &context) ||
             sphg_neighbors_create(context, &neighbors) ||
             sphg_neighbors_search(context, neighbors, &scheme, &box);
    sphg_sources sources = {.neighbors = neighbors, .volume = sphg_same_f64(&volume)};
    sources.correction = sphg_view_f64(correction[0], sizeof correction[0]);
    failed |= sphg_correction(context, &scheme, &sources, NULL, sources.correction, sphg_absent());

    for (double rr = dot(r, r), end = 1e-20 * rr; !failed && rr > end && turns < 200; ++turns) {
        multiply(&sources, p, q);
        const double step = rr / dot(p, q), before = rr;
        for (int i = 0; i < COUNT; ++i) {
            u[i] += step * p[i];
            r[i] -= step * q[i];
        }
        rr = dot(r, r);
        for (int i = 0; i < COUNT; ++i)
            p[i] = r[i] + rr / before * p[i];
    }
    const double exact = 1 / (1 + k * wave * wave), height = 2.0 / COUNT * dot(mode, u);
    const double error = height / exact - 1, change = dot(one, u) / (COUNT + dot(one, mode)) - 1;
    if (failed)
        fprintf(stderr, "%s\n", sphg_last_message(context));
    else
        printf("%d products: wave %.4f, exact %.4f (error %.1e); total changed by %.0e\n", turns,
               height, exact, error, change);
    sphg_neighbors_destroy(neighbors);
    sphg_context_destroy(context);
    return !(fabs(error) < 0.02 && fabs(change) < 1e-9);
}
