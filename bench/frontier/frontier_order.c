/* SPDX-License-Identifier: MIT */
/* Order 2 beside order 1, over H and N: time from positions to Jacobians against the error at the
 * boundary and inside, of a fixed field on a cube of ever finer particles. */
#include "fields/field_study.h"
#include "frontier.h"
#include "report/machine.h"
#include "report/plot.h"
#include "report/progress.h"
#include <stdio.h>

enum { WAYS = 4, SUPPORTS = 3, SIZES = 3, POINTS = WAYS * SUPPORTS * SIZES };

static const struct study_way ways[WAYS] = {{.name = "order 1", .method = SPHG_KGC},
                                            {.name = "classic", .method = SPHG_CMLS},
                                            {.name = "order 2", .order = 2},
                                            {.name = "order 2 lent", .order = 2, .lent = true}};
static const double supports[SUPPORTS] = {2, 2.5, 3};

struct order_point {
    const struct study_way *way;
    int lattice; /* over supports and sizes */
    struct study_errors errors;
    struct samples time;
};

static void derive(const struct study *study, const struct study_way *way)
{
    study_search(study);
    study_derive(study, way);
}

static void measure(const struct settings *settings, const struct study *studies,
                    struct order_point *points)
{
    for (int32_t round = -1; round < settings->repetitions; ++round)
        for (int k = 0; k < POINTS; ++k) {
            const struct study *study = &studies[points[k].lattice];
            progress_show("order 2: round %d of %d", round + 1, settings->repetitions);
            const struct moment start = now();
            derive(study, points[k].way);
            if (round < 0)
                points[k].errors = study_compare(study, NULL, NULL);
            else
                samples_add(&points[k].time, since(start));
        }
    progress_clear();
}

static struct table *table_of_points(const struct study *studies, const struct order_point *points)
{
    static const struct column columns[] = {{"", "way", NULL, NULL},
                                            {"H", "support", NULL, NULL},
                                            {"N", "side", NULL, NULL},
                                            {"ns", "", "%.0f (%.0f-%.0f)", "ns_per_particle"},
                                            {"ms", "all", "%.2f (%.2f-%.2f)", NULL},
                                            {"boundary max", "boundary_max", "%.2e", NULL},
                                            {"mean", "boundary_mean", "%.2e", NULL},
                                            {"inside max", "inside_max", "%.2e", NULL},
                                            {"mean", "inside_mean", "%.2e", NULL},
                                            {0}};
    struct table *table = table_create("order", columns);
    for (int k = 0; k < POINTS; ++k) {
        const struct order_point *point = &points[k];
        const struct study *study = &studies[point->lattice];
        const struct study_errors *e = &point->errors;
        if (k > 0 && k % (WAYS * SUPPORTS) == 0)
            table_section(table, NULL);
        TABLE_ROW(table, cell_text(point->way->name),
                  cell_text(table_text("%g", study->setting.support)),
                  cell_text(table_text("%d", study->setting.side)),
                  cell_time(&point->time, 1e6 / study->count), cell_time(&point->time, 1),
                  cell_number(e->most[STUDY_BOUNDARY]), cell_number(e->mean[STUDY_BOUNDARY]),
                  cell_number(e->most[STUDY_INSIDE]), cell_number(e->mean[STUDY_INSIDE]));
    }
    return table;
}

const struct table *frontier_order(const struct settings *settings)
{
    static const char *const parts[] = {"frontier/frontier_order.gp", NULL};
    const int32_t middle = settings_side(settings->particles, 3);
    struct study studies[SUPPORTS * SIZES];
    struct order_point *points = allocate_to_the_end(POINTS, sizeof *points);
    for (int k = 0; k < SUPPORTS * SIZES; ++k) {
        const int32_t side = (middle << k / SUPPORTS) / 2;
        const struct study_setting setting = {.dimension = 3,
                                              .threads = settings->threads,
                                              .side = side > 6 ? side : 6,
                                              .support = supports[k % SUPPORTS],
                                              .jitter = settings->jitter};
        studies[k] = study_open(&setting);
        study_fill(&studies[k], FIELD_TRIGONOMETRIC);
    }
    for (int k = 0; k < POINTS; ++k) {
        points[k].way = &ways[k / SUPPORTS % WAYS];
        points[k].lattice = k / SUPPORTS / WAYS * SUPPORTS + k % SUPPORTS;
    }
    measure(settings, studies, points);
    const struct table *table = table_of_points(studies, points);
    printf("\norder 2 beside order 1: N^3 particles in [-1, 1]^3, v = (cos 2x, cos y - sin 3x, cos "
           "2z), KGC (classic: CMLS), f32;\nerror |J_i - J|_F of the two outermost layers, and "
           "inside\n");
    table_print(table);
    table_write_csv(table, settings->output, "frontier_order.csv");
    const bool drawn =
        plot_draw(settings->output, "frontier_order.gp",
                  table_text("title = \"N = %d, %d, %d, jitter %g, %d thread%s, %s\"\n",
                             studies[0].setting.side, studies[SUPPORTS].setting.side,
                             studies[2 * SUPPORTS].setting.side, settings->jitter,
                             settings->threads, settings->threads > 1 ? "s" : "", machine_cpu()),
                  parts);
    printf("\nwritten to %s: frontier_order.csv, frontier_order.gp%s\n", settings->output,
           drawn ? ", frontier_order.png" : "");
    for (int k = 0; k < SUPPORTS * SIZES; ++k)
        study_close(&studies[k]);
    return table;
}
