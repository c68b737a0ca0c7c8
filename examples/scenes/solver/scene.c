/* SPDX-License-Identifier: MIT */
#define _DEFAULT_SOURCE /* fork, isatty, MAP_ANONYMOUS */
#include "scene.h"
#include "command_line.h"
#include "output.h"
#include "stopwatch.h"
#include <signal.h>
#include <stdio.h>
#include <stdlib.h>
#include <sys/mman.h>
#include <sys/prctl.h>
#include <sys/wait.h>
#include <unistd.h>

struct sph run_open(const struct run *run, int32_t dimension, double support_radius,
                    int32_t particles)
{
    static const sphg_method methods[METHOD_COUNT] = {SPHG_PLAIN, SPHG_KGC, SPHG_MLS, SPHG_RKPM};
    const int32_t few = particles < 10000;
    const int32_t threads = run->options->threads ? run->options->threads : few;
    return sph_open(threads, dimension, support_radius, methods[run->method]);
}

int32_t run_frames(const struct run *run, double share)
{
    const int32_t frames = run->options->frames;
    return frames ? 1 + (int32_t)(share * (frames - 1) + 1e-9) : 0;
}

void run_progress(const struct run *run, double done, double of)
{
    static double shown;
    if (!run->shows_progress || !isatty(STDERR_FILENO) ||
        (done < of && stopwatch_wall() - shown < 0.2))
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
                     struct metrics *metrics, bool shows_progress)
{
    const struct run run = {options, method, metrics, shows_progress};
    const double start = stopwatch_wall();
    scene->simulate(&run);
    metrics_set(metrics, "seconds", stopwatch_wall() - start);
}

static void simulate_in_turn(const struct scene *scene, const struct options *options,
                             struct metrics runs[METHOD_COUNT])
{
    for (int m = SPH; m < METHOD_COUNT; ++m)
        if (is_run(scene, options, (enum method)m)) {
            simulate(scene, options, (enum method)m, &runs[m], true);
            metrics_print(options, (enum method)m, &runs[m]);
        }
}

static pid_t begin(const struct scene *scene, const struct options *options, enum method method,
                   struct metrics *metrics)
{
    const pid_t process = fork();
    if (process < 0) {
        perror("no process for a method");
        exit(EXIT_FAILURE);
    }
    if (process > 0)
        return process;
    prctl(PR_SET_PDEATHSIG, SIGKILL); /* no method outlives the scene */
    simulate(scene, options, method, metrics, method == options->method);
    exit(EXIT_SUCCESS);
}

static void await(const struct options *options, enum method method, pid_t process)
{
    int status;
    if (waitpid(process, &status, 0) == process && status == 0)
        return;
    fprintf(stderr, "%s, %s: ended early\n", options->scene, method_names[method]);
    exit(EXIT_FAILURE);
}

/* Each method in a process of its own. */
static void simulate_side_by_side(const struct scene *scene, const struct options *options,
                                  struct metrics runs[METHOD_COUNT])
{
    pid_t processes[METHOD_COUNT];
    for (int m = SPH; m < METHOD_COUNT; ++m)
        if (is_run(scene, options, (enum method)m))
            processes[m] = begin(scene, options, (enum method)m, &runs[m]);
    for (int m = SPH; m < METHOD_COUNT; ++m)
        if (is_run(scene, options, (enum method)m)) {
            await(options, (enum method)m, processes[m]);
            metrics_print(options, (enum method)m, &runs[m]);
        }
}

static struct metrics *shared_metrics(void)
{
    void *memory = mmap(NULL, METHOD_COUNT * sizeof(struct metrics), PROT_READ | PROT_WRITE,
                        MAP_SHARED | MAP_ANONYMOUS, -1, 0);
    if (memory == MAP_FAILED) {
        perror("no memory for metrics");
        exit(EXIT_FAILURE);
    }
    return memory;
}

static void draw(const struct scene *scene, const struct options *options,
                 const struct metrics *runs)
{
    if (!options->output || options->alone || options->method == SPH)
        return;
    struct picture picture = picture_open(options, runs);
    scene->draw(&picture);
    picture_end(&picture);
    for (int32_t frame = 0; frame < options->frames; ++frame) {
        picture_frame(&picture, frame, options->frames);
        scene->draw(&picture);
        picture_end(&picture);
    }
    picture_close(&picture);
}

int scene_main(const struct scene *scene, int argc, char **argv)
{
    const struct options options = options_read(scene->name, scene->about, argc, argv);
    struct metrics *runs = shared_metrics();
    if (options.frames && !scene->has_film)
        command_line_refuse("--frames: this scene has no film");
    if (options.output)
        output_explain();
    if (options.full || options.threads)
        simulate_in_turn(scene, &options, runs);
    else
        simulate_side_by_side(scene, &options, runs);
    draw(scene, &options, runs);
    return !options.check || gates_hold(&options, scene->gates, runs) ? EXIT_SUCCESS : EXIT_FAILURE;
}
