/* SPDX-License-Identifier: MIT */
/* Files that a run leaves in its output directory: SCENE_METHOD_LABEL.dat for gnuplot, and
 * SCENE_METHOD_0001.vtkhdf for ParaView, with SCENE_METHOD_particles.vtkhdf.series, which lists
 * these and their times: open that. Without a directory all calls do nothing. */
#ifndef SOLVER_OUTPUT_H
#define SOLVER_OUTPUT_H
#include "particles.h"
#include "scene.h"
#include <stdio.h>

/* Says on stderr which kinds of output this build has to skip. */
void output_explain(void);

/* A text table, or NULL. */
FILE *output_open(const struct run *run, const char *label);

/* That of a frame of a film. */
FILE *output_open_frame(const struct run *run, const char *label, int32_t frame);
void output_close(FILE *file);

/* One value per particle beside its place; dimension 1: a scalar, 3: a vector. */
struct output_field {
    const char *name;
    const double *values;
    int32_t dimension;
};

/* Particles as the numbered file `frame`, and when that is [s]: from 0 on, each once. The table of
 * fields ends with a name of NULL. */
void output_particles(const struct run *run, int32_t frame, double time, int32_t count, vector *x,
                      const struct output_field *fields);

/* The same with velocity and density as fields. */
void output_state(const struct run *run, int32_t frame, double time,
                  const struct particles *particles);

/* A table for picture_views: particles as seen from `eye`, and a colour for each. */
void output_view(const struct run *run, const char *label, const double eye[3], int32_t count,
                 vector *x, const double *colour);

/* That of the particles' speeds. */
void output_speeds(const struct run *run, const char *label, const double eye[3],
                   const struct particles *particles);
#endif
