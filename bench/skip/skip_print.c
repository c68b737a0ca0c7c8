/* What skipping saves, on a terminal and for machines. */
#include "report/report_json.h"
#include "skip.h"
#include "report/text.h"

#include <stdio.h>
#include <string.h>

static double saved(const struct skip_result *result)
{
    return 100 * (1 - samples_wall(&result->part).median / samples_wall(&result->full).median);
}

static void describe_exactness(const struct skip_row *row, const struct skip_result *result,
                               char text[TEXT_SIZE])
{
    if (row->compared == 0)
        snprintf(text, TEXT_SIZE, "-");
    else if (result->differences == 0)
        snprintf(text, TEXT_SIZE, "same bits");
    else
        snprintf(text, TEXT_SIZE, "off by %.1e", result->deviation);
}

static void print_row(const struct skip_row *row, const struct skip_result *result)
{
    char full[TEXT_SIZE], part[TEXT_SIZE], exact[TEXT_SIZE];
    text_median(&result->full, full);
    text_median(&result->part, part);
    describe_exactness(row, result, exact);
    printf("  %-32s%-37s%24s%24s%9.0f   %s\n", row->what, row->against, full, part, saved(result),
           exact);
}

void skip_print(const struct skip *skip)
{
    char count[TEXT_SIZE];
    printf("particles  %s, lattice jittered by %g spacings, H = %g spacings, %.2f pairs a "
           "particle; 2D: %.2f\n",
           text_grouped(skip->count, count), skip->settings.jitter, skip->settings.support,
           skip->pairs, skip->plane_pairs);
    printf("scheme     KGC, cubic spline, f32; neighbours kept and found before, unless it says "
           "search\n");
    text_print_machine(skip->settings.threads);
    printf("times      median (min-max) of %d rounds [ms]; exact: compared with the full result\n",
           skip->settings.repetitions);
    text_print_if_busy(&skip->results[0].full, skip->settings.threads);
    printf("\n  %-32s%-37s%24s%24s%9s   %s\n", "what", "against", "full [ms]", "this [ms]",
           "saved %", "exact");
    for (int k = 0; k < skip_row_count; k++) {
        if (k > 0 && strcmp(skip_rows[k].group, skip_rows[k - 1].group) != 0)
            printf("\n");
        print_row(&skip_rows[k], &skip->results[k]);
    }
    if (skip->skin_was_spent)
        printf("\nThe skin did not hold: its row includes searches that found pairs anew.\n");
}

static void report_row(struct report *report, const struct skip_row *row,
                       const struct skip_result *result)
{
    char name[128];
    const struct counter counters[] = {{"saved_percent", saved(result)},
                                       {"compared", row->compared != 0},
                                       {"targets_with_other_bits", (double)result->differences},
                                       {"deviation", result->deviation},
                                       {NULL, 0}};
    const struct counter none = {NULL, 0};
    snprintf(name, sizeof name, "skip/%s/%s", row->group, row->what);
    report_benchmark(report, name, &result->part, counters);
    snprintf(name, sizeof name, "full/%s/%s", row->group, row->what);
    report_benchmark(report, name, &result->full, &none);
}

void skip_write_json(const struct skip *skip, const char *path, const char *executable)
{
    struct report *report = report_create(executable, skip->settings.threads);
    report_number(report, "particles", skip->count);
    report_number(report, "support_spacings", skip->settings.support);
    report_number(report, "jitter", skip->settings.jitter);
    report_number(report, "pairs_per_particle", skip->pairs);
    report_number(report, "skin_was_spent", skip->skin_was_spent);
    for (int k = 0; k < skip_row_count; k++)
        report_row(report, &skip_rows[k], &skip->results[k]);
    report_write(report, path);
}
