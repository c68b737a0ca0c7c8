/* The command `lists`. */
#include "lists.h"
#include "commands.h"
#include "report/machine.h"
#include "options.h"

#include <stdlib.h>

enum { OPTION_PRECISION = 256 };

static const struct argp_option option_list[] = {
    {"precision", OPTION_PRECISION, "TYPE", 0,
     "f32, f64, or mixed: positions f64, the rest f32 (f32)", 0},
    {0}};

static error_t parse_option(int key, char *text, struct argp_state *state)
{
    struct lists *lists = state->input;
    switch (key) {
    case ARGP_KEY_INIT:
        state->child_inputs[0] = &lists->settings;
        return 0;
    case OPTION_PRECISION:
        lists->precision = (enum precision)option_choice("precision", text, precision_names);
        return 0;
    default:
        return ARGP_ERR_UNKNOWN;
    }
}

static void destroy_samples(struct lists *lists)
{
    for (int supply = 0; supply < SUPPLIES; supply++)
        for (int work = 0; work < LISTS_WORKS; work++)
            samples_destroy(&lists->supplied[supply][work]);
    for (int k = 0; k < EXPORTS; k++)
        samples_destroy(&lists->exported[k]);
}

int command_lists(int argc, char **argv)
{
    struct lists lists = {.settings = {.particles = 100000,
                                       .threads = machine_threads(),
                                       .repetitions = 15,
                                       .support = 2,
                                       .jitter = 0.2},
                          .precision = PRECISION_F32};
    const struct argp_child children[] = {{&settings_argp, 0, NULL, 0}, {NULL, 0, NULL, 0}};
    const struct argp argp = {
        .options = option_list,
        .parser = parse_option,
        .children = children,
        .doc = "Times a pair of sums over the library's lists and over a host's (arrays, "
               "pointers, a function), and of pairs that are written out: indices, gradients, "
               "sorted or in any order. Takes some seconds."};
    options_parse(&argp, argc, argv, &lists);
    lists_measure(&lists);
    lists_print(&lists);
    if (lists.settings.json)
        lists_write_json(&lists, lists.settings.json, "sphgrad-bench");
    destroy_samples(&lists);
    return EXIT_SUCCESS;
}
