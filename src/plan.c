#include "plan.h"
#include "view.h"
#include <stdio.h>
#include <string.h>

#define REFUSE(result, ...) return sphgi_fail(making->checker.context, result, __VA_ARGS__)

enum { NAME_LENGTH = 64 };

/* What the steps below share. */
struct making {
    struct sphgi_checker checker;
    const sphg_request *request;
    enum sphgi_purpose purpose;
    struct sphgi_plan *plan;
    struct sphgi_stream *streams;
    struct sphgi_extent *extents;
    int32_t extent_count;
    char (*names)[NAME_LENGTH];
};

/* ---- Views ---------------------------------------------------------------------------------- */

static const char *name_of(struct making *making, const char *format, int32_t a, int32_t b)
{
    char *name = making->names[making->extent_count];
    /* cppcheck-suppress wrongPrintfScanfArgNum ; formats of one number leave the second unread */
    snprintf(name, NAME_LENGTH, format, (int)a, (int)b);
    return name;
}

/* Checks one view and remembers where it lies. */
static sphg_result take_view(struct making *making, const sphg_view *view,
                             struct sphgi_expected expected, struct sphgi_columns *columns)
{
    expected.dimension = making->plan->dimension;
    const sphg_result result = sphgi_check_view(making->checker, view, &expected);
    if (result)
        return result;
    *columns = expected.shape ? sphgi_columns_of(view, expected.shape, expected.dimension)
                              : sphgi_flat_columns(view, expected.numbers);
    if (columns->count)
        making->extents[making->extent_count++] =
            (struct sphgi_extent){expected.name, *columns, expected.count,
                                  sphgi_size_of_type(expected.type), expected.use == SPHGI_OUTPUT};
    return SPHG_OK;
}

static sphg_result take_input(struct making *making, const sphg_view *view, const char *name,
                              sphg_shape shape, int32_t numbers, int32_t count,
                              struct sphgi_columns *columns)
{
    const struct sphgi_expected expected = {.name = name,
                                            .type = making->plan->type,
                                            .shape = shape,
                                            .numbers = numbers,
                                            .count = count,
                                            .use = SPHGI_INPUT};
    return take_view(making, view, expected, columns);
}

static sphg_result take_output(struct making *making, const sphg_view *view, const char *name,
                               sphg_type type, sphg_shape shape, int32_t numbers,
                               struct sphgi_columns *columns)
{
    const struct sphgi_expected expected = {.name = name,
                                            .type = type,
                                            .shape = shape,
                                            .numbers = numbers,
                                            .count = making->plan->target_count,
                                            .use = SPHGI_OUTPUT};
    return take_view(making, view, expected, columns);
}

/* ---- Sets ----------------------------------------------------------------------------------- */

static sphg_result check_set(struct making *making, int32_t s)
{
    const char *f = making->checker.function;
    struct sphgi_plan *plan = making->plan;
    const sphg_neighbors *n = making->request->sources[s].neighbors;
    if (!n)
        REFUSE(SPHG_ERROR_ARGUMENT, "%s: sources[%d].neighbors is NULL", f, (int)s);
    if (!n->kind)
        REFUSE(SPHG_ERROR_STATE, "%s: sources[%d].neighbors were never built", f, (int)s);
    if (s == 0) {
        plan->type = n->type;
        plan->target_count = n->target_count;
    }
    if (n->type != plan->type)
        REFUSE(SPHG_ERROR_TYPE, "%s: sources[%d].neighbors differ in precision from sources[0]", f,
               (int)s);
    if (n->dimension != plan->dimension)
        REFUSE(SPHG_ERROR_SIZE, "%s: sources[%d].neighbors were built in %dD, the scheme is %dD", f,
               (int)s, (int)n->dimension, (int)plan->dimension);
    if (n->target_count != plan->target_count)
        REFUSE(SPHG_ERROR_SIZE, "%s: sources[%d].neighbors have %d targets, sources[0] has %d", f,
               (int)s, (int)n->target_count, (int)plan->target_count);
    if (plan->scheme.radius > n->radius)
        REFUSE(SPHG_ERROR_SIZE,
               "%s: scheme.support_radius is %.9g, sources[%d].neighbors were built for %.9g", f,
               plan->scheme.radius, (int)s, n->radius);
    if (n->part_of && plan->own_set < 0)
        plan->own_set = s;
    plan->sets[s].neighbors = n;
    return SPHG_OK;
}

static sphg_result take_volume(struct making *making, int32_t s)
{
    struct sphgi_set_plan *set = &making->plan->sets[s];
    return take_input(making, &making->request->sources[s].volume,
                      name_of(making, "sources[%d].volume", s, 0), SPHG_SCALAR, 1,
                      set->neighbors->source_count, &set->volume);
}

