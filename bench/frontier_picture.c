/* The picture of frontier: two panels, every way a point, the frontier a line whose points are
 * numbered and named beneath. */
#include "frontier.h"
#include "machine.h"
#include "numbers.h"
#include "plot.h"

#include <math.h>
#include <stdio.h>
#include <stdlib.h>

enum { NAMED_MOST = 14 };

/* Colour-blind-safe: Okabe, Ito 2008, "Color universal design". */
static const char *const colours[FRONTIER_METHODS] = {
    [SPHG_KGC] = "#0072B2",  [SPHG_MLS] = "#009E73",   [SPHG_RKPM] = "#56B4E9",
    [SPHG_CMLS] = "#D55E00", [SPHG_CRKPM] = "#E69F00", [SPHG_PLAIN] = "#999999"};

/* gnuplot: open circle, open square, open triangle */
static const int symbols[FRONTIER_PRECISIONS] = {6, 4, 8};

/* "1", "2" and so on, for ways over the host's lists "a", "b". */
static void write_mark(enum frontier_side side, int k, char text[16])
{
    if (side == SIDE_HOST)
        snprintf(text, 16, "%c", 'a' + k % 26);
    else
        snprintf(text, 16, "%d", k + 1);
}

static void write_steps(FILE *script, const struct frontier *frontier, enum frontier_field field,
                        enum frontier_side side, const struct frontier_point *const points[],
                        int count)
{
    char mark[16];
    fprintf(script, "$frontier%d%d << EOD\n", field, side);
    for (int k = 0; k < count; k++) {
        write_mark(side, k, mark);
        fprintf(script, "%.6g,%.6e,%s\n", frontier_time(frontier, points[k]),
                frontier_error(points[k], field), mark);
    }
    fprintf(script, "EOD\n");
}

/* Names beneath the panel; where there are too many, the CSV file has the rest. */
static int write_names(FILE *script, enum frontier_side side, int line,
                       const struct frontier_point *const points[], int count)
{
    char text[160], mark[16];
    for (int k = 0; k < count && line < NAMED_MOST; k++, line++) {
        frontier_describe(points[k], text, sizeof text);
        write_mark(side, k, mark);
        fprintf(script, "set label %d \"%s   %s\" at graph 0, graph %.3f font ',10'\n", line + 1,
                mark, text, -0.19 - 0.042 * line);
    }
    return line;
}

static void write_frontiers(FILE *script, const struct frontier *frontier,
                            enum frontier_field field)
{
    const struct frontier_point **points =
        allocate_or_exit((size_t)frontier->point_count, sizeof *points);
    int line = 0;
    fprintf(script, "unset label\n");
    for (int k = 0; k < SIDES; k++) {
        const enum frontier_side side = (enum frontier_side)k;
        const int count = frontier_points(frontier, field, side, points);
        write_steps(script, frontier, field, side, points, count);
        line = write_names(script, side, line, points, count);
    }
    free(points);
}

static void write_line(FILE *script, enum frontier_field field, enum frontier_side side)
{
    fprintf(script,
            "  $frontier%d%d using 1:2 with steps lw 1.8 dt %d lc rgb 'black' notitle, \\\n"
            "  '' using 1:2 with points pt 7 ps 0.7 lc rgb 'black' notitle, \\\n"
            "  '' using 1:2:3 with labels offset -0.8,-0.8 font ',11' notitle%s\n",
            field, side, side == SIDE_HOST ? 2 : 1, side == SIDE_HOST ? "" : ", \\");
}

static void write_panel(FILE *script, const struct frontier *frontier, enum frontier_field field)
{
    const int linear = field == FRONTIER_LINEAR, column = linear ? 12 : 9;
    write_frontiers(script, frontier, field);
    fprintf(script, "set title '%s'\nset ylabel '%s'\n%s\nplot \\\n",
            linear ? "linear field v = (-y, x, 2z)" : "trigonometric field, 20 spacings a wave",
            linear ? "largest relative error of J" : "mean relative error of J",
            linear
                ? "set yrange [*:10]\nset ytics autofreq\nset format y '10^{%T}'"
                : "set yrange [0.5*least:1.5*most]\nset ytics (0.01, 0.02, 0.05, 0.1, 0.2, 0.5)");
    for (int method = 0; method < FRONTIER_METHODS; method++)
        for (int precision = 0; precision < FRONTIER_PRECISIONS; precision++)
            fprintf(script,
                    "  data using (strcol(1) eq '%s' && strcol(3) eq '%s' ? $6 : NaN):%d "
                    "with points pt %d ps 0.8 lw 1.2 lc rgb '%s' title '%s %s', \\\n",
                    method_names[method], precision_names[precision], column, symbols[precision],
                    colours[method], method_names[method], precision_names[precision]);
    write_line(script, field, SIDE_SEARCH);
    write_line(script, field, SIDE_HOST);
}

/* Ranges, so that a way that met a slow moment does not press the others together. */
static void write_ranges(FILE *script, const struct frontier *frontier)
{
    double least = INFINITY, most = 0, shortest = INFINITY, sum = 0;
    for (int k = 0; k < frontier->point_count; k++) {
        const struct frontier_point *point = &frontier->points[k];
        const double error = frontier_error(point, FRONTIER_TRIGONOMETRIC);
        least = fmin(least, error);
        most = fmax(most, error);
        shortest = fmin(shortest, frontier_time(frontier, point));
        sum += log(frontier_time(frontier, point));
    }
    const double typical = exp(sum / frontier->point_count);
    fprintf(script, "least = %g\nmost = %g\nset xrange [%g:%g]\n", least, most, 0.8 * shortest,
            fmax(6 * typical, 3 * shortest));
}

bool frontier_draw(const struct frontier *frontier)
{
    FILE *script = plot_file(frontier->output, "frontier.gp");
    fprintf(script, "set terminal pngcairo size 1500,880 font 'Sans,12' background '#ffffff'\n"
                    "set output 'frontier.png'\nset datafile separator ','\nset encoding utf8\n"
                    "data = 'frontier.csv'\nset logscale xy\n"
                    "set grid lc rgb '#dddddd'\nset xlabel 'time from positions to Jacobians "
                    "[ns a particle]'\nset tics nomirror\nset border 3\n"
                    "set xtics (10, 20, 50, 100, 200, 500, 1000, 2000, 5000, 10000, 20000)\n");
    write_ranges(script, frontier);
    fprintf(script,
            "set multiplot title \"%d particles, H = %g spacings, %d thread%s, %s\\n"
            "every point one way: method, kernel, precision, path, option; black: the frontier, "
            "dashed: over lists that the host found\"\n",
            frontier->count, frontier->settings.support, frontier->settings.threads,
            frontier->settings.threads > 1 ? "s" : "", machine_cpu());
    fprintf(script, "set tmargin at screen 0.87\nset bmargin at screen 0.40\n"
                    "set lmargin at screen 0.07\nset rmargin at screen 0.485\nunset key\n");
    write_panel(script, frontier, FRONTIER_TRIGONOMETRIC);
    fprintf(script, "set lmargin at screen 0.57\nset rmargin at screen 0.985\n"
                    "set key at screen 0.5, screen 0.06 center center maxrows 3 font ',10'\n");
    write_panel(script, frontier, FRONTIER_LINEAR);
    fprintf(script, "unset multiplot\n");
    plot_close(script, "frontier.gp");
    return plot_run(frontier->output, "frontier.gp");
}
