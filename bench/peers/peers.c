/* SPDX-License-Identifier: MIT */
/* peers [PARTICLES]: the search of one peer beside the library's, on one thread. */
#include "lattice.h"
#include "library.h"
#include "peer.h"
#include "report/timing.h"
#include <stdio.h>
#include <stdlib.h>
#include <string.h>

enum { ROUNDS = 5 };

struct lists {
    int64_t *offsets, count;
    int32_t *indices;
};

static struct lists create_lists(int32_t count, int64_t room)
{
    return (struct lists){.offsets = allocate_or_exit((size_t)count + 1, sizeof(int64_t)),
                          .indices = allocate_or_exit((size_t)room, sizeof(int32_t))};
}

/* From positions to lists in the host's memory, by the library. */
static void search_ours(sphg_context *context, sphg_neighbors *neighbors,
                        const struct numbers *positions, double radius, struct lists *lists,
                        int64_t room)
{
    const sphg_scheme scheme = {.support_radius = radius};
    const sphg_geometry geometry = library_geometry(positions, SPHG_F64);
    const sphg_sources sources = {.neighbors = neighbors};
    sphg_pairs pairs = {.offsets = lists->offsets, .indices = lists->indices, .capacity = room};
    library_search(context, neighbors, &scheme, &geometry);
    library_check(context,
                  sphg_pair_gradients(context, &scheme, &sources, NULL, sphg_absent(), &pairs));
    lists->count = pairs.count;
}

static int order_of_indices(const void *left, const void *right)
{
    const int32_t a = *(const int32_t *)left, b = *(const int32_t *)right;
    return (a > b) - (a < b);
}

/* Targets whose lists are not the same, whatever their order. */
static int32_t different_rows(int32_t count, const struct lists *ours, struct lists *theirs)
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

static void compare(sphg_context *context, int32_t particles, bool shuffled)
{
    const struct lattice lattice = {.dimension = 3,
                                    .side = particles,
                                    .spacing = 1.0 / 128,
                                    .jitter = 0.2,
                                    .shuffled = shuffled};
    const int32_t count = lattice_count(&lattice);
    const int64_t room = (int64_t)count * 64;
    const double radius = 2 * lattice.spacing;
    struct numbers positions = numbers_create(SPHG_F64, count, 3);
    struct lists ours = create_lists(count, room), theirs = create_lists(count, room);
    struct samples our_times = {0}, their_times = {0};
    sphg_neighbors *neighbors = library_neighbors(context);
    lattice_fill(&lattice, &positions);
    for (int round = 0; round < ROUNDS; ++round) {
        struct moment start = now();
        search_ours(context, neighbors, &positions, radius, &ours, room);
        samples_add(&our_times, since(start));
        start = now();
        theirs.count = peer_search((const double(*)[3])positions.data, count, radius,
                                   theirs.offsets, theirs.indices, room);
        samples_add(&their_times, since(start));
    }
    const struct spread a = samples_wall(&our_times), b = samples_wall(&their_times);
    const int32_t different = different_rows(count, &ours, &theirs);
    printf(
        "%-18s %9d  %-8s  %9.1f (%.1f-%.1f)  sphgrad %s %9.1f (%.1f-%.1f)  %6.2f times as long, ",
        peer_name(), count, shuffled ? "shuffled" : "lattice", b.median, b.min, b.max,
        library_version(), a.median, a.min, a.max, b.median / a.median);
    printf(different ? "%d lists differ\n" : "same pairs\n", different);
    sphg_neighbors_destroy(neighbors);
    numbers_destroy(&positions);
    free(ours.offsets), free(ours.indices), free(theirs.offsets), free(theirs.indices);
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
    sphg_context_destroy(context);
    return EXIT_SUCCESS;
}
