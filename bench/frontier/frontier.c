/* SPDX-License-Identifier: MIT */
/* The command `frontier`. */
#include "frontier.h"
#include "commands.h"
#include "numbers.h"
#include "report/machine.h"
#include "report/plot.h"
#include "report/report.h"
#include <stdio.h>
#include <stdlib.h>

/* Every way; plain SPH has no matrices and so no table of them. */
static void create_points(struct frontier *frontier)
{
    const int room = FRONTIER_METHODS * FRONTIER_KERNELS * FRONTIER_PRECISIONS * PATHS * 2;
    frontier->points = allocate_to_the_end((size_t)room, sizeof *frontier->points);
    for (int k = 0; k < room; ++k) {
        const struct frontier_point point = {
            .by_table = k % 2,
            .path = (enum frontier_path)(k / 2 % PATHS),
            .precision = (enum precision)(k / 2 / PATHS % FRONTIER_PRECISIONS),
            .kernel = (sphg_kernel)(k / 2 / PATHS / FRONTIER_PRECISIONS % FRONTIER_KERNELS),
            .method = (sphg_method)(k / 2 / PATHS / FRONTIER_PRECISIONS / FRONTIER_KERNELS)};
        if (point.method != SPHG_PLAIN || !point.by_table)
            frontier->points[frontier->point_count++] = point;
    }
}

/* ---- Tables ---------------------------------------------------------------------------------- */

static void add_point(struct table *table, const struct frontier *frontier,
                      const struct frontier_point *point)
{
    static const char *const paths[PATHS] = {"kept lists", "list-free", "host's lists"};
    TABLE_ROW(table, cell_text("method", "method", method_names[point->method]),
              cell_text("kernel", "kernel", kernel_names[point->kernel]),
              cell_text("type", "precision", precision_names[point->precision]),
              cell_text("path", "path", paths[point->path]),
              cell_text("option", "option",
                        point->method == SPHG_PLAIN ? "one sweep"
                        : point->by_table           ? "table"
                                                    : "fused"),
              cell_time("ns", "", &point->time, 1e6 / frontier->count, "ns_per_particle",
                        "%.1f (%.0f-%.0f)"),
              cell_number("trig. mean", "trigonometric_mean", "%.2e", point->mean[0]),
              cell_number("max", "trigonometric_max", "%.1e", point->most[0]),
              cell_number("lin. mean", "linear_mean", "%.1e", point->mean[1]),
              cell_number("max", "linear_max", "%.1e", point->most[1]),
              cell_number(NULL, "trigonometric_frontier", NULL, point->on_frontier[0]),
              cell_number(NULL, "linear_frontier", NULL, point->on_frontier[1]));
}

/* Points lie in the order of their times: the first is the fastest. */
static void add_fastest(struct table *table, const struct frontier *frontier, sphg_method method,
                        enum precision precision, enum frontier_side side)
{
    for (int k = 0; k < frontier->point_count; ++k) {
        const struct frontier_point *point = &frontier->points[k];
        if (point->method == method && point->precision == precision &&
            frontier_side(point) == side) {
            add_point(table, frontier, point);
            return;
        }
    }
}

static void print_fastest(const struct frontier *frontier)
{
    struct table *table = table_create("frontier");
    printf("\nfastest way of each method and precision, whatever its error\n");
    for (int k = 0; k < FRONTIER_METHODS * FRONTIER_PRECISIONS * SIDES; ++k)
        add_fastest(table, frontier, (sphg_method)(k / SIDES / FRONTIER_PRECISIONS),
                    (enum precision)(k / SIDES % FRONTIER_PRECISIONS),
                    (enum frontier_side)(k % SIDES));
    table_print(table);
}

static void print_frontier(const struct frontier *frontier, enum frontier_field field,
                           enum frontier_side side, const char *title)
{
    struct table *table = table_create("frontier");
    for (int k = 0; k < frontier->point_count; ++k)
        if (frontier->points[k].on_frontier[field] && frontier_side(&frontier->points[k]) == side)
            add_point(table, frontier, &frontier->points[k]);
    printf("\n%s\n", title);
    table_print(table);
}

/* ---- The whole ------------------------------------------------------------------------------- */

static void print_results(const struct frontier *frontier, const struct report *report)
{
    const struct settings *settings = &frontier->settings;
    printf("particles  %s, a block with free surfaces, jittered by %g spacings, H = %g spacings, "
           "%.1f pairs a particle\n",
           text_grouped(frontier->count), settings->jitter, settings->support, frontier->pairs);
    report_machine(report);
    printf("times      ns a particle from positions to Jacobians, median (min-max) of %d rounds "
           "through %d ways;\n           host's lists: taken over, not searched for\n",
           settings->repetitions, frontier->point_count);
    printf("errors     |J_i - J|_F over the root mean square of |J|_F, over all particles, of\n"
           "           v_a = sin(k x_a) cos(k x_b), 20 spacings a wave, and of v = (-y, x, 2z)\n");
    report_if_busy(report, &frontier->points[0].time);
    print_fastest(frontier);
    print_frontier(
        frontier, FRONTIER_TRIGONOMETRIC, SIDE_SEARCH,
        "frontier: nothing is faster and, on average, nearer to the trigonometric field");
    print_frontier(frontier, FRONTIER_LINEAR, SIDE_SEARCH,
                   "frontier: nothing is faster and, at worst, nearer to the linear field");
    print_frontier(frontier, FRONTIER_TRIGONOMETRIC, SIDE_HOST,
                   "the first frontier of those who search for themselves");
    print_frontier(frontier, FRONTIER_LINEAR, SIDE_HOST, "and the second");
}

static void write_results(const struct frontier *frontier, struct report *report)
{
    const struct settings *settings = &frontier->settings;
    struct table *all = table_create("frontier");
    for (int k = 0; k < frontier->point_count; ++k)
        add_point(all, frontier, &frontier->points[k]);
    table_write_csv(all, settings->output, "frontier.csv");
    plot_written(settings->output, "frontier/frontier", "frontier.csv",
                 table_text("title = \"%d particles, H = %g spacings, %d thread%s, %s\"\n",
                            frontier->count, settings->support, settings->threads,
                            settings->threads > 1 ? "s" : "", machine_cpu()));
    report_lattice_numbers(report, frontier->count, frontier->pairs);
    report_times(report, all);
}

int command_frontier(int argc, char **argv)
{
    struct frontier frontier = {.settings = settings_default(27000, 7, "frontier")};
    const struct settings *settings = &frontier.settings;
    bool order_alone = false;
    const struct command_option options[] = {
        OUTPUT_OPTION(frontier.settings, "CSV, script and picture", "frontier"),
        {"order", 0, NULL, "order 2 beside order 1 alone", OPTION_FLAG, &order_alone, 0, 0, NULL,
         NULL},
        LATTICE_OPTIONS(frontier.settings),
        {0}};
    settings_read(settings, options,
                  "Times every way to a velocity gradient (method, kernel, precision, path, "
                  "option) from positions to result, and measures its error on a block with free "
                  "surfaces: which are worth their time.",
                  argc, argv);
    struct report *report = report_create(settings);
    if (order_alone) {
        report_machine(report);
    } else {
        create_points(&frontier);
        frontier_measure(&frontier);
        print_results(&frontier, report);
        write_results(&frontier, report);
    }
    frontier_order(settings, report);
    report_write(report);
    return EXIT_SUCCESS;
}
