/* SPDX-License-Identifier: MIT */
/* All passes for one scalar type and one instruction set. Include once per translation unit, with
 *   REAL_IS_F64   0 or 1
 *   SUFFIX        of the one exported symbol, sphgi_passes_SUFFIX
 *   FUSES         1: products are fused to sums (vec.inl.h); may be left to the machine
 * The instruction set comes from the compile flags of the including file. Everything is static:
 * code for one instruction set must never be merged with that for another. */
#include "passes.h"
#include "kernel_list.h"
#include "with.inl.h"
#include "vec.inl.h"
#include "lanes.inl.h"
#include "kernels.inl.h"
#include "rows.inl.h"
#include "gather.inl.h"
#include "lists.inl.h"
#include "host_lists.inl.h"
#define OUT         float
#define OUT_NAME(x) x##_f32
#include "gather_pairs.inl.h"
#undef OUT
#undef OUT_NAME
#if REAL_IS_F64 /* fields are never wider than positions */
#define OUT         double
#define OUT_NAME(x) x##_f64
#include "gather_pairs.inl.h"
#undef OUT
#undef OUT_NAME
#endif
#include "packing.inl.h"
#include "staging.inl.h"
#include "cells.inl.h"
#include "octaves.inl.h"
#include "search.inl.h"
#include "search_by_radii.inl.h"
#include "near.inl.h"
#include "shape.inl.h"
#include "gather_factors.inl.h"
#include "gather_quadratic.inl.h"
#include "kept_factors.inl.h"
#include "sums.inl.h"
#include "other_side.inl.h"
#include "both_sides.inl.h"
#include "contracted.inl.h"
#include "folded.inl.h"
#include "group_sums.inl.h"
#if !defined(__x86_64__) || defined(__AVX2__) /* others wait for arithmetic: not worth the code */
#define RECORDS_ARE_READ
#include "records.inl.h"
#include "record_sums.inl.h"
#endif
#include "classic.inl.h"
#include "classic_groups.inl.h"
#include "classic_other_side.inl.h"
#include "quadratic_sums.inl.h"
#include "quadratic_groups.inl.h"
#include "diffusion.inl.h"
#include "values.inl.h"
#include "eigen.inl.h"
#include "threshold.inl.h"
#include "invert.inl.h"
#include "classic_solution.inl.h"
#include "lane_units.inl.h"
#include "results.inl.h"
#include "forms.inl.h"
#include "quadratic.inl.h"
#include "borrowed.inl.h"
#include "quadratic_results.inl.h"

#define CONCATENATE_(a, b) a##b
#define CONCATENATE(a, b)  CONCATENATE_(a, b)

const struct sphgi_passes CONCATENATE(sphgi_passes_, SUFFIX) = {
    .lanes = LANES,
    .load_rows = load_rows,
    .read_positions = read_positions,
    .take_into_box = take_into_box,
    .cut = cut,
    .cut_octaves = cut_octaves,
    .first_not_finite = first_not_finite,
#if REAL_IS_F64
    .put_volumes = {put_volumes_f32, put_volumes_f64},
    .gather = {gather_f32, gather_f64},
#else
    .put_volumes = {put_volumes_f32},
    .gather = {gather_f32},
#endif
    .largest_move = largest_move,
    .gather_factors = gather_factors,
    .gather_quadratic = gather_quadratic,
    .gather_both = gather_both,
    .weigh_both = weigh_both,
    .gather_offsets = gather_offsets,
    .keep_factors = keep_factors,
    .stage = stage,
    .sum_group = sum_group,
    .begin_classic = begin_classic,
    .sum_quadratic_group = sum_quadratic_group,
#if defined(RECORDS_ARE_READ)
    .sum_records = sum_records,
    .put_records = put_records,
#endif
    .find = find,
    .bounds = bounds,
    .pack_by_radii = pack_by_radii,
    .find_by_radii = find_by_radii,
    .keep_near = keep_near,
    .weave = weave,
    .pick_lists = pick_lists,
    .interleave = interleave,
    .clean_ids = clean_ids,
    .interleave_hosts = interleave_hosts,
    .lane_units = lane_units,
    .lane_table_units = lane_table_units,
    .scale_pairs = scale_pairs,
    .shape_factors = shape_factors,
    .shape_other = shape_other,
    .shape_weights = shape_weights,
    .shape_values = shape_values,
    .shape_products = shape_products,
    .keep_kernel = keep_kernel,
    .values_of_volumes = values_of_volumes,
    .classic_vectors = classic_vectors,
    .quadratic_gradients = quadratic_gradients,
    .pair_gradients = pair_gradients,
    .transposed = transposed,
    .pair_laplacian = pair_laplacian,
    .pair_laplacian_plain = pair_laplacian_plain,
    .transposed_classic = transposed_classic,
    .transposed_classic_other = transposed_classic_other,
    .scale_rows = scale_rows,
    .transposed_quadratic = transposed_quadratic,
    .transposed_quadratic_other = transposed_quadratic_other,
    .sum_moments = sum_moments,
    .sum_classic = sum_classic,
    .sum_classic_slopes = sum_classic_slopes,
    .sum_quadratic_moments = sum_quadratic_moments,
    .sum_quadratic_field = sum_quadratic_field,
    .sum_quadratic_vectors = sum_quadratic_vectors,
    .sum_lent = sum_lent,
    .sum_field = sum_field,
    .sum_classic_field = sum_classic_field,
    .sum_divergence = sum_divergence,
    .sum_squares = sum_squares,
    .sum_value = sum_value,
    .sum_weights = sum_weights,
    .means = means,
    .sum_diffusion = sum_diffusion,
    .sum_vectors = sum_vectors,
    .sum_folded = sum_folded,
    .sum_volume = sum_volume,
    .join_lanes = join_lanes,
    .settle = settle,
    .invert = invert,
    .decompose = decompose_lanes,
    .solve_classic = solve_classic,
    .finish_classic = finish_classic,
    .invert_quadratic = invert_quadratic,
    .eigen = eigen_lanes,
    .apply = apply,
    .apply_quadratic = apply_quadratic,
    .add_borrowed = add_borrowed,
    .lend = lend,
    .scale = scale_lanes,
    .divide = divide_lanes,
    .valid_volumes = valid_volumes,
    .fill = fill,
    .source_weights = source_weights,
    .quotient = quotient,
    .add_outer = add_outer,
    .two_sided_gradient = two_sided_gradient,
    .two_sided_divergence = two_sided_divergence,
    .square = square,
    .double_product = double_product,
    .contract = contract,
    .ask_for_lanes = ask_for_lanes,
    .pack_lanes = pack_lanes,
    .load_lanes = load_lanes,
    .store_lanes = store_lanes,
    .put_away = put_away,
    .add_put_away = add_put_away,
};
