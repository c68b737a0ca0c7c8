/* SPDX-License-Identifier: MIT */
/* The arguments of each public function and what is wrong with them, a table per function. */
#include "bad_argument_rows.h"
#include "public_names.h"
#include "public_calls.h"
#include <stdio.h>

#define AT(member) offsetof(valid_call, member)

/* ---- Arguments that need a word of their own ---------------------------------------------- */

static int say(trial *made, int code, const char *words, const char *value, const char *what)
{
    made->expected = code;
    made->words = words;
    snprintf(made->value, sizeof made->value, "%s", value);
    snprintf(made->what, sizeof made->what, "%s", what);
    return 1;
}

static int spoil_version(valid_call *own, int number, trial *made)
{
    static const int32_t values[] = {0, -1, INT32_MIN, INT32_MAX, SPHG_VERSION + 1000000};
    if (number > 4)
        return 0;
    own->version = values[number];
    return say(made, SPHG_ERROR_VERSION, "version", test_text("%d", values[number]), "a number");
}

static int spoil_threads(valid_call *own, int number, trial *made)
{
    own->config.threads = number == 1 ? INT32_MIN : number - 1;
    if (number == 2) {
        own->config.threads = 0;
        own->config.parallel_for = fake_host_reversed;
    }
    return number < 3 && say(made, SPHG_ERROR_ARGUMENT, "config.threads",
                             test_text("%d", own->config.threads), "threads");
}

static int spoil_allocator(valid_call *own, int number, trial *made)
{
    if (number == 0)
        own->config.allocate = NULL;
    else
        own->config.release = NULL;
    return number < 2 && say(made, SPHG_ERROR_ARGUMENT,
                             number ? "config.release" : "config.allocate", "NULL", "one alone");
}

static int32_t empty_row(int32_t target, int32_t worker, const int32_t **indices, void *user)
{
    (void)target, (void)worker, (void)user;
    *indices = NULL;
    return 0;
}

static int spoil_groups(valid_call *own, int number, trial *made)
{
    static const int32_t lengths[VALID_CALL_COUNT] = {0};
    static const int32_t *const rows[VALID_CALL_COUNT] = {0};
    const sphg_lists ways[] = {{0},
                               {.offsets = own->offsets, .indices = own->indices, .row = empty_row},
                               {.rows = rows, .lengths = lengths, .row = empty_row},
                               {.offsets = own->offsets, .rows = rows, .lengths = lengths},
                               {.offsets = own->offsets},
                               {.indices = own->indices},
                               {.rows = rows},
                               {.lengths = lengths}};
    static const char *const words[] = {"lists",         "lists",         "lists",
                                        "lists",         "lists.indices", "lists.offsets",
                                        "lists.lengths", "lists.rows"};
    if (number > 7)
        return 0;
    own->lists = ways[number];
    return say(made, SPHG_ERROR_ARGUMENT, words[number], number > 3 ? "NULL" : "", "groups");
}

static int spoil_capacity(valid_call *own, int number, trial *made)
{
    static const int64_t values[] = {-1, INT64_MIN, 0, 3};
    if (number > 3)
        return 0;
    own->pairs.capacity = values[number];
    return say(made, number < 2 ? SPHG_ERROR_ARGUMENT : SPHG_ERROR_CAPACITY, "pairs.capacity",
               test_text("%lld", (long long)values[number]), "capacity");
}

/* The targets' side cannot be looked up in a set that they are no part of. */
static int spoil_lookup(valid_call *own, int number, trial *made)
{
    own->field.at_sources = number ? own->field.at_sources : NULL;
    return number < 1 && say(made, SPHG_ERROR_ARGUMENT, "at_sources", "NULL", "no array");
}

static int spoil_shape(valid_call *own, int number, trial *made)
{
    static const int values[] = {0, 5, -1, INT32_MAX, SPHG_VECTOR};
    if (number > 4)
        return 0;
    own->shape = (sphg_shape)values[number];
    return say(made, SPHG_ERROR_ARGUMENT, "shape",
               number < 4 ? test_text("%d", values[number]) : "", "shape");
}

/* ---- Rows --------------------------------------------------------------------------------- */

#define REQUIRED ARGUMENT_REQUIRED
#define OUTPUT   ARGUMENT_OUTPUT
#define VECTOR   ARGUMENT_VECTOR