/* ---- Targets -------------------------------------------------------------------------------- */

/* The targets' own view, else the view of the set that they are part of. */
static sphg_result take_target_side(struct making *making, const sphg_view *own,
                                    const sphg_view *of_set, const char *name,
                                    const char *name_of_set, sphg_shape shape, int32_t numbers,
                                    struct sphgi_columns *columns)
{
    const bool from_set = sphgi_is_absent(own) && of_set;
    return take_input(making, from_set ? of_set : own, from_set ? name_of_set : name, shape,
                      numbers, making->plan->target_count, columns);
}

static sphg_result take_targets(struct making *making)
{
    struct sphgi_plan *plan = making->plan;
    const sphg_request *request = making->request;
    const sphg_sources *own = plan->own_set < 0 ? NULL : &request->sources[plan->own_set];
    const int32_t width = sphgi_correction_width(plan->scheme.method, plan->dimension);
    sphg_result result =
        take_target_side(making, &request->target_volume, own ? &own->volume : NULL,
                         "target_volume", "sources.volume", SPHG_SCALAR, 1, &plan->target_volume);
    if (!result)
        result = take_target_side(making, &request->target_density, own ? &own->density : NULL,
                                  "target_density", "sources.density", SPHG_SCALAR, 1,
                                  &plan->target_density);
    if (!result && width)
        result = take_target_side(
            making, &request->target_correction, own ? &own->correction : NULL, "target_correction",
            "sources.correction", (sphg_shape)0, width, &plan->target_correction);
    if (own)
        plan->own_volume = plan->sets[plan->own_set].volume;
    return result;
}

static sphg_result take_wanted(struct making *making)
{
    struct sphgi_plan *plan = making->plan;
    const sphg_request *request = making->request;
    const int32_t width = sphgi_correction_width(plan->scheme.method, plan->dimension);
    sphg_result result = take_output(making, &request->correction, "correction", plan->type,
                                     (sphg_shape)0, width, &plan->correction);
    if (!result)
        result = take_output(making, &request->rank, "rank", SPHG_U8, SPHG_SCALAR, 1, &plan->rank);
    if (!result)
        result = take_output(making, &request->lambda_min, "lambda_min", plan->type, SPHG_SCALAR, 1,
                             &plan->lambda_min);
    plan->stats = request->stats;
    if (result)
        return result;
    const bool wanted = !sphgi_is_absent(&request->correction) || plan->rank.count ||
                        plan->lambda_min.count || plan->stats;
    if (wanted && !width)
        REFUSE(SPHG_ERROR_UNSUPPORTED, "%s: PLAIN has no corrections to report",
               making->checker.function);
    if (wanted && plan->target_correction.count)
        REFUSE(SPHG_ERROR_ARGUMENT,
               "%s: corrections are given as a table and wanted as a result; leave one absent",
               making->checker.function);
    plan->computes = wanted;
    return SPHG_OK;
}

/* ---- Fields --------------------------------------------------------------------------------- */

static sphg_result check_field(struct making *making, int32_t k)
{
    const char *f = making->checker.function;
    const sphg_field *field = &making->request->fields[k];
    if (field->shape < SPHG_SCALAR || field->shape > SPHG_TENSOR)
        REFUSE(SPHG_ERROR_ARGUMENT, "%s: fields[%d].shape is %d, not a shape", f, (int)k,
               (int)field->shape);
    if (field->form < SPHG_DIFFERENCE || field->form > SPHG_ADJOINT)
        REFUSE(SPHG_ERROR_ARGUMENT, "%s: fields[%d].form is %d, not a form", f, (int)k,
               (int)field->form);
    if (!field->at_sources)
        REFUSE(SPHG_ERROR_ARGUMENT, "%s: fields[%d].at_sources is NULL", f, (int)k);
    const bool tensor = field->shape >= SPHG_SYM_TENSOR, scalar = field->shape == SPHG_SCALAR;
    if (tensor && !sphgi_is_absent(&field->gradient))
        REFUSE(SPHG_ERROR_UNSUPPORTED, "%s: fields[%d].gradient of a tensor", f, (int)k);
    if (scalar && !sphgi_is_absent(&field->divergence))
        REFUSE(SPHG_ERROR_UNSUPPORTED, "%s: fields[%d].divergence of a scalar", f, (int)k);
    if (field->shape != SPHG_VECTOR && !sphgi_is_absent(&field->curl))
        REFUSE(SPHG_ERROR_UNSUPPORTED, "%s: fields[%d].curl of what is no vector", f, (int)k);
    if (field->form != SPHG_DIRECT && !sphgi_is_absent(&field->value))
        REFUSE(SPHG_ERROR_UNSUPPORTED, "%s: fields[%d].value outside the direct form", f, (int)k);
    if ((field->form != SPHG_DIRECT || !scalar) && !sphgi_is_absent(&field->square))
        REFUSE(SPHG_ERROR_UNSUPPORTED, "%s: fields[%d].square outside the direct form of a scalar",
               f, (int)k);
    return SPHG_OK;
}

