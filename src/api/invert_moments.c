/* SPDX-License-Identifier: MIT */
/* Corrections from moments that the host summed itself. */
#include "core/digits.h"
#include "core/kernel.h"
#include "core/overlap.h"
#include "core/parallel.h"
#include "matrix_batch.h"
#include "plan/units.h"
#include "sweep/tally.h"
#include <math.h>

/* `in` are moments, `out` corrections and the smallest normalised moments. */
struct inversion {
    struct sphgi_matrix_batch batch;
    struct sphgi_threshold threshold;
    const struct sphgi_scheme *scheme;
    struct sphgi_columns volume, rank;
    struct sphgi_tally *tallies; /* one per worker */
};

/* ---- Group by group ------------------------------------------------------------------------- */

/* Matrices without a certificate, until there are enough to fill vectors. */
struct waiting {
    int32_t count, items[SPHGI_WIDTH];
    SPHGI_LANES_BUFFER(moments, 6);
    SPHGI_LANES_BUFFER(volume, 1);
};

/* What one worker inverts. Moments of the host = factor * ours; see sphgi_table_scales(): the
 * inverse takes the same factor. */
struct inverting {
    const struct inversion *of;
    const struct sphgi_matrix_batch *batch;
    struct sphgi_tally *tally;
    double factor, per_volume;
    struct waiting waiting;
    SPHGI_LANES_BUFFER(moments, 6);
    SPHGI_LANES_BUFFER(volume, 1);
    SPHGI_LANES_BUFFER(correction, 6);
    SPHGI_LANES_BUFFER(lambda_min, 1);
};

static void read_moments(struct inverting *own, const int32_t *items)
{
    const struct sphgi_matrix_batch *b = own->batch;
    const struct sphgi_passes *p = b->passes;
    p->load_lanes(SPHGI_WIDTH, &b->in, items, own->moments);
    if (own->factor != 1)
        p->scale(SPHGI_WIDTH, b->in.count, own->moments, own->factor, NULL, own->moments);
    if (own->of->volume.count) {
        p->load_lanes(SPHGI_WIDTH, &own->of->volume, items, own->volume);
        own->tally->bad_volume |= !p->valid_volumes(SPHGI_WIDTH, own->volume);
        p->scale(SPHGI_WIDTH, 1, own->volume, own->per_volume, NULL, own->volume);
    }
}

static void write_inverses(struct inverting *own, const struct sphgi_verdict *verdict,
                           const int32_t *items)
{
    const struct sphgi_matrix_batch *b = own->batch;
    const struct sphgi_passes *p = b->passes;
    const int32_t count = verdict->count;
    if (own->factor != 1)
        p->scale(SPHGI_WIDTH, b->in.count, own->correction, own->factor, NULL, own->correction);
    if (b->out[0].count)
        p->store_lanes(count, &b->out[0], items, own->correction, false);
    if (b->out[1].count)
        p->store_lanes(count, &b->out[1], items, own->lambda_min, false);
    for (int32_t l = 0; own->of->rank.count && l < count; ++l)
        *(uint8_t *)(uintptr_t)(own->of->rank.at[0] + items[l] * own->of->rank.stride) =
            verdict->decomposed >> l & 1 ? verdict->rank[l] : (uint8_t)b->dimension;
}

static void decompose_waiting(struct inverting *own)
{
    const struct sphgi_matrix_batch *b = own->batch;
    struct waiting *w = &own->waiting;
    struct sphgi_verdict verdict = {.count = w->count,
                                    .decomposed = (uint32_t)(((uint64_t)1 << w->count) - 1)};
    if (!w->count)
        return;
    b->passes->decompose(SPHGI_WIDTH, &own->of->threshold, w->moments,
                         own->of->volume.count ? w->volume : NULL, own->correction, own->lambda_min,
                         &verdict);
    write_inverses(own, &verdict, w->items);
    sphgi_tally_verdict(own->tally, &verdict, b->dimension);
    w->count = 0;
}

/* [number][SPHGI_WIDTH]: all numbers of a lane to another place. */
static void copy_lane(const struct sphgi_matrix_batch *b, int32_t numbers, const void *from,
                      int32_t lane, void *to, int32_t place)
{
    for (int32_t k = 0; k < numbers * SPHGI_WIDTH; k += SPHGI_WIDTH)
        if (b->type == SPHG_F64)
            ((double *)to)[k + place] = ((const double *)from)[k + lane];
        else
            ((float *)to)[k + place] = ((const float *)from)[k + lane];
}

static void put_aside(struct inverting *own, int32_t lane, int32_t item)
{
    struct waiting *w = &own->waiting;
    copy_lane(own->batch, own->batch->in.count, own->moments, lane, w->moments, w->count);
    if (own->of->volume.count)
        copy_lane(own->batch, 1, own->volume, lane, w->volume, w->count);
    w->items[w->count++] = item;
    if (w->count == SPHGI_WIDTH)
        decompose_waiting(own);
}

/* Writes all of the group; what waits is written again when it has been decomposed. */
static void invert_group(struct inverting *own, int32_t g)
{
    const struct sphgi_matrix_batch *b = own->batch;
    int32_t items[SPHGI_WIDTH];
    struct sphgi_verdict verdict = {.count = sphgi_batch_items(b, g, items)};
    read_moments(own, items);
    b->passes->invert(SPHGI_WIDTH, &own->of->threshold, own->moments,
                      own->of->volume.count ? own->volume : NULL, own->correction,
                      b->out[1].count ? own->lambda_min : NULL, &verdict);
    write_inverses(own, &verdict, items);
    uint32_t open = verdict.decomposed;
    verdict.count -= __builtin_popcount(open);
    verdict.decomposed = 0;
    sphgi_tally_verdict(own->tally, &verdict, b->dimension);
    for (; open; open &= open - 1)
        put_aside(own, __builtin_ctz(open), items[__builtin_ctz(open)]);
}

