/* The limit on a terminal, and for machines. */
#include "library.h"
#include "limit.h"
#include "report/machine.h"
#include "report/report_json.h"
#include "report/text.h"

#include <stdio.h>

const char *const limit_work_names[LIMIT_WORKS] = {"matrices", "gradient", "fused"};

static const char *const stage_names[] = {"sums", "results"};

int limit_fastest(const struct limit_times *times, int finished)
{
    int best = 0;
    double least = samples_wall(&times->arrangements[finished][0]).median;
    for (int k = 1; k < LIMIT_ARRANGEMENTS; k++) {
        const double median = samples_wall(&times->arrangements[finished][k]).median;
        if (median < least)
            least = median, best = k;
    }
    return best;
}

static void describe_arrangement(int index, char *text, size_t size)
{
    const struct limit_arrangement how = limit_arrangement(index);
    snprintf(text, size, "%s in lanes, %s, %s", how.lanes_are_targets ? "targets" : "pairs",
             how.by_newton ? "estimate and Newton step" : "sqrt and division",
             how.in_passes ? "weights first" : "one loop");
}

static void print_row(const char *label, const struct samples *const samples[LIMIT_WORKS])
{
    printf("  %-30s", label);
    for (int work = 0; work < LIMIT_WORKS; work++) {
        char text[TEXT_SIZE];
        text_median(samples[work], text);
        printf("%26s", text);
    }
    printf("\n");
}

static void print_limits(const struct limit *limit, int finished)
{
    printf("\n  %s\n", finished ? "limit: sums reduced, matrices inverted, gradients formed"
                                : "limit: sums alone");
    for (int set = 0; set < limit->set_count; set++) {
        const struct samples *fastest[LIMIT_WORKS];
        for (int work = 0; work < LIMIT_WORKS; work++) {
            const struct limit_times *times = &limit->times[set][work];
            fastest[work] = &times->arrangements[finished][limit_fastest(times, finished)];
        }
        print_row(limit->sets[set]->name, fastest);
    }
}

/* Limit over library, [%]. */
static double share(const struct limit *limit, int set, int work, int finished)
{
    const struct limit_times *times = &limit->times[set][work];
    const struct samples *fastest = &times->arrangements[finished][limit_fastest(times, finished)];
    return 100 * samples_wall(fastest).median / samples_wall(&limit->library[work]).median;
}

static void print_shares(const struct limit *limit, int finished)
{
    printf("\n  share of the limit, %s [%%]\n", stage_names[finished]);
    for (int set = 0; set < limit->set_count; set++) {
        printf("  %-30s", limit->sets[set]->name);
        for (int work = 0; work < LIMIT_WORKS; work++)
            printf("%26.0f", share(limit, set, work, finished));
        printf("\n");
    }
}

static void print_arrangements(const struct limit *limit)
{
    printf("\nfastest of %d arrangements, sums\n", LIMIT_ARRANGEMENTS);
    for (int set = 0; set < limit->set_count; set++)
        for (int work = 0; work < LIMIT_WORKS; work++) {
            char text[96];
            describe_arrangement(limit_fastest(&limit->times[set][work], 0), text, sizeof text);
            printf("  %-20s %-10s %s\n", limit->sets[set]->name, limit_work_names[work], text);
        }
}

static void print_packed(const struct limit *limit)
{
    printf("packed     ");
    for (int set = 0; set < limit->set_count; set++) {
        double worst = 0;
        for (int work = 0; work < LIMIT_WORKS; work++) {
            const double deviation = limit->times[set][work].deviation;
            worst = numbers_larger(worst, deviation);
        }
        printf("%s%s: %.1f pairs in %d vectors a target, %.0f kB, off double by %.1e\n",
               set ? "           " : "", limit->sets[set]->name, limit->packed_pairs[set],
               limit->slots[set] / limit->sets[set]->lanes, limit->kilobytes[set], worst);
    }
}

