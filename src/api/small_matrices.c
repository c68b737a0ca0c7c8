/* SPDX-License-Identifier: MIT */
/* Public batches of small matrices: corrections from the host's own moments, eigenvalues, SVD. */
#include "core/overlap.h"
#include "core/digits.h"
#include "core/kernel.h"
#include "core/parallel.h"
#include "svd.h"
#include "sweep/tally.h"
#include "plan/units.h"
#include "core/view.h"
#include <math.h>

enum { GRAIN = 16 /* groups */ };

/* What the batches share: one group of lanes after the other. */
struct batch {
    sphg_context *context;
    const struct sphgi_passes *passes;
    sphg_type type;
    int32_t count, dimension;
    struct sphgi_columns in, out[3];
    /* inversion */
    struct sphgi_threshold threshold;
    const struct sphgi_scheme *scheme;
    struct sphgi_columns volume, rank;
    struct sphgi_tally *tallies; /* one per worker */
};

#define LANES_BUFFER(name, numbers)                                                                \
    unsigned char name[(numbers)*SPHGI_WIDTH * sizeof(double)]                                     \
        __attribute__((aligned(SPHGI_ALIGNMENT)))

static int32_t group_count(const struct batch *b)
{
    return (int32_t)(((int64_t)b->count + SPHGI_WIDTH - 1) / SPHGI_WIDTH);
}

/* Items of group g; returns how many. */
static int32_t items_of(const struct batch *b, int32_t g, int32_t *items)
{
    const int32_t first = g * SPHGI_WIDTH;
    const int32_t count = sphgi_min32(SPHGI_WIDTH, b->count - first);
    for (int32_t l = 0; l < SPHGI_WIDTH; ++l)
        items[l] = first + (l < count ? l : 0);
    return count;
}

static double lane_get(const struct batch *b, const void *lanes, int32_t number, int32_t lane)
{
    const int32_t k = number * SPHGI_WIDTH + lane;
    return b->type == SPHG_F64 ? ((const double *)lanes)[k] : (double)((const float *)lanes)[k];
}

static void lane_set(const struct batch *b, void *lanes, int32_t number, int32_t lane, double x)
{
    const int32_t k = number * SPHGI_WIDTH + lane;
    if (b->type == SPHG_F64)
        ((double *)lanes)[k] = x;
    else
        ((float *)lanes)[k] = (float)x;
}

/* ---- Moments -------------------------------------------------------------------------------- */

/* Matrices without a certificate, until there are enough to fill vectors. */
struct waiting {
    int32_t count, items[SPHGI_WIDTH];
    LANES_BUFFER(moments, 6);
    LANES_BUFFER(volume, 1);
};

/* One worker's share. Moments of the host = factor * ours; see sphgi_table_scales(): the inverse
 * takes the same factor. */
struct inversion {
    const struct batch *batch;
    struct sphgi_tally *tally;
    double factor, per_volume;
    struct waiting waiting;
    LANES_BUFFER(moments, 6);
    LANES_BUFFER(volume, 1);
    LANES_BUFFER(correction, 6);
    LANES_BUFFER(lambda_min, 1);
};

static void read_moments(struct inversion *run, const int32_t *items)
{
    const struct batch *b = run->batch;
    const struct sphgi_passes *p = b->passes;
    p->load_lanes(SPHGI_WIDTH, &b->in, items, run->moments);
    if (run->factor != 1)
        p->scale(SPHGI_WIDTH, b->in.count, run->moments, run->factor, NULL, run->moments);
    if (b->volume.count) {
        p->load_lanes(SPHGI_WIDTH, &b->volume, items, run->volume);
        run->tally->bad_volume |= !p->valid_volumes(SPHGI_WIDTH, run->volume);
        p->scale(SPHGI_WIDTH, 1, run->volume, run->per_volume, NULL, run->volume);
    }
}

static void write_inverses(struct inversion *run, const struct sphgi_verdict *verdict,
                           const int32_t *items)
{
    const struct batch *b = run->batch;
    const struct sphgi_passes *p = b->passes;
    const int32_t count = verdict->count;
    if (run->factor != 1)
        p->scale(SPHGI_WIDTH, b->in.count, run->correction, run->factor, NULL, run->correction);
    if (b->out[0].count)
        p->store_lanes(count, &b->out[0], items, run->correction, false);
    if (b->out[1].count)
        p->store_lanes(count, &b->out[1], items, run->lambda_min, false);
    for (int32_t l = 0; b->rank.count && l < count; ++l)
        *(uint8_t *)(uintptr_t)(b->rank.at[0] + items[l] * b->rank.stride) =
            verdict->decomposed >> l & 1 ? verdict->rank[l] : (uint8_t)b->dimension;
}

