/* The command `frontier`. */
#include "frontier.h"
#include "commands.h"
#include "report/machine.h"
#include "particles/numbers.h"
#include "options.h"

#include <stdio.h>
#include <stdlib.h>

enum { OPTION_OUTPUT = 256 };

static const struct argp_option option_list[] = {
    {"output", OPTION_OUTPUT, "FOLDER", 0, "where CSV, script and picture go (frontier)", 0}, {0}};

static error_t parse_option(int key, char *text, struct argp_state *state)
{
    struct frontier *frontier = state->input;
    switch (key) {
    case ARGP_KEY_INIT:
        state->child_inputs[0] = &frontier->settings;
        return 0;
    case OPTION_OUTPUT:
        frontier->output = text;
        return 0;
    default:
        return ARGP_ERR_UNKNOWN;
    }
}

/* Every way; plain SPH has no matrices and so no table of them. */
static void create_points(struct frontier *frontier)
{
    const int room = FRONTIER_METHODS * FRONTIER_KERNELS * FRONTIER_PRECISIONS * PATHS * 2;
    frontier->points = allocate_or_exit((size_t)room, sizeof *frontier->points);
    for (int k = 0; k < room; k++) {
        const struct frontier_point point = {
            .by_table = k % 2,
            .path = (enum frontier_path)(k / 2 % PATHS),
            .precision = (enum precision)(k / 2 / PATHS % FRONTIER_PRECISIONS),
            .kernel = (sphg_kernel)(k / 2 / PATHS / FRONTIER_PRECISIONS % FRONTIER_KERNELS),
            .method = (sphg_method)(k / 2 / PATHS / FRONTIER_PRECISIONS / FRONTIER_KERNELS)};
        if (point.method == SPHG_PLAIN && point.by_table)
            continue;
        frontier->points[frontier->point_count] = point;
        frontier->points[frontier->point_count++].time =
            samples_create(frontier->settings.repetitions);
    }
}

int command_frontier(int argc, char **argv)
{
    struct frontier frontier = {.settings = {.particles = 27000,
                                             .threads = machine_threads(),
                                             .repetitions = 7,
                                             .support = 2,
                                             .jitter = 0.2},
                                .output = "frontier"};
    const struct argp_child children[] = {{&settings_argp, 0, NULL, 0}, {NULL, 0, NULL, 0}};
    const struct argp argp = {
        .options = option_list,
        .parser = parse_option,
        .children = children,
        .doc = "Times every way to a velocity gradient (method, kernel, precision, path, option) "
               "from positions to result, and measures its error on a block with free surfaces: "
               "which are worth their time."};
    options_parse(&argp, argc, argv, &frontier);
    option_folder("output", frontier.output);
    create_points(&frontier);
    frontier_measure(&frontier);
    frontier_print(&frontier);
    frontier_write_csv(&frontier);
    frontier_write_steps(&frontier);
    if (frontier.settings.json)
        frontier_write_json(&frontier, frontier.settings.json, "sphgrad-bench");
    const bool drawn = frontier_draw(&frontier);
    printf("\nwritten to %s: frontier.csv, frontier_steps.csv, frontier.gp%s\n", frontier.output,
           drawn ? ", frontier.png" : "");
    for (int k = 0; k < frontier.point_count; k++)
        samples_destroy(&frontier.points[k].time);
    free(frontier.points);
    return EXIT_SUCCESS;
}
