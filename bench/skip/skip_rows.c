/* SPDX-License-Identifier: MIT */
/* Each row of the table: the full evaluation, and the part of it that a scene may need. */
#include "skip.h"

static sphg_sources sources_of(const struct skip_stage *stage, const sphg_neighbors *neighbors)
{
    return (sphg_sources){.neighbors = neighbors, .volume = numbers_view(&stage->volumes)};
}

static void evaluate(const struct skip_stage *stage, const struct cloud *cloud,
                     const sphg_sources *sources, sphg_field *fields, int32_t field_count,
                     const struct numbers *corrections)
{
    const sphg_request request = {.sources = sources,
                                  .set_count = 1,
                                  .fields = fields,
                                  .field_count = field_count,
                                  .correction =
                                      corrections ? numbers_view(corrections) : sphg_absent()};
    library_check(stage->context, sphg_evaluate(stage->context, &cloud->scheme, &request));
}

/* Matrices kept, and all derivatives of a vector field. */
static void everything(struct skip_stage *stage, struct outputs *outputs, int parameter)
{
    (void)parameter;
    const sphg_sources sources = sources_of(stage, stage->solid.kept);
    const sphg_view at_sources = numbers_view(&stage->solid.fields[0]);
    sphg_field field = {.shape = SPHG_VECTOR,
                        .at_sources = &at_sources,
                        .gradient = numbers_view(&outputs->jacobians[0]),
                        .divergence = numbers_view(&outputs->divergence),
                        .curl = numbers_view(&outputs->curl)};
    evaluate(stage, &stage->solid, &sources, &field, 1, &outputs->corrections);
}

static void jacobian_of(struct skip_stage *stage, const struct cloud *cloud,
                        const sphg_sources *sources, const sphg_subset *subset,
                        struct outputs *outputs, int field)
{
    library_check(stage->context, sphg_jacobian(stage->context, &cloud->scheme, sources, subset,
                                                numbers_view(&cloud->fields[field]),
                                                numbers_view(&outputs->jacobians[field])));
}

static void jacobian(struct skip_stage *stage, struct outputs *outputs, int parameter)
{
    (void)parameter;
    const sphg_sources sources = sources_of(stage, stage->solid.kept);
    jacobian_of(stage, &stage->solid, &sources, NULL, outputs, 0);
}

static void divergence(struct skip_stage *stage, struct outputs *outputs, int parameter)
{
    (void)parameter;
    const sphg_sources sources = sources_of(stage, stage->solid.kept);
    library_check(stage->context, sphg_divergence(stage->context, &stage->solid.scheme, &sources,
                                                  NULL, numbers_view(&stage->solid.fields[0]),
                                                  numbers_view(&outputs->divergence)));
}

static void curl(struct skip_stage *stage, struct outputs *outputs, int parameter)
{
    (void)parameter;
    const sphg_sources sources = sources_of(stage, stage->solid.kept);
    library_check(stage->context,
                  sphg_curl(stage->context, &stage->solid.scheme, &sources, NULL,
                            numbers_view(&stage->solid.fields[0]), numbers_view(&outputs->curl)));
}

static void matrices(struct skip_stage *stage, struct outputs *outputs, int parameter)
{
    (void)parameter;
    const sphg_sources sources = sources_of(stage, stage->solid.kept);
    library_correct(stage->context, &stage->solid.scheme, &sources,
                    numbers_view(&outputs->corrections), NULL);
}

/* As if no matrix were certified: 4 eps is more than any of their eigenvalues. */
static void decomposed_matrices(struct skip_stage *stage, struct outputs *outputs, int parameter)
{
    (void)parameter;
    const sphg_sources sources = sources_of(stage, stage->solid.kept);
    sphg_scheme scheme = stage->solid.scheme;
    scheme.threshold = 0.5;
    library_correct(stage->context, &scheme, &sources, numbers_view(&outputs->corrections), NULL);
}

/* With the matrices that the stage keeps. */
static void jacobian_by_table(struct skip_stage *stage, struct outputs *outputs, int parameter)
{
    (void)parameter;
    sphg_sources sources = sources_of(stage, stage->solid.kept);
    sources.correction = numbers_view(&stage->corrections);
    jacobian_of(stage, &stage->solid, &sources, NULL, outputs, 0);
}

/* Every call after the first reads what kernel and volumes gave each pair. */
static void jacobian_by_weights(struct skip_stage *stage, struct outputs *outputs, int parameter)
{
    (void)parameter;
    sphg_sources sources = sources_of(stage, stage->solid.weighted);
    sources.same_volumes = 1;
    jacobian_of(stage, &stage->solid, &sources, NULL, outputs, 0);
}

