/* The pictures of the command `fields`: one gnuplot script each, left beside the data so that they
 * can be changed and run again. */
#include "fields.h"
#include "plot.h"

#include <math.h>
#include <stdio.h>
#include <string.h>

/* One picture of three panels: the field, the plain error, the corrected error. */
struct panels {
    const struct lattice_results *results;
    enum study_field field;
    bool curl;
};

/* Output, size and what all pictures share; the picture stands beside its script. */
static void write_start(FILE *script, const char *name)
{
    const int stem = (int)strlen(name) - (int)strlen(".gp");
    fprintf(script,
            "set terminal pngcairo size 1260,480 font 'Sans,12' background '#ffffff'\n"
            "set output '%.*s.png'\nset datafile separator ','\nset encoding utf8\n",
            stem, name);
}

static int position_in_order(sphg_method method)
{
    int k = 0;
    while (fields_order[k] != method)
        k++;
    return k;
}

/* Column of the CSV file, from 1. */
static int error_column(const struct panels *panels, sphg_method method)
{
    return 5 + position_in_order(method) + (panels->curl ? FIELDS_METHODS : 0);
}

static double largest_error(const struct panels *panels, sphg_method method)
{
    const struct study_errors *errors = &panels->results->errors[panels->field][method][0];
    return panels->curl ? errors->curl_max : fmax(errors->boundary_max, errors->inside_max);
}

/* "7.3·10^{-1}" in gnuplot's markup. */
static const char *power_of_ten(double value, char text[48])
{
    if (value == 0)
        return "0";
    const int exponent = (int)floor(log10(value));
    if (exponent >= -2 && exponent < 3)
        snprintf(text, 48, "%.3g", value);
    else
        snprintf(text, 48, "%.1f·10^{%d}", value / pow(10, exponent), exponent);
    return text;
}

/* Of fields computed exactly the error is rounding, 10 to 15 decades below the plain one: the
 * scale then starts under the rounding unit, and its lower third of colours covers all of that. */
static void write_scale(FILE *script, const struct panels *panels)
{
    const bool rounding = panels->field == FIELD_ROTATION;
    const bool wide = panels->results->setting.precision == PRECISION_F64;
    const double decades = !rounding ? 4 : wide ? 17 : 9;
    if (rounding)
        plot_palette(script, 1 - 2.5 / decades, 0.35);
    else
        plot_palette(script, 0.5, 0.5);
    fprintf(script, "least = 1e%d\nset cbrange [least:%s]\n", rounding ? -(int)decades : -3,
            rounding ? "1" : "3");
    fprintf(script, "set logscale cb\nset format cb '10^{%%T}'\n");
}

static void write_frame(FILE *script, const struct panels *panels)
{
    const struct lattice_results *results = panels->results;
    fprintf(script, "data = 'fields_%s_%s.csv'\nN = %d\nd = 2.0 / N\n",
            fields_kind_name(panels->field), results->name, results->setting.side);
    write_scale(script, panels);
    fprintf(script, "set xrange [-1:1]\nset yrange [-1:1]\nset size ratio -1\n"
                    "set xtics -1, 0.5\nset ytics -1, 0.5\nset tics out nomirror scale 0.5\n"
                    "set xlabel 'x' offset 0, 0.5\nset ylabel 'y' offset 2.2, 0\nunset key\n"
                    "set border lw 0.8\nset style fill solid noborder\n");
}

static void write_caption(FILE *script, const struct panels *panels)
{
    const struct study_setting *setting = &panels->results->setting;
    char text[48];
    fprintf(script, "set label 1 \"%s lattice, N = %d, H = %g d, %s, %s;  largest error of",
            panels->results->name, setting->side, setting->support, kernel_title(setting->kernel),
            precision_names[setting->precision]);
    for (int k = 0; k < FIELDS_METHODS; k++)
        if (fields_order[k] != SPHG_PLAIN && fields_order[k] != SPHG_KGC)
            fprintf(script, "  %s %s", method_names[fields_order[k]],
                    power_of_ten(largest_error(panels, fields_order[k]), text));
    fprintf(script, "\" at screen 0.5, 0.035 center font ',11' textcolor '#444444'\n");
}

