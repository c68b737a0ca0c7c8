/* The command `scaling`. */
#include "scaling.h"
#include "commands.h"
#include "report/machine.h"
#include "options.h"

#include <stdio.h>
#include <stdlib.h>

enum { OPTION_OUTPUT = 256, OPTION_FULL };

static const struct argp_option option_list[] = {
    {"output", OPTION_OUTPUT, "FOLDER", 0, "where CSV, script and picture go (scaling)", 0},
    {"full", OPTION_FULL, NULL, 0,
     "sizes up to 30 times the particles, not 10; some 250 bytes of memory each", 0},
    {0}};

static error_t parse_option(int key, char *text, struct argp_state *state)
{
    struct scaling *scaling = state->input;
    switch (key) {
    case ARGP_KEY_INIT:
        state->child_inputs[0] = &scaling->settings;
        return 0;
    case OPTION_OUTPUT:
        scaling->output = text;
        return 0;
    case OPTION_FULL:
        scaling->full = true;
        return 0;
    default:
        return ARGP_ERR_UNKNOWN;
    }
}

static void destroy_cases(struct scaling *scaling)
{
    for (int k = 0; k < scaling->case_count; k++)
        for (int work = 0; work < SCALING_WORKS; work++)
            samples_destroy(&scaling->cases[k].time[work]);
    free(scaling->cases);
}

int command_scaling(int argc, char **argv)
{
    struct scaling scaling = {.settings = {.particles = 1000000,
                                           .threads = machine_threads(),
                                           .repetitions = 5,
                                           .support = 2,
                                           .jitter = 0.2},
                              .output = "scaling"};
    const struct argp_child children[] = {{&settings_argp, 0, NULL, 0}, {NULL, 0, NULL, 0}};
    const struct argp argp = {
        .options = option_list,
        .parser = parse_option,
        .children = children,
        .doc = "Times search, matrices, gradient and both in one call for a tenth to ten times "
               "the particles, for threads, neighbour counts, orders in memory and shapes of "
               "the cloud."};
    options_parse(&argp, argc, argv, &scaling);
    option_folder("output", scaling.output);
    scaling_create_cases(&scaling);
    scaling_measure(&scaling);
    scaling_print(&scaling);
    scaling_write_csv(&scaling);
    if (scaling.settings.json)
        scaling_write_json(&scaling, scaling.settings.json, "sphgrad-bench");
    const bool drawn = scaling_draw(&scaling);
    printf("\nwritten to %s: scaling.csv, scaling.gp%s\n", scaling.output,
           drawn ? ", scaling.png" : "");
    destroy_cases(&scaling);
    return EXIT_SUCCESS;
}