static sphg_result take_results(struct making *making, int32_t k)
{
    struct sphgi_plan *plan = making->plan;
    const sphg_field *given = &making->request->fields[k];
    struct sphgi_field_plan *field = &plan->fields[k];
    const sphg_shape gradient = given->shape == SPHG_SCALAR ? SPHG_VECTOR : SPHG_TENSOR;
    const sphg_shape divergence = given->shape == SPHG_VECTOR ? SPHG_SCALAR : SPHG_VECTOR;
    const sphg_shape curl = plan->dimension == 3 ? SPHG_VECTOR : SPHG_SCALAR;
    sphg_result result =
        take_output(making, &given->value, name_of(making, "fields[%d].value", k, 0), plan->type,
                    given->shape, 0, &field->value);
    if (!result)
        result = take_output(making, &given->gradient, name_of(making, "fields[%d].gradient", k, 0),
                             plan->type, gradient, 0, &field->gradient);
    if (!result)
        result =
            take_output(making, &given->divergence, name_of(making, "fields[%d].divergence", k, 0),
                        plan->type, divergence, 0, &field->divergence);
    if (!result)
        result = take_output(making, &given->curl, name_of(making, "fields[%d].curl", k, 0),
                             plan->type, curl, 0, &field->curl);
    if (!result)
        result = take_output(making, &given->square, name_of(making, "fields[%d].square", k, 0),
                             plan->type, SPHG_SCALAR, 0, &field->square);
    field->differentiates = field->gradient.count || field->divergence.count || field->curl.count ||
                            field->square.count;
    return result;
}

/* A_i: as a target in difference, adjoint and symmetric; as a source (self term) in direct. */
static sphg_result take_field_at_target(struct making *making, int32_t k)
{
    struct sphgi_plan *plan = making->plan;
    const sphg_field *given = &making->request->fields[k];
    struct sphgi_field_plan *field = &plan->fields[k];
    const sphg_view absent = sphg_absent();
    const sphg_view *of_set = plan->own_set < 0 ? NULL : &given->at_sources[plan->own_set];
    const sphg_view *own = given->form == SPHG_DIRECT ? &absent : &given->at_targets;
    if (sphgi_is_absent(own) && !of_set && given->form != SPHG_DIRECT && field->differentiates)
        REFUSE(SPHG_ERROR_ARGUMENT,
               "%s: fields[%d].at_targets is absent, and the targets are part of no source set",
               making->checker.function, (int)k);
    const bool from_set = sphgi_is_absent(own) && of_set;
    const char *name = name_of(
        making, from_set ? "fields[%d].at_sources[%d]" : "fields[%d].at_targets", k, plan->own_set);
    return take_target_side(making, own, of_set, name, name, given->shape, 0, &field->target);
}

static sphg_result take_field(struct making *making, int32_t k)
{
    struct sphgi_plan *plan = making->plan;
    const sphg_field *given = &making->request->fields[k];
    struct sphgi_field_plan *field = &plan->fields[k];
    sphg_result result = check_field(making, k);
    if (result)
        return result;
    *field =
        (struct sphgi_field_plan){.shape = given->shape,
                                  .form = given->form,
                                  .accumulate = given->accumulate != 0,
                                  .components = sphgi_components(given->shape, plan->dimension)};
    field->streams = (field->components + SPHGI_ROW - 1) / SPHGI_ROW;
    field->stream = plan->stream_count;
    plan->stream_count += field->streams;
    field->at_target = plan->target_lanes;
    plan->target_lanes += field->streams * SPHGI_ROW; /* whole rows may be loaded */
    result = take_results(making, k);
    return result ? result : take_field_at_target(making, k);
}

/* ---- Streams: what is read of each source --------------------------------------------------- */

static void add_streams(struct making *making, int32_t s, int32_t first,
                        const struct sphgi_columns *columns, int32_t components, int32_t width)
{
    struct sphgi_stream *stream =
        making->streams + (ptrdiff_t)s * making->plan->stream_count + first;
    for (int32_t c = 0; c < components; c += width, ++stream)
        *stream = (struct sphgi_stream){*columns, c, sphgi_min32(width, components - c)};
}

