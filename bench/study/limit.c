/* SPDX-License-Identifier: MIT */
/* The command `limit`. */
#include "limit.h"
#include "commands.h"
#include "library.h"
#include "report/machine.h"
#include "report/report.h"
#include "report/text.h"
#include <stdio.h>
#include <stdlib.h>

static const char *const stage_names[] = {"sums", "results"}, *const work_names[LIMIT_WORKS] = {
                                                                  "matrices", "gradient", "fused"};

/* The arrangement that is the fastest by its median. */
static int fastest_of(const struct limit_times *times, int finished)
{
    int best = 0;
    for (int k = 1; k < LIMIT_ARRANGEMENTS; ++k)
        if (samples_median(&times->arrangements[finished][k]) <
            samples_median(&times->arrangements[finished][best]))
            best = k;
    return best;
}

static const struct samples *limit_of(const struct limit *limit, int set, int work, int finished)
{
    const struct limit_times *times = &limit->times[set][work];
    return &times->arrangements[finished][fastest_of(times, finished)];
}

/* Limit over library, [%]. */
static double share_of(const struct limit *limit, const struct samples *samples, int work)
{
    return 100 * samples_median(samples) / samples_median(&limit->library[work]);
}

static const char *describe_arrangement(int index)
{
    const struct limit_arrangement how = limit_arrangement(index);
    return table_text("%s in lanes, %s, %s", how.lanes_are_targets ? "targets" : "pairs",
                      how.by_newton ? "estimate and Newton step" : "sqrt and division",
                      how.in_passes ? "weights first" : "one loop");
}

/* ---- On a terminal --------------------------------------------------------------------------- */

static void print_times(const struct limit *limit)
{
    static const struct column columns[] = {{"", NULL, NULL, NULL},
                                            {"matrices", NULL, NULL, NULL},
                                            {"gradient", NULL, NULL, NULL},
                                            {"fused", NULL, NULL, NULL},
                                            {0}};
    static const struct column of_shares[] = {{"", NULL, NULL, NULL},
                                              {"matrices", NULL, "%.0f", NULL},
                                              {"gradient", NULL, "%.0f", NULL},
                                              {"fused", NULL, "%.0f", NULL},
                                              {0}};
    struct table *table = table_create("", columns), *shares = table_create("", of_shares);
    TABLE_ROW(table, cell_text(table_text("library, %s", library_isa())),
              cell_time(&limit->library[0], 1), cell_time(&limit->library[1], 1),
              cell_time(&limit->library[2], 1));
    for (int finished = 0; finished < 2; ++finished) {
        table_section(table, finished ? "limit: reduced, inverted, formed" : "limit: sums alone");
        table_section(shares, table_text("share of the limit, %s [%%]", stage_names[finished]));
        for (int set = 0; set < limit->set_count; ++set) {
            struct cell cells[LIMIT_WORKS + 1] = {cell_text(limit->sets[set]->name)},
                                            percent[LIMIT_WORKS + 1] = {cells[0]};
            for (int work = 0; work < LIMIT_WORKS; ++work) {
                const struct samples *fastest = limit_of(limit, set, work, finished);
                cells[work + 1] = cell_time(fastest, 1);
                percent[work + 1] = cell_number(share_of(limit, fastest, work));
            }
            table_add(table, cells, LIMIT_WORKS + 1);
            table_add(shares, percent, LIMIT_WORKS + 1);
        }
    }
    table_print(table);
    table_print(shares);
}

static void print_arrangements(const struct limit *limit)
{
    static const struct column columns[] = {{"fastest arrangement, sums", NULL, NULL, NULL},
                                            {"", NULL, NULL, NULL},
                                            {"", NULL, NULL, NULL},
                                            {0}};
    struct table *table = table_create("", columns);
    for (int set = 0; set < limit->set_count; ++set)
        for (int work = 0; work < LIMIT_WORKS; ++work)
            TABLE_ROW(table, cell_text(limit->sets[set]->name), cell_text(work_names[work]),
                      cell_text(describe_arrangement(fastest_of(&limit->times[set][work], 0))));
    table_print(table);
}

static void print_packed(const struct limit *limit)
{
    for (int set = 0; set < limit->set_count; ++set) {
        double worst = 0;
        for (int work = 0; work < LIMIT_WORKS; ++work)
            worst = numbers_larger(worst, limit->times[set][work].deviation);
        printf("%-11s%s: %.1f pairs in %d vectors a target, %.0f kB, off double by %.1e\n",
               set ? "" : "packed", limit->sets[set]->name, limit->packed_pairs[set],
               limit->slots[set] / limit->sets[set]->lanes, limit->kilobytes[set], worst);
    }
}

