/* SPDX-License-Identifier: MIT */
#include "make.h"
#include "builder.h"
#include "core/digits.h"
#include "search/places.h"
#include "core/view.h"
#include <string.h>

/* ---- Sets ----------------------------------------------------------------------------------- */

/* Units are those of the largest radius, and of each target's in turn. */
static void take_radii_of_set(struct sphgi_plan *plan, const sphg_neighbors *n)
{
    const bool first = !(plan->scheme.radius > 0);
    plan->graded |= n->graded || (!first && plan->scheme.radius != n->radius);
    plan->scheme.radius = n->radius > plan->scheme.radius ? n->radius : plan->scheme.radius;
    plan->least = first || n->least < plan->least ? n->least : plan->least;
}

static sphg_result check_set(struct sphgi_plan_builder *builder, int32_t s)
{
    const char *f = builder->checker.function;
    struct sphgi_plan *plan = builder->plan;
    const sphg_neighbors *n = builder->request->sources[s].neighbors;
    if (!n)
        SPHGI_REFUSE(SPHG_ERROR_ARGUMENT, "%s: sources[%d].neighbors is NULL", f, (int)s);
    if (!n->kind)
        SPHGI_REFUSE(SPHG_ERROR_STATE, "%s: sources[%d].neighbors were never built", f, (int)s);
    if (!sphgi_has_its_targets(n))
        SPHGI_REFUSE(
            SPHG_ERROR_STATE,
            "%s: sources[%d].neighbors have targets of an object that was built anew since", f,
            (int)s);
    if (s == 0) {
        plan->type = n->type;
        plan->target_count = n->target_count;
    }
    if (n->type != plan->type)
        SPHGI_REFUSE(SPHG_ERROR_TYPE,
                     "%s: sources[%d].neighbors differ in precision from sources[0]", f, (int)s);
    if (n->dimension != plan->dimension)
        SPHGI_REFUSE(SPHG_ERROR_SIZE,
                     "%s: sources[%d].neighbors were built in %dD, the scheme is %dD", f, (int)s,
                     (int)n->dimension, (int)plan->dimension);
    if (n->target_count != plan->target_count)
        SPHGI_REFUSE(SPHG_ERROR_SIZE,
                     "%s: sources[%d].neighbors have %d targets, sources[0] has %d", f, (int)s,
                     (int)n->target_count, (int)plan->target_count);
    if (n->radii != builder->request->sources[0].neighbors->radii)
        SPHGI_REFUSE(SPHG_ERROR_SIZE, "%s: sources[%d].neighbors have %s, unlike sources[0]", f,
                     (int)s, n->radii ? "a radius per particle" : "one radius for all");
    if (n->radii)
        take_radii_of_set(plan, n);
    else if (plan->scheme.radius > n->radius)
        SPHGI_REFUSE(SPHG_ERROR_SIZE,
                     "%s: scheme.support_radius is %s, sources[%d].neighbors were built for %s", f,
                     sphgi_digits(plan->scheme.radius).text, (int)s, sphgi_digits(n->radius).text);
    if (n->part_of && plan->own_set < 0)
        plan->own_set = s;
    plan->sets[s].neighbors = n;
    plan->sets[s].same_volumes = builder->request->sources[s].same_volumes != 0;
    return SPHG_OK;
}

static bool have_same_periods(const sphg_neighbors *a, const sphg_neighbors *b)
{
    return a->period[0] == b->period[0] && a->period[1] == b->period[1] &&
           a->period[2] == b->period[2];
}

/* Sums of all sets are added target by target: each must mean the same ones. In other types, or
 * with other periods, the same place may be another number. */
static sphg_result check_same_targets(struct sphgi_plan_builder *builder, int32_t s)
{
    const sphg_neighbors *a = builder->plan->sets[0].neighbors,
                         *b = builder->plan->sets[s].neighbors;
    if (a->position_type != b->position_type || !have_same_periods(a, b))
        return SPHG_OK;
    const int32_t target = sphgi_first_elsewhere(builder->checker.context, a, b);
    if (target >= 0)
        SPHGI_REFUSE(SPHG_ERROR_SIZE,
                     "%s: target %d of sources[%d].neighbors stands elsewhere than in sources[0]",
                     builder->checker.function, (int)target, (int)s);
    return SPHG_OK;
}

static sphg_result take_volume(struct sphgi_plan_builder *builder, int32_t s)
{
    struct sphgi_set_plan *set = &builder->plan->sets[s];
    return sphgi_take_input(builder, &builder->request->sources[s].volume,
                            sphgi_name_view(builder, "sources[%d].volume", s, 0), SPHG_SCALAR, 1,
                            set->neighbors->source_count, &set->volume);
}

/* ---- Targets -------------------------------------------------------------------------------- */

