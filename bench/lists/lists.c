/* SPDX-License-Identifier: MIT */
/* The command `lists`. */
#include "lists.h"
#include "commands.h"
#include "report/machine.h"
#include "report/report.h"
#include "report/text.h"
#include <stdio.h>
#include <stdlib.h>

static const char time_format[] = "%.3f (%.3f-%.3f)";

static struct table *table_of_supplies(const struct lists *lists, double ns_a_pair)
{
    static const char *const names[SUPPLIES] = {"kept lists",          "list-free",
                                                "host's CSR",          "host's rows",
                                                "host's row function", "host's CSR, copied"};
    static const struct column columns[] = {{"sums over", "supply", NULL, NULL},
                                            {"build", "build", time_format, "ns_per_pair"},
                                            {"matrices", "matrices", time_format, "ns_per_pair"},
                                            {"gradient", "gradient", time_format, "ns_per_pair"},
                                            {"fused", "fused", time_format, "ns_per_pair"},
                                            {"error", "error_max", "%.1e", NULL},
                                            {NULL, "pairs", NULL, NULL},
                                            {0}};
    struct table *table = table_create("lists/sums", columns);
    for (int supply = 0; supply < SUPPLIES; ++supply) {
        const struct samples *times = lists->supplied[supply];
        TABLE_ROW(table, cell_text(names[supply]), cell_time(&times[WORK_BUILD], ns_a_pair),
                  cell_time(&times[WORK_MATRICES], ns_a_pair),
                  cell_time(&times[WORK_GRADIENT], ns_a_pair),
                  cell_time(&times[WORK_FUSED], ns_a_pair),
                  cell_number(lists->supplied_error[supply]), cell_count(lists->pairs));
    }
    return table;
}

static struct table *table_of_exports(const struct lists *lists, double ns_a_pair)
{
    static const struct column columns[] = {{"pairs written out", "what", NULL, NULL},
                                            {"time", "", time_format, "ns_per_pair"},
                                            {"error", "error_max", "%.1e", NULL},
                                            {0}};
    struct table *table = table_create("lists/pairs", columns);
    for (int k = 0; k < EXPORTS; ++k)
        TABLE_ROW(table, cell_text(lists_exports[k].name),
                  cell_time(&lists->exported[k], ns_a_pair),
                  lists_exports[k].gradients ? cell_number(lists->exported_error[k]) : cell_none());
    return table;
}

static void report_results(const struct lists *lists)
{
    const struct settings *settings = &lists->settings;
    const double ns_a_pair = 1e6 / (double)lists->pairs;
    struct table *supplies = table_of_supplies(lists, ns_a_pair),
                 *exports = table_of_exports(lists, ns_a_pair);
    text_print_lattice(settings, lists->count, (double)lists->pairs / lists->count);
    printf("; KGC, cubic spline, %s\n", precision_names[settings->precision]);
    text_print_machine(settings->threads);
    printf("times      ns a pair, median (min-max) of %d rounds through everything; gradient and "
           "pairs written out:\n           with matrices that are there; error: largest |J_i - "
           "J|_F / |J|_F of v = (-y, x, 2z)\n",
           settings->repetitions);
    text_print_if_busy(&lists->supplied[SUPPLY_KEPT][WORK_FUSED], settings->threads);
    table_print(supplies);
    table_print(exports);

    struct report *report = report_create(settings->threads);
    report_lattice(report, settings, lists->count, (double)lists->pairs / lists->count);
    report_table(report, supplies);
    report_table(report, exports);
    report_write(report, settings->json);
}

int command_lists(int argc, char **argv)
{
    struct lists lists = {.settings = {.particles = 100000,
                                       .threads = machine_threads(),
                                       .repetitions = 15,
                                       .support = 2,
                                       .jitter = 0.2}};
    const struct command_option options[] = {
        PRECISION_OPTION(lists.settings, "f32"), LATTICE_OPTIONS(lists.settings), {0}};
    settings_read(&lists.settings, options,
                  "Times a pair of sums over the library's lists and over a host's (arrays, "
                  "pointers, a function), and of pairs that are written out: indices, gradients, "
                  "sorted or in any order. Takes some seconds.",
                  argc, argv);
    lists_measure(&lists);
    report_results(&lists);
    return EXIT_SUCCESS;
}
