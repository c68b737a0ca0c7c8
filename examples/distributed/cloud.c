/* SPDX-License-Identifier: MIT */
#include "cloud.h"
#include "stop.h"
#include <math.h>
#include <stdlib.h>

/* Density is linear: 1 + slope . x. */
static const double slope[3] = {.02, .03, -.01};

/* ---- Particles ------------------------------------------------------------------------------- */

/* A number from -1 to 1 that belongs to a particle. */
static double scattered(int name, int which)
{
    uint32_t bits = (uint32_t)name * 2654435761u + (uint32_t)which * 40503u + 12345u;
    bits = (bits ^ bits >> 15) * 2246822519u;
    bits = (bits ^ bits >> 13) * 3266489917u;
    return (double)(bits ^ bits >> 16) / 2147483648. - 1;
}

static struct cloud_particle particle_of(int name, int side)
{
    const double place[3] = {name % side, name / side % side, name / side / side};
    struct cloud_particle p = {.volume = 1 + .1 * scattered(name, 3), .density = 1, .name = name};
    for (int a = 0; a < 3; ++a) {
        p.x[a] = place[a] + .2 * scattered(name, a);
        p.density += slope[a] * p.x[a];
    }
    p.pressure = 1 + .5 * sin(p.x[0] + 2 * p.x[2]);
    for (int k = 0; k < 6; ++k)
        p.stress[k] = cos(p.x[1] + k) + scattered(name, 4 + k);
    return p;
}

void cloud_make(struct domain *domain, MPI_Comm ranks, int side)
{
    int rank, rank_count, count = 0;
    MPI_Comm_rank(ranks, &rank);
    MPI_Comm_size(ranks, &rank_count);
    const int all = side * side * side;
    struct cloud_particle *particles =
        resized(NULL, (size_t)(all / rank_count + 1), sizeof *particles);
    for (int name = rank; name < all; name += rank_count)
        particles[count++] = particle_of(name, side);
    domain_make(domain, ranks, particles, sizeof *particles, count);
    free(particles);
}

/* ---- Sums ------------------------------------------------------------------------------------ */

static double dot(const double *a, const double *b)
{
    return a[0] * b[0] + a[1] * b[1] + a[2] * b[2];
}

/* What forces do to momentum and to a flow. */
struct sums {
    double force[3], size_of_force, work, expected, size_of_work;
};

static void add(struct sums *sums, const double *force, double weight, const double *v,
                double expected)
{
    for (int a = 0; a < 3; ++a)
        sums->force[a] += weight * force[a];
    sums->size_of_force += weight * sqrt(dot(force, force));
    sums->work += weight * dot(force, v);
    sums->expected += expected;
    sums->size_of_work += fabs(weight * dot(force, v)) + fabs(expected);
}

/* sum f_i . v_i = -sum V_i S_i : grad v, whatever the neighbourhoods are like, if the gradient is
 * exact on v, here v = x. */
static void add_adjoint(struct sums *sums, const struct cloud_particle *p, const double *force)
{
    const double trace = p->stress[0] + p->stress[3] + p->stress[5];
    add(sums, force, 1, p->x, -p->volume * trace);
}

/* sum V_i f_i . v_i = -sum (V_i A_i / rho_i) sum_j rho_j (v_j - v_i) . G_ij, and the inner sum is
 * div (rho v) - v . grad rho if both rho and rho v are linear, here rho v = x. */
static void add_symmetric(struct sums *sums, const struct cloud_particle *p, const double *force)
{
    const double v[3] = {p->x[0] / p->density, p->x[1] / p->density, p->x[2] / p->density};
    add(sums, force, p->volume, v, -p->volume * p->pressure / p->density * (3 - dot(v, slope)));
}

struct cloud_errors cloud_judge(const struct cloud_forces *forces, int side, enum cloud_form form)
{
    struct sums sums = {.work = 0};
    for (int name = 0; name < side * side * side; ++name) {
        const struct cloud_particle p = particle_of(name, side);
        (form == CLOUD_ADJOINT ? add_adjoint : add_symmetric)(&sums, &p, forces[name].of[form]);
    }
    return (struct cloud_errors){sqrt(dot(sums.force, sums.force)) / sums.size_of_force,
                                 fabs(sums.work - sums.expected) / sums.size_of_work};
}

/* ---- Differences ----------------------------------------------------------------------------- */

static void widen(double *largest, const double *number, const double *other)
{
    for (int a = 0; a < 3; ++a) {
        const double distance = fabs(number[a] - (other ? other[a] : 0));
        if (!(distance <= *largest)) /* NaN stays */
            *largest = distance;
    }
}

double cloud_difference(const struct cloud_forces *a, const struct cloud_forces *b, int side,
                        enum cloud_form form)
{
    double difference = 0, size = 0;
    for (int k = 0; k < side * side * side; ++k) {
        widen(&difference, a[k].of[form], b[k].of[form]);
        widen(&size, b[k].of[form], NULL);
    }
    return size > 0 ? difference / size : difference;
}