#define FREE(path)                                                                                 \
    {                                                                                              \
        path, ARGUMENT_FREE, 0, 0, 0, 0, NULL, NULL                                                \
    }
#define ROW(path, kind, member)                                                                    \
    {                                                                                              \
        path, ARGUMENT_##kind, AT(member), 0, 0, 0, NULL, NULL                                     \
    }
#define POSITIVE(path, member)                                                                     \
    {                                                                                              \
        path, ARGUMENT_COUNT, AT(member), ARGUMENT_POSITIVE, 0, 0, NULL, NULL                      \
    }
#define VIEW(path, member, more)                                                                   \
    {                                                                                              \
        path, ARGUMENT_VIEW, AT(member), more, 0, 0, NULL, NULL                                    \
    }
#define ENUM(path, member, low, high)                                                              \
    {                                                                                              \
        path, ARGUMENT_ENUM, AT(member), 0, low, high, NULL, NULL                                  \
    }
#define SPECIAL(path, function)                                                                    \
    {                                                                                              \
        path, ARGUMENT_SPECIAL, 0, 0, 0, 0, function, NULL                                         \
    }

#define CONTEXT ROW("context", HANDLE, context)
#define SCHEME                                                                                     \
    ROW("scheme", POINTER, scheme_given), ROW("scheme.dimension", DIMENSION, scheme.dimension),    \
        ENUM("scheme.method", scheme.method, SPHG_KGC, SPHG_PLAIN),                                \
        ENUM("scheme.kernel", scheme.kernel, SPHG_CUBIC_SPLINE, SPHG_SPIKY),                       \
        ENUM("scheme.policy", scheme.policy, SPHG_BLEND, SPHG_IDENTITY),                           \
        ROW("scheme.support_radius", RADIUS, scheme.support_radius),                               \
        ROW("scheme.threshold", THRESHOLD, scheme.threshold),                                      \
        ENUM("scheme.order", scheme.order, 0, 2)
#define GEOMETRY                                                                                   \
    ROW("geometry", POINTER, geometry_given),                                                      \
        VIEW("geometry.sources", geometry.sources, REQUIRED | VECTOR | ARGUMENT_LEADING),          \
        ROW("geometry.sources", POSITIONS, geometry.sources),                                      \
        VIEW("geometry.targets", geometry.targets, VECTOR),                                        \
        ROW("geometry.targets", POSITIONS, geometry.targets), {"geometry.source_count",            \
                                                               ARGUMENT_COUNT,                     \
                                                               AT(geometry.source_count),          \
                                                               0,                                  \
                                                               -1,                                 \
                                                               0,                                  \
                                                               NULL,                               \
                                                               NULL},                              \
        ROW("geometry.target_count", COUNT, geometry.target_count),                                \
        ENUM("geometry.precision", geometry.precision, 0, SPHG_F64),                               \
        ROW("geometry.skin", LENGTH, geometry.skin),                                               \
        ROW("geometry.period", LENGTH, geometry.period[1]), FREE("geometry.list_free"),            \
        FREE("geometry.keep_weights"), FREE("geometry.source_support"),                            \
        FREE("geometry.target_support"), FREE("geometry.mutual"), FREE("geometry.targets_of")
#define SOURCES                                                                                    \
    ROW("sources", POINTER, sources_given), ROW("sources.neighbors", BUILT, sources[0].neighbors), \
        ROW("sources.neighbors", INDICES, sources[0].neighbors),                                   \
        VIEW("sources.volume", sources[0].volume, REQUIRED),                                       \
        ROW("sources.volume", VOLUMES, sources[0].volume), FREE("sources.same_volumes")
#define SUBSET                                                                                     \
    FREE("subset"), ROW("subset.begin", RANGE, subset), ROW("subset.end", RANGE, subset),          \
        ROW("subset.indices", PICKED, subset), FREE("subset.mask")

#define PROBE(prepare, call, arguments)                                                            \
    {                                                                                              \
        prepare, call, arguments, (int)(sizeof(arguments) / sizeof *(arguments))                   \
    }

