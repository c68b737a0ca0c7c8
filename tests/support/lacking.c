#include "lacking.h"
#include "pairs.h"

/* place: among the target's neighbours in ascending order. */
static int is_kept(stage_lack lack, int dimension, int target, int source, int64_t place)
{
    const int low = target < source ? target : source, high = target + source - low;
    if (lack == STAGE_CUT_AT_BOTH_ENDS)
        return (low * 7 + high * 11) % 5 > 0;
    return lack == STAGE_HALF ? source > target : place < (dimension == 2 ? 12 : 32);
}

stage stage_lacking(const stage *made, stage_lack lack)
{
    static const char *const names[] = {"cut at both ends", "half lists", "cut at a maximum"};
    stage other = *made;
    const rows all = rows_listed(made->context, made->neighbors, &made->scheme, NULL);
    int64_t *offsets = test_memory(((size_t)all.count + 1) * sizeof *offsets);
    int32_t *indices = test_memory(((size_t)all.offsets[all.count] + 1) * sizeof *indices);
    for (int i = 0; i < all.count; i++) {
        int64_t end = offsets[i];
        for (int64_t k = all.offsets[i]; k < all.offsets[i + 1]; k++)
            if (is_kept(lack, made->points.dimension, i, all.indices[k], k - all.offsets[i]))
                indices[end++] = all.indices[k];
        offsets[i + 1] = end;
    }
    const sphg_lists lists = {.offsets = offsets, .indices = indices};
    const fixture_array positions = fixture_positions(made->test, &other.points);
    const sphg_geometry geometry = fixture_geometry(made->test, &other.points, &positions);
    other.neighbors = fixture_lists(made->context, &made->scheme, &geometry, &lists);
    other.name = names[lack];
    return other;
}
