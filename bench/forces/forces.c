/* The command `forces`. */
#include "forces.h"
#include "commands.h"
#include "options.h"
#include "report/machine.h"

#include <stdlib.h>

enum { OPTION_PRECISION = 256 };

static const struct argp_option option_list[] = {
    {"precision", OPTION_PRECISION, "TYPE", 0,
     "f32, f64, or mixed: positions f64, the rest f32 (f32)", 0},
    {0}};

static error_t parse_option(int key, char *text, struct argp_state *state)
{
    struct forces *forces = state->input;
    switch (key) {
    case ARGP_KEY_INIT:
        state->child_inputs[0] = &forces->settings;
        return 0;
    case OPTION_PRECISION:
        forces->precision = (enum precision)option_choice("precision", text, precision_names);
        return 0;
    default:
        return ARGP_ERR_UNKNOWN;
    }
}

int command_forces(int argc, char **argv)
{
    struct forces forces = {.settings = {.particles = 1000000,
                                         .threads = machine_threads(),
                                         .repetitions = 9,
                                         .support = 2,
                                         .jitter = 0.2},
                            .precision = PRECISION_F32};
    const struct argp_child children[] = {{&settings_argp, 0, NULL, 0}, {NULL, 0, NULL, 0}};
    const struct argp argp = {
        .options = option_list,
        .parser = parse_option,
        .children = children,
        .doc =
            "Times the operators that a solver iterates: forces in the adjoint and the symmetric "
            "form and divergences, with lists alone and with weights that neighbours keep. "
            "Takes some ten seconds."};
    options_parse(&argp, argc, argv, &forces);
    forces_measure(&forces);
    forces_print(&forces);
    if (forces.settings.json)
        forces_write_json(&forces, forces.settings.json, "sphgrad-bench");
    for (int k = 0; k < FORCE_CASES * FORCE_SUPPLIES; k++)
        samples_destroy(&forces.times[k / FORCE_SUPPLIES][k % FORCE_SUPPLIES]);
    return EXIT_SUCCESS;
}
