/* Times of forces on a terminal and for machines. */
#include "forces.h"
#include "library.h"
#include "report/report_json.h"
#include "report/text.h"

#include <stdio.h>

static const char *const supplies[FORCE_SUPPLIES] = {"lists", "lists and weights"};

void forces_print(const struct forces *forces)
{
    const struct settings *settings = &forces->settings;
    char text[TEXT_SIZE];
    printf(
        "particles  %s, lattice jittered by %g spacings, H = %g spacings, %.2f pairs a particle; "
        "cubic spline, %s\n",
        text_grouped(forces->count, text), settings->jitter, settings->support,
        (double)forces->pairs / forces->count, precision_names[forces->precision]);
    text_print_machine(settings->threads);
    printf("times      ms, median (min-max) of %d rounds; corrections are there\n"
           "error      adjoint and symmetric: |sum f| / sum |f|, which conservation makes 0; "
           "difference: largest\n           relative error of div (-y, x, 2z)\n",
           settings->repetitions);
    text_print_if_busy(&forces->times[0][0], settings->threads);
    printf("\n  %-24s %-6s %22s %22s %9s\n", "operator", "method", "kept lists", "kept weights",
           "error");
    for (int k = 0; k < FORCE_CASES; k++) {
        printf("  %-24s %-6s", force_cases[k].name, method_names[force_cases[k].method]);
        for (int supply = 0; supply < FORCE_SUPPLIES; supply++) {
            text_median(&forces->times[k][supply], text);
            printf(" %22s", text);
        }
        printf(" %9.1e\n", forces->error[k]);
    }
}

void forces_write_json(const struct forces *forces, const char *path, const char *executable)
{
    struct report *report = report_create(executable, forces->settings.threads);
    report_number(report, "particles", forces->count);
    for (int k = 0; k < FORCE_CASES; k++)
        for (int supply = 0; supply < FORCE_SUPPLIES; supply++) {
            char name[128];
            const struct counter counters[] = {{"error", forces->error[k]}, {NULL, 0}};
            snprintf(name, sizeof name, "forces/%s/%s/%s", force_cases[k].name,
                     method_names[force_cases[k].method], supplies[supply]);
            report_benchmark(report, name, &forces->times[k][supply], counters);
        }
    report_write(report, path);
}