static void decompose_waiting(struct inversion *run)
{
    const struct batch *b = run->batch;
    struct waiting *w = &run->waiting;
    struct sphgi_verdict verdict = {.count = w->count,
                                    .decomposed = (uint32_t)(((uint64_t)1 << w->count) - 1)};
    if (!w->count)
        return;
    b->passes->decompose(SPHGI_WIDTH, &b->threshold, w->moments, b->volume.count ? w->volume : NULL,
                         run->correction, run->lambda_min, &verdict);
    write_inverses(run, &verdict, w->items);
    sphgi_tally_verdict(run->tally, &verdict, b->dimension);
    w->count = 0;
}

/* [number][SPHGI_WIDTH]: all numbers of a lane to another place. */
static void copy_lane(const struct batch *b, int32_t numbers, const void *from, int32_t lane,
                      void *to, int32_t place)
{
    for (int32_t k = 0; k < numbers * SPHGI_WIDTH; k += SPHGI_WIDTH)
        if (b->type == SPHG_F64)
            ((double *)to)[k + place] = ((const double *)from)[k + lane];
        else
            ((float *)to)[k + place] = ((const float *)from)[k + lane];
}

static void put_aside(struct inversion *run, int32_t lane, int32_t item)
{
    struct waiting *w = &run->waiting;
    copy_lane(run->batch, run->batch->in.count, run->moments, lane, w->moments, w->count);
    if (run->batch->volume.count)
        copy_lane(run->batch, 1, run->volume, lane, w->volume, w->count);
    w->items[w->count++] = item;
    if (w->count == SPHGI_WIDTH)
        decompose_waiting(run);
}

/* Writes all of the group; what waits is written again when it has been decomposed. */
static void invert_group(struct inversion *run, int32_t g)
{
    const struct batch *b = run->batch;
    int32_t items[SPHGI_WIDTH];
    struct sphgi_verdict verdict = {.count = items_of(b, g, items)};
    read_moments(run, items);
    b->passes->invert(SPHGI_WIDTH, &b->threshold, run->moments,
                      b->volume.count ? run->volume : NULL, run->correction,
                      b->out[1].count ? run->lambda_min : NULL, &verdict);
    write_inverses(run, &verdict, items);
    uint32_t open = verdict.decomposed;
    verdict.count -= __builtin_popcount(open);
    verdict.decomposed = 0;
    sphgi_tally_verdict(run->tally, &verdict, b->dimension);
    for (; open; open &= open - 1)
        put_aside(run, __builtin_ctz(open), items[__builtin_ctz(open)]);
}

static void invert_task(void *data, int32_t begin, int32_t end, int32_t worker)
{
    const struct batch *b = data;
    struct inversion run;
    run.batch = b;
    run.tally = &b->tallies[worker];
    run.factor = sphgi_table_scales(b->scheme).value;
    run.per_volume = sphgi_power(1 / b->scheme->radius, b->dimension);
    run.waiting.count = 0;
    for (int32_t g = begin; g < end; ++g)
        invert_group(&run, g);
    decompose_waiting(&run);
}

static sphg_result check_batch(struct sphgi_checker checker, const sphg_view *view,
                               const char *name, sphg_shape shape, const struct batch *b,
                               enum sphgi_use use, sphg_type type, bool required)
{
    const struct sphgi_expected expected = {.name = name,
                                            .type = type,
                                            .shape = shape,
                                            .dimension = b->dimension,
                                            .count = b->count,
                                            .use = use,
                                            .required = required && b->count > 0};
    return sphgi_check_view(checker, view, &expected);
}

/* The type of a batch is that of its matrices. */
static sphg_result begin_batch(struct sphgi_checker checker, const sphg_view *matrices,
                               const char *name, int32_t count, struct batch *b)
{
    sphg_context *context = checker.context;
    if (count < 0)
        return sphgi_fail(context, SPHG_ERROR_ARGUMENT, "%s: count is %d", checker.function,
                          (int)count);
    b->context = context;
    b->count = count;
    b->type = matrices->x || matrices->type ? matrices->type : SPHG_F32;
    if (b->type != SPHG_F32 && b->type != SPHG_F64)
        return sphgi_fail(context, SPHG_ERROR_TYPE, "%s: %s.type is %d, must be 1 (f32) or 2 (f64)",
                          checker.function, name, (int)b->type);
    b->passes = sphgi_passes_of(context, b->type);
    return SPHG_OK;
}