static const argument none[] = {FREE("result"), FREE("context"), FREE("neighbors")};
static const probe probes_sphg_result_string[] = {PROBE(NULL, NULL, none)};
static const probe probes_sphg_version[] = {PROBE(NULL, NULL, none)};
static const probe probes_sphg_context_destroy[] = {PROBE(NULL, NULL, none)};
static const probe probes_sphg_last_message[] = {PROBE(NULL, NULL, none)};
static const probe probes_sphg_neighbors_destroy[] = {PROBE(NULL, NULL, none)};

/* Without a result: see functions_without_a_result_are_harmless(). */
static const argument of_numbers[] = {
    FREE("scheme"), FREE("r"),      FREE("w"),          FREE("dw_over_r"), FREE("sigma"),
    FREE("mu2"),    FREE("volume"), FREE("correction"), FREE("gradient"),  FREE("x_ij")};
static const probe probes_sphg_correction_width[] = {PROBE(NULL, NULL, of_numbers)};
static const probe probes_sphg_kernel_value[] = {PROBE(NULL, NULL, of_numbers)};
static const probe probes_sphg_kernel_constants[] = {PROBE(NULL, NULL, of_numbers)};
static const probe probes_sphg_pair_gradient[] = {PROBE(NULL, NULL, of_numbers)};

static const argument of_context_create[] = {
    SPECIAL("version", spoil_version),
    FREE("config"),
    SPECIAL("config.threads", spoil_threads),
    ENUM("config.isa", config.isa, SPHG_ISA_BEST, SPHG_ISA_NEON),
    FREE("config.trusted"),
    SPECIAL("config.allocate", spoil_allocator),
    SPECIAL("config.release", spoil_allocator),
    FREE("config.log"),
    FREE("config.parallel_for"),
    FREE("config.user"),
    ROW("context", HANDLE, context_out),
};
static const probe probes_sphg_context_create[] = {
    PROBE(NULL, call_create_context, of_context_create)};

static const argument of_get_context_info[] = {CONTEXT, ROW("info", POINTER, context_info)};
static const probe probes_sphg_context_get_info[] = {
    PROBE(NULL, call_get_context_info, of_get_context_info)};

static const argument of_neighbors_create[] = {CONTEXT, ROW("neighbors", POINTER, neighbors_out)};
static const probe probes_sphg_neighbors_create[] = {
    PROBE(NULL, call_create_neighbors, of_neighbors_create)};

static const argument of_search[] = {CONTEXT, ROW("neighbors", POINTER, neighbors), SCHEME,
                                     GEOMETRY};
static const argument of_radii[] = {
    VIEW("geometry.source_support", geometry.source_support, REQUIRED),
    ROW("geometry.source_support", RADII, geometry.source_support),
    VIEW("geometry.target_support", geometry.target_support, REQUIRED),
    ROW("geometry.target_support", RADII, geometry.target_support)};
static const probe probes_sphg_neighbors_search[] = {
    PROBE(NULL, call_search, of_search), PROBE(prepare_with_targets, call_search, of_search),
    PROBE(prepare_with_radii, call_search, of_radii)};

static const argument of_would_rebuild[] = {CONTEXT, ROW("neighbors", POINTER, neighbors), SCHEME,
                                            GEOMETRY, ROW("rebuild", POINTER, rebuild)};
static const probe probes_sphg_neighbors_would_rebuild[] = {
    PROBE(NULL, call_would_rebuild, of_would_rebuild),
    PROBE(prepare_with_targets, call_would_rebuild, of_would_rebuild),
    PROBE(prepare_with_radii, call_would_rebuild, of_radii)};

static const argument of_use_lists[] = {CONTEXT,
                                        ROW("neighbors", POINTER, neighbors),
                                        SCHEME,
                                        GEOMETRY,
                                        ROW("lists", POINTER, lists_given),
                                        ROW("lists.offsets", OFFSETS, lists),
                                        SPECIAL("lists.indices", spoil_groups),
                                        SPECIAL("lists.rows", spoil_groups),
                                        SPECIAL("lists.lengths", spoil_groups),
                                        SPECIAL("lists.row", spoil_groups),
                                        FREE("lists.user"),
                                        FREE("lists.index_mask"),
                                        FREE("lists.copy")};
static const probe probes_sphg_neighbors_use_lists[] = {
    PROBE(NULL, call_use_lists, of_use_lists),
    PROBE(prepare_with_radii, call_use_lists, of_radii), /* later calls want one radius for all */
    PROBE(prepare_with_targets, call_use_lists, of_use_lists)};

