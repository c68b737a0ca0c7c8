/* SPDX-License-Identifier: MIT */
/* The command `limit`: how near the library comes to the arithmetic limit of this machine. Each
 * round goes once through the probe, the library and all sets. */
#include "commands.h"
#include "limit_pack.h"
#include "particles/particles.h"
#include "probe.h"
#include "report/report.h"

/* What is timed: the probe's works, the library's, without and with weights that a sweep before
 * kept, and of each set, work and stage (sums alone, or finished) every arrangement. */
enum {
    LIBRARY = PROBE_WORKS,
    WEIGHTED = LIBRARY + LIMIT_WORKS,
    PACKED = WEIGHTED + LIMIT_WORKS,
    SET_ITEMS = LIMIT_WORKS * 2 * LIMIT_ROOTS,
    ITEMS_MOST = PACKED + LIMIT_SETS_MOST * SET_ITEMS
};

static const char *const stage_names[] = {"sums", "results"};
static const char *const work_names[] = {"matrices", "gradient", "fused"};

struct limit {
    struct settings settings;
    bool probe_only;
    struct probe *probe;
    struct scene scene, weighted;
    int set_count;
    const struct limit_set *sets[LIMIT_SETS_MOST];
    struct packed *packed[LIMIT_SETS_MOST]; /* of each thread */
    double deviation[LIMIT_SETS_MOST][LIMIT_WORKS];
    struct samples times[ITEMS_MOST];
};

/* ---- Measuring ------------------------------------------------------------------------------- */

/* Through an eighth of the targets, so that a round stays short: which share is returned. */
static double run_packed(const struct limit *limit, int item)
{
    enum { SHARE = 8, GRAIN = LIMIT_TARGETS };
    const int32_t threads = limit->settings.threads;
    const int32_t targets =
        (limit->scene.count / threads / SHARE + GRAIN - 1) / GRAIN * GRAIN; /* of each thread */
    const int set = item / SET_ITEMS;
    const enum limit_work work = (enum limit_work)(item / LIMIT_ROOTS / 2 % LIMIT_WORKS);
    const enum limit_root root = (enum limit_root)(item % LIMIT_ROOTS);
    const bool finished = item / LIMIT_ROOTS % 2;
#pragma omp parallel for num_threads(threads) schedule(static, 1)
    for (int32_t thread = 0; thread < threads; ++thread)
        limit->sets[set]->run(&limit->packed[set][thread].data, work, root, finished, targets);
    return (double)targets * threads / limit->scene.count;
}

static double run(void *data, int32_t item)
{
    const struct limit *limit = data;
    if (item >= PACKED)
        return run_packed(limit, item - PACKED);
    if (item >= WEIGHTED)
        scene_run(&limit->weighted, (enum work)(WORK_MATRICES + item - WEIGHTED));
    else if (item >= LIBRARY)
        scene_run(&limit->scene, (enum work)(WORK_MATRICES + item - LIBRARY));
    else
        probe_run(limit->probe, (enum probe_work)item, limit->settings.threads);
    return 1;
}

static int32_t items_of(const struct limit *limit)
{
    return limit->probe_only ? LIBRARY : PACKED + limit->set_count * SET_ITEMS;
}

/* Every arrangement must come to the same results as plain arithmetic in double. */
static void check_set(struct limit *limit, int set)
{
    const struct packed *packed = &limit->packed[set][0];
    for (int work = 0; work < LIMIT_WORKS; ++work)
        for (int k = 0; k < LIMIT_ROOTS; ++k) {
            double *deviation = &limit->deviation[set][work];
            for (int32_t n = 0; n < LIMIT_TARGETS * LIMIT_SUMS; ++n)
                packed->data.results[n] = 0;
            limit->sets[set]->run(&packed->data, (enum limit_work)work, (enum limit_root)k, true,
                                  LIMIT_TARGETS);
            *deviation =
                numbers_larger(*deviation, packed_deviation(packed, (enum limit_work)work));
        }
}

/* Those that this processor can run. */
static void find_sets(struct limit *limit)
{
    limit->sets[limit->set_count++] = &limit_set_base;
#ifdef BENCH_HAVE_X86
    if (library_runs(SPHG_ISA_X86_V3))
        limit->sets[limit->set_count++] = &limit_set_v3;
    if (library_runs(SPHG_ISA_X86_V4))
        limit->sets[limit->set_count++] = &limit_set_v4;
#endif
}