static sphg_result check_inversion(struct sphgi_checker checker, const struct sphgi_scheme *scheme,
                                   const sphg_view *moments, const sphg_view *volume,
                                   const sphg_inversion *wanted, struct batch *b)
{
    const char *f = checker.function;
    if (scheme->method == SPHG_PLAIN || sphgi_is_classic(scheme->method))
        return sphgi_fail(checker.context, SPHG_ERROR_UNSUPPORTED,
                          "%s: scheme.method is %d, only KGC, MLS and RKPM have moments", f,
                          (int)scheme->method);
    if (scheme->order == 2)
        return sphgi_fail(checker.context, SPHG_ERROR_UNSUPPORTED,
                          "%s: scheme.order is 2, which needs more than these moments", f);
    const bool mls = scheme->method == SPHG_MLS;
    sphg_result result = sphgi_check_range(checker, scheme, b->type);
    if (!result)
        result = check_batch(checker, moments, "moments", SPHG_SYM_TENSOR, b, SPHGI_INPUT, b->type,
                             true);
    if (!result)
        result = check_batch(checker, volume, "volume", SPHG_SCALAR, b, SPHGI_INPUT, b->type, mls);
    if (!result)
        result = check_batch(checker, &wanted->correction, "wanted.correction", SPHG_SYM_TENSOR, b,
                             SPHGI_OUTPUT, b->type, false);
    if (!result)
        result = check_batch(checker, &wanted->lambda_min, "wanted.lambda_min", SPHG_SCALAR, b,
                             SPHGI_OUTPUT, b->type, false);
    if (!result)
        result = check_batch(checker, &wanted->rank, "wanted.rank", SPHG_SCALAR, b, SPHGI_OUTPUT,
                             SPHG_U8, false);
    if (result)
        return result;
    b->in = sphgi_columns_of(moments, SPHG_SYM_TENSOR, b->dimension);
    b->out[0] = sphgi_columns_of(&wanted->correction, SPHG_SYM_TENSOR, b->dimension);
    b->out[1] = sphgi_flat_columns(&wanted->lambda_min, 1);
    b->rank = sphgi_flat_columns(&wanted->rank, 1);
    if (mls)
        b->volume = sphgi_flat_columns(volume, 1);
    const bool in_place = moments->x == wanted->correction.x &&
                          moments->stride == wanted->correction.stride &&
                          moments->layout == wanted->correction.layout;
    const size_t size = sphgi_size_of_type(b->type);
    const struct sphgi_columns none = {.count = 0};
    const struct sphgi_extent extents[] = {
        sphgi_extent_of("moments", in_place ? &none : &b->in, b->count, size, false),
        {"volume", b->volume, b->count, size, false},
        sphgi_extent_of("wanted.correction", &b->out[0], b->count, size, true),
        {"wanted.lambda_min", b->out[1], b->count, size, true},
        {"wanted.rank", b->rank, b->count, 1, true}};
    return sphgi_check_overlap(checker, extents, 5);
}

/* Workers only note that there was one; the first is looked up for the message. */
static sphg_result report_volume(struct sphgi_checker checker, const struct batch *b)
{
    int32_t k = 0;
    double value = 0;
    for (; k < b->count; ++k) {
        const char *at = b->volume.at[0] + k * b->volume.stride;
        value = b->type == SPHG_F64 ? *(const double *)(const void *)at
                                    : (double)*(const float *)(const void *)at;
        if (!(value >= 0) || !isfinite(value))
            break;
    }
    return sphgi_fail(checker.context, SPHG_ERROR_VOLUME,
                      "%s: volume[%d] is %s, must be >= 0 and finite", checker.function, (int)k,
                      sphgi_digits(value).text);
}

static sphg_result run_inversion(struct sphgi_checker checker, struct batch *b, sphg_stats *stats)
{
    sphg_context *context = checker.context;
    if (!sphgi_reserve(&context->allocator, &context->workers, (size_t)context->threads,
                       sizeof *b->tallies))
        return sphgi_fail_memory(context, checker.function);
    b->tallies = context->workers.data;
    struct sphgi_tally total;
    sphgi_tally_clear(&total);
    for (int32_t t = 0; t < context->threads; ++t)
        sphgi_tally_clear(&b->tallies[t]);
    sphgi_parallel_for(context, invert_task, b, group_count(b), GRAIN);
    for (int32_t t = 0; t < context->threads; ++t)
        sphgi_tally_add(&total, &b->tallies[t]);
    if (stats)
        *stats = sphgi_tally_stats(&total, b->type);
    if (total.bad_volume && !context->config.trusted)
        return report_volume(checker, b);
    return SPHG_OK;
}

