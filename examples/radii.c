/* SPDX-License-Identifier: MIT */
/* A support radius per particle: the forces of a gas whose resolution varies, with grad-h terms.
 * With P/(Omega rho^2) in the plain adjoint form momentum is conserved, and heating takes back what
 * forces do to the velocities. Prints both errors, that of a corrected divergence whose value is 2,
 * and the range of Omega. */
#include <sphgrad/sphgrad.h>
#include <math.h>
#include <stdio.h>
#include <stdlib.h>

enum { SIDE = 48, COUNT = SIDE * SIDE }; /* 2D */

static float x[COUNT][2], v[COUNT][2], force[COUNT][2], radius[COUNT], mass[COUNT];
static float density[COUNT], spread[COUNT], stress[COUNT];
static sphg_context *context;

static void check(sphg_result result)
{
    if (result != SPHG_OK) {
        fprintf(stderr, "%s\n", sphg_last_message(context));
        exit(EXIT_FAILURE);
    }
}

int main(void)
{
    for (int i = 0; i < COUNT; ++i) { /* columns .5 apart on the left, 1.5 on the right */
        const double u = (i % SIDE + 0.5) / SIDE, y = i / SIDE + 0.5;
        x[i][0] = (float)(SIDE * (0.5 * u + 0.5 * u * u) + 0.1 * sin(3.0 * i));
        x[i][1] = (float)(y + 0.1 * cos(5.0 * i));
        v[i][0] = (float)sin(0.2 * y), v[i][1] = (float)cos(0.3 * y * u);
        mass[i] = (float)(0.5 + u); /* density 1 */
        radius[i] = 2 * sqrtf(mass[i]);
    }
    const float unit = 1;
    const sphg_view one = sphg_same_f32(&unit);
    const sphg_scheme kgc = {.dimension = 2, .support_radius = 1}; /* not read: radii are given */
    sphg_scheme sph = kgc;
    sph.method = SPHG_PLAIN;
    const sphg_view positions = sphg_view_f32(x[0], 8), spreads = sphg_view_f32(spread, 4);
    sphg_geometry geometry = sphg_all(positions, COUNT);
    geometry.source_support = sphg_view_f32(radius, 4);
    geometry.mutual = 1; /* forces act on both */
    sphg_neighbors *neighbors = NULL;
    check(sphg_context_create(SPHG_VERSION, NULL, &context));
    check(sphg_neighbors_create(context, &neighbors));
    check(sphg_neighbors_search(context, neighbors, &sph, &geometry));

    /* With m_j for V_j: rho = sum m W, and div x = sum m r |W'| = d rho Omega */
    const sphg_sources gas = {.neighbors = neighbors, .volume = sphg_view_f32(mass, 4)};
    const sphg_field sum = {.shape = SPHG_SCALAR,
                            .form = SPHG_DIRECT,
                            .at_sources = &one,
                            .value = sphg_view_f32(density, 4)};
    const sphg_request rho = {.sources = &gas, .fields = &sum, .set_count = 1, .field_count = 1};
    check(sphg_evaluate(context, &sph, &rho));
    check(sphg_divergence(context, &sph, &gas, NULL, positions, spreads));
    double least = 1, most = 1, work = 0, size = 0, total = 0, off = 0;
    for (int i = 0; i < COUNT; ++i) {
        const double omega = spread[i] / (2 * density[i]);
        stress[i] = (float)(pow(density[i], 1.4) / (omega * density[i] * density[i]));
        least = fmin(least, omega), most = fmax(most, omega);
    }
    check(sphg_force(context, &sph, &gas, NULL, SPHG_SCALAR, sphg_view_f32(stress, 4),
                     sphg_view_f32(force[0], 8)));
    check(sphg_divergence(context, &sph, &gas, NULL, sphg_view_f32(v[0], 8), spreads));
    for (int i = 0; i < COUNT; ++i) { /* m dv/dt = -force, du/dt = -stress div v */
        total += force[i][0] + force[i][1];
        size += fabs(force[i][0]) + fabs(force[i][1]);
        work += v[i][0] * force[i][0] + v[i][1] * force[i][1] + mass[i] * stress[i] * spread[i];
    }
    check(sphg_divergence(context, &kgc, &gas, NULL, positions, spreads));
    for (int i = 0; i < COUNT; ++i)
        off += fabs(spread[i] / 2 - 1) / COUNT;
    printf("momentum off by %.0e, energy by %.0e, div x by %.0e; Omega from %.2f to %.2f\n",
           fabs(total) / size, fabs(work) / size, off, least, most);
    sphg_neighbors_destroy(neighbors);
    sphg_context_destroy(context);
    return !(fabs(total) / size < 1e-6 && fabs(work) / size < 1e-6 && off < 1e-5);
}