static void print_results(const struct limit *limit, const struct table *probe)
{
    const struct settings *settings = &limit->settings;
    text_print_lattice(settings, limit->count, limit->probe_pairs);
    printf("; KGC, cubic spline, f32\n");
    text_print_machine(settings->threads);
    if (!limit->probe_only)
        print_packed(limit);
    printf("probe      int32 CSR, sorted 16-byte rows; error of its Jacobians, and what its "
           "matrices are off the library's\n"
           "times      median (min-max) of %d rounds, ms for all targets\n",
           settings->repetitions);
    text_print_if_busy(&limit->probe[PROBE_GRADIENT], settings->threads);
    table_print(probe);
    if (limit->probe_only)
        return;
    print_times(limit);
    print_arrangements(limit);
}

/* ---- For programs ---------------------------------------------------------------------------- */

static struct table *table_of_probe(const struct limit *limit)
{
    static const struct column columns[] = {{"probe", "work", NULL, NULL},
                                            {"time", "", NULL, NULL},
                                            {"error", "error_max", "%.1e", NULL},
                                            {"off by", "matrix_deviation", "%.1e", NULL},
                                            {0}};
    struct table *table = table_create("probe", columns);
    for (int work = 0; work < PROBE_WORKS; ++work)
        TABLE_ROW(table, cell_text(work_names[work]), cell_time(&limit->probe[work], 1),
                  cell_number(limit->probe_error), cell_number(limit->probe_deviation));
    return table;
}

/* Every arrangement of every set, and the library, whose share of the limit stands with the limit.
 */
static struct table *table_of_arrangements(const struct limit *limit)
{
    static const struct column columns[] = {
        {NULL, "work", NULL, NULL},     {NULL, "stage", NULL, NULL},
        {NULL, "set", NULL, NULL},      {NULL, "arrangement", NULL, NULL},
        {NULL, "", NULL, NULL},         {NULL, "deviation", NULL, NULL},
        {NULL, "is_limit", NULL, NULL}, {NULL, "percent_of_library", NULL, NULL},
        {NULL, "vectors", NULL, NULL},  {0}};
    struct table *table = table_create("limit", columns);
    for (int n = 0; n < LIMIT_WORKS * 2 * limit->set_count * LIMIT_ARRANGEMENTS; ++n) {
        const int k = n % LIMIT_ARRANGEMENTS, set = n / LIMIT_ARRANGEMENTS % limit->set_count;
        const int stage = n / LIMIT_ARRANGEMENTS / limit->set_count % 2;
        const int work = n / LIMIT_ARRANGEMENTS / limit->set_count / 2;
        const struct limit_times *times = &limit->times[set][work];
        const struct samples *samples = &times->arrangements[stage][k];
        TABLE_ROW(table, cell_text(work_names[work]), cell_text(stage_names[stage]),
                  cell_text(limit->sets[set]->name), cell_text(describe_arrangement(k)),
                  cell_time(samples, 1), cell_number(times->deviation),
                  cell_number(k == fastest_of(times, stage)),
                  cell_number(share_of(limit, samples, work)),
                  cell_number((double)limit->slots[set] / limit->sets[set]->lanes));
    }
    for (int work = 0; work < LIMIT_WORKS; ++work)
        TABLE_ROW(table, cell_text(work_names[work]), cell_text("library"), cell_none(),
                  cell_none(), cell_time(&limit->library[work], 1), cell_none(), cell_none(),
                  cell_none(), cell_none());
    return table;
}

int command_limit(int argc, char **argv)
{
    struct limit limit = {.settings = {.particles = 1000000,
                                       .threads = machine_threads(),
                                       .repetitions = 15,
                                       .support = 2,
                                       .jitter = 0.2}};
    const struct command_option options[] = {
        {"probe", 0, NULL, "only the fixed yardstick by which machines are compared", OPTION_FLAG,
         &limit.probe_only, 0, 0, NULL, NULL},
        LATTICE_OPTIONS(limit.settings),
        {0}};
    settings_read(&limit.settings, options,
                  "Times the pair arithmetic of KGC on packed data in the first-level cache, each "
                  "instruction set in every arrangement of the loop, and the library beside it: "
                  "which share of the arithmetic limit the library reaches.",
                  argc, argv);
    limit_measure(&limit);
    const struct table *probe = table_of_probe(&limit);
    print_results(&limit, probe);
    struct report *report = report_create(limit.settings.threads);
    report_lattice(report, &limit.settings, limit.count, limit.probe_pairs);
    report_table(report, probe);
    if (!limit.probe_only)
        report_table(report, table_of_arrangements(&limit));
    report_write(report, limit.settings.json);
    return EXIT_SUCCESS;
}