/* Three squares, and room for the colour bar at the right. */
static void write_panel_place(FILE *script, int panel)
{
    const double left = 0.05 + 0.305 * panel;
    fprintf(script, "set lmargin at screen %.4f\nset rmargin at screen %.4f\n", left, left + 0.26);
    fprintf(script, "set bmargin at screen 0.18\nset tmargin at screen 0.863\n");
}

static void write_velocity_panel(FILE *script, const struct panels *panels)
{
    write_panel_place(script, 0);
    fprintf(script, "set title \"velocity\\n%s\" offset 0, -0.5\n",
            fields_kind_formula(panels->field));
    fprintf(script, "every = (N + 13) / 14\nstart = (N - 1) %% every / 2\n"
                    "shown(k) = int(k) %% N %% every == start && int(k) / N %% every == start\n"
                    "arrow = every * d / 1.9\n"
                    "plot data skip 1 using (shown($0) ? $1 - arrow * $3 / 2 : NaN)"
                    ":($2 - arrow * $4 / 2):(arrow * $3):(arrow * $4)"
                    " with vectors head filled size 0.045, 18 lw 1.4 lc '#31688e'\n");
}

static void write_error_panel(FILE *script, const struct panels *panels, int panel,
                              sphg_method method)
{
    char text[48];
    const int column = error_column(panels, method);
    const char *quantity = panels->curl ? "curl error" : "gradient error";
    write_panel_place(script, panel);
    fprintf(script, "set title \"%s of %s\\nat most %s\" offset 0, -0.5\n", quantity,
            method == SPHG_PLAIN ? "plain SPH" : method_names[method],
            power_of_ten(largest_error(panels, method), text));
    fprintf(script, "error(e) = e > least ? e : least\n");
    if (panels->results->setting.jitter > 0)
        fprintf(script,
                "plot data skip 1 using 1:2:(0.5 * d):(error($%d)) with circles lc palette\n",
                column);
    else
        fprintf(script, "plot data skip 1 using 1:2:(error($%d)) with image\n", column);
}

static void write_panels(FILE *script, const struct panels *panels)
{
    write_frame(script, panels);
    write_caption(script, panels);
    fprintf(script, "set multiplot\nunset colorbox\n");
    write_velocity_panel(script, panels);
    fprintf(script, "unset label 1\nset ylabel ''\n");
    write_error_panel(script, panels, 1, SPHG_PLAIN);
    fprintf(script,
            "set colorbox user origin 0.934, 0.18 size 0.013, 0.683\n"
            "set label 2 '%s' at screen 0.995, 0.93 right\n",
            panels->curl ? "|curl_i - curl|" : "|J_i - J|_F");
    write_error_panel(script, panels, 2, SPHG_KGC);
    fprintf(script, "unset multiplot\n");
}

/* Okabe, Ito 2008: eight colours that everyone can tell apart. The curves of the corrected methods
 * nearly coincide: their marks stand side by side, `shift` apart, instead of over each other. */
static const struct {
    sphg_method method;
    int shift;
    const char *style;
} curves[] = {
    {SPHG_PLAIN, 0, "lc '#000000' pt 5 ps 1.1"}, {SPHG_KGC, -2, "lc '#d55e00' pt 7 ps 1.1"},
    {SPHG_MLS, -1, "lc '#0072b2' pt 9 ps 1.2"},  {SPHG_RKPM, 0, "lc '#009e73' pt 11 ps 1.2"},
    {SPHG_CMLS, 1, "lc '#cc79a7' pt 13 ps 1.2"}, {SPHG_CRKPM, 2, "lc '#e69f00' pt 15 ps 1.1"},
};

