/* SPDX-License-Identifier: MIT */
#include "library.h"
#include "stopwatch.h"
#include <stdio.h>
#include <stdlib.h>

void *array_new(int32_t count, size_t item_size)
{
    void *memory = calloc(count > 0 ? (size_t)count : 1, item_size);
    if (!memory) {
        fprintf(stderr, "out of memory: %d items of %zu bytes\n", (int)count, item_size);
        exit(EXIT_FAILURE);
    }
    return memory;
}

void sph_check(const struct sph *sph, sphg_result result)
{
    if (result == SPHG_OK)
        return;
    fprintf(stderr, "%s (%s)\n", sph->context ? sphg_last_message(sph->context) : "sphgrad",
            sphg_result_string(result));
    exit(EXIT_FAILURE);
}

struct sph sph_open(int32_t threads, int32_t dimension, double support_radius, sphg_method method)
{
    const sphg_config config = {.threads = threads};
    struct sph sph = {
        .plain = {.dimension = dimension, .method = SPHG_PLAIN, .support_radius = support_radius}};
    sph.corrected = sph.plain;
    sph.corrected.method = method;
    sph.spent = array_new(ACCOUNT_COUNT, sizeof *sph.spent);
    sph_check(&sph, sphg_context_create(SPHG_VERSION, &config, &sph.context));
    return sph;
}

void sph_close(struct sph *sph)
{
    sphg_context_destroy(sph->context);
    sph->context = NULL;
    free(sph->spent);
}

sphg_neighbors *sph_neighbors(const struct sph *sph)
{
    sphg_neighbors *neighbors = NULL;
    sph_check(sph, sphg_neighbors_create(sph->context, &neighbors));
    return neighbors;
}

void sph_search(const struct sph *sph, sphg_neighbors *neighbors, int32_t count, vector *x)
{
    const sphg_geometry geometry = sphg_all(vectors(x), count);
    const double start = stopwatch_now();
    sph_check(sph, sphg_neighbors_search(sph->context, neighbors, &sph->plain, &geometry));
    sph->spent[SEARCH] += stopwatch_now() - start;
}

sphg_field direct_field(sphg_shape shape, const sphg_view *at_sources)
{
    const sphg_field field = {.shape = shape, .form = SPHG_DIRECT, .at_sources = at_sources};
    return field;
}

void sph_evaluate(const struct sph *sph, const sphg_scheme *scheme, const sphg_sources *sources,
                  sphg_view target_volume, int32_t field_count, const sphg_field *fields)
{
    const sphg_request request = {.sources = sources,
                                  .set_count = 1,
                                  .fields = fields,
                                  .field_count = field_count,
                                  .target_volume = target_volume};
    sph_check(sph, sphg_evaluate(sph->context, scheme, &request));
}
