/* SPDX-License-Identifier: MIT */
#include "library.h"
#include "particles/names.h"
#include "command_line.h"
#include <stdio.h>
#include <stdlib.h>

static sphg_isa chosen = SPHG_ISA_BEST;

static bool runs_here(sphg_isa isa)
{
    sphg_context *context = NULL;
    const sphg_config config = {.threads = 1, .isa = isa};
    const sphg_result result = sphg_context_create(SPHG_VERSION, &config, &context);
    sphg_context_destroy(context);
    return result == SPHG_OK;
}

bool library_choose_isa(sphg_isa isa)
{
    chosen = isa;
    return runs_here(isa);
}

/* The library does not name its choice, but says which ones it could not serve. */
const char *library_isa(void)
{
    static const sphg_isa best_first[] = {SPHG_ISA_X86_V4, SPHG_ISA_X86_V3, SPHG_ISA_NEON,
                                          SPHG_ISA_BASE};
    int k = 0;
    while (chosen == SPHG_ISA_BEST && !runs_here(best_first[k]))
        ++k;
    return isa_names[chosen == SPHG_ISA_BEST ? best_first[k] : chosen];
}

sphg_context *library_open(int32_t threads)
{
    sphg_context *context = NULL;
    const sphg_config config = {.threads = threads, .isa = chosen};
    const sphg_result result = sphg_context_create(SPHG_VERSION, &config, &context);
    if (result != SPHG_OK) {
        fprintf(stderr, "sphgrad-bench: no context: %s\n", sphg_result_string(result));
        exit(EXIT_FAILURE);
    }
    return context;
}

void library_check(const sphg_context *context, sphg_result result)
{
    if (result == SPHG_OK)
        return;
    fprintf(stderr, "sphgrad-bench: %s (%s)\n", sphg_last_message(context),
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

const char *library_path_name(int path)
{
    return isa_names[path + 1];
}

sphg_context *library_open_path(int32_t threads, int path)
{
    sphg_context *context = NULL;
    const sphg_config config = {.threads = threads, .isa = (sphg_isa)(path + 1)};
    return sphg_context_create(SPHG_VERSION, &config, &context) == SPHG_OK ? context : NULL;
}

sphg_neighbors *library_neighbors(sphg_context *context)
{
    sphg_neighbors *neighbors = NULL;
    library_check(context, sphg_neighbors_create(context, &neighbors));
    return neighbors;
}

sphg_geometry library_geometry(const struct numbers *positions, sphg_type field_type)
{
    sphg_geometry geometry = sphg_all(numbers_view(positions), positions->count);
    geometry.precision = field_type;
    return geometry;
}

void library_search(sphg_context *context, sphg_neighbors *neighbors, const sphg_scheme *scheme,
                    const sphg_geometry *geometry)
{
    library_check(context, sphg_neighbors_search(context, neighbors, scheme, geometry));
}

sphg_neighbors_info library_info(sphg_context *context, const sphg_neighbors *neighbors)
{
    sphg_neighbors_info info;
    library_check(context, sphg_neighbors_get_info(context, neighbors, &info));
    return info;
}

void library_correct(sphg_context *context, const sphg_scheme *scheme, const sphg_sources *sources,
                     sphg_view corrections, uint8_t *ranks)
{
    library_check(context, sphg_correction(context, scheme, sources, NULL, corrections,
                                           ranks ? sphg_view_u8(ranks, 1) : sphg_absent()));
}

void library_jacobian(sphg_context *context, const sphg_scheme *scheme, const sphg_sources *sources,
                      const struct numbers *field, const struct numbers *jacobians)
{
    library_check(context, sphg_jacobian(context, scheme, sources, NULL, numbers_view(field),
                                         numbers_view(jacobians)));
}

void library_volumes(sphg_context *context, const sphg_scheme *scheme,
                     const sphg_neighbors *neighbors, struct numbers *volumes)
{
    sphg_scheme plain = *scheme;
    plain.method = SPHG_PLAIN;
    struct numbers one = numbers_create(volumes->type, 1, 1);
    numbers_set(&one, 0, 0, 1);
    sphg_view ones = numbers_view(&one);
    ones.stride = 0;
    const sphg_sources sources = {.neighbors = neighbors, .volume = ones};
    const sphg_field field = {.shape = SPHG_SCALAR,
                              .form = SPHG_DIRECT,
                              .at_sources = &ones,
                              .value = numbers_view(volumes)};
    const sphg_request request = {
        .sources = &sources, .set_count = 1, .fields = &field, .field_count = 1};
    library_check(context, sphg_evaluate(context, &plain, &request));
    for (int32_t i = 0; i < volumes->count; ++i)
        numbers_set(volumes, i, 0, 1 / numbers_get(volumes, i, 0));
    numbers_destroy(&one);
}
