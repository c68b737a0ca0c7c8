/* SPDX-License-Identifier: MIT */
/* The measurements of limit. Each round goes once through the probe, the library and all
 * arrangements of all sets, so that a slow second of the machine hits all of them. */
#include "library.h"
#include "limit.h"
#include "particles/names.h"
#include "report/progress.h"
#include "team.h"
#include <stdlib.h>

/* The packed loops go through 1/SHARE of the targets, so that a round stays short. */
enum { SHARE = 8, GRAIN = LIMIT_TARGETS };

struct bench {
    struct limit *limit;
    sphg_context *context;
    sphg_neighbors *neighbors;
    struct probe *probe;
    struct particles particles;
    struct numbers corrections, jacobians;
    struct packed *packed[LIMIT_SETS_MOST]; /* of each thread */
};

static sphg_scheme scheme_of(const struct bench *bench)
{
    return (sphg_scheme){.method = SPHG_KGC,
                         .support_radius = bench->limit->settings.support * lattice_spacing};
}

static void search(struct bench *bench)
{
    const sphg_scheme scheme = scheme_of(bench);
    const sphg_geometry geometry = library_geometry(&bench->particles.positions, SPHG_F32);
    bench->neighbors = library_neighbors(bench->context);
    library_search(bench->context, bench->neighbors, &scheme, &geometry);
    bench->limit->neighbors = library_info(bench->context, bench->neighbors);
}

static void run_library(struct bench *bench, enum limit_work work)
{
    const sphg_scheme scheme = scheme_of(bench);
    const sphg_view corrections = numbers_view(&bench->corrections);
    sphg_sources sources = {.neighbors = bench->neighbors,
                            .volume = numbers_view(&bench->particles.volumes)};
    if (work == LIMIT_GRADIENT)
        sources.correction = corrections;
    if (work == LIMIT_MATRICES)
        library_correct(bench->context, &scheme, &sources, corrections, NULL);
    else
        library_jacobian(bench->context, &scheme, &sources, &bench->particles.velocities,
                         &bench->jacobians);
}

/* What one thread is to do; its share of items says which packed data are its own. */
struct assignment {
    const struct packed *packed;
    const struct limit_set *set;
    enum limit_work work;
    int arrangement;
    bool finished;
    int32_t targets; /* of each thread */
};

static void run_packed_share(void *data, int32_t begin, int32_t end)
{
    const struct assignment *assignment = data;
    for (int32_t thread = begin; thread < end; ++thread)
        assignment->set->run(&assignment->packed[thread].data, assignment->work,
                             assignment->arrangement, assignment->finished, assignment->targets);
}

/* For as many targets as there are particles, [ms]. */
static struct moment time_packed(const struct bench *bench, int set, enum limit_work work,
                                 int arrangement, int finished)
{
    const int32_t threads = bench->limit->settings.threads;
    const int32_t share = (bench->limit->count / threads / SHARE + GRAIN - 1) / GRAIN * GRAIN;
    struct assignment assignment = {
        bench->packed[set], bench->limit->sets[set], work, arrangement, finished, share};
    const struct moment start = now();
    team_run(threads, run_packed_share, &assignment, threads, 1);
    const struct moment time = since(start);
    const double scale = (double)bench->limit->count / ((double)share * threads);
    return (struct moment){scale * time.wall, scale * time.cpu};
}

static void pack(struct bench *bench)
{
    struct limit *limit = bench->limit;
    const double pairs = (double)limit->neighbors.pairs / limit->count;
    for (int set = 0; set < limit->set_count; ++set) {
        const size_t threads = (size_t)limit->settings.threads;
        bench->packed[set] = allocate_or_exit(threads, sizeof *bench->packed[set]);
        for (size_t thread = 0; thread < threads; ++thread)
            bench->packed[set][thread] = packed_create(limit->sets[set], limit->settings.support,
                                                       limit->settings.jitter, pairs);
        limit->packed_pairs[set] = bench->packed[set][0].pairs;
        limit->kilobytes[set] = bench->packed[set][0].kilobytes;
        limit->slots[set] = bench->packed[set][0].data.slots;
    }
}

