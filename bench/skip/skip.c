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
    struct table *table = table_create("skip");
    for (int k = 0; k < SKIP_ROWS; ++k) {
        const struct skip_row *row = &skip_rows[k];
        const struct skip_result *result = &skip->results[k];
        const struct samples *full = &skip->times[k][0], *part = &skip->times[k][1];
        if (k > 0 && strcmp(row->group, skip_rows[k - 1].group) != 0)
            table_section(table, NULL);
        TABLE_ROW(table, cell_text(NULL, "group", row->group), cell_text("what", "what", row->what),
                  cell_text("against", NULL, row->against), cell_ms("full [ms]", "full", full),
                  cell_ms("this [ms]", "this", part),
                  cell_number("saved %", "saved_percent", "%.0f",
                              100 * (1 - samples_median(part) / samples_median(full))),
                  cell_text("exact", NULL, exactness(row, result)),
                  cell_number(NULL, "compared", NULL, skip_is_compared(row)),
                  cell_count(NULL, "targets_with_other_bits", result->differences),
                  cell_number(NULL, "deviation", NULL, result->deviation));
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