static sphg_result take_targets(struct sphgi_plan_builder *builder)
{
    struct sphgi_plan *plan = builder->plan;
    const sphg_request *request = builder->request;
    const sphg_sources *own = plan->own_set < 0 ? NULL : &request->sources[plan->own_set];
    const int32_t width = sphgi_plan_width(plan);
    sphg_result result = sphgi_take_target_side(
        builder, &request->target_volume, own ? &own->volume : NULL, "target_volume",
        "sources.volume", SPHG_SCALAR, 1, &plan->target_volume);
    if (!result)
        result = sphgi_take_target_side(builder, &request->target_density,
                                        own ? &own->density : NULL, "target_density",
                                        "sources.density", SPHG_SCALAR, 1, &plan->target_density);
    if (!result && width)
        result = sphgi_take_target_side(builder, &request->target_correction,
                                        own ? &own->correction : NULL, "target_correction",
                                        "sources.correction", sphgi_shape_of_table(plan), width,
                                        &plan->target_correction);
    if (own)
        plan->own_volume = plan->sets[plan->own_set].volume;
    return result;
}

static sphg_result take_wanted(struct sphgi_plan_builder *builder)
{
    struct sphgi_plan *plan = builder->plan;
    const sphg_request *request = builder->request;
    const int32_t width = sphgi_plan_width(plan);
    sphg_result result = sphgi_take_output(builder, &request->correction, "correction", plan->type,
                                           sphgi_shape_of_table(plan), width, &plan->correction);
    if (!result)
        result = sphgi_take_output(builder, &request->rank, "rank", SPHG_U8, SPHG_SCALAR, 1,
                                   &plan->rank);
    if (!result)
        result = sphgi_take_output(builder, &request->lambda_min, "lambda_min", plan->type,
                                   SPHG_SCALAR, 1, &plan->lambda_min);
    if (!result)
        result = sphgi_take_borrows(builder);
    plan->stats = request->stats;
    if (result)
        return result;
    const bool wanted = !sphgi_is_absent(&request->correction) || plan->rank.count ||
                        plan->lambda_min.count || plan->borrows.count || plan->stats;
    if (wanted && !width)
        SPHGI_REFUSE(SPHG_ERROR_UNSUPPORTED, "%s: PLAIN has no corrections to report",
                     builder->checker.function);
    if (wanted && plan->target_correction.count)
        SPHGI_REFUSE(
            SPHG_ERROR_ARGUMENT,
            "%s: corrections are given as a table and wanted as a result; leave one absent",
            builder->checker.function);
    plan->computes = wanted;
    return SPHG_OK;
}

/* ---- What must be there --------------------------------------------------------------------- */

/* Volumes and densities that the arithmetic will read must be there. */
static sphg_result check_needed(struct sphgi_plan_builder *builder)
{
    const char *f = builder->checker.function;
    const struct sphgi_plan *plan = builder->plan;
    const sphg_method method = plan->scheme.method;
    const bool transposes = plan->adjoint || plan->transposes[1];
    const bool in_weight = method != SPHG_MLS && method != SPHG_CMLS;
    const bool in_value = plan->values_by_volume && !plan->classic;
    const bool anything = plan->computes || plan->differentiates || plan->wants_value;
    const bool at_sources = (anything && in_weight) || transposes || in_value || plan->mean_volume;
    for (int32_t s = 0; s < plan->set_count && at_sources; ++s)
        if (!plan->sets[s].volume.count && plan->sets[s].neighbors->source_count > 0)
            SPHGI_REFUSE(SPHG_ERROR_ARGUMENT, "%s: sources[%d].volume is absent", f, (int)s);
    if (!plan->target_count)
        return SPHG_OK; /* nobody's volume and density are read */
    if (!anything && builder->purpose == SPHGI_FOR_RESULTS)
        SPHGI_REFUSE(SPHG_ERROR_ARGUMENT,
                     "%s: nothing is asked for: no field has a result, and correction, rank, "
                     "lambda_min and stats are absent",
                     f);
    const bool at_targets = plan->adjoint || (plan->transposes[1] && !in_weight) ||
                            (plan->transposes[1] && plan->classic);
    if (at_targets && !plan->target_volume.count)
        SPHGI_REFUSE(SPHG_ERROR_ARGUMENT, "%s: target_volume is absent; this form reads it", f);
    if (plan->transposes[1] && !plan->target_density.count)
        SPHGI_REFUSE(SPHG_ERROR_ARGUMENT,
                     "%s: target_density is absent; the symmetric form reads it", f);
    return SPHG_OK;
}

/* ---- Memory of the plan --------------------------------------------------------------------- */

/* Returns the bytes. */
static size_t place_plan(struct sphgi_plan_builder *builder, char *base)
{
    struct sphgi_layout layout = {base, 0};
    const sphg_request *request = builder->request;
    const size_t sets = (size_t)request->set_count, fields = (size_t)request->field_count;
    size_t each = 0, more = 0; /* views of each set */
    for (int32_t k = 0; k < request->field_count; ++k) {
        each += (size_t)sphgi_streams_of(&request->fields[k]);
        more += sphgi_views_of(&request->fields[k]);
    }
    const size_t corrections = builder->plan->scheme.order == 2 ? 6 : 4;
    const size_t views = sets * (fields + more + 3) + 15 * fields + 8;
    builder->plan->sets = sphgi_place(&layout, sets, sizeof *builder->plan->sets);
    builder->plan->fields = sphgi_place(&layout, fields, sizeof *builder->plan->fields);
    builder->streams =
        sphgi_place(&layout, sets * (each + corrections + 1), sizeof *builder->streams);
    builder->extents = sphgi_place(&layout, views, sizeof *builder->extents);
    builder->names = sphgi_place(&layout, views, sizeof *builder->names);
    return layout.used;
}