sphg_result sphg_invert_moments(sphg_context *context, const sphg_scheme *scheme, int32_t count,
                                sphg_view moments, sphg_view volume, const sphg_inversion *wanted)
{
    const struct sphgi_checker checker = {context, "sphg_invert_moments"};
    struct sphgi_scheme checked = {0};
    struct batch batch = {.scheme = &checked};
    sphg_result result = sphgi_enter(context);
    if (result)
        return result;
    result = sphgi_check_scheme(checker, scheme, &checked);
    if (!result)
        result = sphgi_check_pointer(checker, wanted, "wanted");
    if (!result)
        result = begin_batch(checker, &moments, "moments", count, &batch);
    batch.dimension = checked.dimension;
    batch.threshold = (struct sphgi_threshold){.policy = checked.policy,
                                               .eps = checked.threshold,
                                               .dimension = checked.dimension,
                                               .unit = 1};
    if (!result)
        result = check_inversion(checker, &checked, &moments, &volume, wanted, &batch);
    if (!result)
        result = run_inversion(checker, &batch, wanted->stats);
    return sphgi_leave(context, result);
}

/* ---- Eigenvalues ---------------------------------------------------------------------------- */

static void eigen_task(void *data, int32_t begin, int32_t end, int32_t worker)
{
    const struct batch *b = data;
    LANES_BUFFER(matrices, 6);
    LANES_BUFFER(values, 3);
    LANES_BUFFER(vectors, 9);
    (void)worker;
    for (int32_t g = begin; g < end; ++g) {
        int32_t items[SPHGI_WIDTH];
        const int32_t count = items_of(b, g, items);
        b->passes->load_lanes(SPHGI_WIDTH, &b->in, items, matrices);
        b->passes->eigen(SPHGI_WIDTH, b->dimension, matrices, values, vectors);
        if (b->out[0].count)
            b->passes->store_lanes(count, &b->out[0], items, values, false);
        if (b->out[1].count)
            b->passes->store_lanes(count, &b->out[1], items, vectors, false);
    }
}

static sphg_result check_shapes(struct sphgi_checker checker, struct batch *b,
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

sphg_result sphg_eigen(sphg_context *context, int32_t dimension, int32_t count, sphg_view matrices,
                       sphg_view values, sphg_view vectors)
{
    const struct sphgi_checker checker = {context, "sphg_eigen"};
    const sphg_view *views[] = {&matrices, &values, &vectors};
    static const char *const names[] = {"matrices", "values", "vectors"};
    static const sphg_shape shapes[] = {SPHG_SYM_TENSOR, SPHG_VECTOR, SPHG_TENSOR};
    struct batch batch = {.dimension = dimension};
    sphg_result result = sphgi_enter(context);
    if (result)
        return result;
    if (dimension != 2 && dimension != 3)
        result = sphgi_fail(context, SPHG_ERROR_ARGUMENT, "%s: dimension is %d, must be 2 or 3",
                            checker.function, (int)dimension);
    if (!result)
        result = begin_batch(checker, &matrices, "matrices", count, &batch);
    if (!result)
        result = check_shapes(checker, &batch, views, names, shapes, 3);
    if (!result)
        sphgi_parallel_for(context, eigen_task, &batch, group_count(&batch), GRAIN);
    return sphgi_leave(context, result);
}

/* ---- SVD ------------------------------------------------------------------------------------ */

static void svd_task(void *data, int32_t begin, int32_t end, int32_t worker)
{
    const struct batch *b = data;
    LANES_BUFFER(matrices, 9);
    LANES_BUFFER(u, 9);
    LANES_BUFFER(sigma, 3);
    LANES_BUFFER(v, 9);
    const void *results[3] = {u, sigma, v};
    (void)worker;
    for (int32_t g = begin; g < end; ++g) {
        int32_t items[SPHGI_WIDTH];
        const int32_t count = items_of(b, g, items);
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
    struct batch batch = {.dimension = 3};
    sphg_result result = sphgi_enter(context);
    if (result)
        return result;
    result = begin_batch(checker, &matrices, "matrices", count, &batch);
    if (!result)
        result = check_shapes(checker, &batch, views, names, shapes, 4);
    if (!result)
        sphgi_parallel_for(context, svd_task, &batch, group_count(&batch), GRAIN);
    return sphgi_leave(context, result);
}
