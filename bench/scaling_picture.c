/* The picture of scaling: a panel each for sizes, threads, neighbours, and for clouds and orders.
 */
#include "machine.h"
#include "plot.h"
#include "scaling.h"

#include <stdio.h>

/* Colour-blind-safe: Okabe, Ito 2008, "Color universal design". */
static const char *const colours[SCALING_WORKS] = {"#999999", "#0072B2", "#009E73", "#D55E00"};

enum { FIRST_TIME_COLUMN = 8 }; /* of scaling.csv, from 1 */

static void write_lines(FILE *script, const char *group, const char *more, int x_column)
{
    fprintf(script, "plot \\\n");
    for (int work = 0; work < SCALING_WORKS; work++)
        fprintf(script,
                "  data using (strcol(1) eq '%s'%s ? $%d : NaN):%d with linespoints pt 7 ps 0.8 "
                "lw 1.6 lc rgb '%s' title '%s'%s\n",
                group, more, x_column, FIRST_TIME_COLUMN + work, colours[work],
                scaling_work_names[work], work + 1 < SCALING_WORKS ? ", \\" : "");
}

static void write_speed_up(FILE *script, const struct scaling *scaling)
{
    fprintf(script, "plot x with lines lw 1 dt 2 lc rgb 'black' title 'ideal', \\\n");
    for (int work = 0; work < SCALING_WORKS; work++) {
        const struct scaling_case *single = scaling->cases;
        while (single->group[0] != 't') /* "threads" */
            single++;
        fprintf(script,
                "  data using (strcol(1) eq 'threads' ? $4 : NaN):(%.6g / $%d) with linespoints "
                "pt 7 ps 0.8 lw 1.6 lc rgb '%s' title '%s'%s\n",
                scaling_time(single, (enum scaling_work)work), FIRST_TIME_COLUMN + work,
                colours[work], scaling_work_names[work], work + 1 < SCALING_WORKS ? ", \\" : "");
    }
}

static void write_bars(FILE *script)
{
    fprintf(script, "plot \\\n");
    for (int work = 0; work < SCALING_WORKS; work++)
        fprintf(script,
                "  '< grep -E \"^(order|cloud),\" scaling.csv' using %d:xtic(2) with histograms "
                "fs solid 0.85 lc rgb '%s' title '%s'%s\n",
                FIRST_TIME_COLUMN + work, colours[work], scaling_work_names[work],
                work + 1 < SCALING_WORKS ? ", \\" : "");
}

static void write_start(FILE *script, const struct scaling *scaling)
{
    fprintf(script, "set terminal pngcairo size 1400,1000 font 'Sans,12' background '#ffffff'\n"
                    "set output 'scaling.png'\nset datafile separator ','\nset encoding utf8\n"
                    "data = 'scaling.csv'\nset grid lc rgb '#dddddd'\nset tics nomirror\n"
                    "set border 3\nset datafile missing NaN\n");
    fprintf(script,
            "set multiplot layout 2,2 title \"%d particles, H = %g spacings, %d thread%s, %s, "
            "but for what a panel changes\"\n",
            scaling->settings.particles, scaling->settings.support, scaling->settings.threads,
            scaling->settings.threads > 1 ? "s" : "", machine_cpu());
    fprintf(script, "set ylabel 'time [ns a particle]'\nset yrange [0:*]\n");
}

bool scaling_draw(const struct scaling *scaling)
{
    FILE *script = plot_file(scaling->output, "scaling.gp");
    write_start(script, scaling);
    fprintf(script, "set title 'number of particles'\nset logscale x\nset format x '10^{%%T}'\n"
                    "set xlabel 'particles'\nset key right top\n");
    write_lines(script, "particles", "", 3);
    fprintf(script,
            "set title 'threads'\nunset logscale x\nset format x '%%g'\n"
            "set xlabel 'threads'\nset ylabel 'speed-up'\nset xrange [1:%d]\n"
            "set key left top\n",
            scaling->settings.threads > 1 ? scaling->settings.threads : 2);
    write_speed_up(script, scaling);
    fprintf(script, "set title 'neighbours in 3D'\nset xrange [0:*]\n"
                    "set xlabel 'pairs a particle'\nset ylabel 'time [ns a particle]'\n");
    write_lines(script, "neighbours", " && $5 == 3", 6);
    fprintf(script, "set title 'order in memory, and shape of the cloud'\nunset xlabel\n"
                    "set xrange [*:*]\nset style data histograms\n"
                    "set style histogram clustered gap 1\nset xtics rotate by -25\n"
                    "set key right top\nset rmargin 9\n");
    write_bars(script);
    fprintf(script, "unset multiplot\n");
    plot_close(script, "scaling.gp");
    return plot_run(scaling->output, "scaling.gp");
}
