/* SPDX-License-Identifier: MIT */
#include "picture.h"
#include "arrays.h"
#include "gnuplot.h"
#include <errno.h>
#include <math.h>
#include <stdlib.h>
#include <string.h>

struct picture picture_open(const struct options *options, const struct metrics *runs)
{
    static const char *const titles[METHOD_COUNT] = {"plain SPH", "KGC", "MLS", "RKPM"};
    char path[4096];
    struct picture picture = {.options = options,
                              .directory = options->output,
                              .name = options->scene,
                              .methods = {method_names[SPH], method_names[options->method]},
                              .titles = {titles[SPH], titles[options->method]},
                              .metrics = {&runs[SPH], &runs[options->method]},
                              .full = options->full,
                              .share = 1};
    if (snprintf(path, sizeof path, "%s/%s.gp", picture.directory, picture.name) < (int)sizeof path)
        picture.script = fopen(path, "w");
    if (!picture.script) {
        fprintf(stderr, "cannot write %s: %s\n", path, strerror(errno));
        exit(EXIT_FAILURE);
    }
    return picture;
}

void picture_frame(struct picture *picture, int32_t frame, int32_t of)
{
    snprintf(picture->frame, sizeof picture->frame, "_%04d", (int)(frame % 10000));
    picture->share = (double)frame / (of - 1);
}

/* Viridis (van der Walt, Smith 2015, matplotlib, CC0): the colour-blind see it, too. */
void picture_begin(const struct picture *picture, int width, int height)
{
    fprintf(picture->script,
            "reset\n"
            "set terminal pngcairo size %d,%d font 'Sans,12' background '#ffffff'\n"
            "set output '%s%s.png'\n"
            "set palette defined (0 '#440154', 1 '#482878', 2 '#3e4a89', 3 '#31688e', "
            "4 '#26828e', 5 '#1f9e89', 6 '#35b779', 7 '#6dcd59', 8 '#b4de2c', 9 '#fde725')\n"
            "set style fill solid\n"
            "unset key\n"
            "set multiplot\n",
            width, height, picture->name, picture->frame);
}

void picture_end(const struct picture *picture)
{
    fputs("unset multiplot\n", picture->script);
}

static const double low = 0.13, high = 0.87; /* of every panel and colour bar */

void picture_panel(const struct picture *picture, double left, double right)
{
    fprintf(picture->script,
            "set lmargin at screen %g\nset rmargin at screen %g\n"
            "set bmargin at screen %g\nset tmargin at screen %g\n",
            left, right, low, high);
}

void picture_bar(const struct picture *picture, double left, const char *label)
{
    fprintf(picture->script,
            "set cblabel '%s' offset 0.8\n"
            "set colorbox user origin screen %g, screen %g size screen 0.014, screen %g\n",
            label, left, low, high - low);
}

/* Ranges that both panels share, so that one length is the same in both. */
static void share_ranges(const struct picture *picture, const char *label)
{
    for (int k = 0; k < 2; ++k)
        fprintf(picture->script, "stats '%s_%s_%s.dat' using 1:2 name 'VIEW%d' nooutput\n",
                picture->name, picture->methods[k], label, k);
    for (int axis = 0; axis < 2; ++axis) {
        const char letter = axis ? 'y' : 'x';
        fprintf(picture->script,
                "low = VIEW0_min_%c < VIEW1_min_%c ? VIEW0_min_%c : VIEW1_min_%c\n"
                "high = VIEW0_max_%c > VIEW1_max_%c ? VIEW0_max_%c : VIEW1_max_%c\n"
                "set %crange [low - 0.07 * (high - low):high + 0.07 * (high - low)]\n",
                letter, letter, letter, letter, letter, letter, letter, letter, letter);
    }
}

void picture_views(const struct picture *picture, const char *label, double radius,
                   const char *title, double width)
{
    share_ranges(picture, label);
    fprintf(picture->script, "set size ratio -1\nunset xtics\nunset ytics\nunset border\n");
    for (int k = 0; k < 2; ++k) {
        picture_panel(picture, 0.01 + k * width, (k + 1) * width);
        fprintf(picture->script,
                "set title '%s: %s'\n"
                "plot '%s_%s_%s.dat' using 1:2:(%g):3 with circles lc palette "
                "fillstyle solid border lc rgb '#333333'\n",
                picture->titles[k], title, picture->name, picture->methods[k], label, radius);
    }
}

void picture_series(const struct picture *picture, const char *label)
{
    static const char *const colours[2] = {"#440154", "#35b779"};
    picture_panel(picture, 0.755, 0.985);
    fprintf(picture->script, "set size noratio\nset xtics\nset ytics\nset border\n"
                             "set xrange [*:*]\nset xlabel 'time [s]'\nplot ");
    for (int k = 0; k < 2; ++k)
        fprintf(picture->script, "'%s_%s_%s.dat' with lines lw 2 lc rgb '%s' title '%s'%s",
                picture->name, picture->methods[k], label, colours[k], picture->titles[k],
                k ? "\n" : ", ");
}

void picture_close(const struct picture *picture)
{
    char script[256];
    snprintf(script, sizeof script, "%s.gp", picture->name);
    if (fclose(picture->script) != 0)
        fprintf(stderr, "cannot write %s: %s\n", script, strerror(errno));
    gnuplot_run(picture->directory, script);
}

struct seen {
    double right, up, near, colour;
};

static int farther_first(const void *a, const void *b)
{
    const struct seen *first = a, *second = b;
    return (first->near > second->near) - (first->near < second->near);
}

void picture_project(FILE *table, const double eye[3], int count, double (*x)[3],
                     const double *colour)
{
    const double flat = hypot(eye[0], eye[1]), length = hypot(flat, eye[2]);
    const vector toward = {eye[0] / length, eye[1] / length, eye[2] / length};
    const vector right = {-eye[1] / flat, eye[0] / flat, 0};
    vector up;
    if (!table)
        return;
    cross(toward, right, up);
    struct seen *seen = array_new(count, sizeof *seen);
    for (int i = 0; i < count; ++i)
        seen[i] = (struct seen){dot(x[i], right), dot(x[i], up), dot(x[i], toward), colour[i]};
    qsort(seen, (size_t)count, sizeof *seen, farther_first);
    for (int i = 0; i < count; ++i)
        fprintf(table, "%.5g %.5g %.5g\n", seen[i].right, seen[i].up, seen[i].colour);
    free(seen);
}
