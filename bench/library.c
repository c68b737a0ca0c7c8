/* SPDX-License-Identifier: MIT */
#include "library.h"
#include "particles/names.h"
#include "command_line.h"
#include <stdio.h>
#include <stdlib.h>

static sphg_isa chosen = SPHG_ISA_BEST;

static void destroy_context(void *context)
{
    sphg_context_destroy(context);
}

static void destroy_neighbors(void *neighbors)
{
    sphg_neighbors_destroy(neighbors);
}

sphg_context *library_open_isa(int32_t threads, sphg_isa isa)
{
    sphg_context *context = NULL;
    const sphg_config config = {.threads = threads, .isa = isa};
    const sphg_result result = sphg_context_create(SPHG_VERSION, &config, &context);
    if (result == SPHG_OK)
        hold(context, destroy_context);
    else if (result != SPHG_ERROR_UNSUPPORTED)
        library_check(NULL, result);
    return context;
}

sphg_context *library_open(int32_t threads)
{
    return library_open_isa(threads, chosen);
}

bool library_runs(sphg_isa isa)
{
    struct held *mark = held_so_far();
    const bool runs = library_open_isa(1, isa) != NULL;
    release_held(mark);
    return runs;
}

bool library_choose_isa(sphg_isa isa)
{
    chosen = isa;
    return library_runs(isa);
}

const char *library_isa(void)
{
    struct held *mark = held_so_far();
    sphg_context *context = library_open(1);
    sphg_context_info info;
    library_check(context, sphg_context_get_info(context, &info));
    release_held(mark);
    return isa_names[info.isa];
}

void library_check(const sphg_context *context, sphg_result result)
{
    if (result == SPHG_OK)
        return;
    fprintf(stderr, "sphgrad-bench: %s (%s)\n", context ? sphg_last_message(context) : "no context",
            sphg_result_string(result));
    exit(result > 0 ? EXIT_REFUSED : EXIT_FAILURE); /* positive: what it was given is at fault */
}

const char *library_version(void)
{
    static char text[32];
    const int version = sphg_version();
    snprintf(text, sizeof text, "%d.%d.%d", version / 10000, version / 100 % 100, version % 100);
    return text;
}

sphg_neighbors *library_neighbors(sphg_context *context)
{
    sphg_neighbors *neighbors = NULL;
    library_check(context, sphg_neighbors_create(context, &neighbors));
    hold(neighbors, destroy_neighbors);
    return neighbors;
}

sphg_neighbors_info library_info(sphg_context *context, const sphg_neighbors *neighbors)
{
    sphg_neighbors_info info;
    library_check(context, sphg_neighbors_get_info(context, neighbors, &info));
    return info;
}

/* The first call says how many pairs there are. */
struct library_lists library_lists(sphg_context *context, const sphg_scheme *scheme,
                                   const sphg_neighbors *neighbors, int32_t particles)
{
    enum { BEYOND = 16 };
    const sphg_sources sources = {.neighbors = neighbors};
    sphg_pairs pairs = {.offsets = allocate_held((size_t)particles + 1, sizeof *pairs.offsets)};
    for (int call = 0; call < 2; ++call) {
        library_check(context,
                      sphg_pair_gradients(context, scheme, &sources, NULL, sphg_absent(), &pairs));
        if (call == 0)
            pairs.indices = allocate_held((size_t)pairs.count + BEYOND, sizeof *pairs.indices);
        pairs.capacity = pairs.count;
    }
    return (struct library_lists){pairs.count, pairs.offsets, pairs.indices};
}
