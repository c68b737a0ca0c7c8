/* SPDX-License-Identifier: MIT */
/* What a step of the rotating drop costs on many ranks: a model from what was measured on few. It
 * holds for boxes inside a large fluid, cubes with neighbours on all sides. */
#include <math.h>
#include <stdio.h>
#include <stdlib.h>

static const char usage[] =
    "scaling [PARTICLE [GHOST [LATENCY [BANDWIDTH]]]]\n"
    "  PARTICLE   microseconds that an own particle costs a step, on one core (0.55)\n"
    "  GHOST      microseconds for a ghost: choice, packing, search (0.6)\n"
    "  LATENCY    microseconds from one rank to another (2)\n"
    "  BANDWIDTH  gigabytes a second of one rank, its share of the network (0.4)\n";

enum { PARTICLE, GHOST, LATENCY, BANDWIDTH, NUMBERS };

/* Of the drop: H of 2 spacings and a skin of 0.3 H; positions in f64, velocities, then C and stress
 * in f32; a choice of ghosts each fifth step. */
static const double reach = 2 * 1.3, bytes_of_position = 24, bytes_of_velocity = 12,
                    bytes_of_second = 48, steps_between = 5;

/* Boxes that touch a box, and bytes of a count in the Alltoall of a choice. */
static const double neighbours = 26, count_message = .1; /* [us] for each rank */

struct cost { /* [us] */
    double own, ghosts, exchange, hidden, decision;
};

/* To all neighbours, one after the other through the same network card. */
static double time_of(const double *given, double ghosts, double bytes)
{
    return neighbours * given[LATENCY] + ghosts * bytes / (1e3 * given[BANDWIDTH]);
}

static double ghosts_of(double particles)
{
    return pow(cbrt(particles) + 2 * reach, 3) - particles;
}

/* Velocities travel during the search and the sums over inner particles, C and stress during the
 * forces on these; both sums take about half of the time. Positions travel while everybody waits.
 */
static struct cost cost_of(const double *given, double particles, double ranks)
{
    const double ghosts = ghosts_of(particles), own = given[PARTICLE] * particles;
    const double inner = pow(fmax(cbrt(particles) - 2 * reach, 0), 3) / particles;
    const double velocity = time_of(given, ghosts, bytes_of_velocity);
    const double second = time_of(given, ghosts, bytes_of_second);
    return (struct cost){.own = own,
                         .ghosts = given[GHOST] * ghosts,
                         .exchange = velocity + second + time_of(given, ghosts, bytes_of_position),
                         .hidden = fmin(velocity, inner * own / 2) + fmin(second, inner * own / 2),
                         .decision = 2 * log2(ranks) * given[LATENCY] +
                                     ranks * count_message / steps_between};
}

static void print_row(const double *given, double particles)
{
    static const double ranks[] = {64, 4096, 65536};
    const struct cost c = cost_of(given, particles, ranks[0]);
    printf("%9.0f %10.2f %9.3f %9.3f %9.3f %9.3f ", particles, ghosts_of(particles) / particles,
           c.own / 1e3, c.ghosts / 1e3, c.exchange / 1e3, c.hidden / 1e3);
    for (int k = 0; k < 3; ++k) {
        const struct cost all = cost_of(given, particles, ranks[k]);
        const double step = all.own + all.ghosts + all.exchange - all.hidden + all.decision;
        printf(" %6.0f %%", 100 * all.own / step);
    }
    putchar('\n');
}

int main(int count, char **words)
{
    double given[NUMBERS] = {.55, .6, 2, .4};
    for (int k = 1; k < count; ++k) {
        char *end = words[k];
        const double value = strtod(words[k], &end);
        if (k > NUMBERS || *end || end == words[k] || !(value > 0) || !isfinite(value)) {
            fputs(usage, stderr);
            return 2;
        }
        given[k - 1] = value;
    }
    printf("Model: %g us a particle, %g us a ghost, latency %g us, %g GB/s a rank\n\n"
           "%9s %10s %39s   %s\n%9s %10s %9s %9s %9s %9s   %7s %8s %8s\n",
           given[PARTICLE], given[GHOST], given[LATENCY], given[BANDWIDTH], "particles", "ghosts",
           "milliseconds a step", "efficiency on ... ranks", "a rank", "/ particle", "own",
           "ghosts", "exchange", "hidden", "64", "4096", "65536");
    for (double particles = 1e3; particles < 2e6; particles *= 10)
        print_row(given, particles);
    return 0;
}
