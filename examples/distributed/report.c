/* SPDX-License-Identifier: MIT */
#include "report.h"
#include "gather.h"
#include "stop.h"
#include <math.h>
#include <stdio.h>
#include <stdlib.h>

/* ---- Over all ranks -------------------------------------------------------------------------- */

static double most(const struct drop *drop, double value)
{
    MPI_Allreduce(MPI_IN_PLACE, &value, 1, MPI_DOUBLE, MPI_MAX, drop->domain.ranks);
    return value;
}

static double sum(const struct drop *drop, double value)
{
    MPI_Allreduce(MPI_IN_PLACE, &value, 1, MPI_DOUBLE, MPI_SUM, drop->domain.ranks);
    return value;
}

static struct least_most range(const struct drop *drop, double value)
{
    return (struct least_most){-most(drop, -value), most(drop, value)};
}

/* What the particles of all ranks add up to, about the middle of the drop, which moves. */
struct sums {
    double momentum[3], spin[3], size_of_momentum, square, along, across;
};
enum { SUMS = sizeof(struct sums) / sizeof(double) };

static void cross(const double *a, const double *b, double *product)
{
    for (int k = 0; k < 3; ++k)
        product[k] = a[(k + 1) % 3] * b[(k + 2) % 3] - a[(k + 2) % 3] * b[(k + 1) % 3];
}

static void add(struct sums *sums, const double *x, const double *v, const double *start)
{
    double spin[3];
    cross(x, v, spin);
    for (int a = 0; a < 3; ++a) {
        sums->momentum[a] += v[a];
        sums->spin[a] += spin[a];
        sums->square += x[a] * x[a];
    }
    sums->size_of_momentum += sqrt(v[0] * v[0] + v[1] * v[1] + v[2] * v[2]);
    sums->along += start[0] * x[0] + start[1] * x[1];
    sums->across += start[0] * x[1] - start[1] * x[0];
}

static double (*first_places(int layers, int count))[3]
{
    double(*places)[3] = resized(NULL, (size_t)count, sizeof *places);
    struct particle *all = resized(NULL, (size_t)count, sizeof *all);
    drop_fill(layers, 0, 1, all);
    for (int k = 0; k < count; ++k)
        for (int a = 0; a < 3; ++a)
            places[k][a] = all[k].x[a];
    free(all);
    return places;
}

/* Positions and velocities beside those of the middle. */
static struct sums sums_of(const struct drop *drop, double (*const first)[3])
{
    const struct particle *particles = (const struct particle *)(void *)drop->domain.items;
    struct sums sums = {.square = 0};
    double middle[3];
    drop_middle(drop, middle);
    for (int i = 0; i < drop->domain.own; ++i) {
        double x[3], v[3];
        for (int a = 0; a < 3; ++a) {
            x[a] = particles[i].x[a] - middle[a];
            v[a] = (double)particles[i].v[a] - drop_velocity[a];
        }
        add(&sums, x, v, first[particles[i].name]);
    }
    MPI_Allreduce(MPI_IN_PLACE, &sums, SUMS, MPI_DOUBLE, MPI_SUM, drop->domain.ranks);
    return sums;
}

/* ---- Places by name -------------------------------------------------------------------------- */

static struct placed *places(const struct drop *drop, int count)
{
    const struct particle *particles = (const struct particle *)(void *)drop->domain.items;
    const int own = drop->domain.own;
    struct placed *rows = resized(NULL, (size_t)own, sizeof *rows);
    for (int i = 0; i < own; ++i) {
        const double *x = particles[i].x;
        rows[i] = (struct placed){particles[i].name, {x[0], x[1], x[2]}};
    }
    struct placed *all = gather_by_name(drop->domain.ranks, rows, sizeof *rows, own, count);
    free(rows);
    return all;
}

/* ---- The report ------------------------------------------------------------------------------ */

struct report report_of(const struct drop *drop)
{
    const double steps = drop->given.steps, degree = 180 / acos(-1);
    const int count = drop_count(drop->given.layers);
    double(*first)[3] = first_places(drop->given.layers, count);
    double square = 0, spin = 0;
    const struct sums sums = sums_of(drop, first);
    for (int k = 0; k < count; ++k) {
        const double *x = first[k], around = x[0] * x[0] + x[1] * x[1];
        square += around + x[2] * x[2];
        spin += drop_spin * around;
    }
    struct report report = {.rank_count = drop->domain.rank_count,
                            .steps = drop->given.steps,
                            .settled = drop->settled,
                            .seconds = most(drop, drop->seconds) / steps,
                            .waiting = most(drop, drop->waiting) / steps,
                            .settling = most(drop, drop->settling) / steps,
                            .own = range(drop, drop->domain.own),
                            .ghosts = range(drop, drop->domain.ghosts),
                            .bytes = most(drop, (double)drop->transfer.bytes) / steps,
                            .messages = most(drop, (double)drop->transfer.messages) / steps,
                            .moved = sum(drop, (double)drop->domain.moved),
                            .pairs = sum(drop, (double)drop_pairs(drop)),
                            .angle = degree * atan2(sums.across, sums.along),
                            .exact_angle = degree * remainder(drop_spin * drop->time, 2 * acos(-1)),
                            .radius = sqrt(sums.square / square),
                            .count = count};
    const double *p = sums.momentum, *s = sums.spin;
    report.momentum = sqrt(p[0] * p[0] + p[1] * p[1] + p[2] * p[2]) / sums.size_of_momentum;
    report.spin = sqrt(s[0] * s[0] + s[1] * s[1] + (s[2] - spin) * (s[2] - spin)) / spin;
    report.places = places(drop, count);
    free(first);
    return report;
}

void report_free(struct report *report)
{
    free(report->places);
    report->places = NULL;
}

double report_difference(const struct report *many, const struct report *one)
{
    double largest = 0;
    for (int k = 0; k < many->count; ++k) {
        double square = 0;
        for (int a = 0; a < 3; ++a)
            square += pow(many->places[k].x[a] - one->places[k].x[a], 2);
        if (!(sqrt(square) <= largest))
            largest = sqrt(square);
    }
    return largest;
}
