/* SPDX-License-Identifier: MIT */
#include "settings.h"
#include "library.h"
#include "report/machine.h"
#include <math.h>

struct settings settings_default(int32_t particles, int32_t repetitions, const char *output)
{
    return (struct settings){.particles = particles,
                             .threads = machine_threads(),
                             .repetitions = repetitions,
                             .support = 2,
                             .jitter = 0.2,
                             .output = output};
}

void settings_read(const struct settings *settings, const struct command_option *options,
                   const char *about, int argc, char **argv)
{
    command_line_read(options, about, argc, argv);
    if (!library_choose_isa(settings->isa))
        command_line_refuse("--isa: %s does not run here", isa_names[settings->isa]);
}

int32_t settings_side(int32_t particles, int32_t dimension)
{
    const int32_t side = (int32_t)lround(pow((double)particles, 1.0 / dimension));
    return side > 1 ? side : 1;
}
