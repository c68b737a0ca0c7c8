/* SPDX-License-Identifier: MIT */
/* Vorticity near a free surface (the paper's Fig. 4 and section 5.4): the curl of a rigid rotation,
 * the spin of a micropolar fluid (Bender et al. 2017, doi:10.1145/3099564.3099578) held in that
 * rotation, and what becomes of its angular momentum where spin and flow drive each other. */
#include "solver/operators.h"
#include "solver/output.h"
#include "solver/pairs.h"
#include <math.h>
#include <stdlib.h>
#include <string.h>

static const double spacing = 0.05;
static const double support_radius = 0.1;
static const double density = 1000;
static const double rotation[3] = {0.6, -1.2, 3}; /* Omega [1/s] */
static const double transfer = 0.1;               /* nu_t [m^2/s] */
static const double inertia = 0.01; /* Theta [m^2]: spin follows within Theta / (2 nu_t) = 50 ms */
static const double step = 2e-3;
static const int32_t held_steps = 1000; /* of the held rotation: 2 s */

static double length(const double *a)
{
    return sqrt(dot(a, a));
}

static struct particles make_block(const struct run *run, struct random *random)
{
    const int32_t side = run->options->full ? 40 : 12, sides[3] = {side, side, side};
    return particles_block(sides, spacing, 0.2, density, random);
}

static void rotate(struct particles *block)
{
    for (int32_t i = 0; i < block->count; ++i)
        cross(rotation, block->x[i], block->v[i]);
}

/* Largest |curl - 2 Omega| / |2 Omega|. */
static double curl_error(vector *curl, int32_t count)
{
    double worst = 0;
    for (int32_t i = 0; i < count; ++i) {
        vector off = {0};
        add_scaled(off, 0.5, curl[i]);
        add_scaled(off, -1, rotation);
        worst = fmax(worst, length(off) / length(rotation));
    }
    return worst;
}

/* Eq. (47) to the letter takes grad Phi_i(x_j) for grad Phi_j(x_i): minus the curl, and no exact
 * one. */
static double printed_curl_error(const struct sph *sph, const struct operators *operators,
                                 const struct particles *block)
{
    struct pairs pairs = pairs_new(block->count);
    vector *curl = array_new(block->count, sizeof *curl);
    pairs_update(sph, &operators->sources, 0, block->count, &pairs);
    for (int32_t i = 0; i < block->count; ++i)
        for (int64_t k = pairs.offsets[i]; k < pairs.offsets[i + 1]; ++k) {
            const int32_t j = pairs.indices[k];
            vector apart = {0}, slower = {0}, gradient, term;
            add_scaled(apart, 1, block->x[j]);
            add_scaled(apart, -1, block->x[i]);
            add_scaled(slower, 1, block->v[i]);
            add_scaled(slower, -1, block->v[j]);
            sphg_pair_gradient(&sph->corrected, apart, block->volume[i],
                               operators->correction + (ptrdiff_t)6 * j, gradient);
            cross(slower, gradient, term);
            add_scaled(curl[i], 1, term);
        }
    const double error = curl_error(curl, block->count);
    pairs_free(&pairs);
    free(curl);
    return error;
}

static void find_curl(const struct sph *sph, const struct operators *operators, vector *v,
                      vector *curl)
{
    sph_check(sph, sphg_curl(sph->context, &sph->corrected, &operators->sources, NULL, vectors(v),
                             vectors(curl)));
}

/* d spin / dt = nu_t (curl v - 2 spin) / Theta */
static void advance_spin(int32_t count, vector *curl, vector *spin)
{
    for (int32_t i = 0; i < count; ++i)
        for (int k = 0; k < 3; ++k)
            spin[i][k] += step * transfer / inertia * (curl[i][k] - 2 * spin[i][k]);
}

static double spin_error(vector *spin, int32_t count)
{
    double worst = 0;
    for (int32_t i = 0; i < count; ++i) {
        vector off = {0};
        add_scaled(off, 1, spin[i]);
        add_scaled(off, -1, rotation);
        worst = fmax(worst, length(off) / length(rotation));
    }
    return worst;
}

/* The layer next to the middle of the block. */
static void write_layer(const struct run *run, const struct particles *block, vector *spin)
{
    FILE *table = output_open(run, "spin");
    for (int32_t i = 0; table && i < block->count; ++i)
        if (fabs(block->x[i][2] - 0.5 * spacing) < 0.5 * spacing)
            fprintf(table, "%g %g %g\n", block->x[i][0], block->x[i][1],
                    length(spin[i]) / length(rotation));
    output_close(table);
    const struct output_field fields[] = {{"spin", spin[0], 3}, {"velocity", block->v[0], 3}, {0}};
    output_particles(run, 0, step * held_steps, block->count, block->x, fields);
}

/* Spin in a fluid that is held in rigid rotation for 2 s. */
static void held_rotation(const struct run *run, const struct sph *sph, struct particles *block)
{
    struct operators operators = operators_new(sph, NULL, block->count);
    vector *curl = array_new(block->count, sizeof *curl),
           *spin = array_new(block->count, sizeof *spin);
    rotate(block);
    operators_update(&operators, block);
    find_curl(sph, &operators, block->v, curl);
    for (int32_t k = 0; k < held_steps; ++k)
        advance_spin(block->count, curl, spin);
    metrics_set(run->metrics, "curl_error", curl_error(curl, block->count));
    if (run->method != SPH)
        metrics_set(run->metrics, "printed_curl_error", printed_curl_error(sph, &operators, block));
    metrics_set(run->metrics, "spin_error", spin_error(spin, block->count));
    write_layer(run, block, spin);
    operators_free(&operators);
    free(curl);
    free(spin);
}

