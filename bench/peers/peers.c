/* SPDX-License-Identifier: MIT */
/* peers [PARTICLES]: the search of one peer beside the library's, on one thread. */
#include "lattice.h"
#include "peer.h"
#include "report/timing.h"
#include "scene.h"
#include <stdio.h>
#include <stdlib.h>
#include <string.h>

enum { ROUNDS = 5 };

static int order_of_indices(const void *left, const void *right)
{
    const int32_t a = *(const int32_t *)left, b = *(const int32_t *)right;
    return (a > b) - (a < b);
}

/* Targets whose lists are not the same, whatever their order. */
static int32_t different_rows(int32_t count, const struct library_lists *ours,
                              struct library_lists *theirs)
{
    int32_t different = 0;
    for (int32_t i = 0; i < count; ++i) {
        const int64_t begin = ours->offsets[i], length = ours->offsets[i + 1] - begin;
        int32_t *row = theirs->indices + theirs->offsets[i];
        const bool as_long = theirs->offsets[i + 1] - theirs->offsets[i] == length;
        if (as_long)
            qsort(row, (size_t)length, sizeof *row, order_of_indices);
        different +=
            !as_long || memcmp(row, ours->indices + begin, (size_t)length * sizeof *row) != 0;
    }
    return different;
}

struct bench {
    struct scene scene;
    struct library_lists ours, theirs;
    int64_t room;
};

/* From positions to lists in the host's memory: by the library, and by the peer. */
static double run(void *data, int32_t item)
{
    struct bench *bench = data;
    const struct scene *scene = &bench->scene;
    const sphg_sources sources = {.neighbors = scene->neighbors};
    sphg_pairs pairs = {
        .offsets = bench->ours.offsets, .indices = bench->ours.indices, .capacity = bench->room};
    if (item == 1) {
        bench->theirs.count = peer_search((const double(*)[3])scene->positions.data, scene->count,
                                          scene->scheme.support_radius, bench->theirs.offsets,
                                          bench->theirs.indices, bench->room);
        return 1;
    }
    scene_run(scene, WORK_SEARCH);
    library_check(scene->context, sphg_pair_gradients(scene->context, &scene->scheme, &sources,
                                                      NULL, sphg_absent(), &pairs));
    return 1;
}

static struct library_lists create_lists(int32_t count, int64_t room)
{
    return (struct library_lists){.offsets = allocate_held((size_t)count + 1, sizeof(int64_t)),
                                  .indices = allocate_held((size_t)room, sizeof(int32_t))};
}

static void compare(sphg_context *context, int32_t side, bool shuffled)
{
    const struct lattice lattice = {
        .dimension = 3, .side = side, .spacing = 1.0 / 128, .jitter = 0.2, .shuffled = shuffled};
    const sphg_scheme scheme = {.support_radius = 2 * lattice.spacing};
    const int32_t count = lattice_count(&lattice);
    struct numbers positions = numbers_create(SPHG_F64, count, 3);
    struct bench bench = {
        .scene = scene_open(context, &scheme, positions, numbers_create(SPHG_F64, 1, 1)),
        .room = (int64_t)count * 64};
    struct samples times[2] = {{0}};
    bench.ours = create_lists(count, bench.room);
    bench.theirs = create_lists(count, bench.room);
    lattice_fill(&lattice, &positions);
    rounds_measure(&(struct rounds){peer_name(), ROUNDS, 2, run, NULL, &bench}, times);
    double ours[ROUNDS], theirs[ROUNDS];
    for (int round = 0; round < ROUNDS; ++round) {
        ours[round] = times[0].values[round].wall;
        theirs[round] = times[1].values[round].wall;
    }
    const double our_median = median_of(ours, ROUNDS), their_median = median_of(theirs, ROUNDS);
    const int32_t different = different_rows(count, &bench.ours, &bench.theirs);
    printf(
        "%-18s %9d  %-8s  %9.1f (%.1f-%.1f)  sphgrad %s %9.1f (%.1f-%.1f)  %6.2f times as long, ",
        peer_name(), count, shuffled ? "shuffled" : "lattice", their_median, theirs[0],
        theirs[ROUNDS - 1], library_version(), our_median, ours[0], ours[ROUNDS - 1],
        their_median / our_median);
    printf(different ? "%d lists differ\n" : "same pairs\n", different);
}

int main(int argc, char **argv)
{
    const double wanted = argc > 1 ? strtod(argv[1], NULL) : 100000;
    int32_t side = 2;
    while ((side + 0.5) * (side + 0.5) * (side + 0.5) < wanted)
        ++side;
    sphg_context *context = library_open(1);
    for (int shuffled = 0; shuffled < 2; ++shuffled)
        compare(context, side, shuffled);
    return EXIT_SUCCESS;
}
