/* The command `skip`. */
#include "skip.h"
#include "commands.h"
#include "report/machine.h"
#include "options.h"
#include "report/progress.h"
#include "skip_compare.h"

#include <stdlib.h>

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
    samples_add_since(&result->full, full_start);
    const struct moment part_start = now();
    row->part(stage, &stage->solid.part, row->parameter);
    samples_add_since(&result->part, part_start);
}

static void keep_matrices(struct skip_stage *stage)
{
    const sphg_sources sources = {.neighbors = stage->solid.kept,
                                  .volume = numbers_view(&stage->volumes)};
    library_check(stage->context,
                  sphg_correction(stage->context, &stage->solid.scheme, &sources, NULL,
                                  numbers_view(&stage->corrections), sphg_absent()));
}

static void measure(struct skip *skip)
{
    progress_show("warm-up");
    struct skip_stage stage = skip_stage_create(&skip->settings);
    skip->count = stage.solid.positions.count;
    skip->pairs = (double)stage.solid.info.pairs / skip->count;
    skip->plane_pairs = (double)stage.plane.info.pairs / stage.plane.positions.count;
    keep_matrices(&stage);
    for (stage.positions_are_moved = 0; stage.positions_are_moved < 2; stage.positions_are_moved++)
        for (int k = 0; k < skip_row_count; k++)
            compare_row(&stage, &skip_rows[k], &skip->results[k]);
    for (int32_t round = 0; round < skip->settings.repetitions; round++) {
        stage.positions_are_moved = round % 2;
        for (int k = 0; k < skip_row_count; k++) {
            progress_show("round %d of %d: %s", round + 1, skip->settings.repetitions,
                          skip_rows[k].what);
            time_row(&stage, &skip_rows[k], &skip->results[k]);
        }
    }
    progress_clear();
    skip->skin_was_spent = stage.skin_was_spent;
    skip_stage_destroy(&stage);
}

static error_t parse_option(int key, char *text, struct argp_state *state)
{
    struct skip *skip = state->input;
    (void)text;
    if (key != ARGP_KEY_INIT)
        return ARGP_ERR_UNKNOWN;
    state->child_inputs[0] = &skip->settings;
    return 0;
}

int command_skip(int argc, char **argv)
{
    struct skip skip = {.settings = {.particles = 1000000,
                                     .threads = machine_threads(),
                                     .repetitions = 9,
                                     .support = 2,
                                     .jitter = 0.2}};
    const struct argp_child children[] = {{&settings_argp, 0, NULL, 0}, {NULL, 0, NULL, 0}};
    const struct argp argp = {
        .parser = parse_option,
        .children = children,
        .doc = "Times parts of an evaluation beside the whole: outputs that are not wanted, "
               "particles that are not active, neighbours that are still known. Says where "
               "results are the same to the bit."};
    options_parse(&argp, argc, argv, &skip);
    skip.results = allocate_or_exit((size_t)skip_row_count, sizeof *skip.results);
    for (int k = 0; k < skip_row_count; k++) {
        skip.results[k].part = samples_create(skip.settings.repetitions);
        skip.results[k].full = samples_create(skip.settings.repetitions);
    }
    measure(&skip);
    skip_print(&skip);
    if (skip.settings.json)
        skip_write_json(&skip, skip.settings.json, "sphgrad-bench");
    for (int k = 0; k < skip_row_count; k++) {
        samples_destroy(&skip.results[k].part);
        samples_destroy(&skip.results[k].full);
    }
    free(skip.results);
    return EXIT_SUCCESS;
}