/* What drives the flow is the adjoint of what drives the spin: with s = curl v - 2 spin a particle
 * gains the angular momentum rho nu_t V s, and the stress is minus half of it as an antisymmetric
 * tensor. */
static void spin_stress(const double *curl, const double *spin, double *stress)
{
    double s[3];
    for (int k = 0; k < 3; ++k)
        s[k] = 0.5 * density * transfer * (curl[k] - 2 * spin[k]);
    const double antisymmetric[9] = {0, -s[2], s[1], s[2], 0, -s[0], -s[1], s[0], 0};
    memcpy(stress, antisymmetric, sizeof antisymmetric);
}

static void total_angular_momentum(const struct particles *block, vector *spin, double *total)
{
    particles_angular_momentum(block, total);
    for (int32_t i = 0; i < block->count; ++i)
        add_scaled(total, density * inertia * block->volume[i], spin[i]);
}

static void couple(const struct sph *sph, const struct operators *operators,
                   struct particles *block, vector *spin, tensor *stress, vector *work)
{
    find_curl(sph, operators, block->v, work);
    for (int32_t i = 0; i < block->count; ++i)
        spin_stress(work[i], spin[i], stress[i]);
    advance_spin(block->count, work, spin);
    operators_force(operators, SPHG_TENSOR, tensors(stress), work);
    for (int32_t i = 0; i < block->count; ++i) {
        add_scaled(block->v[i], step / block->mass[i], work[i]);
        add_scaled(block->x[i], step, block->v[i]);
    }
}

/* A block at rest whose particles spin sets itself in motion; nothing acts from outside. */
static void free_block(const struct run *run, const struct sph *sph, struct particles *block)
{
    struct operators operators = operators_new(sph, NULL, block->count);
    vector *spin = array_new(block->count, sizeof *spin),
           *work = array_new(block->count, sizeof *work);
    tensor *stress = array_new(block->count, sizeof *stress);
    vector before, after, orbital;
    for (int32_t i = 0; i < block->count; ++i) {
        memset(block->v[i], 0, sizeof block->v[i]);
        add_scaled(spin[i], 1, rotation);
    }
    total_angular_momentum(block, spin, before);
    for (int32_t k = 0; k < 50; ++k) {
        operators_update(&operators, block);
        couple(sph, &operators, block, spin, stress, work);
    }
    total_angular_momentum(block, spin, after);
    particles_angular_momentum(block, orbital);
    metrics_set(run->metrics, "angular_momentum_moved", length(orbital) / length(before));
    add_scaled(after, -1, before);
    metrics_set(run->metrics, "angular_momentum_lost", length(after) / length(before));
    operators_free(&operators);
    free(spin);
    free(work);
    free(stress);
}

static void simulate(const struct run *run)
{
    struct random random = {run->options->seed};
    struct particles block = make_block(run, &random);
    struct sph sph = run_open(run, 3, support_radius, block.count);
    held_rotation(run, &sph, &block);
    free_block(run, &sph, &block);
    particles_free(&block);
    sph_close(&sph);
}

static void draw(const struct picture *picture)
{
    FILE *script = picture->script;
    picture_begin(picture, 1000, 460);
    fprintf(script, "set size ratio -1\nset cbrange [0.4:1.15]\n"
                    "set xrange [-0.33:0.33]\nset yrange [-0.33:0.33]\n"
                    "set xtics 0.2\nset ytics 0.2\nset xlabel 'x [m]'\nset ylabel 'y [m]'\n");
    picture_bar(picture, 0.9, "spin / angular velocity");
    for (int k = 0; k < 2; ++k) {
        picture_panel(picture, 0.085 + 0.41 * k, 0.47 + 0.41 * k);
        fprintf(script,
                "set title '%s: spin in a rigid rotation, middle layer'\n"
                "plot 'vorticity_%s_spin.dat' using 1:2:(0.025):3 with circles lc palette\n"
                "unset ylabel\nset format y ''\n",
                picture->titles[k], picture->methods[k]);
    }
}

int main(int argc, char **argv)
{
    static const struct gate gates[] = {{"spin_error", ONLY_SPH, AT_LEAST, 0.4},
                                        {"curl_error", EACH_CORRECTED, AT_MOST, 1e-12},
                                        {"printed_curl_error", EACH_CORRECTED, AT_LEAST, 1},
                                        {"spin_error", EACH_CORRECTED, AT_MOST, 1e-8},
                                        {"angular_momentum_moved", EACH_CORRECTED, AT_LEAST, 0.3},
                                        {"angular_momentum_moved", EACH_CORRECTED, AT_MOST, 1},
                                        {"angular_momentum_lost", EACH_CORRECTED, AT_MOST, 1e-10},
                                        {0}};
    static const struct scene scene = {
        "vorticity", "Vorticity and spin near a free surface.", simulate, draw, gates, true, false};
    return scene_main(&scene, argc, argv);
}
