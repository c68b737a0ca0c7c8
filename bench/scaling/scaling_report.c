/* Scaling as tables on a terminal, as CSV, and for machines. */
#include "report/machine.h"
#include "report/plot.h"
#include "report/report_json.h"
#include "scaling.h"
#include "report/text.h"

#include <stdio.h>
#include <string.h>

const char *const scaling_work_names[SCALING_WORKS] = {"search", "matrices", "gradient", "fused"};

double scaling_time(const struct scaling_case *one, enum scaling_work work)
{
    return 1e6 * samples_wall(&one->time[work]).median / one->count;
}

static void print_times(const struct scaling_case *one)
{
    for (int work = 0; work < SCALING_WORKS; work++) {
        const struct spread spread = samples_wall(&one->time[work]);
        const double scale = 1e6 / one->count;
        char text[TEXT_SIZE];
        snprintf(text, sizeof text, "%.1f (%.0f-%.0f)", scale * spread.median, scale * spread.min,
                 scale * spread.max);
        printf("%23s", text);
    }
}

static void print_case(const struct scaling_case *one)
{
    printf("  %-24s%8.1f%8.0f", one->label, one->pairs, one->bytes);
    print_times(one);
    printf("%11.1f%10.1e%s\n", 100 * one->deficient, one->error,
           one->not_finite > 0 ? "  NOT FINITE" : "");
}

static void print_group_header(const char *group)
{
    printf("\n  %-24s%8s%8s", group, "pairs", "bytes");
    for (int work = 0; work < SCALING_WORKS; work++)
        printf("%20s ns", scaling_work_names[work]);
    printf("%11s%10s\n", "deficient%", "error");
}

static int is_thread_case(const struct scaling_case *one)
{
    return strcmp(one->group, "threads") == 0;
}

static const struct scaling_case *find_single(const struct scaling *scaling)
{
    const struct scaling_case *one = scaling->cases;
    while (!is_thread_case(one))
        one++;
    return one;
}

static void print_speed_up(const struct scaling *scaling)
{
    const struct scaling_case *single = find_single(scaling);
    printf("\n  %-24s%16s", "threads", "");
    for (int work = 0; work < SCALING_WORKS; work++)
        printf("%23s", scaling_work_names[work]);
    printf("   speed-up, efficiency\n");
    for (int k = 0; k < scaling->case_count; k++) {
        const struct scaling_case *one = &scaling->cases[k];
        if (!is_thread_case(one))
            continue;
        printf("  %-40s", one->label);
        for (int work = 0; work < SCALING_WORKS; work++) {
            const double speed_up = scaling_time(single, (enum scaling_work)work) /
                                    scaling_time(one, (enum scaling_work)work);
            printf("%16.2f %4.0f %%", speed_up, 100 * speed_up / one->threads);
        }
        printf("\n");
    }
}

void scaling_print(const struct scaling *scaling)
{
    const struct settings *settings = &scaling->settings;
    char count[TEXT_SIZE];
    printf("particles  %s, lattice jittered by %g spacings, H = %g spacings, lattice order, but "
           "for what a\n           group changes; KGC, cubic spline, f32\n",
           text_grouped(settings->particles, count), settings->jitter, settings->support);
    text_print_machine(settings->threads);
    printf("times      ns a particle, median (min-max) of %d rounds through the cases of a group; "
           "fused:\n           matrices and gradient in one call; bytes: a particle, held by the "
           "neighbours\n",
           settings->repetitions);
    printf("errors     largest |J_i - J|_F / |J|_F of v = (-y, x, 2z), in 2D (-y, 2x), where rank "
           "is full\n");
    text_print_if_busy(&scaling->cases[0].time[SCALING_FUSED], settings->threads);
    for (int k = 0; k < scaling->case_count; k++) {
        if (k == 0 || strcmp(scaling->cases[k].group, scaling->cases[k - 1].group) != 0)
            print_group_header(scaling->cases[k].group);
        print_case(&scaling->cases[k]);
    }
    print_speed_up(scaling);
}

void scaling_write_csv(const struct scaling *scaling)
{
    FILE *file = plot_file(scaling->output, "scaling.csv");
    fprintf(file, "# %s, %s\n", machine_cpu(), machine_date());
    fprintf(file, "group,label,particles,threads,dimension,pairs,bytes,search_ns,matrices_ns,"
                  "gradient_ns,fused_ns,deficient,error\n");
    for (int k = 0; k < scaling->case_count; k++) {
        const struct scaling_case *one = &scaling->cases[k];
        fprintf(file, "%s,\"%s\",%d,%d,%d,%.4g,%.5g", one->group, one->label, one->count,
                one->threads, one->cloud.dimension, one->pairs, one->bytes);
        for (int work = 0; work < SCALING_WORKS; work++)
            fprintf(file, ",%.6g", scaling_time(one, (enum scaling_work)work));
        fprintf(file, ",%.6g,%.6e\n", one->deficient, one->error);
    }
    plot_close(file, "scaling.csv");
}

void scaling_write_json(const struct scaling *scaling, const char *path, const char *executable)
{
    struct report *report = report_create(executable, scaling->settings.threads);
    report_number(report, "particles", scaling->settings.particles);
    for (int k = 0; k < scaling->case_count; k++)
        for (int work = 0; work < SCALING_WORKS; work++) {
            const struct scaling_case *one = &scaling->cases[k];
            char name[128];
            const struct counter counters[] = {
                {"ns_per_particle", scaling_time(one, (enum scaling_work)work)},
                {"particles", one->count},
                {"case_threads", one->threads},
                {"pairs_per_particle", one->pairs},
                {"bytes_per_particle", one->bytes},
                {"deficient_share", one->deficient},
                {"error_max", one->error},
                {"not_finite", (double)one->not_finite},
                {NULL, 0}};
            snprintf(name, sizeof name, "scaling/%s/%s/%s", one->group, one->label,
                     scaling_work_names[work]);
            report_benchmark(report, name, &one->time[work], counters);
        }
    report_write(report, path);
}
