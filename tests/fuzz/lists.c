/* SPDX-License-Identifier: MIT */
/* Lists of the host, right and wrong: refused, found wrong by the operators, or summed; never read
 * beyond their ends, and the same numbers come of them if they are copied. Offsets decide how long
 * the indices must be: a copy of just that size. */
#include "fuzz.h"

enum { MOST = 24, INDICES = 400 };

typedef struct host {
    const fuzz_instance *instance;
    sphg_type type;
    int dimension, count, shape;
    double x[MOST * 3], radii[MOST], volume[MOST], density[MOST], field[MOST * 9], table[MOST * 45];
    double lent[MOST * 55], coefficient[MOST], weight[MOST], tensor[MOST * 9];
    double results[7][MOST * 55];
    int64_t offsets[MOST + 1];
    int32_t lengths[MOST], indices[INDICES];
    const int32_t *rows[MOST];
    sphg_scheme scheme;
} host;

static sphg_view numbers(fuzz_bytes *from, const host *on, double *memory, int width, int tame)
{
    for (int k = 0; k < on->count * width; ++k)
        fuzz_put(on->type, memory, k, tame ? fuzz_byte(from) / 64. : fuzz_real(from));
    return fuzz_view(on->type, memory, width);
}

static void take_lists(fuzz_bytes *from, host *on, sphg_lists *lists)
{
    const int kind = fuzz_byte(from), honest = kind & 1;
    for (int i = 0; i < on->count; ++i) {
        on->lengths[i] = fuzz_below(from, INDICES / MOST);
        on->offsets[i + 1] = on->offsets[i] + on->lengths[i];
        if (!honest && fuzz_byte(from) > 250)
            on->offsets[i + 1] = fuzz_byte(from) - 128;
        if (on->offsets[i + 1] > INDICES) /* nobody can tell where an array ends */
            on->offsets[i + 1] = INDICES;
        if (!honest && fuzz_byte(from) > 250)
            on->lengths[i] = -fuzz_byte(from);
        on->rows[i] = on->indices + i * (INDICES / MOST);
    }
    for (int k = 0; k < INDICES; ++k) {
        const int index = fuzz_byte(from);
        on->indices[k] = on->count ? index % on->count : 0;
        if (!honest && index > 250)
            fuzz_take(from, &on->indices[k], sizeof on->indices[k]);
    }
    lists->index_mask = kind & 4 ? 0xffff : 0;
    if (kind & 2) {
        lists->rows = on->rows;
        lists->lengths = on->lengths;
    } else {
        lists->offsets = on->offsets;
        lists->indices = on->indices;
    }
}

/* The indices at the end of a block of their own: reading on is seen by the sanitizer. */
static int32_t *moved_to_the_end(host *on, sphg_lists *lists)
{
    const int64_t used = lists->offsets ? on->offsets[on->count] : 0;
    int monotone = lists->offsets != NULL && used >= 0 && used <= INDICES;
    for (int i = 0; i < on->count && monotone; ++i)
        monotone = on->offsets[i] <= on->offsets[i + 1];
    if (!monotone)
        return NULL;
    int32_t *copy = malloc((size_t)used * sizeof *copy + 1);
    memcpy(copy, on->indices, (size_t)used * sizeof *copy);
    lists->indices = copy;
    return copy;
}

/* Octaves apart, now and then anything at all. */
static void take_radii(fuzz_bytes *from, host *on, sphg_geometry *geometry)
{
    for (int k = 0; k < on->count; ++k) {
        const int kind = fuzz_byte(from);
        fuzz_put(on->type, on->radii, k,
                 kind == 255 ? fuzz_real(from) : ldexp(1 + kind % 16 / 16., -(kind / 32)));
    }
    geometry->source_support = fuzz_view(on->type, on->radii, 1);
}

/* Views of source sets that a field may have beside its values. */
typedef struct extras {
    sphg_view coefficient, weight;
} extras;

