/* SPDX-License-Identifier: MIT */
#include "matrix_batch.h"

sphg_result sphgi_begin_batch(struct sphgi_checker checker, const sphg_view *matrices,
                              const char *name, int32_t count, struct sphgi_matrix_batch *b)
{
    sphg_context *context = checker.context;
    if (count < 0)
        return sphgi_fail(context, SPHG_ERROR_ARGUMENT, "%s: count is %d", checker.function,
                          (int)count);
    b->count = count;
    b->type = matrices->x || matrices->type ? matrices->type : SPHG_F32;
    if (b->type != SPHG_F32 && b->type != SPHG_F64)
        return sphgi_fail(context, SPHG_ERROR_TYPE, "%s: %s.type is %d, must be 1 (f32) or 2 (f64)",
                          checker.function, name, (int)b->type);
    b->passes = sphgi_passes_of(context, b->type);
    return SPHG_OK;
}

int32_t sphgi_batch_groups(const struct sphgi_matrix_batch *b)
{
    return (int32_t)(((int64_t)b->count + SPHGI_WIDTH - 1) / SPHGI_WIDTH);
}

int32_t sphgi_batch_items(const struct sphgi_matrix_batch *b, int32_t g, int32_t *items)
{
    const int32_t first = g * SPHGI_WIDTH;
    const int32_t count = sphgi_min32(SPHGI_WIDTH, b->count - first);
    for (int32_t l = 0; l < SPHGI_WIDTH; ++l)
        items[l] = first + (l < count ? l : 0);
    return count;
}
