/* SPDX-License-Identifier: MIT */
#include "pairs.h"
#include <stdio.h>
#include <stdlib.h>

struct pairs pairs_new(int32_t count)
{
    const struct pairs pairs = {.offsets = array_new(count + 1, sizeof *pairs.offsets)};
    return pairs;
}

void pairs_free(struct pairs *pairs)
{
    free(pairs->offsets);
    free(pairs->indices);
    free(pairs->gradient);
}

static void grow(struct pairs *pairs, int64_t count)
{
    pairs->capacity = count + count / 4; /* so that it does not grow in every step */
    free(pairs->indices);
    free(pairs->gradient);
    pairs->indices = malloc((size_t)pairs->capacity * sizeof *pairs->indices);
    pairs->gradient = calloc((size_t)pairs->capacity, sizeof *pairs->gradient);
    if (!pairs->indices || !pairs->gradient) {
        fprintf(stderr, "out of memory for %lld pairs\n", (long long)count);
        exit(EXIT_FAILURE);
    }
}

void pairs_update(const struct sph *sph, const sphg_sources *sources, int32_t first, int32_t end,
                  struct pairs *pairs)
{
    const sphg_subset subset = sphg_range(first, end);
    for (;;) {
        sphg_pairs filled = {.offsets = pairs->offsets,
                             .indices = pairs->indices,
                             .gradient = pairs->capacity ? vectors(pairs->gradient) : sphg_absent(),
                             .capacity = pairs->capacity};
        const sphg_result result = sphg_pair_gradients(sph->context, &sph->plain, sources, &subset,
                                                       sphg_absent(), &filled);
        if (filled.count > pairs->capacity)
            grow(pairs, filled.count);
        else {
            sph_check(sph, result);
            return;
        }
    }
}
