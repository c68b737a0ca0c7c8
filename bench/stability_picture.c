/* The pictures of stability: what bounds the errors, who can be corrected, and what a solver's
 * author reads from it. */
#include "machine.h"
#include "plot.h"
#include "stability.h"

#include <stdio.h>

/* Colour-blind-safe: Okabe, Ito 2008, "Color universal design". */
static const char *const colours[STABILITY_METHODS] = {
    [SPHG_KGC] = "#0072B2",  [SPHG_MLS] = "#009E73",   [SPHG_RKPM] = "#56B4E9",
    [SPHG_CMLS] = "#D55E00", [SPHG_CRKPM] = "#E69F00", [SPHG_PLAIN] = "#999999"};
static const char *const policy_colours[STABILITY_POLICIES] = {"#0072B2", "#D55E00", "#E69F00",
                                                               "#009E73"};
static const char *const precision_colours[STABILITY_PRECISIONS] = {"#D55E00", "#0072B2",
                                                                    "#009E73"};

/* gnuplot: filled circle, open square, open triangle */
static const int symbols[STABILITY_PRECISIONS] = {7, 4, 8};

/* Of stability.csv, from 1. */
enum {
    AT = 5,
    RANK = 8,
    DECOMPOSED = 10,
    FULL_RATIO,
    TOUCHED_RATIO,
    LINEAR_MEAN = 17,
    LINEAR_FULL
};
enum { NOISE = 19, CORRECTION_JUMP = 23, CORRECTION_JUMP_LEFT };

/* Zero has no place on a logarithmic axis: it is drawn where `zero` says. */
struct axis {
    const char *title, *label, *settings;
    double zero;
};

static const struct axis axes[SWEEPS] = {
    [SWEEP_SLAB] = {"slab becomes thin", "(spacing / thickness)^2",
                    "set logscale x\nset format x '10^{%T}'\nset xrange [0.5:2e12]\n"
                    "set xtics 1, 1000",
                    0},
    [SWEEP_THRESHOLD] = {"threshold: block and wedge", "eps",
                         "set logscale x\nset format x '10^{%T}'\nset xrange [5e-7:0.6]\n"
                         "set xtics autofreq",
                         0},
    [SWEEP_OFFSET] = {"far from the origin", "distance / H",
                      "set logscale x\nset format x '10^{%T}'\nset xrange [0.05:2e8]\n"
                      "set xtics 1, 100\nset xtics add ('0' 0.1)",
                      0.1},
    [SWEEP_SCALE] = {"unit of length", "k, all lengths times 2^k",
                     "unset logscale x\nset format x '%g'\nset xrange [-360:360]\n"
                     "set xtics -340, 170",
                     0},
    [SWEEP_NEIGHBOURS] = {"number of neighbours", "neighbours of a target",
                          "set logscale x\nset format x '%g'\nset xrange [0.4:400]\n"
                          "set xtics (1, 3, 10, 30, 100, 300)\nset xtics add ('0' 0.5)",
                          0.5},
    [SWEEP_VOLUMES] = {"uneven volumes", "largest / smallest volume",
                       "set logscale x\nset format x '10^{%T}'\nset xrange [0.5:2e12]\n"
                       "set xtics 1, 1000",
                       0},
    [SWEEP_JITTER] = {"disorder", "jitter / spacing",
                      "unset logscale x\nset format x '%g'\nset xrange [-0.03:1.03]\n"
                      "set xtics 0, 0.25",
                      0},
    [SWEEP_MERGING] = {"two layers merge", "distance of the layers / H",
                       "unset logscale x\nset format x '%g'\nset xrange [-0.03:1.13]\n"
                       "set xtics 0, 0.25",
                       0},
};

static FILE *open_script(const char *directory, const char *name, int width, int height)
{
    char script_name[64];
    snprintf(script_name, sizeof script_name, "%s.gp", name);
    FILE *script = plot_file(directory, script_name);
    fprintf(script,
            "set terminal pngcairo size %d,%d font 'Sans,12' background '#ffffff'\n"
            "set output '%s.png'\nset datafile separator ','\nset encoding utf8\n"
            "data = 'stability.csv'\nset grid lc rgb '#dddddd'\nset tics nomirror\nset border 3\n"
            "set datafile missing NaN\nshown(x, zero) = x == 0 && zero > 0 ? zero : x\n"
            "of(s, m, t) = strcol(1) eq s && strcol(3) eq m && strcol(4) eq t\n"
            "worse(a, b) = a > b ? a : b > 0 ? b : NaN\n",
            width, height, name);
    return script;
}