static const argument of_get_info[] = {CONTEXT, ROW("neighbors", POINTER, neighbors),
                                       ROW("info", POINTER, info)};
static const probe probes_sphg_neighbors_get_info[] = {PROBE(NULL, call_get_info, of_get_info)};

static const argument of_get_order[] = {CONTEXT, ROW("neighbors", BUILT, neighbors),
                                        ROW("order", POINTER, order)};
static const probe probes_sphg_neighbors_get_order[] = {PROBE(NULL, call_get_order, of_get_order)};

static const argument of_check[] = {CONTEXT, SCHEME, ROW("neighbors", BUILT, neighbors),
                                    FREE("fault")};
static const probe probes_sphg_neighbors_check[] = {PROBE(NULL, call_check, of_check),
                                                    PROBE(prepare_listed, call_check, of_check)};

#define REQUEST                                                                                    \
    ROW("request", POINTER, request_given), ROW("request.sources", POINTER, request.sources),      \
        ROW("request.fields", POINTER, request.fields),                                            \
        POSITIVE("request.set_count", request.set_count),                                          \
        POSITIVE("request.field_count", request.field_count), FREE("request.subset"),              \
        ENUM("fields.shape", field.shape, SPHG_SCALAR, SPHG_TENSOR),                               \
        ENUM("fields.form", field.form, SPHG_DIFFERENCE, SPHG_ADJOINT), FREE("fields.accumulate"), \
        FREE("fields.mirror"), SPECIAL("fields.at_sources", spoil_lookup),                         \
        ROW("fields.at_sources", NUMBERS, at_sources[0]), FREE("request.stats")