static bool make_room(struct sphgi_plan_builder *builder)
{
    sphg_context *context = builder->checker.context;
    const size_t bytes = place_plan(builder, NULL);
    if (!sphgi_reserve(&context->allocator, &context->plan, bytes, 1))
        return false;
    memset(context->plan.data, 0, bytes);
    place_plan(builder, context->plan.data);
    return true;
}

static sphg_result check_counts(struct sphgi_plan_builder *builder)
{
    const char *f = builder->checker.function;
    const sphg_request *request = builder->request;
    if (request->set_count < 1 || request->set_count > 4096)
        SPHGI_REFUSE(SPHG_ERROR_ARGUMENT, "%s: set_count is %d, must be 1 to 4096", f,
                     (int)request->set_count);
    if (request->field_count < 0 || request->field_count > 4096)
        SPHGI_REFUSE(SPHG_ERROR_ARGUMENT, "%s: field_count is %d, must be 0 to 4096", f,
                     (int)request->field_count);
    if (request->fields && !request->field_count)
        SPHGI_REFUSE(SPHG_ERROR_ARGUMENT, "%s: fields is set, but field_count is 0", f);
    const sphg_result missing = sphgi_check_pointer(builder->checker, request->sources, "sources");
    if (missing || !request->field_count)
        return missing;
    return sphgi_check_pointer(builder->checker, request->fields, "fields");
}

static sphg_result check_radii(struct sphgi_plan_builder *builder)
{
    const struct sphgi_plan *plan = builder->plan;
    struct sphgi_scheme smallest = plan->scheme;
    smallest.radius = plan->least;
    const sphg_result result = sphgi_check_range(builder->checker, &plan->scheme, plan->type);
    if (result || !plan->graded)
        return result;
    return sphgi_check_range(builder->checker, &smallest, plan->type);
}

static sphg_result take_everything(struct sphgi_plan_builder *builder)
{
    struct sphgi_plan *plan = builder->plan;
    sphg_result result = SPHG_OK;
    for (int32_t s = 0; s < plan->set_count && !result; ++s)
        result = check_set(builder, s);
    for (int32_t s = 1; s < plan->set_count && !result && !builder->checker.context->config.trusted;
         ++s)
        result = check_same_targets(builder, s);
    if (!result)
        result = check_radii(builder);
    for (int32_t s = 0; s < plan->set_count && !result; ++s)
        result = take_volume(builder, s);
    if (!result)
        result = take_targets(builder);
    if (!result)
        result = take_wanted(builder);
    for (int32_t k = 0; k < plan->field_count && !result; ++k)
        result = sphgi_take_field(builder, k);
    if (result)
        return result;
    sphgi_plan_decide(plan, builder->purpose);
    result = check_needed(builder);
    if (!result)
        result = sphgi_take_streams(builder);
    if (!result)
        result = sphgi_check_subset(builder->checker, builder->request->subset, plan->target_count);
    if (!result)
        result = sphgi_check_overlap(builder->checker, builder->extents, builder->extent_count);
    return result;
}

static bool are_radii_given(const sphg_request *request)
{
    const sphg_sources *first = request && request->set_count > 0 ? request->sources : NULL;
    return first && first->neighbors && first->neighbors->radii;
}

sphg_result sphgi_plan_make(struct sphgi_checker checker, const sphg_scheme *scheme,
                            const sphg_request *request, enum sphgi_purpose purpose,
                            struct sphgi_plan *plan)
{
    struct sphgi_plan_builder builder = {
        .checker = checker, .request = request, .purpose = purpose, .plan = plan};
    *plan = (struct sphgi_plan){.own_set = -1};
    sphg_result result = are_radii_given(request)
                             ? sphgi_check_scheme_beside_radii(checker, scheme, &plan->scheme)
                             : sphgi_check_scheme(checker, scheme, &plan->scheme);
    if (!result)
        result = sphgi_check_pointer(checker, request, "request");
    if (!result)
        result = check_counts(&builder);
    if (result)
        return result;
    if (!make_room(&builder))
        return sphgi_fail_memory(checker.context, checker.function);
    plan->dimension = plan->scheme.dimension;
    plan->classic = sphgi_is_classic(plan->scheme.method);
    plan->weighted = plan->scheme.method == SPHG_CRKPM;
    plan->quadratic = plan->scheme.order == 2;
    plan->set_count = request->set_count;
    plan->field_count = request->field_count;
    return take_everything(&builder);
}