static bool close_script(FILE *script, const char *directory, const char *name)
{
    char script_name[64];
    snprintf(script_name, sizeof script_name, "%s.gp", name);
    fprintf(script, "unset multiplot\n");
    plot_close(script, script_name);
    return plot_run(directory, script_name);
}

/* Where the panel stands, of two rows, the first at the upper left; room for a key below. */
static void write_place(FILE *script, int panel, int columns, double below)
{
    const double width = 1.0 / columns, height = (0.94 - below) / 2;
    const double left = width * (panel % columns), top = 0.94 - height * (panel / columns);
    fprintf(script, "set lmargin at screen %.4f\nset rmargin at screen %.4f\n", left + 0.18 * width,
            left + (columns == 4 ? 0.83 : 0.9) * width);
    fprintf(script, "set tmargin at screen %.4f\nset bmargin at screen %.4f\n", top - 0.09 * height,
            top - 0.82 * height);
}

static void write_axis(FILE *script, const struct axis *axis)
{
    fprintf(script, "set title '%s'\nset xlabel '%s'\n%s\n", axis->title, axis->label,
            axis->settings);
}

/* The series of one sweep, of one or of all policies. */
static void write_using(FILE *script, enum stability_sweep sweep, int policy, sphg_method method,
                        enum precision precision, const char *y)
{
    fprintf(script, "  data using (of('%s', '%s', '%s')", sweep_names[sweep], method_names[method],
            precision_names[precision]);
    if (policy >= 0)
        fprintf(script, " && strcol(2) eq '%s'", policy_names[policy]);
    fprintf(script, " ? shown($%d, %g) : NaN):(%s) ", AT, axes[sweep].zero, y);
}

static bool has_method(enum stability_sweep sweep, sphg_method method)
{
    return method != SPHG_PLAIN || (sweep != SWEEP_THRESHOLD && sweep != SWEEP_MERGING);
}

/* ---- Errors over their bounds ---------------------------------------------------------------- */

static void write_ratio_panel(FILE *script, enum stability_sweep sweep)
{
    char y[64];
    snprintf(y, sizeof y, "worse($%d, $%d)", FULL_RATIO, TOUCHED_RATIO);
    write_place(script, (int)sweep, 4, 0.07);
    write_axis(script, &axes[sweep]);
    fprintf(
        script,
        "set ylabel '%s' offset 1.5,0\nplot 10 with lines lw 1.5 dt 2 lc rgb 'black' notitle, \\\n"
        "  16 with lines lw 1.5 dt 3 lc rgb 'black' notitle",
        sweep % 4 == 0 ? "error / bound" : "");
    for (int method = 0; method < STABILITY_METHODS; method++)
        for (int precision = 0; precision < STABILITY_PRECISIONS; precision++) {
            if (!has_method(sweep, (sphg_method)method))
                continue;
            fprintf(script, ", \\\n");
            write_using(script, sweep, -1, (sphg_method)method, (enum precision)precision, y);
            fprintf(script, "with points pt %d ps 0.7 lc rgb '%s' notitle", symbols[precision],
                    colours[method]);
        }
    if (sweep == SWEEP_MERGING) { /* the key of all panels */
        for (int method = 0; method < STABILITY_METHODS; method++)
            fprintf(script, ", \\\n  keyentry with points pt 5 ps 1.4 lc rgb '%s' title '%s'",
                    colours[method], method_names[method]);
        for (int precision = 0; precision < STABILITY_PRECISIONS; precision++)
            fprintf(script, ", \\\n  keyentry with points pt %d ps 1.1 lc rgb 'black' title '%s'",
                    symbols[precision], precision_names[precision]);
    }
    fprintf(script, "\n");
}

static bool draw_ratios(const struct stability *stability)
{
    FILE *script = open_script(stability->output, "stability_ratios", 1600, 900);
    fprintf(script,
            "set multiplot title \"Largest error of a gradient over its bound, beside "
            "brute force in quadruple precision (H = %g spacings, %s)\\n"
            "dashed: 10, the limit at full rank; dotted: 16, the limit where the "
            "threshold acts; equal marks cover each other\"\n",
            stability->settings.support, machine_cpu());
    fprintf(script, "set logscale y\nset yrange [1e-4:40]\nset format y '10^{%%T}'\n"
                    "set key at screen 0.5, screen 0.035 center center vertical maxrows 1 "
                    "samplen 1.5 width 2\n");
    for (int sweep = 0; sweep < SWEEPS; sweep++)
        write_ratio_panel(script, (enum stability_sweep)sweep);
    return close_script(script, stability->output, "stability_ratios");
}

/* ---- Ranks and decompositions ---------------------------------------------------------------- */