static sphg_result take_field_at_sources(struct making *making, int32_t s, int32_t k)
{
    const struct sphgi_field_plan *field = &making->plan->fields[k];
    struct sphgi_columns columns = {.count = 0};
    const sphg_result result =
        take_input(making, &making->request->fields[k].at_sources[s],
                   name_of(making, "fields[%d].at_sources[%d]", k, s), field->shape, 0,
                   making->plan->sets[s].neighbors->source_count, &columns);
    add_streams(making, s, field->stream, &columns, field->components, SPHGI_ROW);
    return result;
}

/* A set needs its own corrections only where one of its fields is summed from the other side. */
static bool set_transposes(const struct making *making, int32_t s, sphg_form form)
{
    for (int32_t k = 0; k < making->plan->field_count; ++k) {
        const sphg_field *field = &making->request->fields[k];
        if (field->form == form && making->plan->fields[k].differentiates &&
            !sphgi_is_absent(&field->at_sources[s]))
            return true;
    }
    return false;
}

static sphg_result take_correction_of_set(struct making *making, int32_t s)
{
    struct sphgi_plan *plan = making->plan;
    const int32_t width = sphgi_correction_width(plan->scheme.method, plan->dimension);
    const sphg_view *view = &making->request->sources[s].correction;
    struct sphgi_columns columns = {.count = 0};
    const bool needed =
        set_transposes(making, s, SPHG_ADJOINT) || set_transposes(making, s, SPHG_SYMMETRIC);
    if (needed && sphgi_is_absent(view))
        REFUSE(SPHG_ERROR_ARGUMENT,
               "%s: sources[%d].correction is absent; adjoint and symmetric forms read it",
               making->checker.function, (int)s);
    const sphg_result result =
        take_input(making, view, name_of(making, "sources[%d].correction", s, 0), (sphg_shape)0,
                   width, plan->sets[s].neighbors->source_count, &columns);
    add_streams(making, s, plan->correction_stream, &columns, width,
                plan->classic ? plan->dimension + 1 : SPHGI_ROW);
    return result;
}

static sphg_result take_density_of_set(struct making *making, int32_t s)
{
    struct sphgi_plan *plan = making->plan;
    const sphg_view *view = &making->request->sources[s].density;
    struct sphgi_columns columns = {.count = 0};
    if (sphgi_is_absent(view))
        REFUSE(SPHG_ERROR_ARGUMENT,
               "%s: sources[%d].density is absent; the symmetric form reads it",
               making->checker.function, (int)s);
    const sphg_result result =
        take_input(making, view, name_of(making, "sources[%d].density", s, 0), SPHG_SCALAR, 1,
                   plan->sets[s].neighbors->source_count, &columns);
    add_streams(making, s, plan->density_stream, &columns, 1, 1);
    return result;
}

static sphg_result take_streams(struct making *making)
{
    struct sphgi_plan *plan = making->plan;
    for (int32_t s = 0; s < plan->set_count; ++s) {
        sphg_result result = SPHG_OK;
        plan->sets[s].streams = making->streams + (ptrdiff_t)s * plan->stream_count;
        for (int32_t k = 0; k < plan->field_count && !result; ++k)
            result = take_field_at_sources(making, s, k);
        if (!result && plan->correction_stream >= 0)
            result = take_correction_of_set(making, s);
        if (!result && plan->density_stream >= 0)
            result = take_density_of_set(making, s);
        if (result)
            return result;
    }
    return SPHG_OK;
}

/* ---- What must be there --------------------------------------------------------------------- */

/* Volumes and densities that the arithmetic will read must be there. */
static sphg_result check_needed(struct making *making)
{
    const char *f = making->checker.function;
    const struct sphgi_plan *plan = making->plan;
    const sphg_method method = plan->scheme.method;
    const bool transposes = plan->adjoint || plan->transposes[1];
    const bool in_weight = method != SPHG_MLS && method != SPHG_CMLS;
    const bool in_value = plan->wants_value && !plan->classic;
    const bool anything = plan->computes || plan->differentiates || plan->wants_value;
    const bool at_sources = (anything && in_weight) || transposes || in_value || plan->mean_volume;
    for (int32_t s = 0; s < plan->set_count && at_sources; ++s)
        if (!plan->sets[s].volume.count)
            REFUSE(SPHG_ERROR_ARGUMENT, "%s: sources[%d].volume is absent", f, (int)s);
    const bool at_targets = plan->adjoint || (plan->transposes[1] && !in_weight) ||
                            (plan->transposes[1] && plan->classic);
    if (at_targets && !plan->target_volume.count)
        REFUSE(SPHG_ERROR_ARGUMENT, "%s: target_volume is absent; this form reads it", f);
    if (plan->transposes[1] && !plan->target_density.count)
        REFUSE(SPHG_ERROR_ARGUMENT, "%s: target_density is absent; the symmetric form reads it", f);
    return SPHG_OK;
}

