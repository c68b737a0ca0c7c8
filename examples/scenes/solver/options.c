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
        {"alone", 'a', NULL, "this method without sph beside it, and no picture",
         AS_FLAG(options.alone)},
        {"size", 's', "NAME", "quick or full (default: quick)", AS_CHOICE(size, sizes)},
        {"seed", 'r', "N", "of the random numbers (default: 1)", AS_SEED(options.seed, 0x1p62)},
        {"threads", 't', "N",
         "methods in turn on so many threads (default: quick sizes run methods side by side, each "
         "on one; full sizes on all, or on one while particles are few)",
         AS_WHOLE(options.threads, 0, 4096)},
        {"output", 'o', "DIR", "write pictures, tables and particles there",
         AS_FOLDER(options.output)},
        {"frames", 'f', "N",
         "of a film of the whole run, as pictures in the output directory (default: none)",
         AS_WHOLE(options.frames, 2, 9999)},
        {"check", 'c', NULL, "compare with the gates of this scene; status 1 if one fails",
         AS_FLAG(options.check)},
        {"brief", 'b', NULL,
         "measure the beginning and do not simulate; --check then takes the gates on that",
         AS_FLAG(options.brief)},
        {0}};
    command_line_program(scene);
    command_line_read(described, about, argc, argv);
    options.full = size == 1;
    check_combination(&options);
    return options;
}