static void write_rank_panel(FILE *script, enum stability_sweep sweep)
{
    char rank[32], decomposed[32];
    snprintf(rank, sizeof rank, "$%d", RANK);
    snprintf(decomposed, sizeof decomposed, "3 * $%d", DECOMPOSED);
    const int panel = (int)sweep - (sweep > SWEEP_SCALE);
    write_place(script, panel, 4, 0);
    write_axis(script, &axes[sweep]);
    fprintf(script, "set ylabel '%s' offset 1,0\nset y2label '%s' offset -2.5,0\nplot",
            panel % 4 == 0 ? "mean rank (lines)" : "",
            panel % 4 == 3 || sweep == SWEEP_MERGING ? "decomposed [%] (marks)" : "");
    const char *separator = " \\\n";
    for (int method = SPHG_KGC; method <= SPHG_CRKPM; method++) {
        const int dash = method == SPHG_RKPM || method == SPHG_CRKPM ? 2 : 1;
        fprintf(script, "%s", separator);
        write_using(script, sweep, SPHG_BLEND, (sphg_method)method, PRECISION_F32, rank);
        fprintf(script, "with lines lw 2 dt %d lc rgb '%s' notitle, \\\n", dash, colours[method]);
        write_using(script, sweep, SPHG_BLEND, (sphg_method)method, PRECISION_F32, decomposed);
        fprintf(script, "with points pt %d ps 0.8 lc rgb '%s' notitle", dash == 1 ? 7 : 6,
                colours[method]);
        separator = ", \\\n";
    }
    for (int method = 0; method <= SPHG_CRKPM && sweep == SWEEP_MERGING; method++)
        fprintf(script, ", \\\n  keyentry with linespoints pt %d lw 2 dt %d lc rgb '%s' title '%s'",
                method == SPHG_RKPM || method == SPHG_CRKPM ? 6 : 7,
                method == SPHG_RKPM || method == SPHG_CRKPM ? 2 : 1, colours[method],
                method_names[method]);
    fprintf(script, "\n");
}

static bool draw_ranks(const struct stability *stability)
{
    FILE *script = open_script(stability->output, "stability_ranks", 1600, 900);
    fprintf(script, "set multiplot title 'Fully corrected directions, and share of particles that "
                    "the eigensolver decides (blend, eps = 0.01 but for the second panel, f32)'\n"
                    "set yrange [-0.1:3.1]\nset ytics 0, 1\nset border 11\n"
                    "set y2range [-3.333:103.333]\nset y2tics 0, 25\n"
                    "set key at screen 0.88, screen 0.25 center center vertical samplen 4 "
                    "spacing 1.4\n");
    for (int sweep = 0; sweep < SWEEPS; sweep++)
        if (sweep != SWEEP_SCALE)
            write_rank_panel(script, (enum stability_sweep)sweep);
    return close_script(script, stability->output, "stability_ranks");
}

/* ---- What an author reads -------------------------------------------------------------------- */

/* One column of a sweep under the four policies, KGC. */
static void write_policies(FILE *script, enum stability_sweep sweep, enum precision precision,
                           int column)
{
    static const double widths[STABILITY_POLICIES] = {2, 7, 4, 1.3}; /* equal ones lie nested */
    char y[32];
    snprintf(y, sizeof y, "$%d > 0 ? $%d : NaN", column, column);
    for (int policy = 0; policy < STABILITY_POLICIES; policy++) {
        fprintf(script, "%s", policy ? ", \\\n" : "plot \\\n");
        write_using(script, sweep, policy, SPHG_KGC, precision, y);
        fprintf(script, "with lines lw %g lc rgb '%s' title '%s'", widths[policy],
                policy_colours[policy], policy_names[policy]);
    }
}

static void write_precisions(FILE *script, enum stability_sweep sweep, int column)
{
    char y[32];
    snprintf(y, sizeof y, "$%d > 0 ? $%d : NaN", column, column);
    for (int precision = 0; precision < STABILITY_PRECISIONS; precision++) {
        fprintf(script, "%s", precision ? ", \\\n" : "plot \\\n");
        write_using(script, sweep, SPHG_BLEND, SPHG_KGC, (enum precision)precision, y);
        fprintf(script, "with linespoints pt %d ps 0.9 lw 1.8 lc rgb '%s' title '%s'",
                symbols[precision], precision_colours[precision], precision_names[precision]);
    }
    fprintf(script, "\n");
}