/* Diffusion, sums of values, J : T_i: with what they read, or now and then without. */
static void ask_for_more(fuzz_bytes *from, host *on, int item, int tame, extras *views,
                         sphg_field *field)
{
    const int d = on->dimension, wanted = fuzz_byte(from);
    if (field->form == SPHG_ADJOINT && wanted & 1) {
        field->laplacian = fuzz_view(on->type, on->results[5], item);
        views->coefficient = numbers(from, on, on->coefficient, 1, tame);
        field->coefficient = wanted & 2 ? &views->coefficient : NULL;
    }
    if (field->form <= SPHG_DIRECT && wanted & 4) {
        field->value = fuzz_view(on->type, on->results[2], item);
        views->weight = numbers(from, on, on->weight, 1, tame);
        field->value_volume = wanted & 8 ? &views->weight : NULL;
        field->shepard = wanted & 16 ? 1 : 0;
        field->curl = sphg_absent();
    }
    if (on->shape == SPHG_VECTOR && wanted & 32) {
        field->tensor = numbers(from, on, on->tensor, d * d, tame);
        field->contraction = fuzz_view(on->type, on->results[1], 1);
    }
}

static sphg_result evaluate(fuzz_bytes *from, host *on)
{
    const int d = on->dimension, width = sphg_correction_width(&on->scheme);
    const int given = fuzz_byte(from) % 4, tame = fuzz_byte(from) % 2;
    const int form = on->scheme.order == 2 && given == SPHG_DIRECT ? SPHG_DIFFERENCE : given;
    on->shape = 1 + fuzz_byte(from) % 4;
    const int item = on->shape == 1   ? 1
                     : on->shape == 2 ? d
                     : on->shape == 3 ? d * (d + 1) / 2
                                      : d * d;
    const sphg_view at_sources = numbers(from, on, on->field, item, tame);
    sphg_sources sources = {.neighbors = on->instance->neighbors};
    sources.volume = numbers(from, on, on->volume, 1, fuzz_byte(from) % 4);
    sources.density = numbers(from, on, on->density, 1, tame);
    if (width && given > 1)
        sources.correction = numbers(from, on, on->table, width, tame);
    sphg_field field = {.shape = (sphg_shape)on->shape,
                        .form = (sphg_form)form,
                        .accumulate = fuzz_byte(from) % 2,
                        .at_sources = &at_sources};
    if (on->shape < 3)
        field.gradient = fuzz_view(on->type, on->results[0], on->shape == 1 ? d : d * d);
    else
        field.divergence = fuzz_view(on->type, on->results[1], d);
    if (on->shape == 2)
        field.curl = fuzz_view(on->type, on->results[2], d == 3 ? 3 : 1);
    if (on->shape == SPHG_SCALAR && form == SPHG_DIRECT && fuzz_byte(from) % 2)
        field.square = fuzz_view(on->type, on->results[1], 1);
    if (on->scheme.order == 2 && on->shape < 3 && form == SPHG_DIFFERENCE)
        field.hessian =
            fuzz_view(on->type, on->results[4], d * (d + 1) / 2 * (on->shape == 1 ? 1 : d));
    if (on->scheme.order == 2 && form == SPHG_DIFFERENCE)
        field.laplacian = fuzz_view(on->type, on->results[5], item);
    extras views = {.coefficient = sphg_absent()};
    ask_for_more(from, on, item, tame, &views, &field);
    const int lent = 1 + item * d * (d + 1) / 2;
    sphg_view lenders = sphg_absent();
    if (on->scheme.order == 2 && given < 2) {
        field.curvature = fuzz_view(on->type, on->results[6], lent);
        if (given == 1 && on->shape < 3) {
            lenders = numbers(from, on, on->lent, lent, tame);
            field.lenders = &lenders;
        }
    }
    sphg_request request = {
        .sources = &sources, .fields = &field, .set_count = 1, .field_count = 1};
    if (width && given < 2 && !field.lenders)
        request.correction = fuzz_view(on->type, on->results[3], width);
    return sphg_evaluate(on->instance->context, &on->scheme, &request);
}