static const argument of_evaluate[] = {
    CONTEXT,
    SCHEME,
    REQUEST,
    ROW("sources.neighbors", BUILT, sources[0].neighbors),
    ROW("sources.neighbors", INDICES, sources[0].neighbors),
    VIEW("sources.volume", sources[0].volume, REQUIRED),
    ROW("sources.volume", VOLUMES, sources[0].volume),
    SUBSET,
    VIEW("fields.at_sources", at_sources[0], REQUIRED),
    VIEW("fields.at_targets", field.at_targets, 0),
    VIEW("fields.gradient", field.gradient, OUTPUT | VECTOR),
    VIEW("request.correction", request.correction, OUTPUT),
    VIEW("request.rank", request.rank, OUTPUT | ARGUMENT_BYTES),
    VIEW("request.lambda_min", request.lambda_min, OUTPUT),
};
static const argument of_two_sided[] = {
    VIEW("sources.volume", sources[0].volume, REQUIRED),
    VIEW("sources.density", sources[0].density, REQUIRED),
    VIEW("sources.correction", sources[0].correction, REQUIRED),
    VIEW("request.target_volume", request.target_volume, 0),
    VIEW("request.target_density", request.target_density, 0),
    VIEW("request.target_correction", request.target_correction, 0),
    ROW("sources.density", NUMBERS, sources[0].density),
    ROW("sources.correction", NUMBERS, sources[0].correction),
    ROW("sources.neighbors", INDICES, sources[0].neighbors),
    VIEW("fields.at_sources", at_sources[0], 0),
    VIEW("fields.gradient", field.gradient, OUTPUT | VECTOR),
};
static const argument of_direct[] = {
    VIEW("sources.volume", sources[0].volume, REQUIRED),
    ROW("sources.volume", VOLUMES, sources[0].volume),
    VIEW("fields.at_sources", at_sources[0], VECTOR),
    VIEW("fields.value", field.value, OUTPUT | VECTOR),
    VIEW("fields.gradient", field.gradient, OUTPUT | VECTOR),
    VIEW("fields.divergence", field.divergence, OUTPUT),
    VIEW("fields.curl", field.curl, OUTPUT),
};
static const argument of_square[] = {
    VIEW("sources.volume", sources[0].volume, REQUIRED),
    ROW("sources.volume", VOLUMES, sources[0].volume),
    VIEW("fields.at_sources", at_sources[0], 0),
    VIEW("fields.square", field.square, OUTPUT),
};
static const argument of_quadratic[] = {
    VIEW("sources.volume", sources[0].volume, REQUIRED),
    ROW("sources.volume", VOLUMES, sources[0].volume),
    VIEW("fields.at_sources", at_sources[0], REQUIRED),
    VIEW("fields.gradient", field.gradient, OUTPUT | VECTOR),
    VIEW("fields.hessian", field.hessian, OUTPUT),
    VIEW("fields.laplacian", field.laplacian, OUTPUT),
};
static const argument of_lending[] = {
    VIEW("fields.at_sources", at_sources[0], REQUIRED),
    VIEW("fields.gradient", field.gradient, OUTPUT | VECTOR),
    VIEW("fields.curvature", field.curvature, OUTPUT),
    FREE("fields.lenders"),
    {"lenders", ARGUMENT_VIEW, AT(lenders[0]), 0, 0, 0, NULL, NULL},
    {"lenders", ARGUMENT_NUMBERS, AT(lenders[0]), 0, 0, 0, NULL, NULL},
    VIEW("request.borrows", request.borrows, OUTPUT | ARGUMENT_BYTES),
};
static const argument of_diffusion[] = {
    VIEW("sources.volume", sources[0].volume, REQUIRED),
    ROW("sources.volume", VOLUMES, sources[0].volume),
    VIEW("sources.correction", sources[0].correction, REQUIRED),
    ROW("sources.correction", NUMBERS, sources[0].correction),
    VIEW("fields.at_sources", at_sources[0], REQUIRED),
    VIEW("fields.laplacian", field.laplacian, OUTPUT),
    FREE("fields.coefficient"),
    {"coefficient", ARGUMENT_VIEW, AT(coefficient[0]), REQUIRED, 0, 0, NULL, NULL},
    {"coefficient", ARGUMENT_NUMBERS, AT(coefficient[0]), 0, 0, 0, NULL, NULL},
    VIEW("fields.coefficient_at_targets", field.coefficient_at_targets, 0),
    ROW("fields.coefficient_at_targets", NUMBERS, field.coefficient_at_targets),
};
static const argument of_values[] = {
    VIEW("fields.at_sources", at_sources[0], VECTOR),
    VIEW("fields.value", field.value, OUTPUT | VECTOR),
    FREE("fields.shepard"),
    FREE("fields.value_volume"),
    {"value_volume", ARGUMENT_VIEW, AT(volumes[0]), REQUIRED, 0, 0, NULL, NULL},
    {"value_volume", ARGUMENT_NUMBERS, AT(volumes[0]), 0, 0, 0, NULL, NULL},
    VIEW("fields.tensor", field.tensor, REQUIRED),
    ROW("fields.tensor", NUMBERS, field.tensor),
    VIEW("fields.contraction", field.contraction, OUTPUT),
};
static const probe probes_sphg_evaluate[] = {PROBE(NULL, call_evaluate, of_evaluate),
                                             PROBE(prepare_two_sided, call_evaluate, of_two_sided),
                                             PROBE(prepare_direct, call_evaluate, of_direct),
                                             PROBE(prepare_square, call_evaluate, of_square),
                                             PROBE(prepare_quadratic, call_evaluate, of_quadratic),
                                             PROBE(prepare_lending, call_evaluate, of_lending),
                                             PROBE(prepare_diffusion, call_evaluate, of_diffusion),
                                             PROBE(prepare_values, call_evaluate, of_values)};

static const argument of_correction[] = {
    CONTEXT,
    SCHEME,
    SOURCES,
    SUBSET,
    VIEW("correction", table_out, OUTPUT),
    VIEW("rank", rank_out, OUTPUT | ARGUMENT_BYTES),
};
static const probe probes_sphg_correction[] = {PROBE(NULL, call_correction, of_correction)};

/* In messages of the short ways a field stands as what it is in their request. */
#define SHORT_WAY(name, field, field_flags, result, result_path, result_flags)                     \
    static const argument of_##name[] = {                                                          \
        CONTEXT,                                                                                   \
        SCHEME,                                                                                    \
        SOURCES,                                                                                   \
        SUBSET,                                                                                    \
        VIEW("field", field, REQUIRED | (field_flags)),                                            \
        ROW("field", NUMBERS, field),                                                              \
        VIEW(result_path, result, REQUIRED | OUTPUT | (result_flags)),                             \
    };                                                                                             \
    static const probe probes_sphg_##name[] = {PROBE(NULL, call_##name, of_##name)}

