/* SPDX-License-Identifier: MIT */
/* The command `forces`. */
#include "forces.h"
#include "commands.h"
#include "report/machine.h"
#include "report/report.h"
#include "report/text.h"
#include <stdio.h>
#include <stdlib.h>

static void report_results(const struct forces *forces)
{
    static const struct column columns[] = {
        {"operator", "operator", NULL, NULL}, {"method", "method", NULL, NULL},
        {"kept lists", "lists", NULL, NULL},  {"kept weights", "lists and weights", NULL, NULL},
        {"error", "error", "%.1e", NULL},     {0}};
    const struct settings *settings = &forces->settings;
    struct table *table = table_create("forces", columns);
    for (int k = 0; k < FORCE_CASES; ++k)
        TABLE_ROW(table, cell_text(force_cases[k].name),
                  cell_text(method_names[force_cases[k].method]),
                  cell_time(&forces->times[k][0], 1), cell_time(&forces->times[k][1], 1),
                  cell_number(forces->error[k]));

    text_print_lattice(settings, forces->count, forces->pairs);
    printf("; cubic spline, %s\n", precision_names[settings->precision]);
    text_print_machine(settings->threads);
    printf("times      ms, median (min-max) of %d rounds; corrections are there\n"
           "error      adjoint and symmetric: |sum f| / sum |f|, which conservation makes 0; "
           "difference: largest\n           relative error of div (-y, x, 2z)\n",
           settings->repetitions);
    text_print_if_busy(&forces->times[0][0], settings->threads);
    table_print(table);

    struct report *report = report_create(settings->threads);
    report_lattice(report, settings, forces->count, forces->pairs);
    report_table(report, table);
    report_write(report, settings->json);
}

int command_forces(int argc, char **argv)
{
    struct forces forces = {.settings = {.particles = 1000000,
                                         .threads = machine_threads(),
                                         .repetitions = 9,
                                         .support = 2,
                                         .jitter = 0.2}};
    const struct command_option options[] = {
        PRECISION_OPTION(forces.settings, "f32"), LATTICE_OPTIONS(forces.settings), {0}};
    settings_read(&forces.settings, options,
                  "Times the operators that a solver iterates: forces in the adjoint and the "
                  "symmetric form and divergences, with lists alone and with weights that "
                  "neighbours keep. Takes some ten seconds.",
                  argc, argv);
    forces_measure(&forces);
    report_results(&forces);
    return EXIT_SUCCESS;
}
