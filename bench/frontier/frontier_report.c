/* The frontier as tables on a terminal, as CSV, and for machines. */
#include "frontier.h"
#include "report/machine.h"
#include "particles/numbers.h"
#include "report/plot.h"
#include "report/report_json.h"
#include "report/text.h"

#include <stdio.h>
#include <stdlib.h>

const char *const path_names[PATHS] = {"kept lists", "list-free", "host's lists"};

double frontier_error(const struct frontier_point *point, enum frontier_field field)
{
    return field == FRONTIER_LINEAR ? point->most[field] : point->mean[field];
}

double frontier_time(const struct frontier *frontier, const struct frontier_point *point)
{
    return 1e6 * samples_wall(&point->time).median / frontier->count;
}

static const char *option_name(const struct frontier_point *point)
{
    return point->method == SPHG_PLAIN ? "one sweep" : point->by_table ? "table" : "fused";
}

static int compare_times(const void *left, const void *right)
{
    const struct frontier_point *const *a = left, *const *b = right;
    const double time_a = samples_wall(&(*a)->time).median,
                 time_b = samples_wall(&(*b)->time).median;
    return (time_a > time_b) - (time_a < time_b);
}

void frontier_sort(const struct frontier_point *points[], int count)
{
    qsort(points, (size_t)count, sizeof *points, compare_times);
}

enum frontier_side frontier_side(const struct frontier_point *point)
{
    return point->path == PATH_HOST_LISTS ? SIDE_HOST : SIDE_SEARCH;
}

int frontier_points(const struct frontier *frontier, enum frontier_field field,
                    enum frontier_side side, const struct frontier_point *points[])
{
    int count = 0;
    for (int k = 0; k < frontier->point_count; k++)
        if (frontier->points[k].on_frontier[field] && frontier_side(&frontier->points[k]) == side)
            points[count++] = &frontier->points[k];
    frontier_sort(points, count);
    return count;
}

static void print_header(const char *title)
{
    printf("\n%s\n  %-7s%-16s%-7s%-14s%-11s%11s%15s%11s%10s%10s%10s\n", title, "method", "kernel",
           "type", "path", "option", "ns", "(min-max)", "trig. mean", "max", "lin. mean", "max");
}

static void print_point(const struct frontier *frontier, const struct frontier_point *point)
{
    const struct spread spread = samples_wall(&point->time);
    const double scale = 1e6 / frontier->count;
    char range[TEXT_SIZE];
    snprintf(range, sizeof range, "%.0f-%.0f", scale * spread.min, scale * spread.max);
    printf("  %-7s%-16s%-7s%-14s%-11s%11.1f%15s%11.2e%10.1e%10.1e%10.1e\n",
           method_names[point->method], kernel_title(point->kernel),
           precision_names[point->precision], path_names[point->path], option_name(point),
           scale * spread.median, range, point->mean[0], point->most[0], point->mean[1],
           point->most[1]);
}

static void print_fastest(const struct frontier *frontier, sphg_method method,
                          enum precision precision, enum frontier_side side)
{
    const struct frontier_point *fastest = NULL;
    for (int k = 0; k < frontier->point_count; k++) {
        const struct frontier_point *point = &frontier->points[k];
        if (point->method == method && point->precision == precision &&
            frontier_side(point) == side &&
            (!fastest || frontier_time(frontier, point) < frontier_time(frontier, fastest)))
            fastest = point;
    }
    print_point(frontier, fastest);
}

static void print_frontier(const struct frontier *frontier, enum frontier_field field,
                           enum frontier_side side)
{
    const struct frontier_point **points =
        allocate_or_exit((size_t)frontier->point_count, sizeof *points);
    const int count = frontier_points(frontier, field, side, points);
    for (int k = 0; k < count; k++)
        print_point(frontier, points[k]);
    free(points);
}

static void print_frontiers(const struct frontier *frontier)
{
    print_header("frontier: nothing is faster and, on average, nearer to the trigonometric field");
    print_frontier(frontier, FRONTIER_TRIGONOMETRIC, SIDE_SEARCH);
    print_header("frontier: nothing is faster and, at worst, nearer to the linear field");
    print_frontier(frontier, FRONTIER_LINEAR, SIDE_SEARCH);
    print_header("frontiers of those who search for themselves, in the same order");
    print_frontier(frontier, FRONTIER_TRIGONOMETRIC, SIDE_HOST);
    printf("\n");
    print_frontier(frontier, FRONTIER_LINEAR, SIDE_HOST);
}

