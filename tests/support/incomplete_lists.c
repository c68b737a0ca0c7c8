/* SPDX-License-Identifier: MIT */
#include "incomplete_lists.h"
#include "brute_force.h"

/* place: among the target's neighbours in ascending order. */
static int is_kept(comparison_lack lack, int dimension, int target, int source, int64_t place)
{
    const int low = target < source ? target : source, high = target + source - low;
    if (lack == COMPARISON_CUT_AT_BOTH_ENDS)
        return (low * 7 + high * 11) % 5 > 0;
    return lack == COMPARISON_HALF ? source > target : place < (dimension == 2 ? 12 : 32);
}

comparison comparison_lacking(const comparison *made, comparison_lack lack)
{
    static const char *const names[] = {"cut at both ends", "half lists", "cut at a maximum"};
    comparison other = *made;
    const rows all = rows_listed(made->context, made->neighbors, &made->scheme, NULL);
    int64_t *offsets = test_memory(((size_t)all.count + 1) * sizeof *offsets);
    int32_t *indices = test_memory(((size_t)all.offsets[all.count] + 1) * sizeof *indices);
    for (int i = 0; i < all.count; ++i) {
        int64_t end = offsets[i];
        for (int64_t k = all.offsets[i]; k < all.offsets[i + 1]; ++k)
            if (is_kept(lack, made->points.dimension, i, all.indices[k], k - all.offsets[i]))
                indices[end++] = all.indices[k];
        offsets[i + 1] = end;
    }
    const sphg_lists lists = {.offsets = offsets, .indices = indices};
    const setup_array positions = setup_positions(made->test, &other.points);
    const sphg_geometry geometry = setup_geometry(made->test, &other.points, &positions);
    other.neighbors = setup_lists(made->context, &made->scheme, &geometry, &lists);
    other.name = names[lack];
    return other;
}