static void fields_one_by_one(struct skip_stage *stage, struct outputs *outputs, int parameter)
{
    (void)parameter;
    const sphg_sources sources = sources_of(stage, stage->solid.kept);
    for (int f = 0; f < SKIP_FIELDS; ++f)
        jacobian_of(stage, &stage->solid, &sources, NULL, outputs, f);
}

static void fields_one_by_one_by_table(struct skip_stage *stage, struct outputs *outputs,
                                       int parameter)
{
    (void)parameter;
    sphg_sources sources = sources_of(stage, stage->solid.kept);
    sources.correction = numbers_view(&stage->corrections);
    for (int f = 0; f < SKIP_FIELDS; ++f)
        jacobian_of(stage, &stage->solid, &sources, NULL, outputs, f);
}

/* parameter: 1 by the table of matrices */
static void fields_in_one_call(struct skip_stage *stage, struct outputs *outputs, int parameter)
{
    sphg_sources sources = sources_of(stage, stage->solid.kept);
    if (parameter)
        sources.correction = numbers_view(&stage->corrections);
    sphg_view at_sources[SKIP_FIELDS];
    sphg_field fields[SKIP_FIELDS];
    for (int f = 0; f < SKIP_FIELDS; ++f) {
        at_sources[f] = numbers_view(&stage->solid.fields[f]);
        fields[f] = (sphg_field){.shape = SPHG_VECTOR,
                                 .at_sources = &at_sources[f],
                                 .gradient = numbers_view(&outputs->jacobians[f])};
    }
    evaluate(stage, &stage->solid, &sources, fields, SKIP_FIELDS, NULL);
}

static void jacobian_of_masked(struct skip_stage *stage, struct outputs *outputs, int pattern)
{
    const sphg_sources sources = sources_of(stage, stage->solid.kept);
    const sphg_subset subset =
        sphg_masked(stage->patterns[pattern].mask, stage->solid.positions.count);
    jacobian_of(stage, &stage->solid, &sources, &subset, outputs, 0);
}

static void jacobian_of_listed(struct skip_stage *stage, struct outputs *outputs, int pattern)
{
    const sphg_sources sources = sources_of(stage, stage->solid.kept);
    const sphg_subset subset =
        sphg_listed(stage->patterns[pattern].indices, stage->patterns[pattern].count);
    jacobian_of(stage, &stage->solid, &sources, &subset, outputs, 0);
}

static void search(const struct skip_stage *stage, const struct numbers *positions,
                   sphg_neighbors *neighbors, int32_t list_free, double skin)
{
    sphg_geometry geometry = library_geometry(positions, SPHG_F32);
    geometry.list_free = list_free;
    geometry.skin = skin;
    library_search(stage->context, neighbors, &stage->solid.scheme, &geometry);
}

static void search_and_jacobian(struct skip_stage *stage, struct outputs *outputs, int parameter)
{
    (void)parameter;
    search(stage, &stage->solid.positions, stage->solid.rebuilt, 0, 0);
    const sphg_sources sources = sources_of(stage, stage->solid.rebuilt);
    jacobian_of(stage, &stage->solid, &sources, NULL, outputs, 0);
}

static void list_free_jacobian(struct skip_stage *stage, struct outputs *outputs, int parameter)
{
    (void)parameter;
    search(stage, &stage->solid.positions, stage->solid.list_free, 1, 0);
    const sphg_sources sources = sources_of(stage, stage->solid.list_free);
    jacobian_of(stage, &stage->solid, &sources, NULL, outputs, 0);
}

static const struct numbers *positions_of_round(const struct skip_stage *stage)
{
    return stage->positions_are_moved ? &stage->solid.moved : &stage->solid.positions;
}

static void moved_search_and_jacobian(struct skip_stage *stage, struct outputs *outputs,
                                      int parameter)
{
    (void)parameter;
    search(stage, positions_of_round(stage), stage->solid.rebuilt, 0, 0);
    const sphg_sources sources = sources_of(stage, stage->solid.rebuilt);
    jacobian_of(stage, &stage->solid, &sources, NULL, outputs, 0);
}

static void skinned_search_and_jacobian(struct skip_stage *stage, struct outputs *outputs,
                                        int parameter)
{
    (void)parameter;
    search(stage, positions_of_round(stage), stage->solid.skinned, 0, stage->skin);
    const sphg_sources sources = sources_of(stage, stage->solid.skinned);
    jacobian_of(stage, &stage->solid, &sources, NULL, outputs, 0);
    stage->skin_was_spent |= library_info(stage->context, stage->solid.skinned).rebuilt;
}

static void jacobian_in_plane(struct skip_stage *stage, struct outputs *outputs, int parameter)
{
    (void)outputs, (void)parameter;
    const sphg_sources sources = sources_of(stage, stage->plane.kept);
    jacobian_of(stage, &stage->plane, &sources, NULL, &stage->plane.part, 0);
}

