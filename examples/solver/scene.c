#define _POSIX_C_SOURCE 200809L /* clock_gettime, isatty */
#include "scene.h"
#include "output.h"
#include "stopwatch.h"

#include <stdio.h>
#include <stdlib.h>
#include <unistd.h>

struct sph run_open(const struct run *run, int32_t dimension, double support_radius,
                    int32_t particles)
{
    static const sphg_method methods[METHOD_COUNT] = {SPHG_PLAIN, SPHG_KGC, SPHG_MLS, SPHG_RKPM};
    const int32_t few = particles < 10000;
    const int32_t threads = run->options->threads ? run->options->threads : few;
    return sph_open(threads, dimension, support_radius, methods[run->method]);
}

void run_progress(const struct run *run, double done, double of)
{
    static double shown;
    if (!isatty(STDERR_FILENO) || (done < of && stopwatch_wall() - shown < 0.2))
        return;
    shown = stopwatch_wall();
    fprintf(stderr, "\r%s, %s: %3.0f %%%s", run->options->scene, method_names[run->method],
            100 * done / of, done < of ? "" : "\r\33[K");
}

static bool is_run(const struct scene *scene, const struct options *options, enum method method)
{
    if (options->check && !options->method_given && scene->checks_all)
        return true;
    return (method == SPH && !options->alone) || method == options->method;
}

static void simulate(const struct scene *scene, const struct options *options, enum method method,
                     struct metrics *metrics)
{
    const struct run run = {options, method, metrics};
    const double start = stopwatch_wall();
    scene->simulate(&run);
    metrics_set(metrics, "seconds", stopwatch_wall() - start);
    metrics_print(options, method, metrics);
}

static void draw(const struct scene *scene, const struct options *options)
{
    if (!options->output || options->alone || options->method == SPH)
        return;
    const struct picture picture = picture_open(options);
    scene->draw(&picture);
    picture_close(&picture);
}

int scene_main(const struct scene *scene, int argc, char **argv)
{
    const struct options options = options_read(scene->name, scene->about, argc, argv);
    static struct metrics runs[METHOD_COUNT];
    if (options.output)
        output_explain();
    for (int m = SPH; m < METHOD_COUNT; m++)
        if (is_run(scene, &options, (enum method)m))
            simulate(scene, &options, (enum method)m, &runs[m]);
    draw(scene, &options);
    return !options.check || gates_hold(&options, scene->gates, runs) ? EXIT_SUCCESS : EXIT_FAILURE;
}