/* From borrowed lists, or copied ones; no result: FUZZ_REQUIRE knows which there may be. */
static sphg_result results_of(fuzz_bytes from, host *on, const sphg_geometry *geometry,
                              sphg_lists lists, int copy)
{
    sphg_context *context = on->instance->context;
    lists.copy = copy;
    memset(on->results, 0, sizeof on->results);
    sphg_result result =
        sphg_neighbors_use_lists(context, on->instance->neighbors, &on->scheme, geometry, &lists);
    FUZZ_REQUIRE(result == SPHG_OK || result == SPHG_ERROR_ARGUMENT ||
                     result == SPHG_ERROR_NOT_FINITE || (copy && result == SPHG_ERROR_INDEX),
                 "%s", sphg_last_message(context));
    if (!result)
        result = evaluate(&from, on);
    FUZZ_REQUIRE(result == SPHG_OK || result == SPHG_ERROR_ARGUMENT ||
                     result == SPHG_ERROR_NOT_FINITE || result == SPHG_ERROR_INDEX ||
                     result == SPHG_ERROR_VOLUME || result == SPHG_ERROR_UNSUPPORTED,
                 "%s", sphg_last_message(context));
    return result;
}

/* The same bits, but of what is no number, and of signs of 0: a list of the target alone, or of
 * what is far away, may be one of nobody. */
static void require_same_results(const host *on, const void *before)
{
    const int count = (int)(sizeof on->results / (on->type == SPHG_F64 ? 8 : 4));
    for (int k = 0; k < count; ++k) {
        const double x = fuzz_get(on->type, before, k), y = fuzz_get(on->type, on->results, k);
        FUZZ_REQUIRE(x == y || isnan(x) || isnan(y),
                     "result %d is %.17g of borrowed lists, %.17g of copied ones", k, x, y);
    }
}

int LLVMFuzzerTestOneInput(const uint8_t *data, size_t size)
{
    static host on;
    static double before[sizeof on.results / sizeof(double)];
    fuzz_bytes from = {data, size};
    sphg_lists lists = {0};
    memset(&on, 0, sizeof on);
    on.instance = fuzz_instance_for(size);
    const int flags = fuzz_byte(&from);
    on.type = flags & 1 ? SPHG_F64 : SPHG_F32;
    on.dimension = flags & 2 ? 3 : 2;
    on.count = fuzz_below(&from, MOST + 1);
    on.scheme.dimension = on.dimension;
    on.scheme.method = (sphg_method)(fuzz_byte(&from) % 6);
    on.scheme.order = flags & 8 && on.scheme.method <= SPHG_RKPM ? 2 : 1;
    on.scheme.kernel = (sphg_kernel)(fuzz_byte(&from) % 7);
    on.scheme.policy = (sphg_policy)(fuzz_byte(&from) % 4);
    on.scheme.support_radius = (1 + fuzz_byte(&from)) / 16.;
    sphg_geometry geometry = {.sources = numbers(&from, &on, on.x, on.dimension, flags & 4),
                              .source_count = on.count,
                              .target_count = on.count,
                              .mutual = flags >> 5 & 1};
    if (flags & 16)
        take_radii(&from, &on, &geometry);
    take_lists(&from, &on, &lists);
    int32_t *copy = moved_to_the_end(&on, &lists);
    const sphg_result borrowed = results_of(from, &on, &geometry, lists, 0);
    memcpy(before, on.results, sizeof before);
    const sphg_result copied = results_of(from, &on, &geometry, lists, 1);
    FUZZ_REQUIRE(borrowed == copied || copied == SPHG_ERROR_INDEX,
                 "%d of borrowed lists, %d of copied ones", (int)borrowed, (int)copied);
    if (!borrowed && !copied)
        require_same_results(&on, before);
    free(copy);
    return 0;
}
