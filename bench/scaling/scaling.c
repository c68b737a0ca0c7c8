/* SPDX-License-Identifier: MIT */
/* The command `scaling`. */
#include "scaling.h"
#include "commands.h"
#include "report/machine.h"
#include "report/plot.h"
#include "report/report.h"
#include "report/text.h"
#include <stdio.h>
#include <stdlib.h>
#include <string.h>

static struct table *table_of_cases(const struct scaling *scaling)
{
    static const char format[] = "%.1f (%.0f-%.0f)", unit[] = "ns_per_particle";
    static const struct column columns[] = {{NULL, "group", NULL, NULL},
                                            {"", "label", NULL, NULL},
                                            {NULL, "particles", NULL, NULL},
                                            {NULL, "case_threads", NULL, NULL},
                                            {NULL, "dimension", NULL, NULL},
                                            {"pairs", "pairs_per_particle", "%.1f", NULL},
                                            {"bytes", "bytes_per_particle", "%.0f", NULL},
                                            {"search [ns]", "search", format, unit},
                                            {"matrices [ns]", "matrices", format, unit},
                                            {"gradient [ns]", "gradient", format, unit},
                                            {"fused [ns]", "fused", format, unit},
                                            {"deficient %", NULL, "%.1f", NULL},
                                            {NULL, "deficient_share", NULL, NULL},
                                            {"error", "error_max", "%.1e", NULL},
                                            {NULL, "not_finite", NULL, NULL},
                                            {0}};
    struct table *table = table_create("scaling", columns);
    for (int k = 0; k < scaling->case_count; ++k) {
        const struct scaling_case *one = &scaling->cases[k];
        const double ns = 1e6 / one->count;
        if (k == 0 || strcmp(one->group, one[-1].group) != 0)
            table_section(table, one->group);
        TABLE_ROW(table, cell_text(one->group), cell_text(one->label), cell_count(one->count),
                  cell_count(one->threads), cell_count(one->cloud.dimension),
                  cell_number(one->pairs), cell_number(one->bytes),
                  cell_time(&one->time[WORK_SEARCH], ns), cell_time(&one->time[WORK_MATRICES], ns),
                  cell_time(&one->time[WORK_GRADIENT], ns), cell_time(&one->time[WORK_FUSED], ns),
                  cell_number(100 * one->deficient), cell_number(one->deficient),
                  cell_number(one->error), cell_count(one->not_finite));
    }
    return table;
}

/* Beside the first of the cases with more and more threads. */
static struct table *table_of_speed_ups(const struct scaling *scaling)
{
    static const struct column columns[] = {{"threads", NULL, NULL, NULL},
                                            {"search", NULL, NULL, NULL},
                                            {"matrices", NULL, NULL, NULL},
                                            {"gradient", NULL, NULL, NULL},
                                            {"fused", NULL, NULL, NULL},
                                            {"speed-up, efficiency", NULL, NULL, NULL},
                                            {0}};
    struct table *table = table_create("", columns);
    const struct scaling_case *single = NULL;
    for (int k = 0; k < scaling->case_count; ++k) {
        const struct scaling_case *one = &scaling->cases[k];
        struct cell cells[WORKS + 2] = {cell_text(one->label)};
        if (strcmp(one->group, "threads") != 0)
            continue;
        single = single ? single : one;
        for (int work = 0; work < WORKS; ++work) {
            const double speed_up =
                samples_median(&single->time[work]) / samples_median(&one->time[work]);
            cells[work + 1] =
                cell_text(table_text("%.2f, %.0f %%", speed_up, 100 * speed_up / one->threads));
        }
        cells[WORKS + 1] = cell_text("");
        table_add(table, cells, WORKS + 2);
    }
    return table;
}

static void report_results(const struct scaling *scaling)
{
    const struct settings *settings = &scaling->settings;
    const struct table *cases = table_of_cases(scaling);
    struct report *report = report_create(settings);
    char count[TEXT_SIZE];
    printf("particles  %s, lattice jittered by %g spacings, H = %g spacings, lattice order, but "
           "for what a\n           group changes; KGC, cubic spline, f32\n",
           text_grouped(settings->particles, count), settings->jitter, settings->support);
    report_machine(report);
    printf("times      ns a particle, median (min-max) of %d rounds through the cases of a group; "
           "fused:\n           matrices and gradient in one call; bytes: a particle, held by the "
           "neighbours\n",
           settings->repetitions);
    printf("errors     largest |J_i - J|_F / |J|_F of v = (-y, x, 2z), in 2D (-y, x), where rank "
           "is full\n");
    report_if_busy(report, &scaling->cases[0].time[WORK_FUSED]);
    report_number(report, "particles", settings->particles);
    report_table(report, cases);
    report_table(report, table_of_speed_ups(scaling));
    for (int k = 0; k < scaling->case_count; ++k)
        if (scaling->cases[k].not_finite > 0)
            printf("\nNOT FINITE: %lld numbers of %s, %s\n",
                   (long long)scaling->cases[k].not_finite, scaling->cases[k].group,
                   scaling->cases[k].label);
    table_write_csv(cases, settings->output, "scaling.csv");
    plot_written(settings->output, "scaling/scaling", "scaling.csv",
                 table_text("title = \"%d particles, H = %g spacings, %d thread%s, %s, but for "
                            "what a panel changes\"\nthreads = %d\n",
                            settings->particles, settings->support, settings->threads,
                            settings->threads > 1 ? "s" : "", machine_cpu(), settings->threads));
    report_write(report);
}

int command_scaling(int argc, char **argv)
{
    struct scaling scaling = {.settings = settings_default(1000000, 5, "scaling")};
    const struct command_option options[] = {
        OUTPUT_OPTION(scaling.settings, "CSV, script and picture", "scaling"),
        {"full", 0, NULL,
         "sizes up to 30 times the particles, not 10; some 250 bytes of memory each", OPTION_FLAG,
         &scaling.full, 0, 0, NULL, NULL},
        LATTICE_OPTIONS(scaling.settings),
        {0}};
    settings_read(&scaling.settings, options,
                  "Times search, matrices, gradient and both in one call for a tenth to ten times "
                  "the particles, for threads, neighbour counts, orders in memory and shapes of "
                  "the cloud.",
                  argc, argv);
    scaling_create_cases(&scaling);
    scaling_measure(&scaling);
    report_results(&scaling);
    return EXIT_SUCCESS;
}
