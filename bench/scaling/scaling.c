/* SPDX-License-Identifier: MIT */
/* The command `scaling`. */
#include "scaling.h"
#include "commands.h"
#include "report/machine.h"
#include "report/plot.h"
#include "report/report.h"
#include <stdio.h>
#include <stdlib.h>
#include <string.h>

static struct cell cell_per_particle(const char *name, const struct scaling_case *one,
                                     enum work work)
{
    return cell_time(table_text("%s [ns]", name), name, &one->time[work], 1e6 / one->count,
                     "ns_per_particle", "%.1f (%.0f-%.0f)");
}

static struct table *table_of_cases(const struct scaling *scaling)
{
    struct table *table = table_create("scaling");
    for (int k = 0; k < scaling->case_count; ++k) {
        const struct scaling_case *one = &scaling->cases[k];
        if (k == 0 || strcmp(one->group, one[-1].group) != 0)
            table_section(table, one->group);
        TABLE_ROW(table, cell_text(NULL, "group", one->group), cell_text("", "label", one->label),
                  cell_count(NULL, "particles", one->count),
                  cell_count(NULL, "case_threads", one->threads),
                  cell_count(NULL, "dimension", one->cloud.dimension),
                  cell_number("pairs", "pairs_per_particle", "%.1f", one->pairs),
                  cell_number("bytes", "bytes_per_particle", "%.0f", one->bytes),
                  cell_per_particle("search", one, WORK_SEARCH),
                  cell_per_particle("matrices", one, WORK_MATRICES),
                  cell_per_particle("gradient", one, WORK_GRADIENT),
                  cell_per_particle("fused", one, WORK_FUSED),
                  cell_number("deficient %", NULL, "%.1f", 100 * one->deficient),
                  cell_number(NULL, "deficient_share", NULL, one->deficient),
                  cell_number("error", "error_max", "%.1e", one->error),
                  cell_count(NULL, "not_finite", one->not_finite));
    }
    return table;
}

static struct cell cell_speed_up(const char *name, const struct scaling_case *single,
                                 const struct scaling_case *one, enum work work)
{
    const double speed_up = samples_median(&single->time[work]) / samples_median(&one->time[work]);
    return cell_text(name, NULL,
                     table_text("%.2f, %.0f %%", speed_up, 100 * speed_up / one->threads));
}

/* Beside the first of the cases with more and more threads. */
static struct table *table_of_speed_ups(const struct scaling *scaling)
{
    struct table *table = table_create("");
    const struct scaling_case *single = NULL;
    for (int k = 0; k < scaling->case_count; ++k) {
        const struct scaling_case *one = &scaling->cases[k];
        if (strcmp(one->group, "threads") != 0)
            continue;
        single = single ? single : one;
        TABLE_ROW(table, cell_text("threads", NULL, one->label),
                  cell_speed_up("search", single, one, WORK_SEARCH),
                  cell_speed_up("matrices", single, one, WORK_MATRICES),
                  cell_speed_up("gradient", single, one, WORK_GRADIENT),
                  cell_speed_up("fused", single, one, WORK_FUSED),
                  cell_text("speed-up, efficiency", NULL, ""));
    }
    return table;
}

static void report_results(const struct scaling *scaling)
{
    const struct settings *settings = &scaling->settings;
    const struct table *cases = table_of_cases(scaling);
    struct report *report = report_create(settings);
    printf("particles  %s, lattice jittered by %g spacings, H = %g spacings, lattice order, but "
           "for what a\n           group changes; KGC, cubic spline, f32\n",
           text_grouped(settings->particles), settings->jitter, settings->support);
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