static void write_threshold_panels(FILE *script)
{
    struct axis axis = axes[SWEEP_THRESHOLD];
    axis.title = "what a larger eps costs: error of a linear field";
    write_place(script, 0, 3, 0);
    write_axis(script, &axis);
    fprintf(script, "set ylabel 'mean |J_i - J| / |J|'\nset yrange [0:*]\nset key left top Left "
                    "reverse samplen 2\n");
    write_policies(script, SWEEP_THRESHOLD, PRECISION_F32, LINEAR_MEAN);
    fputc('\n', script);
    axis.title = "what a smaller eps costs: noise of a random field";
    write_place(script, 1, 3, 0);
    write_axis(script, &axis);
    fprintf(script, "set ylabel 'largest |J_i| H, field in [-1, 1]'\nset yrange [1:1e4]\n"
                    "set logscale y\nset format y '10^{%%T}'\nset key right top\n");
    write_policies(script, SWEEP_THRESHOLD, PRECISION_F32, NOISE);
    fputc('\n', script);
    axis.title = "what a precision gives: rounding where rank is full";
    write_place(script, 2, 3, 0);
    write_axis(script, &axis);
    fprintf(script, "set ylabel 'largest |J_i - J| / |J|, linear field'\nset yrange [1e-16:1]\n");
    write_precisions(script, SWEEP_THRESHOLD, LINEAR_FULL);
}

static void write_distance_panel(FILE *script)
{
    struct axis axis = axes[SWEEP_OFFSET];
    axis.title = "far from the origin: digits that positions lose";
    write_place(script, 3, 3, 0);
    write_axis(script, &axis);
    fprintf(script, "set ylabel 'mean |J_i - J| / |J|, linear field'\nset yrange [1e-17:10]\n"
                    "set key left top Left reverse samplen 2\n");
    write_precisions(script, SWEEP_OFFSET, LINEAR_MEAN);
}

static void write_jump_panel(FILE *script)
{
    struct axis axis = axes[SWEEP_MERGING];
    axis.title = "two layers merge: how C jumps (uncorrected: C = 1)";
    write_place(script, 4, 3, 0);
    write_axis(script, &axis);
    fprintf(script,
            "set ylabel 'largest change of C in a step of H / 1000'\nset yrange [1e-4:1e6]\n"
            "set key center top vertical maxrows 3 Right noreverse samplen 1.5 font ',10'\n");
    write_policies(script, SWEEP_MERGING, PRECISION_F64, CORRECTION_JUMP);
    char y[32];
    snprintf(y, sizeof y, "$%d > 0 ? $%d : NaN", CORRECTION_JUMP_LEFT, CORRECTION_JUMP_LEFT);
    fprintf(script, ", \\\n");
    write_using(script, SWEEP_MERGING, SPHG_BLEND, SPHG_KGC, PRECISION_F64, y);
    fprintf(script, "with linespoints pt 6 ps 0.7 dt 3 lw 2 lc rgb '%s' title 'blend, step / 256'",
            policy_colours[SPHG_BLEND]);
    fprintf(script, ", \\\n");
    write_using(script, SWEEP_MERGING, SPHG_REPLACE, SPHG_KGC, PRECISION_F64, y);
    fprintf(script,
            "with linespoints pt 6 ps 0.7 dt 3 lw 2 lc rgb '%s' title 'replace, step / 256'\n",
            policy_colours[SPHG_REPLACE]);
}

static void write_neighbour_panel(FILE *script)
{
    struct axis axis = axes[SWEEP_NEIGHBOURS];
    axis.title = "few neighbours: error of a linear field";
    write_place(script, 5, 3, 0);
    write_axis(script, &axis);
    fprintf(script,
            "set ylabel 'mean |J_i - J| / |J|'\nunset logscale y\nset format y '%%g'\n"
            "set yrange [0:1.2]\nset key right top maxrows 6 samplen 2 font ',12'\nplot \\\n");
    char y[32];
    snprintf(y, sizeof y, "$%d", LINEAR_MEAN);
    for (int method = 0; method < STABILITY_METHODS; method++) {
        write_using(script, SWEEP_NEIGHBOURS, SPHG_BLEND, (sphg_method)method, PRECISION_F32, y);
        fprintf(script, "with linespoints pt 7 ps 0.6 lw 1.8 lc rgb '%s' title '%s'%s\n",
                colours[method], method_names[method],
                method + 1 < STABILITY_METHODS ? ", \\" : "");
    }
}

static bool draw_reading(const struct stability *stability)
{
    FILE *script = open_script(stability->output, "stability_reading", 1600, 900);
    fprintf(script,
            "set multiplot title 'KGC, H = %g spacings, cubic spline, blend, eps = 0.01, "
            "but for what a panel changes'\n",
            stability->settings.support);
    write_threshold_panels(script);
    write_distance_panel(script);
    write_jump_panel(script);
    write_neighbour_panel(script);
    return close_script(script, stability->output, "stability_reading");
}

bool stability_draw(const struct stability *stability)
{
    const bool ratios = draw_ratios(stability), ranks = ratios && draw_ranks(stability);
    return ranks && draw_reading(stability);
}