static void invert_task(void *data, int32_t begin, int32_t end, int32_t worker)
{
    const struct inversion *inversion = data;
    const struct sphgi_scheme *scheme = inversion->scheme;
    struct inverting own;
    own.of = inversion;
    own.batch = &inversion->batch;
    own.tally = &inversion->tallies[worker];
    own.factor = sphgi_table_scales(scheme).value;
    own.per_volume = sphgi_power(1 / scheme->radius, scheme->dimension);
    own.waiting.count = 0;
    for (int32_t g = begin; g < end; ++g)
        invert_group(&own, g);
    decompose_waiting(&own);
}

/* ---- The call ------------------------------------------------------------------------------- */

static sphg_result check_batch(struct sphgi_checker checker, const sphg_view *view,
                               const char *name, sphg_shape shape,
                               const struct sphgi_matrix_batch *b, enum sphgi_use use,
                               sphg_type type, bool required)
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

static sphg_result check_inversion(struct sphgi_checker checker, const struct sphgi_scheme *scheme,
                                   const sphg_view *moments, const sphg_view *volume,
                                   const sphg_inversion *wanted, struct inversion *inversion)
{
    struct sphgi_matrix_batch *b = &inversion->batch;
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
    inversion->rank = sphgi_flat_columns(&wanted->rank, 1);
    if (mls)
        inversion->volume = sphgi_flat_columns(volume, 1);
    const bool in_place = moments->x == wanted->correction.x &&
                          moments->stride == wanted->correction.stride &&
                          moments->layout == wanted->correction.layout;
    const size_t size = sphgi_size_of_type(b->type);
    const struct sphgi_columns none = {.count = 0};
    const struct sphgi_extent extents[] = {
        sphgi_extent_of("moments", in_place ? &none : &b->in, b->count, size, false),
        {"volume", inversion->volume, b->count, size, false},
        sphgi_extent_of("wanted.correction", &b->out[0], b->count, size, true),
        {"wanted.lambda_min", b->out[1], b->count, size, true},
        {"wanted.rank", inversion->rank, b->count, 1, true}};
    return sphgi_check_overlap(checker, extents, 5);
}

/* Workers only note that there was one; the first is looked up for the message. */
static sphg_result report_volume(struct sphgi_checker checker, const struct inversion *inversion)
{
    const struct sphgi_matrix_batch *b = &inversion->batch;
    int32_t k = 0;
    double value = 0;
    for (; k < b->count; ++k) {
        const char *at = inversion->volume.at[0] + k * inversion->volume.stride;
        value = b->type == SPHG_F64 ? *(const double *)(const void *)at
                                    : (double)*(const float *)(const void *)at;
        if (!(value >= 0) || !isfinite(value))
            break;
    }
    return sphgi_fail(checker.context, SPHG_ERROR_VOLUME,
                      "%s: volume[%d] is %s, must be >= 0 and finite", checker.function, (int)k,
                      sphgi_digits(value).text);
}

static sphg_result run_inversion(struct sphgi_checker checker, struct inversion *inversion,
                                 sphg_stats *stats)
{
    sphg_context *context = checker.context;
    if (!sphgi_reserve(&context->allocator, &context->workers, (size_t)context->threads,
                       sizeof *inversion->tallies))
        return sphgi_fail_memory(context, checker.function);
    inversion->tallies = context->workers.data;
    struct sphgi_tally total;
    sphgi_tally_clear(&total);
    for (int32_t t = 0; t < context->threads; ++t)
        sphgi_tally_clear(&inversion->tallies[t]);
    sphgi_parallel_for(context, invert_task, inversion, sphgi_batch_groups(&inversion->batch),
                       SPHGI_BATCH_GRAIN);
    for (int32_t t = 0; t < context->threads; ++t)
        sphgi_tally_add(&total, &inversion->tallies[t]);
    if (stats)
        *stats = sphgi_tally_stats(&total, inversion->batch.type);
    if (total.bad_volume && !context->config.trusted)
        return report_volume(checker, inversion);
    return SPHG_OK;
}

sphg_result sphg_invert_moments(sphg_context *context, const sphg_scheme *scheme, int32_t count,
                                sphg_view moments, sphg_view volume, const sphg_inversion *wanted)
{
    const struct sphgi_checker checker = {context, "sphg_invert_moments"};
    struct sphgi_scheme checked = {0};
    struct inversion inversion = {.scheme = &checked};
    sphg_result result = sphgi_enter(context);
    if (result)
        return result;
    result = sphgi_check_scheme(checker, scheme, &checked);
    if (!result)
        result = sphgi_check_pointer(checker, wanted, "wanted");
    if (!result)
        result = sphgi_begin_batch(checker, &moments, "moments", count, &inversion.batch);
    inversion.batch.dimension = checked.dimension;
    inversion.threshold = (struct sphgi_threshold){.policy = checked.policy,
                                                   .eps = checked.threshold,
                                                   .dimension = checked.dimension,
                                                   .unit = 1};
    if (!result)
        result = check_inversion(checker, &checked, &moments, &volume, wanted, &inversion);
    if (!result)
        result = run_inversion(checker, &inversion, wanted->stats);
    return sphgi_leave(context, result);
}
