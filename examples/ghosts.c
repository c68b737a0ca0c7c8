/* SPDX-License-Identifier: MIT */
/* Ghosts between two processes, here the halves of a block in one. Each half has its own particles,
 * and behind them ghosts, copies of the other's within the support radius. For forces it receives
 * the corrections of its ghosts as well. Prints how far these forces are from those of the whole
 * block. */
#include <sphgrad/sphgrad.h>
#include <math.h>
#include <stdio.h>
#include <stdlib.h>
#include <string.h>

enum { SIDE = 10, LAYER = SIDE * SIDE, COUNT = SIDE * LAYER, OWN = COUNT / 2, GHOSTS = 2 * LAYER };

/* Layers are held from the bottom; by the upper half from the top, so that its own come first. */
struct domain {
    double x[COUNT][3], pressure[COUNT], correction[COUNT][6], force[COUNT][3];
    sphg_neighbors *neighbors;
    sphg_sources sources;
};
static struct domain lower, upper, whole;
static sphg_context *context;
static const sphg_scheme scheme = {.support_radius = 2};

static void check(sphg_result result)
{
    if (result != SPHG_OK) {
        fprintf(stderr, "%s\n", sphg_last_message(context));
        exit(EXIT_FAILURE);
    }
}

static int mirrored(int k) /* the same particle, counted from the other end */
{
    return (SIDE - 1 - k / LAYER) * LAYER + k % LAYER;
}

int main(void)
{
    const double volume = 1;
    double all = 0, difference = 0;
    struct domain *const domains[3] = {&lower, &upper, &whole};
    check(sphg_context_create(SPHG_VERSION, NULL, &context));
    for (int n = 0; n < 3; ++n) {
        struct domain *d = domains[n];
        const int own = d == &whole ? COUNT : OWN, ghosts = d == &whole ? 0 : GHOSTS;
        for (int k = 0; k < own + ghosts; ++k) { /* ghosts are there by the first exchange */
            const int place = d == &upper ? mirrored(k) : k;
            for (int a = 0, rest = place; a < 3; ++a, rest /= SIDE)
                d->x[k][a] = rest % SIDE;
            d->pressure[k] = sin(d->x[k][0] + 2 * d->x[k][2]);
        }
        const sphg_view table = sphg_view_f64(d->correction[0], sizeof d->correction[0]);
        const sphg_view positions = sphg_view_f64(d->x[0], sizeof d->x[0]);
        const sphg_geometry geometry = sphg_own_and_ghosts(positions, own, ghosts);
        check(sphg_neighbors_create(context, &d->neighbors));
        check(sphg_neighbors_search(context, d->neighbors, &scheme, &geometry));
        d->sources = (sphg_sources){d->neighbors, sphg_same_f64(&volume), .correction = table};
        check(sphg_correction(context, &scheme, &d->sources, NULL, table, sphg_absent()));
    }
    for (int k = OWN; k < OWN + GHOSTS; ++k) { /* the second exchange: rows of the tables */
        memcpy(lower.correction[k], upper.correction[mirrored(k)], sizeof lower.correction[k]);
        memcpy(upper.correction[k], lower.correction[mirrored(k)], sizeof upper.correction[k]);
    }
    for (int n = 0; n < 3; ++n) {
        const sphg_view pressure = sphg_view_f64(domains[n]->pressure, sizeof(double));
        const sphg_view force = sphg_view_f64(domains[n]->force[0], 3 * sizeof(double));
        check(
            sphg_force(context, &scheme, &domains[n]->sources, NULL, SPHG_SCALAR, pressure, force));
        sphg_neighbors_destroy(domains[n]->neighbors);
    }
    for (int k = 0; k < 3 * COUNT; ++k) {
        const int i = k / 3, a = k % 3;
        const double force = i < OWN ? lower.force[i][a] : upper.force[mirrored(i)][a];
        all += fabs(whole.force[i][a]);
        difference += fabs(force - whole.force[i][a]);
    }
    printf("forces differ by %.1e of their size\n", difference / all);
    sphg_context_destroy(context);
    return !(difference < 1e-12 * all);
}
