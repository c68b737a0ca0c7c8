/* SPDX-License-Identifier: MIT */
/* What makes a scene, and the main function that all scenes share. */
#ifndef SOLVER_SCENE_H
#define SOLVER_SCENE_H
#include "library.h"
#include "metrics.h"
#include "picture.h"

/* One simulation: a scene with one method. */
struct run {
    const struct options *options;
    enum method method;
    struct metrics *metrics;
    bool shows_progress;
};

struct scene {
    const char *name, *about;
    void (*simulate)(const struct run *run); /* sets metrics, writes tables and particles */
    void (*draw)(const struct picture *picture);
    const struct gate *gates;
    bool checks_all; /* --check runs all methods, else SPH and KGC */
    bool has_film;   /* draw and simulate know frames */
};

/* Quick sizes run their methods side by side, a process with a thread each, unless the user names a
 * number of threads; full ones run them in turn. */
int scene_main(const struct scene *scene, int argc, char **argv);

/* The library for a run of so many particles: unless the user said otherwise on one thread while
 * they are few, because then waiting for the other threads takes longer than their help saves, and
 * on a busy machine very much longer. */
struct sph run_open(const struct run *run, int32_t dimension, double support_radius,
                    int32_t particles);

/* How many frames of a film are due when a share of the run is over. */
int32_t run_frames(const struct run *run, double share);

/* Shows how far a run is, on a terminal only. */
void run_progress(const struct run *run, double done, double of);
#endif