/* ---- Memory of the plan --------------------------------------------------------------------- */

static bool make_room(struct making *making)
{
    sphg_context *context = making->checker.context;
    const sphg_request *request = making->request;
    const size_t sets = (size_t)request->set_count, fields = (size_t)request->field_count;
    const size_t streams = sets * (3 * fields + 5);
    const size_t views = sets * (fields + 3) + 5 * fields + 8;
    const size_t sizes[] = {sets * sizeof(struct sphgi_set_plan),
                            fields * sizeof(struct sphgi_field_plan),
                            streams * sizeof(struct sphgi_stream),
                            views * sizeof(struct sphgi_extent), views * NAME_LENGTH};
    size_t total = 0, at[5];
    for (int k = 0; k < 5; ++k) {
        at[k] = total;
        total += sphgi_round_up(sizes[k], SPHGI_ALIGNMENT);
    }
    if (!sphgi_reserve(&context->allocator, &context->plan, total, 1))
        return false;
    char *memory = context->plan.data;
    memset(memory, 0, total);
    making->plan->sets = (void *)(memory + at[0]);
    making->plan->fields = (void *)(memory + at[1]);
    making->streams = (void *)(memory + at[2]);
    making->extents = (void *)(memory + at[3]);
    making->names = (void *)(memory + at[4]);
    return true;
}

static sphg_result check_counts(struct making *making)
{
    const char *f = making->checker.function;
    const sphg_request *request = making->request;
    if (request->set_count < 1 || request->set_count > 4096)
        REFUSE(SPHG_ERROR_ARGUMENT, "%s: set_count is %d, must be 1 to 4096", f,
               (int)request->set_count);
    if (request->field_count < 0 || request->field_count > 4096)
        REFUSE(SPHG_ERROR_ARGUMENT, "%s: field_count is %d, must be 0 to 4096", f,
               (int)request->field_count);
    const sphg_result missing = sphgi_check_pointer(making->checker, request->sources, "sources");
    if (missing || !request->field_count)
        return missing;
    return sphgi_check_pointer(making->checker, request->fields, "fields");
}

static sphg_result take_everything(struct making *making)
{
    struct sphgi_plan *plan = making->plan;
    sphg_result result = SPHG_OK;
    for (int32_t s = 0; s < plan->set_count && !result; ++s)
        result = check_set(making, s);
    if (!result)
        result = sphgi_check_range(making->checker, &plan->scheme, plan->type);
    for (int32_t s = 0; s < plan->set_count && !result; ++s)
        result = take_volume(making, s);
    if (!result)
        result = take_targets(making);
    if (!result)
        result = take_wanted(making);
    for (int32_t k = 0; k < plan->field_count && !result; ++k)
        result = take_field(making, k);
    if (result)
        return result;
    sphgi_plan_decide(plan, making->purpose);
    result = check_needed(making);
    if (!result)
        result = take_streams(making);
    if (!result)
        result = sphgi_check_subset(making->checker, making->request->subset, plan->target_count);
    if (!result)
        result = sphgi_check_overlap(making->checker, making->extents, making->extent_count);
    return result;
}

sphg_result sphgi_plan_make(struct sphgi_checker checker, const sphg_scheme *scheme,
                            const sphg_request *request, enum sphgi_purpose purpose,
                            struct sphgi_plan *plan)
{
    struct making making = {
        .checker = checker, .request = request, .purpose = purpose, .plan = plan};
    *plan = (struct sphgi_plan){.own_set = -1};
    sphg_result result = sphgi_check_scheme(checker, scheme, &plan->scheme);
    if (!result)
        result = sphgi_check_pointer(checker, request, "request");
    if (!result)
        result = check_counts(&making);
    if (result)
        return result;
    if (!make_room(&making))
        return sphgi_fail_memory(checker.context, checker.function);
    plan->dimension = plan->scheme.dimension;
    plan->classic = sphgi_is_classic(plan->scheme.method);
    plan->weighted = plan->scheme.method == SPHG_CRKPM;
    plan->set_count = request->set_count;
    plan->field_count = request->field_count;
    return take_everything(&making);
}
