/* SPDX-License-Identifier: MIT */
/* Eigenvalues and singular values of the host's small matrices. */
#include "core/overlap.h"
#include "core/parallel.h"
#include "matrix_batch.h"
#include "svd.h"

static sphg_result check_shapes(struct sphgi_checker checker, struct sphgi_matrix_batch *b,
                                const sphg_view *const *views, const char *const *names,
                                const sphg_shape *shapes, int32_t count)
{
    struct sphgi_extent extents[4];
    for (int32_t k = 0; k < count; ++k) {
        const struct sphgi_expected expected = {.name = names[k],
                                                .type = b->type,
                                                .shape = shapes[k],
                                                .dimension = b->dimension,
                                                .count = b->count,
                                                .use = k ? SPHGI_OUTPUT : SPHGI_INPUT,
                                                .required = !k && b->count > 0};
        const sphg_result result = sphgi_check_view(checker, views[k], &expected);
        if (result)
            return result;
        struct sphgi_columns *columns = k ? &b->out[k - 1] : &b->in;
        *columns = sphgi_columns_of(views[k], shapes[k], b->dimension);
        extents[k] =
            sphgi_extent_of(names[k], columns, b->count, sphgi_size_of_type(b->type), k > 0);
    }
    return sphgi_check_overlap(checker, extents, count);
}

/* ---- Eigenvalues ---------------------------------------------------------------------------- */

static void eigen_task(void *data, int32_t begin, int32_t end, int32_t worker)
{
    const struct sphgi_matrix_batch *b = data;
    SPHGI_LANES_BUFFER(matrices, 6);
    SPHGI_LANES_BUFFER(values, 3);
    SPHGI_LANES_BUFFER(vectors, 9);
    (void)worker;
    for (int32_t g = begin; g < end; ++g) {
        int32_t items[SPHGI_WIDTH];
        const int32_t count = sphgi_batch_items(b, g, items);
        b->passes->load_lanes(SPHGI_WIDTH, &b->in, items, matrices);
        b->passes->eigen(SPHGI_WIDTH, b->dimension, matrices, values, vectors);
        if (b->out[0].count)
            b->passes->store_lanes(count, &b->out[0], items, values, false);
        if (b->out[1].count)
            b->passes->store_lanes(count, &b->out[1], items, vectors, false);
    }
}

sphg_result sphg_eigen(sphg_context *context, int32_t dimension, int32_t count, sphg_view matrices,
                       sphg_view values, sphg_view vectors)
{
    const struct sphgi_checker checker = {context, "sphg_eigen"};
    const sphg_view *views[] = {&matrices, &values, &vectors};
    static const char *const names[] = {"matrices", "values", "vectors"};
    static const sphg_shape shapes[] = {SPHG_SYM_TENSOR, SPHG_VECTOR, SPHG_TENSOR};
    struct sphgi_matrix_batch batch = {.dimension = dimension};
    sphg_result result = sphgi_enter(context);
    if (result)
        return result;
    if (dimension != 2 && dimension != 3)
        result = sphgi_fail(context, SPHG_ERROR_ARGUMENT, "%s: dimension is %d, must be 2 or 3",
                            checker.function, (int)dimension);
    if (!result)
        result = sphgi_begin_batch(checker, &matrices, "matrices", count, &batch);
    if (!result)
        result = check_shapes(checker, &batch, views, names, shapes, 3);
    if (!result)
        sphgi_parallel_for(context, eigen_task, &batch, sphgi_batch_groups(&batch),
                           SPHGI_BATCH_GRAIN);
    return sphgi_leave(context, result);
}

/* ---- SVD ------------------------------------------------------------------------------------ */

static double lane_get(const struct sphgi_matrix_batch *b, const void *lanes, int32_t number,
                       int32_t lane)
{
    const int32_t k = number * SPHGI_WIDTH + lane;
    return b->type == SPHG_F64 ? ((const double *)lanes)[k] : (double)((const float *)lanes)[k];
}

static void lane_set(const struct sphgi_matrix_batch *b, void *lanes, int32_t number, int32_t lane,
                     double x)
{
    const int32_t k = number * SPHGI_WIDTH + lane;
    if (b->type == SPHG_F64)
        ((double *)lanes)[k] = x;
    else
        ((float *)lanes)[k] = (float)x;
}

static void svd_task(void *data, int32_t begin, int32_t end, int32_t worker)
{
    const struct sphgi_matrix_batch *b = data;
    SPHGI_LANES_BUFFER(matrices, 9);
    SPHGI_LANES_BUFFER(u, 9);
    SPHGI_LANES_BUFFER(sigma, 3);
    SPHGI_LANES_BUFFER(v, 9);
    const void *results[3] = {u, sigma, v};
    (void)worker;
    for (int32_t g = begin; g < end; ++g) {
        int32_t items[SPHGI_WIDTH];
        const int32_t count = sphgi_batch_items(b, g, items);
        b->passes->load_lanes(SPHGI_WIDTH, &b->in, items, matrices);
        for (int32_t l = 0; l < count; ++l) {
            double a[9], left[9], values[3], right[9];
            for (int32_t k = 0; k < 9; ++k)
                a[k] = lane_get(b, matrices, k, l);
            sphgi_svd(a, left, values, right);
            for (int32_t k = 0; k < 9; ++k) {
                lane_set(b, u, k, l, left[k]);
                lane_set(b, v, k, l, right[k]);
            }
            for (int32_t k = 0; k < 3; ++k)
                lane_set(b, sigma, k, l, values[k]);
        }
        for (int32_t k = 0; k < 3; ++k)
            if (b->out[k].count)
                b->passes->store_lanes(count, &b->out[k], items, results[k], false);
    }
}

sphg_result sphg_svd(sphg_context *context, int32_t count, sphg_view matrices, sphg_view u,
                     sphg_view sigma, sphg_view v)
{
    const struct sphgi_checker checker = {context, "sphg_svd"};
    const sphg_view *views[] = {&matrices, &u, &sigma, &v};
    static const char *const names[] = {"matrices", "u", "sigma", "v"};
    static const sphg_shape shapes[] = {SPHG_TENSOR, SPHG_TENSOR, SPHG_VECTOR, SPHG_TENSOR};
    struct sphgi_matrix_batch batch = {.dimension = 3};
    sphg_result result = sphgi_enter(context);
    if (result)
        return result;
    result = sphgi_begin_batch(checker, &matrices, "matrices", count, &batch);
    if (!result)
        result = check_shapes(checker, &batch, views, names, shapes, 4);
    if (!result)
        sphgi_parallel_for(context, svd_task, &batch, sphgi_batch_groups(&batch),
                           SPHGI_BATCH_GRAIN);
    return sphgi_leave(context, result);
}
