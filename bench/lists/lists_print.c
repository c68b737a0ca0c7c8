/* Times a pair on a terminal and for machines. */
#include "library.h"
#include "lists.h"
#include "report/report_json.h"
#include "report/text.h"

#include <stdio.h>

const char *const supply_names[SUPPLIES] = {"kept lists",          "list-free",
                                            "host's CSR",          "host's rows",
                                            "host's row function", "host's CSR, copied"};
const char *const lists_work_names[LISTS_WORKS] = {"build", "matrices", "gradient", "fused"};

static double time_of_pair(const struct lists *lists, const struct samples *samples)
{
    return 1e6 * samples_wall(samples).median / (double)lists->pairs;
}

static void print_time(const struct lists *lists, const struct samples *samples)
{
    const struct spread spread = samples_wall(samples);
    const double scale = 1e6 / (double)lists->pairs;
    char text[TEXT_SIZE];
    snprintf(text, sizeof text, "%.3f (%.3f-%.3f)", scale * spread.median, scale * spread.min,
             scale * spread.max);
    printf(" %22s", text);
}

static void print_supplies(const struct lists *lists)
{
    printf("\n  %-22s", "sums over");
    for (int work = 0; work < LISTS_WORKS; work++)
        printf(" %22s", lists_work_names[work]);
    printf("%10s\n", "error");
    for (int supply = 0; supply < SUPPLIES; supply++) {
        printf("  %-22s", supply_names[supply]);
        for (int work = 0; work < LISTS_WORKS; work++)
            print_time(lists, &lists->supplied[supply][work]);
        printf("%10.1e\n", lists->supplied_error[supply]);
    }
}

static void print_exports(const struct lists *lists)
{
    printf("\n  %-44s %22s%10s\n", "pairs written out", "time", "error");
    for (int k = 0; k < EXPORTS; k++) {
        printf("  %-44s", lists_exports[k].name);
        print_time(lists, &lists->exported[k]);
        if (lists_exports[k].gradients)
            printf("%10.1e\n", lists->exported_error[k]);
        else
            printf("%10s\n", "-");
    }
}

void lists_print(const struct lists *lists)
{
    const struct settings *settings = &lists->settings;
    char count[TEXT_SIZE], pairs[TEXT_SIZE];
    printf("particles  %s, lattice jittered by %g spacings, H = %g spacings, %s pairs; KGC, cubic "
           "spline, %s\n",
           text_grouped(lists->count, count), settings->jitter, settings->support,
           text_grouped(lists->pairs, pairs), precision_names[lists->precision]);
    text_print_machine(settings->threads);
    printf("times      ns a pair, median (min-max) of %d rounds through everything; gradient and "
           "pairs written out:\n           with matrices that are there; error: largest |J_i - "
           "J|_F / |J|_F of v = (-y, x, 2z)\n",
           settings->repetitions);
    text_print_if_busy(&lists->supplied[SUPPLY_KEPT][WORK_FUSED], settings->threads);
    print_supplies(lists);
    print_exports(lists);
}

static void report_time(struct report *report, const struct lists *lists, const char *name,
                        const struct samples *samples, double error)
{
    const struct counter counters[] = {{"ns_per_pair", time_of_pair(lists, samples)},
                                       {"pairs", (double)lists->pairs},
                                       {error == NO_ERROR ? NULL : "error_max", error},
                                       {NULL, 0}};
    report_benchmark(report, name, samples, counters);
}

void lists_write_json(const struct lists *lists, const char *path, const char *executable)
{
    struct report *report = report_create(executable, lists->settings.threads);
    char name[128];
    report_number(report, "particles", lists->count);
    for (int supply = 0; supply < SUPPLIES; supply++)
        for (int work = 0; work < LISTS_WORKS; work++) {
            snprintf(name, sizeof name, "lists/sums/%s/%s", supply_names[supply],
                     lists_work_names[work]);
            report_time(report, lists, name, &lists->supplied[supply][work],
                        lists->supplied_error[supply]);
        }
    for (int k = 0; k < EXPORTS; k++) {
        snprintf(name, sizeof name, "lists/pairs/%s", lists_exports[k].name);
        report_time(report, lists, name, &lists->exported[k], lists->exported_error[k]);
    }
    report_write(report, path);
}