static void open_library_side(struct limit *limit)
{
    const size_t threads = (size_t)limit->settings.threads;
    scene_run(&limit->scene, WORK_SEARCH);
    limit->weighted = scene_keeping_weights(&limit->scene);
    find_sets(limit);
    for (int set = 0; set < limit->set_count; ++set) {
        limit->packed[set] = allocate_held(threads, sizeof *limit->packed[set]);
        for (size_t thread = 0; thread < threads; ++thread)
            limit->packed[set][thread] = packed_create(limit->sets[set], limit->probe);
        check_set(limit, set);
    }
}

static void measure(struct limit *limit)
{
    const struct settings *settings = &limit->settings;
    sphg_context *context = library_open(settings->threads);
    limit->scene = scene_of_lattice(context, settings, 3);
    limit->probe = probe_create(context, settings_side(settings->particles, 3), settings->support,
                                settings->jitter);
    if (!limit->probe_only)
        open_library_side(limit);
    for (int32_t item = 0; item < items_of(limit) && item < PACKED; ++item)
        run(limit, item);
    rounds_measure(
        &(struct rounds){"limit", settings->repetitions, items_of(limit), run, NULL, limit},
        limit->times);
}

/* ---- Reporting ------------------------------------------------------------------------------- */

/* Every arrangement of every set, whose share of the library's time stands with it; the faster one
 * counts. */
static void add_arrangements(const struct limit *limit)
{
    static const char *const arrangements[LIMIT_ROOTS] = {
        "targets in lanes, sqrt and division, weights first",
        "targets in lanes, estimate and Newton step, weights first"};
    table_begin("limit");
    for (int n = 0; n < limit->set_count * SET_ITEMS; ++n) {
        const int k = n % LIMIT_ROOTS, stage = n / LIMIT_ROOTS % 2, set = n / SET_ITEMS;
        const int work = n / LIMIT_ROOTS / 2 % LIMIT_WORKS;
        const struct packed *packed = &limit->packed[set][0];
        TABLE_ROW(cell_text("work", work_names[work]), cell_text("stage", stage_names[stage]),
                  cell_text("set", limit->sets[set]->name),
                  cell_text("arrangement", arrangements[k]), cell_ms("", &limit->times[PACKED + n]),
                  cell_number("deviation", limit->deviation[set][work]),
                  cell_number("vectors", (double)packed->data.slots / packed->lanes),
                  cell_number(".pairs", packed->pairs), cell_number(".kB", packed->kilobytes));
    }
    table_begin("limit");
    for (int n = 0; n < 2 * LIMIT_WORKS; ++n)
        TABLE_ROW(cell_text("work", work_names[n % LIMIT_WORKS]),
                  cell_text("stage", n < LIMIT_WORKS ? "library" : "library+weights"),
                  cell_ms("", &limit->times[LIBRARY + n]));
}

static int show(const struct limit *limit)
{
    const double error = probe_error(limit->probe),
                 deviation = probe_matrix_deviation(limit->probe);
    report_open("limit", &limit->settings);
    report_lattice(&limit->settings, limit->scene.count, probe_pairs(limit->probe));
    table_begin("probe");
    for (int work = 0; work < PROBE_WORKS; ++work)
        TABLE_ROW(cell_text("work", work_names[work]), cell_ms("", &limit->times[work]),
                  cell_number("error_max", error), cell_number("matrix_deviation", deviation));
    if (!limit->probe_only)
        add_arrangements(limit);
    return report_close();
}

int command_limit(int argc, char **argv)
{
    struct limit limit = {.settings = settings_default(1000000, 15, NULL)};
    const struct command_option options[] = {
        {"probe", 0, NULL, "only the fixed yardstick by which machines are compared",
         AS_FLAG(limit.probe_only)},
        {0}};
    settings_read(&limit.settings, TAKES_LATTICE | TAKES_RUN, options,
                  "Times the pair arithmetic of KGC on packed data in the first-level cache, each "
                  "instruction set in every arrangement of the loop, and the library beside it: "
                  "which share of the arithmetic limit the library reaches.",
                  argc, argv);
    measure(&limit);
    return show(&limit);
}
