/* SPDX-License-Identifier: MIT */
#define _DEFAULT_SOURCE /* sysconf */
#include "settings.h"
#include "library.h"
#include <math.h>
#include <string.h>
#ifdef _OPENMP
#include <omp.h>
#else
#include <unistd.h>
#define omp_get_num_procs()   (int32_t) sysconf(_SC_NPROCESSORS_ONLN)
#define omp_get_max_threads() 1
#endif

/* Not the affinity of this thread: with OMP_PROC_BIND that is one processor. */
int32_t settings_processors(void)
{
    return omp_get_num_procs();
}

struct settings settings_default(int32_t particles, int32_t repetitions, const char *output)
{
    return (struct settings){.particles = particles,
                             .threads = omp_get_max_threads(),
                             .repetitions = repetitions,
                             .support = 2,
                             .jitter = 0.2,
                             .output = output};
}

static bool has(const struct command_option *options, const char *name)
{
    while (options->name && strcmp(options->name, name) != 0)
        ++options;
    return options->name != NULL;
}

/* --help sorts them. */
void settings_read(struct settings *settings, int takes, const struct command_option *own,
                   const char *about, int argc, char **argv)
{
    enum { ROOM = 32 };
    const struct {
        int of;
        struct command_option option;
    } shared[] = {
        {TAKES_LATTICE,
         {"particles", 0, "N", "in the nearest cube or square",
          AS_WHOLE(settings->particles, 1, 1e9)}},
        {TAKES_LATTICE,
         {"support", 0, "H", "support radius in spacings", AS_REAL(settings->support, 1.25, 8)}},
        {TAKES_LATTICE,
         {"jitter", 0, "SHARE", "move each coordinate by up to this share of the spacing",
          AS_REAL(settings->jitter, 0, 1)}},
        {TAKES_LATTICE,
         {"isa", 0, "NAME", "baseline, x86-64-v3, x86-64-v4 or neon (the best)",
          AS_CHOICE(settings->isa, isa_names)}},
        {TAKES_PRECISION,
         {"precision", 0, "TYPE", "f32, f64, or mixed: positions f64, the rest f32 (f32)",
          AS_CHOICE(settings->precision, precision_names)}},
        {TAKES_KERNEL,
         {"kernel", 0, "NAME",
          "cubic, quintic, wendland-c2, wendland-c4, wendland-c6, poly6 or spiky (cubic)",
          AS_CHOICE(settings->kernel, kernel_names)}},
        {TAKES_RUN,
         {"threads", 0, "N", "(OMP_NUM_THREADS, or one per processor)",
          AS_WHOLE(settings->threads, 1, 1024)}},
        {TAKES_RUN,
         {"repetitions", 0, "N", "rounds through everything, after a warm-up",
          AS_WHOLE(settings->repetitions, 1, 10000)}},
        {TAKES_RUN,
         {"json", 0, "FILE", "write all repetitions in Google Benchmark's format",
          AS_FILE(settings->json)}}};
    struct command_option options[ROOM] = {{0}};
    int count = 0;
    for (; own && own->name; ++own)
        options[count++] = *own;
    for (size_t k = 0; k < sizeof shared / sizeof shared[0]; ++k)
        if (shared[k].of & takes && !has(options, shared[k].option.name))
            options[count++] = shared[k].option;
    command_line_read(options, about, argc, argv);
    if (!library_choose_isa(settings->isa))
        command_line_refuse("--isa: %s does not run here", isa_names[settings->isa]);
}

int32_t settings_side(int32_t particles, int32_t dimension)
{
    const int32_t side = (int32_t)lround(pow((double)particles, 1.0 / dimension));
    return side > 1 ? side : 1;
}