SHORT_WAY(gradient, scalars, 0, vector_out, "gradient", VECTOR);
SHORT_WAY(jacobian, vectors, VECTOR, tensor_out, "jacobian", VECTOR);
SHORT_WAY(divergence, vectors, VECTOR, scalar_out, "divergence", 0);

static const argument of_curl[] = {
    CONTEXT,
    SCHEME,
    SOURCES,
    SUBSET,
    VIEW("field", vectors, REQUIRED | VECTOR),
    ROW("field", NUMBERS, vectors),
    FREE("curl"), /* another view in each dimension: see the direct request */
};
static const probe probes_sphg_curl[] = {PROBE(NULL, call_curl, of_curl)};

static const argument of_force[] = {
    CONTEXT,
    SCHEME,
    SOURCES,
    VIEW("sources.correction", sources[0].correction, REQUIRED),
    SUBSET,
    SPECIAL("shape", spoil_shape),
    {"stress", ARGUMENT_VIEW, AT(tensors), REQUIRED | VECTOR, 0, 0, NULL, "field"},
    VIEW("force", vector_out, REQUIRED | OUTPUT | VECTOR),
};
static const probe probes_sphg_force[] = {PROBE(prepare_with_table, call_force, of_force)};

static const argument of_pair_gradients[] = {
    CONTEXT,
    SCHEME,
    SOURCES,
    SUBSET,
    VIEW("target_correction", target_correction, 0),
    ROW("pairs", POINTER, pairs_given),
    SPECIAL("pairs.capacity", spoil_capacity),
    FREE("pairs.any_order"),
    FREE("pairs.block"),
    FREE("pairs.lengths"),
    VIEW("pairs.gradient", pairs.gradient, OUTPUT | VECTOR),
    FREE("pairs.offsets"),
    FREE("pairs.indices"),
    FREE("pairs.count"),
};
static const probe probes_sphg_pair_gradients[] = {
    PROBE(prepare_of_four_targets, call_pair_gradients, of_pair_gradients)};

static const argument of_invert_moments[] = {
    CONTEXT,
    SCHEME,
    ROW("count", COUNT, count),
    VIEW("moments", symmetric, REQUIRED | ARGUMENT_LEADING),
    ROW("moments", NUMBERS, symmetric),
    VIEW("volume", volume_view, REQUIRED),
    ROW("volume", VOLUMES, volume_view),
    ROW("wanted", POINTER, wanted_given),
    VIEW("wanted.correction", wanted.correction, OUTPUT),
    VIEW("wanted.rank", wanted.rank, OUTPUT | ARGUMENT_BYTES),
    VIEW("wanted.lambda_min", wanted.lambda_min, OUTPUT),
    FREE("wanted.stats"),
};
static const probe probes_sphg_invert_moments[] = {
    PROBE(prepare_by_mls, call_invert_moments, of_invert_moments)};

static const argument of_eigen[] = {
    CONTEXT,
    {"dimension", ARGUMENT_DIMENSION, AT(dimension), 0, 1, 0, NULL, NULL},
    ROW("count", COUNT, count),
    VIEW("matrices", symmetric, REQUIRED | ARGUMENT_LEADING),
    ROW("matrices", NUMBERS, symmetric),
    VIEW("values", vector_out, OUTPUT | VECTOR),
    VIEW("vectors", tensor_out, OUTPUT | VECTOR),
};
static const probe probes_sphg_eigen[] = {PROBE(NULL, call_eigen, of_eigen)};

static const argument of_svd[] = {
    CONTEXT,
    ROW("count", COUNT, count),
    VIEW("matrices", squares, REQUIRED | VECTOR | ARGUMENT_LEADING),
    ROW("matrices", NUMBERS, squares),
    VIEW("u", u, OUTPUT | VECTOR),
    VIEW("sigma", sigma, OUTPUT | VECTOR),
    VIEW("v", v, OUTPUT | VECTOR),
};
static const probe probes_sphg_svd[] = {PROBE(NULL, call_svd, of_svd)};

/* A function of the header that has no rows above stops here. */
const argument_function argument_functions[] = {
#define FUNCTION(name, parameters)                                                                 \
    {#name, parameters, probes_##name, (int)(sizeof(probes_##name) / sizeof *probes_##name)},
    PUBLIC_FUNCTIONS(FUNCTION)
#undef FUNCTION
};
const int argument_function_count = sizeof argument_functions / sizeof *argument_functions;
