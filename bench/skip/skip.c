/* SPDX-License-Identifier: MIT */
/* The command `skip`. */
#include "skip.h"
#include "commands.h"
#include "report/report.h"
#include <stdio.h>
#include <stdlib.h>
#include <string.h>

static const char *exactness(const struct skip_row *row, const struct skip_result *result)
{
    if (!skip_is_compared(row))
        return "-";
    return result->differences == 0 ? "same bits" : table_text("off by %.1e", result->deviation);
}

static struct table *table_of(const struct skip *skip)
{
    static const struct column columns[] = {{NULL, "group", NULL, NULL},
                                            {"what", "what", NULL, NULL},
                                            {"against", NULL, NULL, NULL},
                                            {"full [ms]", "full", NULL, NULL},
                                            {"this [ms]", "this", NULL, NULL},
                                            {"saved %", "saved_percent", "%.0f", NULL},
                                            {"exact", NULL, NULL, NULL},
                                            {NULL, "compared", NULL, NULL},
                                            {NULL, "targets_with_other_bits", NULL, NULL},
                                            {NULL, "deviation", NULL, NULL},
                                            {0}};
    struct table *table = table_create("skip", columns);
    for (int k = 0; k < SKIP_ROWS; ++k) {
        const struct skip_row *row = &skip_rows[k];
        const struct skip_result *result = &skip->results[k];
        const struct samples *times = skip->times[k];
        if (k > 0 && strcmp(row->group, skip_rows[k - 1].group) != 0)
            table_section(table, NULL);
        TABLE_ROW(table, cell_text(row->group), cell_text(row->what), cell_text(row->against),
                  cell_time(&times[0], 1), cell_time(&times[1], 1),
                  cell_number(100 * (1 - samples_median(&times[1]) / samples_median(&times[0]))),
                  cell_text(exactness(row, result)), cell_number(skip_is_compared(row)),
                  cell_count(result->differences), cell_number(result->deviation));
    }
    return table;
}

static void report_results(const struct skip *skip)
{
    struct report *report = report_create(&skip->settings);
    report_lattice(report, skip->count, skip->pairs);
    printf("; 2D: %.2f\n", skip->plane_pairs);
    printf("scheme     KGC, cubic spline, f32; neighbours kept and found before, unless it says "
           "search\n");
    report_machine(report);
    printf("times      median (min-max) of %d rounds [ms]; exact: compared with the full result\n",
           skip->settings.repetitions);
    report_if_busy(report, &skip->times[0][0]);
    report_number(report, "skin_was_spent", skip->skin_was_spent);
    report_table(report, table_of(skip));
    if (skip->skin_was_spent)
        printf("\nThe skin did not hold: its row includes searches that found pairs anew.\n");
    report_write(report);
}

int command_skip(int argc, char **argv)
{
    struct skip skip = {.settings = settings_default(1000000, 9, NULL)};
    const struct command_option options[] = {LATTICE_OPTIONS(skip.settings), {0}};
    settings_read(&skip.settings, options,
                  "Times parts of an evaluation beside the whole: outputs that are not wanted, "
                  "particles that are not active, neighbours that are still known. Says where "
                  "results are the same to the bit.",
                  argc, argv);
    skip_measure(&skip);
    report_results(&skip);
    return EXIT_SUCCESS;
}
