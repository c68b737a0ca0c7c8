/* SPDX-License-Identifier: MIT */
/* The command `skip`. */
#include "skip.h"
#include "commands.h"
#include "report/machine.h"
#include "report/progress.h"
#include "report/report.h"
#include "report/text.h"
#include "skip_compare.h"
#include <stdio.h>
#include <stdlib.h>
#include <string.h>

/* The first run of a row is for the comparison, untimed, and warms up. */
static void compare_row(struct skip_stage *stage, const struct skip_row *row,
                        struct skip_result *result)
{
    skip_spoil(row, &stage->solid.full);
    skip_spoil(row, &stage->solid.part);
    row->full(stage, &stage->solid.full, row->parameter);
    row->part(stage, &stage->solid.part, row->parameter);
    skip_compare(stage, row, result);
}

static void time_row(struct skip_stage *stage, const struct skip_row *row,
                     struct skip_result *result)
{
    const struct moment full_start = now();
    row->full(stage, &stage->solid.full, row->parameter);
    samples_add(&result->full, since(full_start));
    const struct moment part_start = now();
    row->part(stage, &stage->solid.part, row->parameter);
    samples_add(&result->part, since(part_start));
}

static void keep_matrices(struct skip_stage *stage)
{
    const sphg_sources sources = {.neighbors = stage->solid.kept,
                                  .volume = numbers_view(&stage->volumes)};
    library_correct(stage->context, &stage->solid.scheme, &sources,
                    numbers_view(&stage->corrections), NULL);
}

static void measure(struct skip *skip)
{
    progress_show("warm-up");
    struct skip_stage stage = skip_stage_create(&skip->settings);
    skip->count = stage.solid.positions.count;
    skip->pairs = (double)stage.solid.info.pairs / skip->count;
    skip->plane_pairs = (double)stage.plane.info.pairs / stage.plane.positions.count;
    keep_matrices(&stage);
    for (stage.positions_are_moved = 0; stage.positions_are_moved < 2; ++stage.positions_are_moved)
        for (int k = 0; k < skip_row_count; ++k)
            compare_row(&stage, &skip_rows[k], &skip->results[k]);
    for (int32_t round = 0; round < skip->settings.repetitions; ++round) {
        stage.positions_are_moved = round % 2;
        for (int k = 0; k < skip_row_count; ++k) {
            progress_show("round %d of %d: %s", round + 1, skip->settings.repetitions,
                          skip_rows[k].what);
            time_row(&stage, &skip_rows[k], &skip->results[k]);
        }
    }
    progress_clear();
    skip->skin_was_spent = stage.skin_was_spent;
    skip_stage_destroy(&stage);
}

static const char *exactness(const struct skip_row *row, const struct skip_result *result)
{
    if (row->compared == 0)
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
    for (int k = 0; k < skip_row_count; ++k) {
        const struct skip_row *row = &skip_rows[k];
        const struct skip_result *result = &skip->results[k];
        if (k > 0 && strcmp(row->group, skip_rows[k - 1].group) != 0)
            table_section(table, NULL);
        TABLE_ROW(
            table, cell_text(row->group), cell_text(row->what), cell_text(row->against),
            cell_time(&result->full, 1), cell_time(&result->part, 1),
            cell_number(100 * (1 - samples_median(&result->part) / samples_median(&result->full))),
            cell_text(exactness(row, result)), cell_number(row->compared != 0),
            cell_count(result->differences), cell_number(result->deviation));
    }
    return table;
}

static void report_results(const struct skip *skip)
{
    const struct settings *settings = &skip->settings;
    const struct table *table = table_of(skip);
    text_print_lattice(settings, skip->count, skip->pairs);
    printf("; 2D: %.2f\n", skip->plane_pairs);
    printf("scheme     KGC, cubic spline, f32; neighbours kept and found before, unless it says "
           "search\n");
    text_print_machine(settings->threads);
    printf("times      median (min-max) of %d rounds [ms]; exact: compared with the full result\n",
           settings->repetitions);
    text_print_if_busy(&skip->results[0].full, settings->threads);
    table_print(table);
    if (skip->skin_was_spent)
        printf("\nThe skin did not hold: its row includes searches that found pairs anew.\n");

    struct report *report = report_create(settings->threads);
    report_lattice(report, settings, skip->count, skip->pairs);
    report_number(report, "skin_was_spent", skip->skin_was_spent);
    report_table(report, table);
    report_write(report, settings->json);
}

int command_skip(int argc, char **argv)
{
    struct skip skip = {.settings = {.particles = 1000000,
                                     .threads = machine_threads(),
                                     .repetitions = 9,
                                     .support = 2,
                                     .jitter = 0.2}};
    const struct command_option options[] = {LATTICE_OPTIONS(skip.settings), {0}};
    settings_read(&skip.settings, options,
                  "Times parts of an evaluation beside the whole: outputs that are not wanted, "
                  "particles that are not active, neighbours that are still known. Says where "
                  "results are the same to the bit.",
                  argc, argv);
    skip.results = allocate_to_the_end((size_t)skip_row_count, sizeof *skip.results);
    measure(&skip);
    report_results(&skip);
    return EXIT_SUCCESS;
}