static void print_probe(const struct limit *limit)
{
    char matrices[TEXT_SIZE], gradient[TEXT_SIZE];
    text_median(&limit->probe[PROBE_MATRICES], matrices);
    text_median(&limit->probe[PROBE_GRADIENT], gradient);
    printf("probe      matrices %s ms, gradient %s ms\n"
           "           (int32 CSR, sorted 16-byte rows, %.2f pairs; error of its Jacobians %.1e, "
           "its matrices\n           off the library's by %.1e)\n",
           matrices, gradient, limit->probe_pairs, limit->probe_error, limit->probe_deviation);
}

void limit_print(const struct limit *limit)
{
    const struct settings *settings = &limit->settings;
    char count[TEXT_SIZE];
    printf("particles  %s, lattice jittered by %g spacings, H = %g spacings, KGC, cubic spline, "
           "f32\n",
           text_grouped(limit->count, count), settings->jitter, settings->support);
    text_print_machine(settings->threads);
    if (!limit->probe_only)
        print_packed(limit);
    print_probe(limit);
    printf("times      median (min-max) of %d rounds, ms for %s targets\n", settings->repetitions,
           count);
    text_print_if_busy(&limit->probe[PROBE_GRADIENT], settings->threads);
    if (limit->probe_only)
        return;
    printf("\n  %-30s%26s%26s%26s\n", "", limit_work_names[0], limit_work_names[1],
           limit_work_names[2]);
    char label[TEXT_SIZE];
    snprintf(label, sizeof label, "library, %s", library_isa());
    const struct samples *const library[] = {&limit->library[0], &limit->library[1],
                                             &limit->library[2]};
    print_row(label, library);
    for (int finished = 0; finished < 2; finished++)
        print_limits(limit, finished);
    for (int finished = 0; finished < 2; finished++)
        print_shares(limit, finished);
    print_arrangements(limit);
}

static void report_set(struct report *report, const struct limit *limit, int set, int work)
{
    char name[192], how[96];
    for (int finished = 0; finished < 2; finished++)
        for (int k = 0; k < LIMIT_ARRANGEMENTS; k++) {
            const struct limit_times *times = &limit->times[set][work];
            const struct counter counters[] = {
                {"deviation", times->deviation},
                {"is_limit", k == limit_fastest(times, finished)},
                {"vectors", (double)limit->slots[set] / limit->sets[set]->lanes},
                {NULL, 0}};
            describe_arrangement(k, how, sizeof how);
            snprintf(name, sizeof name, "limit/%s/%s/%s/%s", limit_work_names[work],
                     stage_names[finished], limit->sets[set]->name, how);
            report_benchmark(report, name, &times->arrangements[finished][k], counters);
        }
}

static void report_library(struct report *report, const struct limit *limit, int work)
{
    char name[64], labels[LIMIT_SETS_MOST][64];
    struct counter counters[LIMIT_SETS_MOST + 1];
    for (int set = 0; set < limit->set_count; set++) {
        snprintf(labels[set], sizeof labels[set], "percent_of_limit, %s", limit->sets[set]->name);
        counters[set] = (struct counter){labels[set], share(limit, set, work, 0)};
    }
    counters[limit->set_count] = (struct counter){NULL, 0};
    snprintf(name, sizeof name, "limit/%s/library", limit_work_names[work]);
    report_benchmark(report, name, &limit->library[work], counters);
}

void limit_write_json(const struct limit *limit, const char *path, const char *executable)
{
    static const char *const probe_names[PROBE_WORKS] = {"probe/matrices", "probe/gradient"};
    struct report *report = report_create(executable, limit->settings.threads);
    report_number(report, "particles", limit->count);
    report_number(report, "support_spacings", limit->settings.support);
    report_number(report, "jitter", limit->settings.jitter);
    const struct counter error[] = {
        {"error_max", limit->probe_error}, {"matrix_deviation", limit->probe_deviation}, {NULL, 0}};
    for (int work = 0; work < PROBE_WORKS; work++)
        report_benchmark(report, probe_names[work], &limit->probe[work], error);
    for (int work = 0; work < LIMIT_WORKS && !limit->probe_only; work++) {
        report_library(report, limit, work);
        for (int set = 0; set < limit->set_count; set++)
            report_set(report, limit, set, work);
    }
    report_write(report, path);
}
