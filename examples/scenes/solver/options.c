/* SPDX-License-Identifier: MIT */
#include "options.h"
#include "command_line.h"
#include <stdlib.h>

const char *const method_names[METHOD_COUNT + 1] = {"sph", "kgc", "mls", "rkpm", NULL};

static void check_combination(const struct options *options)
{
    if (options->check && options->alone)
        command_line_refuse("gates compare with sph: --check cannot go with --alone");
    if (options->frames && (!options->output || options->alone))
        command_line_refuse("--frames needs --output, and another method beside sph");
    if (options->brief && options->output)
        command_line_refuse("--brief has nothing to write to --output");
}

struct options options_read(const char *scene, const char *about, int argc, char **argv)
{
    static const char *const sizes[] = {"quick", "full", NULL};
    struct options options = {.scene = scene, .seed = 1, .method = KGC};
    int size = 0;
    const struct command_option described[] = {
        {"method", 'm', "NAME", "kgc, mls or rkpm beside sph, or sph alone (default: kgc)",
         OPTION_CHOICE, &options.method, 0, 0, method_names, &options.method_given},
        {"alone", 'a', NULL, "this method without sph beside it, and no picture", OPTION_FLAG,
         &options.alone, 0, 0, NULL, NULL},
        {"size", 's', "NAME", "quick or full (default: quick)", OPTION_CHOICE, &size, 0, 0, sizes,
         NULL},
        {"seed", 'r', "N", "of the random numbers (default: 1)", OPTION_SEED, &options.seed, 0,
         0x1p62, NULL, NULL},
        {"threads", 't', "N",
         "methods in turn on so many threads (default: quick sizes run methods side by side, each "
         "on one; full sizes on all, or on one while particles are few)",
         OPTION_WHOLE, &options.threads, 0, 4096, NULL, NULL},
        {"output", 'o', "DIR", "write pictures, tables and particles there", OPTION_FOLDER,
         &options.output, 0, 0, NULL, NULL},
        {"frames", 'f', "N",
         "of a film of the whole run, as pictures in the output directory (default: none)",
         OPTION_WHOLE, &options.frames, 2, 9999, NULL, NULL},
        {"check", 'c', NULL, "compare with the gates of this scene; status 1 if one fails",
         OPTION_FLAG, &options.check, 0, 0, NULL, NULL},
        {"brief", 'b', NULL,
         "measure the beginning and do not simulate; --check then takes the gates on that",
         OPTION_FLAG, &options.brief, 0, 0, NULL, NULL},
        {0}};
    command_line_program(scene);
    command_line_read(described, about, argc, argv);
    options.full = size == 1;
    check_combination(&options);
    return options;
}
