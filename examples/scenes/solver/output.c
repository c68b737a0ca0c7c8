/* SPDX-License-Identifier: MIT */
#include "output.h"
#include "vtkhdf.h"
#include <errno.h>
#include <math.h>
#include <stdlib.h>
#include <string.h>

enum { PATH_LENGTH = 4096 };

static void fail(const char *path)
{
    fprintf(stderr, "cannot write %s: %s\n", path, strerror(errno));
    exit(EXIT_FAILURE);
}

static void make_path(char path[PATH_LENGTH], const struct run *run, const char *end)
{
    const int length = snprintf(path, PATH_LENGTH, "%s/%s_%s_%s", run->options->output,
                                run->options->scene, method_names[run->method], end);
    if (length >= PATH_LENGTH) {
        errno = ENAMETOOLONG;
        fail(run->options->output);
    }
}

void output_explain(void)
{
    if (!vtkhdf_is_there())
        fprintf(stderr, "built without HDF5: no particles for ParaView\n");
}

FILE *output_open(const struct run *run, const char *label)
{
    char path[PATH_LENGTH], end[64];
    if (!run->options->output)
        return NULL;
    snprintf(end, sizeof end, "%s.dat", label);
    make_path(path, run, end);
    FILE *file = fopen(path, "w");
    if (!file)
        fail(path);
    return file;
}

FILE *output_open_frame(const struct run *run, const char *label, int32_t frame)
{
    char numbered[64];
    snprintf(numbered, sizeof numbered, "%s_%04d", label, (int)frame);
    return output_open(run, numbered);
}

void output_close(FILE *file)
{
    if (file && (ferror(file) | fclose(file)) != 0)
        fail("a table");
}

/* Lists the file with its time, behind those before it. */
static void list_frame(const struct run *run, int32_t frame, double time)
{
    static const char end[] = "\n]}\n";
    char path[PATH_LENGTH];
    make_path(path, run, "particles.vtkhdf.series");
    FILE *list = fopen(path, frame ? "r+" : "w");
    if (!list || (frame && fseek(list, -(long)strlen(end), SEEK_END) != 0))
        fail(path);
    fprintf(list, "%s\n{\"name\": \"%s_%s_%04d.vtkhdf\", \"time\": %.9g}%s",
            frame ? "," : "{\"file-series-version\": \"1.0\", \"files\": [", run->options->scene,
            method_names[run->method], (int)frame, time, end);
    if (ferror(list) | fclose(list))
        fail(path);
}

void output_particles(const struct run *run, int32_t frame, double time, int32_t count, vector *x,
                      const struct output_field *fields)
{
    char path[PATH_LENGTH], end[64];
    if (!run->options->output || !vtkhdf_is_there())
        return;
    snprintf(end, sizeof end, "%04d.vtkhdf", (int)frame);
    make_path(path, run, end);
    if (!vtkhdf_write(path, time, count, x, fields)) {
        fprintf(stderr, "cannot write %s\n", path);
        exit(EXIT_FAILURE);
    }
    list_frame(run, frame, time);
}

void output_state(const struct run *run, int32_t frame, double time,
                  const struct particles *particles)
{
    const struct output_field fields[] = {
        {"velocity", particles->v[0], 3}, {"density", particles->density, 1}, {0}};
    output_particles(run, frame, time, particles->count, particles->x, fields);
}

void output_view(const struct run *run, const char *label, const double eye[3], int32_t count,
                 vector *x, const double *colour)
{
    FILE *table = output_open(run, label);
    picture_project(table, eye, count, x, colour);
    output_close(table);
}

void output_speeds(const struct run *run, const char *label, const double eye[3],
                   const struct particles *particles)
{
    double *speed = array_new(particles->count, sizeof *speed);
    for (int32_t i = 0; i < particles->count; ++i)
        speed[i] = sqrt(dot(particles->v[i], particles->v[i]));
    output_view(run, label, eye, particles->count, particles->x, speed);
    free(speed);
}