/* Column of fields_convergence.csv, what it is, and how fast the corrected methods fall there. */
static void write_convergence_panel(FILE *script, const struct lattice_results *results, int panel,
                                    int column, const char *title, int order)
{
    const double left = 0.075 + 0.485 * panel;
    fprintf(script, "set lmargin at screen %.3f\nset rmargin at screen %.3f\n", left, left + 0.42);
    fprintf(script, "set title '%s'\n", title);
    const struct study_errors *first = &results->errors[FIELD_TRIGONOMETRIC][SPHG_KGC][0];
    const double guide = 0.55 * (column == 6 ? first->boundary_max : first->inside_max);
    fprintf(script,
            "plot %.4g * (%d / x)**%d with lines dt 2 lc '#888888' lw 1.5 title 'falls as d%s'",
            guide, results->setting.side, order, order == 2 ? "^2" : "");
    for (size_t k = 0; k < sizeof curves / sizeof curves[0]; k++) {
        fprintf(script,
                ", \\\n     data using (of('%s') ? $4 * 1.025**(%d) : NaN):%d"
                " with linespoints lw 1.2 %s",
                method_names[curves[k].method], curves[k].shift, column, curves[k].style);
        if (panel == 0)
            fprintf(script, " title '%s'", method_names[curves[k].method]);
        else
            fprintf(script, " notitle");
    }
    fprintf(script, "\n");
}

static void write_convergence_frame(FILE *script, const struct lattice_results *results)
{
    const int32_t side = results->setting.side;
    fprintf(script,
            "data = 'fields_convergence.csv'\n"
            "of(m) = strcol(1) eq '%s' && strcol(2) eq 'trigonometric' && strcol(3) eq m\n",
            results->name);
    fprintf(script, "set logscale xy\nset xrange [%g:%g]\nset xtics (%d, %d, %d)\n", 0.8 * side,
            5.0 * side, side, 2 * side, 4 * side);
    fprintf(script, "set yrange [2e-4:4]\nset format y '10^{%%T}'\nset grid ytics lc '#dddddd'\n"
                    "set key bottom left reverse Left vertical maxrows 7 samplen 3 spacing 1.15\n"
                    "set tics nomirror\nset bmargin at screen 0.19\nset tmargin at screen 0.92\n"
                    "set xlabel 'N (N x N particles, spacing d = 2 / N)' offset 0, 0.3\n");
    fprintf(script,
            "set label 1 '%s, %s lattice, H = %g d, %s, %s; equal curves drawn side by side'"
            " at screen 0.5, 0.035 center font ',11' textcolor '#444444'\n",
            fields_kind_formula(FIELD_TRIGONOMETRIC), results->name, results->setting.support,
            kernel_title(results->setting.kernel), precision_names[results->setting.precision]);
}

static void write_convergence(FILE *script, const struct lattice_results *results)
{
    write_convergence_frame(script, results);
    fprintf(script,
            "set multiplot\nset ylabel 'largest gradient error |J_i - J|_F' offset 0.5, 0\n");
    write_convergence_panel(script, results, 0, 6, "two outermost layers", 1);
    fprintf(script, "unset label 1\nset ylabel ''\n");
    const int inside_order = results->setting.jitter > 0 ? 1 : 2;
    write_convergence_panel(script, results, 1, 8, "inside", inside_order);
    fprintf(script, "unset multiplot\n");
}

static const char *const script_names[][4] = {
    {"fields_rotation.gp", "fields_trigonometric.gp", "fields_curl.gp", "fields_convergence.gp"},
    {"fields_rotation_jittered.gp", "fields_trigonometric_jittered.gp", "fields_curl_jittered.gp",
     "fields_convergence_jittered.gp"},
};

static void write_scripts(const char *directory, const struct lattice_results *results)
{
    const char *const *names = script_names[results->setting.jitter > 0];
    const struct panels pictures[] = {{results, FIELD_ROTATION, false},
                                      {results, FIELD_TRIGONOMETRIC, false},
                                      {results, FIELD_ROTATION, true}};
    for (int k = 0; k < 4; k++) {
        FILE *script = plot_file(directory, names[k]);
        write_start(script, names[k]);
        if (k < 3)
            write_panels(script, &pictures[k]);
        else
            write_convergence(script, results);
        plot_close(script, names[k]);
    }
}

bool fields_draw(const char *directory, const struct lattice_results results[2])
{
    write_scripts(directory, &results[0]);
    write_scripts(directory, &results[1]);
    for (int lattice = 0; lattice < 2; lattice++)
        for (int k = 0; k < 4; k++)
            if (!plot_run(directory, script_names[lattice][k]))
                return false;
    return true;
}