static void jacobian_by_one_volume(struct skip_stage *stage, struct outputs *outputs, int parameter)
{
    (void)parameter;
    sphg_sources sources = sources_of(stage, stage->solid.kept);
    sources.volume.x = stage->volume.data;
    sources.volume.stride = 0;
    jacobian_of(stage, &stage->solid, &sources, NULL, outputs, 0);
}

static const char all_outputs[] = "matrices, Jacobian, divergence, curl",
                  all_targets[] = "Jacobian of all particles",
                  anew[] = "search, matrices, Jacobian";

const struct skip_row skip_rows[] = {
    {"outputs", "Jacobian, matrices not kept", all_outputs, jacobian, everything, 0,
     COMPARE_JACOBIAN, -1},
    {"outputs", "divergence alone", all_outputs, divergence, everything, 0, COMPARE_DIVERGENCE, -1},
    {"outputs", "curl alone", all_outputs, curl, everything, 0, COMPARE_CURL, -1},
    {"outputs", "matrices alone", all_outputs, matrices, everything, 0, COMPARE_CORRECTIONS, -1},
    {"fields", "4 vector fields in one call", "one by one", fields_in_one_call, fields_one_by_one,
     0, COMPARE_ALL_FIELDS, -1},
    {"fields", "the same with matrices given", "one by one, matrices given", fields_in_one_call,
     fields_one_by_one_by_table, 1, COMPARE_ALL_FIELDS, -1},
    {"active", "75 % scattered, mask", all_targets, jacobian_of_masked, jacobian, 0,
     COMPARE_JACOBIAN, 0},
    {"active", "50 % scattered, mask", all_targets, jacobian_of_masked, jacobian, 2,
     COMPARE_JACOBIAN, 2},
    {"active", "50 % scattered, list", all_targets, jacobian_of_listed, jacobian, 2,
     COMPARE_JACOBIAN, 2},
    {"active", "50 % clustered, mask", all_targets, jacobian_of_masked, jacobian, 3,
     COMPARE_JACOBIAN, 3},
    {"active", "50 % clustered, list", all_targets, jacobian_of_listed, jacobian, 3,
     COMPARE_JACOBIAN, 3},
    {"active", "10 % scattered, mask", all_targets, jacobian_of_masked, jacobian, 4,
     COMPARE_JACOBIAN, 4},
    {"active", "10 % scattered, list", all_targets, jacobian_of_listed, jacobian, 4,
     COMPARE_JACOBIAN, 4},
    {"active", "10 % clustered, mask", all_targets, jacobian_of_masked, jacobian, 5,
     COMPARE_JACOBIAN, 5},
    {"active", "10 % clustered, list", all_targets, jacobian_of_listed, jacobian, 5,
     COMPARE_JACOBIAN, 5},
    {"active", "1 % scattered, mask", all_targets, jacobian_of_masked, jacobian, 6,
     COMPARE_JACOBIAN, 6},
    {"active", "1 % scattered, list", all_targets, jacobian_of_listed, jacobian, 6,
     COMPARE_JACOBIAN, 6},
    {"active", "1 % clustered, mask", all_targets, jacobian_of_masked, jacobian, 7,
     COMPARE_JACOBIAN, 7},
    {"active", "1 % clustered, list", all_targets, jacobian_of_listed, jacobian, 7,
     COMPARE_JACOBIAN, 7},
    {"reuse", "neighbours kept", anew, jacobian, search_and_jacobian, 0, COMPARE_JACOBIAN, -1},
    {"reuse", "neighbours and matrices kept", anew, jacobian_by_table, search_and_jacobian, 0,
     COMPARE_JACOBIAN, -1},
    {"reuse", "weights kept", all_targets, jacobian_by_weights, jacobian, 0, COMPARE_JACOBIAN, -1},
    {"reuse", "moved within the skin of 0.1 H", anew, skinned_search_and_jacobian,
     moved_search_and_jacobian, 0, COMPARE_JACOBIAN, -1},
    {"reuse", "list-free, for one use", anew, list_free_jacobian, search_and_jacobian, 0,
     COMPARE_JACOBIAN, -1},
    {"problem", "2D, as many particles and pairs", "Jacobian in 3D", jacobian_in_plane, jacobian, 0,
     0, -1},
    {"problem", "matrices that need no SVD", "all decomposed", matrices, decomposed_matrices, 0, 0,
     -1},
    {"problem", "one volume for all", "an array of volumes", jacobian_by_one_volume, jacobian, 0,
     COMPARE_JACOBIAN, -1},
};
const int skip_row_count = (int)(sizeof skip_rows / sizeof skip_rows[0]);
