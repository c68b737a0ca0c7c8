/* The command `stability`. */
#include "stability.h"
#include "commands.h"
#include "report/machine.h"
#include "options.h"

#include <stdio.h>
#include <stdlib.h>

enum {
    OPTION_OUTPUT = 256,
    OPTION_QUICK,
    OPTION_SWEEP,
    OPTION_KERNEL,
    OPTION_COMPARE,
    OPTION_SEED
};

static const struct argp_option option_list[] = {
    {"output", OPTION_OUTPUT, "FOLDER", 0, "where CSV, scripts and pictures go (stability)", 0},
    {"quick", OPTION_QUICK, NULL, 0, "a few places of each sweep, in seconds", 0},
    {"sweep", OPTION_SWEEP, "NAME", 0,
     "this one alone: slab, threshold, offset, scale, neighbours, volumes, jitter, merging; or "
     "crowds, which only shows how errors grow",
     0},
    {"kernel", OPTION_KERNEL, "NAME", 0, "one of the seven smoothing functions (cubic)", 0},
    {"compare", OPTION_COMPARE, "N", 0,
     "targets of a case that stand beside the reference (32, quick 2); 0: none", 0},
    {"seed", OPTION_SEED, "N", 0, "other random numbers (0)", 0},
    {0}};

static error_t parse_option(int key, char *text, struct argp_state *state)
{
    struct stability *stability = state->input;
    switch (key) {
    case ARGP_KEY_INIT:
        state->child_inputs[0] = &stability->settings;
        return 0;
    case OPTION_OUTPUT:
        stability->output = text;
        return 0;
    case OPTION_QUICK:
        stability->quick = true;
        return 0;
    case OPTION_SWEEP:
        stability->first = stability->last = option_choice("sweep", text, sweep_names);
        return 0;
    case OPTION_KERNEL:
        stability->kernel = (sphg_kernel)option_choice("kernel", text, kernel_names);
        return 0;
    case OPTION_COMPARE:
        stability->compared = option_integer("compare", text, 0, 1 << 20);
        return 0;
    case OPTION_SEED:
        stability->seed = option_integer("seed", text, 0, 9999);
        return 0;
    default:
        return ARGP_ERR_UNKNOWN;
    }
}

int command_stability(int argc, char **argv)
{
    struct stability stability = {.settings = {.particles = 512,
                                               .threads = machine_threads(),
                                               .repetitions = 1,
                                               .support = 2,
                                               .jitter = 0.2},
                                  .output = "stability",
                                  .last = SWEEPS - 1,
                                  .compared = -1};
    const struct argp_child children[] = {{&settings_argp, 0, NULL, 0}, {NULL, 0, NULL, 0}};
    const struct argp argp = {
        .options = option_list,
        .parser = parse_option,
        .children = children,
        .doc = "Sweeps thickness, threshold, distance from the origin, scale, neighbours, "
               "volumes, disorder and merging layers for every method and precision, beside a "
               "reference in quadruple precision. A round is another set of random numbers; the "
               "exit status tells whether every promise held."};
    options_parse(&argp, argc, argv, &stability);
    option_folder("output", stability.output);
    if (stability.compared < 0)
        stability.compared = stability.quick ? 2 : 32;
    stability_create_cases(&stability);
    stability_measure(&stability);
    stability_print(&stability);
    stability_write_csv(&stability);
    if (stability.settings.json)
        stability_write_json(&stability, stability.settings.json, "sphgrad-bench");
    const bool all = stability.first == 0 && stability.last == SWEEPS - 1;
    const bool drawn = all && stability_draw(&stability);
    printf("\nwritten to %s: stability.csv%s%s\n", stability.output, all ? ", three scripts" : "",
           drawn ? " and their pictures" : "");
    const int broken = stability_check(&stability);
    free(stability.cases);
    return broken == 0 ? EXIT_SUCCESS : EXIT_FAILURE;
}
