/* The command `limit`. */
#include "limit.h"
#include "commands.h"
#include "report/machine.h"
#include "options.h"

#include <stdlib.h>

enum { OPTION_PROBE = 256 };

static const struct argp_option option_list[] = {
    {"probe", OPTION_PROBE, NULL, 0, "only the fixed yardstick by which machines are compared", 0},
    {0}};

static error_t parse_option(int key, char *text, struct argp_state *state)
{
    struct limit *limit = state->input;
    (void)text;
    switch (key) {
    case ARGP_KEY_INIT:
        state->child_inputs[0] = &limit->settings;
        return 0;
    case OPTION_PROBE:
        limit->probe_only = true;
        return 0;
    default:
        return ARGP_ERR_UNKNOWN;
    }
}

static void destroy_samples(struct limit *limit)
{
    for (int work = 0; work < PROBE_WORKS; work++)
        samples_destroy(&limit->probe[work]);
    for (int work = 0; work < LIMIT_WORKS; work++)
        samples_destroy(&limit->library[work]);
    for (int set = 0; set < limit->set_count; set++)
        for (int work = 0; work < LIMIT_WORKS; work++)
            for (int k = 0; k < 2 * LIMIT_ARRANGEMENTS; k++)
                samples_destroy(&limit->times[set][work].arrangements[k % 2][k / 2]);
}

int command_limit(int argc, char **argv)
{
    struct limit limit = {.settings = {.particles = 1000000,
                                       .threads = machine_threads(),
                                       .repetitions = 15,
                                       .support = 2,
                                       .jitter = 0.2}};
    const struct argp_child children[] = {{&settings_argp, 0, NULL, 0}, {NULL, 0, NULL, 0}};
    const struct argp argp = {
        .options = option_list,
        .parser = parse_option,
        .children = children,
        .doc = "Times the pair arithmetic of KGC on packed data in the first-level cache, each "
               "instruction set in every arrangement of the loop, and the library beside it: "
               "which share of the arithmetic limit the library reaches."};
    options_parse(&argp, argc, argv, &limit);
    limit_measure(&limit);
    limit_print(&limit);
    if (limit.settings.json)
        limit_write_json(&limit, limit.settings.json, "sphgrad-bench");
    destroy_samples(&limit);
    return EXIT_SUCCESS;
}