void frontier_print(const struct frontier *frontier)
{
    const struct settings *settings = &frontier->settings;
    char count[TEXT_SIZE];
    printf("particles  %s, a block with free surfaces, jittered by %g spacings, H = %g spacings, "
           "%.1f pairs a particle\n",
           text_grouped(frontier->count, count), settings->jitter, settings->support,
           frontier->pairs);
    text_print_machine(settings->threads);
    printf("times      ns a particle from positions to Jacobians, median of %d rounds through %d "
           "ways;\n           host's lists: taken over, not searched for\n",
           settings->repetitions, frontier->point_count);
    printf("errors     |J_i - J|_F over the root mean square of |J|_F, over all particles, of\n"
           "           v_a = sin(k x_a) cos(k x_b), 20 spacings a wave, and of v = (-y, x, 2z)\n");
    text_print_if_busy(&frontier->points[0].time, settings->threads);
    print_header("fastest way of each method and precision, whatever its error");
    for (int k = 0; k < FRONTIER_METHODS * FRONTIER_PRECISIONS * SIDES; k++)
        print_fastest(frontier, (sphg_method)(k / SIDES / FRONTIER_PRECISIONS),
                      (enum precision)(k / SIDES % FRONTIER_PRECISIONS),
                      (enum frontier_side)(k % SIDES));
    print_frontiers(frontier);
}

void frontier_write_csv(const struct frontier *frontier)
{
    FILE *file = plot_file(frontier->output, "frontier.csv");
    fprintf(file, "# %s, %d threads, %s\n", machine_cpu(), frontier->settings.threads,
            machine_date());
    fprintf(file, "method,kernel,precision,path,option,ns,ns_min,ns_max,trigonometric_mean,"
                  "trigonometric_max,linear_mean,linear_max,trigonometric_frontier,"
                  "linear_frontier\n");
    for (int k = 0; k < frontier->point_count; k++) {
        const struct frontier_point *point = &frontier->points[k];
        const struct spread spread = samples_wall(&point->time);
        const double scale = 1e6 / frontier->count;
        fprintf(file, "%s,%s,%s,%s,%s,%.6g,%.6g,%.6g,%.6e,%.6e,%.6e,%.6e,%d,%d\n",
                method_names[point->method], kernel_names[point->kernel],
                precision_names[point->precision], path_names[point->path], option_name(point),
                scale * spread.median, scale * spread.min, scale * spread.max, point->mean[0],
                point->most[0], point->mean[1], point->most[1], point->on_frontier[0],
                point->on_frontier[1]);
    }
    plot_close(file, "frontier.csv");
}

/* The points of each frontier, fastest first: "1", "2" and so on, over the host's lists "a", "b".
 */
void frontier_write_steps(const struct frontier *frontier)
{
    static const char *const fields[] = {"trigonometric", "linear"}, *const sides[] = {"search",
                                                                                       "host"};
    const struct frontier_point **points =
        allocate_or_exit((size_t)frontier->point_count, sizeof *points);
    FILE *file = plot_file(frontier->output, "frontier_steps.csv");
    fprintf(file, "field,side,mark,ns,error,method,kernel,precision,path,option\n");
    for (int k = 0; k < FRONTIER_FIELDS * SIDES; k++) {
        const enum frontier_field field = (enum frontier_field)(k / SIDES);
        const enum frontier_side side = (enum frontier_side)(k % SIDES);
        const int count = frontier_points(frontier, field, side, points);
        for (int n = 0; n < count; n++) {
            char mark[16];
            snprintf(mark, sizeof mark, side == SIDE_HOST ? "%c" : "%d",
                     side == SIDE_HOST ? 'a' + n % 26 : n + 1);
            fprintf(file, "%s,%s,%s,%.6g,%.6e,%s,%s,%s,%s,%s\n", fields[field], sides[side], mark,
                    frontier_time(frontier, points[n]), frontier_error(points[n], field),
                    method_names[points[n]->method], kernel_title(points[n]->kernel),
                    precision_names[points[n]->precision], path_names[points[n]->path],
                    option_name(points[n]));
        }
    }
    plot_close(file, "frontier_steps.csv");
    free(points);
}

void frontier_write_json(const struct frontier *frontier, const char *path, const char *executable)
{
    struct report *report = report_create(executable, frontier->settings.threads);
    report_number(report, "particles", frontier->count);
    report_number(report, "support_spacings", frontier->settings.support);
    report_number(report, "jitter", frontier->settings.jitter);
    report_number(report, "pairs_per_particle", frontier->pairs);
    for (int k = 0; k < frontier->point_count; k++) {
        const struct frontier_point *point = &frontier->points[k];
        char name[160];
        const struct counter counters[] = {
            {"ns_per_particle", frontier_time(frontier, point)},
            {"trigonometric_error_mean", point->mean[FRONTIER_TRIGONOMETRIC]},
            {"trigonometric_error_max", point->most[FRONTIER_TRIGONOMETRIC]},
            {"linear_error_mean", point->mean[FRONTIER_LINEAR]},
            {"linear_error_max", point->most[FRONTIER_LINEAR]},
            {"on_trigonometric_frontier", point->on_frontier[FRONTIER_TRIGONOMETRIC]},
            {"on_linear_frontier", point->on_frontier[FRONTIER_LINEAR]},
            {NULL, 0}};
        snprintf(name, sizeof name, "frontier/%s/%s/%s/%s/%s", method_names[point->method],
                 kernel_names[point->kernel], precision_names[point->precision],
                 path_names[point->path], option_name(point));
        report_benchmark(report, name, &point->time, counters);
    }
    report_write(report, path);
}
