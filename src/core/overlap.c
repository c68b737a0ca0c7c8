/* SPDX-License-Identifier: MIT */
#include "overlap.h"
#include "refuse.h"

struct bytes {
    uintptr_t begin, end;
};

static struct bytes bytes_of(const struct sphgi_extent *e, int32_t component)
{
    const uintptr_t first = (uintptr_t)e->columns.at[component];
    const uintptr_t last = first + (uintptr_t)(e->columns.stride * (e->count - 1));
    return first < last ? (struct bytes){first, last + e->number_size}
                        : (struct bytes){last, first + e->number_size};
}

/* Columns of one stride may be interleaved (members of one struct): then their places within the
 * stride decide. Of two strides, touching ranges count as overlap. */
static bool columns_overlap(const struct sphgi_extent *a, int32_t i, const struct sphgi_extent *b,
                            int32_t k)
{
    const struct bytes x = bytes_of(a, i), y = bytes_of(b, k);
    if (x.end <= y.begin || y.end <= x.begin)
        return false;
    ptrdiff_t stride = a->columns.stride < 0 ? -a->columns.stride : a->columns.stride;
    ptrdiff_t other = b->columns.stride < 0 ? -b->columns.stride : b->columns.stride;
    if (a->count <= 1 || !stride)
        stride = other;
    if (b->count <= 1 || !other)
        other = stride;
    if (stride != other || !stride)
        return true;
    const uintptr_t s = (uintptr_t)stride;
    const uintptr_t ahead = (y.begin % s + s - x.begin % s) % s;
    return ahead < a->number_size || s - ahead < b->number_size;
}

static bool extents_overlap(const struct sphgi_extent *a, const struct sphgi_extent *b)
{
    for (int32_t i = 0; i < a->columns.count; ++i)
        for (int32_t k = 0; k < b->columns.count; ++k)
            if (columns_overlap(a, i, b, k))
                return true;
    return false;
}

/* Many numbers that follow one another are one large one. */
struct sphgi_extent sphgi_extent_of(const char *name, const struct sphgi_columns *columns,
                                    int32_t count, size_t number_size, bool output)
{
    struct sphgi_extent extent = {name, *columns, count, number_size, output};
    if (columns->count > SPHGI_COLUMNS_MOST) {
        extent.number_size *= (size_t)columns->count;
        extent.columns.count = 1;
    } else if (columns->layout == SPHG_FULL) {
        extent.number_size *= (size_t)sphgi_numbers_of(columns);
        extent.columns.count = sphgi_min32(columns->count, 1);
    }
    return extent;
}

/* Components of one output that were set on each other. */
static bool overlaps_itself(const struct sphgi_extent *e)
{
    for (int32_t i = 0; i < e->columns.count; ++i)
        for (int32_t k = 0; k < i; ++k)
            if (columns_overlap(e, i, e, k))
                return true;
    return false;
}

sphg_result sphgi_check_overlap(struct sphgi_checker checker, const struct sphgi_extent *extents,
                                int32_t count)
{
    for (int32_t i = 0; i < count; ++i)
        if (extents[i].output && extents[i].count > 0 && overlaps_itself(&extents[i]))
            REFUSE(SPHG_ERROR_ARGUMENT, "%s: output %s overlaps itself", checker.function,
                   extents[i].name);
    for (int32_t i = 0; i < count; ++i)
        for (int32_t k = 0; k < i; ++k) {
            const struct sphgi_extent *a = &extents[i], *b = &extents[k];
            if ((!a->output && !b->output) || a->count < 1 || b->count < 1)
                continue;
            if (extents_overlap(a, b))
                REFUSE(SPHG_ERROR_ARGUMENT, "%s: output %s overlaps %s", checker.function,
                       a->output ? a->name : b->name, a->output ? b->name : a->name);
        }
    return SPHG_OK;
}
