/* SPDX-License-Identifier: MIT */
/* sphg_evaluate and the short ways to call it. */
#include "core/check.h"
#include "plan/make.h"
#include "sweep/sweep.h"

static sphg_result evaluate(struct sphgi_checker checker, const sphg_scheme *scheme,
                            const sphg_request *request)
{
    struct sphgi_plan plan;
    sphg_result result = sphgi_enter(checker.context);
    if (result)
        return result;
    result = sphgi_plan_make(checker, scheme, request, SPHGI_FOR_RESULTS, &plan);
    if (!result)
        result = sphgi_sweep_run(checker, &plan, request->subset, NULL);
    return sphgi_leave(checker.context, result);
}

sphg_result sphg_evaluate(sphg_context *context, const sphg_scheme *scheme,
                          const sphg_request *request)
{
    return evaluate((struct sphgi_checker){context, "sphg_evaluate"}, scheme, request);
}

sphg_result sphg_correction(sphg_context *context, const sphg_scheme *scheme,
                            const sphg_sources *sources, const sphg_subset *subset,
                            sphg_view correction, sphg_view rank)
{
    const struct sphgi_checker checker = {context, "sphg_correction"};
    sphg_sources without_table = {.neighbors = NULL};
    if (sources)
        without_table = *sources;
    without_table.correction = sphg_absent();
    const sphg_request request = {.sources = sources ? &without_table : NULL,
                                  .set_count = 1,
                                  .subset = subset,
                                  .correction = correction,
                                  .rank = rank};
    return evaluate(checker, scheme, &request);
}

static sphg_result refuse(struct sphgi_checker checker, const char *what)
{
    const sphg_result result = sphgi_enter(checker.context);
    if (result)
        return result;
    return sphgi_leave(checker.context, sphgi_fail(checker.context, SPHG_ERROR_ARGUMENT, "%s: %s",
                                                   checker.function, what));
}

/* One field of one source set that holds the targets. */
static sphg_result evaluate_field(struct sphgi_checker checker, const sphg_scheme *scheme,
                                  const sphg_sources *sources, const sphg_subset *subset,
                                  const sphg_field *field)
{
    const sphg_neighbors *n = sources ? sources->neighbors : NULL;
    const bool nobody = n && n->kind && !n->source_count,
               no_target = n && n->kind && !n->target_count;
    const bool wants = field->gradient.x || field->divergence.x || field->curl.x || no_target;
    if (!wants || (!field->at_sources->x && !nobody)) /* in a request absent is 0, or not wanted */
        return refuse(checker, wants ? "the field is absent" : "the result is absent");
    const sphg_request request = {
        .sources = sources, .fields = field, .set_count = 1, .field_count = 1, .subset = subset};
    return evaluate(checker, scheme, &request);
}

sphg_result sphg_gradient(sphg_context *context, const sphg_scheme *scheme,
                          const sphg_sources *sources, const sphg_subset *subset, sphg_view field,
                          sphg_view gradient)
{
    const sphg_field scalar = {.shape = SPHG_SCALAR, .at_sources = &field, .gradient = gradient};
    return evaluate_field((struct sphgi_checker){context, "sphg_gradient"}, scheme, sources, subset,
                          &scalar);
}

sphg_result sphg_jacobian(sphg_context *context, const sphg_scheme *scheme,
                          const sphg_sources *sources, const sphg_subset *subset, sphg_view field,
                          sphg_view jacobian)
{
    const sphg_field vector = {.shape = SPHG_VECTOR, .at_sources = &field, .gradient = jacobian};
    return evaluate_field((struct sphgi_checker){context, "sphg_jacobian"}, scheme, sources, subset,
                          &vector);
}

sphg_result sphg_divergence(sphg_context *context, const sphg_scheme *scheme,
                            const sphg_sources *sources, const sphg_subset *subset, sphg_view field,
                            sphg_view divergence)
{
    const sphg_field vector = {
        .shape = SPHG_VECTOR, .at_sources = &field, .divergence = divergence};
    return evaluate_field((struct sphgi_checker){context, "sphg_divergence"}, scheme, sources,
                          subset, &vector);
}

sphg_result sphg_curl(sphg_context *context, const sphg_scheme *scheme, const sphg_sources *sources,
                      const sphg_subset *subset, sphg_view field, sphg_view curl)
{
    const sphg_field vector = {.shape = SPHG_VECTOR, .at_sources = &field, .curl = curl};
    return evaluate_field((struct sphgi_checker){context, "sphg_curl"}, scheme, sources, subset,
                          &vector);
}

sphg_result sphg_force(sphg_context *context, const sphg_scheme *scheme,
                       const sphg_sources *sources, const sphg_subset *subset, sphg_shape shape,
                       sphg_view stress, sphg_view force)
{
    const struct sphgi_checker checker = {context, "sphg_force"};
    sphg_field field = {.shape = shape, .form = SPHG_ADJOINT, .at_sources = &stress};
    if (shape == SPHG_SCALAR)
        field.gradient = force;
    else
        field.divergence = force;
    if (shape == SPHG_VECTOR) /* its divergence is no vector */
        return refuse(checker, "shape is SPHG_VECTOR, must be a scalar or a tensor");
    return evaluate_field(checker, scheme, sources, subset, &field);
}