/* Every arrangement must come to the same results as plain arithmetic in double. */
static void check_arrangements(struct bench *bench)
{
    struct limit *limit = bench->limit;
    for (int set = 0; set < limit->set_count; ++set)
        for (int work = 0; work < LIMIT_WORKS; ++work)
            for (int k = 0; k < LIMIT_ARRANGEMENTS; ++k) {
                const struct packed *packed = &bench->packed[set][0];
                for (int32_t n = 0; n < LIMIT_TARGETS * LIMIT_SUMS; ++n)
                    packed->data.results[n] = 0;
                limit->sets[set]->run(&packed->data, (enum limit_work)work, k, true, LIMIT_TARGETS);
                const double deviation = packed_deviation(packed, (enum limit_work)work);
                struct limit_times *times = &limit->times[set][work];
                times->deviation = numbers_larger(times->deviation, deviation);
            }
}

static void time_arrangements(struct bench *bench, int set, enum limit_work work)
{
    struct limit_times *times = &bench->limit->times[set][work];
    for (int k = 0; k < LIMIT_ARRANGEMENTS; ++k)
        for (int finished = 0; finished < 2; ++finished)
            samples_add(&times->arrangements[finished][k],
                        time_packed(bench, set, work, k, finished));
}

static void run_round(struct bench *bench)
{
    struct limit *limit = bench->limit;
    for (int work = 0; work < PROBE_WORKS; ++work) {
        const struct moment start = now();
        probe_run(bench->probe, (enum probe_work)work, limit->settings.threads);
        samples_add(&limit->probe[work], since(start));
    }
    for (int work = 0; work < LIMIT_WORKS && !limit->probe_only; ++work) {
        const struct moment start = now();
        run_library(bench, (enum limit_work)work);
        samples_add(&limit->library[work], since(start));
        for (int set = 0; set < limit->set_count; ++set)
            time_arrangements(bench, set, (enum limit_work)work);
    }
}

static void open_library_side(struct bench *bench, int32_t side)
{
    const struct particle_source source = {.side = side, .jitter = bench->limit->settings.jitter};
    bench->particles = particles_create(&source);
    bench->corrections = numbers_create(SPHG_F32, bench->particles.count, 6);
    bench->jacobians = numbers_create(SPHG_F32, bench->particles.count, 9);
    search(bench);
    bench->limit->set_count = limit_sets(bench->limit->sets, LIMIT_SETS_MOST);
    pack(bench);
    check_arrangements(bench);
    for (int work = 0; work < LIMIT_WORKS; ++work)
        run_library(bench, (enum limit_work)work);
}

static void close_library_side(struct bench *bench)
{
    for (int set = 0; set < bench->limit->set_count; ++set) {
        for (int32_t thread = 0; thread < bench->limit->settings.threads; ++thread)
            packed_destroy(&bench->packed[set][thread]);
        free(bench->packed[set]);
    }
    sphg_neighbors_destroy(bench->neighbors);
    numbers_destroy(&bench->corrections);
    numbers_destroy(&bench->jacobians);
    particles_destroy(&bench->particles);
}

void limit_measure(struct limit *limit)
{
    const struct settings *settings = &limit->settings;
    const int32_t side = settings_side(settings->particles, 3);
    struct bench bench = {.limit = limit, .context = library_open(settings->threads)};
    progress_show("warm-up");
    limit->count = side * side * side;
    bench.probe = probe_create(bench.context, side, settings->support, settings->jitter);
    limit->probe_pairs = probe_pairs(bench.probe);
    for (int work = 0; work < PROBE_WORKS; ++work)
        probe_run(bench.probe, (enum probe_work)work, settings->threads);
    limit->probe_error = probe_error(bench.probe);
    limit->probe_deviation = probe_matrix_deviation(bench.probe, bench.context);
    if (!limit->probe_only)
        open_library_side(&bench, side);
    for (int32_t repetition = 0; repetition < settings->repetitions; ++repetition) {
        progress_show("round %d of %d", repetition + 1, settings->repetitions);
        run_round(&bench);
    }
    progress_clear();
    if (!limit->probe_only)
        close_library_side(&bench);
    probe_destroy(bench.probe);
    sphg_context_destroy(bench.context);
}
