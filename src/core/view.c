/* SPDX-License-Identifier: MIT */
#include "view.h"

int32_t sphgi_components(sphg_shape shape, int32_t dimension)
{
    switch (shape) {
    case SPHG_SCALAR:
        return 1;
    case SPHG_VECTOR:
        return dimension;
    case SPHG_SYM_TENSOR:
        return dimension * (dimension + 1) / 2;
    case SPHG_TENSOR:
        return dimension * dimension;
    }
    return 0;
}

/* Components that stand behind one pointer; the next ones start at y and z. */
static int32_t components_per_pointer(sphg_shape shape, int32_t dimension)
{
    return shape == SPHG_VECTOR ? 1 : shape == SPHG_TENSOR ? dimension : 1;
}

/* Matrices column by column, or symmetric ones in full. Components are found by where the first of
 * their numbers stands, in FULL that of the upper triangle. */
static struct sphgi_columns laid_out(const sphg_view *view, int32_t count, int32_t dimension)
{
    struct sphgi_columns columns = sphgi_flat_columns(view, count);
    columns.layout = view->layout;
    columns.side = dimension;
    columns.together = false;
    for (int32_t k = dimension * dimension - 1; columns.count && k >= 0; --k)
        columns.at[sphgi_component_at(&columns, k)] =
            (const char *)view->x + (size_t)k * sphgi_size_of_type(view->type);
    return columns;
}

struct sphgi_columns sphgi_columns_of(const sphg_view *view, sphg_shape shape, int32_t dimension)
{
    const int32_t count = sphgi_components(shape, dimension);
    if (view->layout == SPHG_FULL || (view->layout && !view->y))
        return laid_out(view, count, dimension);
    struct sphgi_columns columns = sphgi_flat_columns(view, count);
    const bool split = view->y && (shape == SPHG_VECTOR || shape == SPHG_TENSOR);
    if (!columns.count || !split)
        return columns;
    const char *start[3] = {view->x, view->y, view->z};
    const int32_t each = components_per_pointer(shape, dimension);
    const size_t size = sphgi_size_of_type(view->type);
    for (int32_t k = 0; k < count; ++k) {
        const int32_t c = view->layout ? k % dimension * dimension + k / dimension : k;
        /* NOLINTNEXTLINE(clang-analyzer-core.UndefinedBinaryOperatorResult): count <= 3 each */
        columns.at[c] = start[k / each] + (size_t)(k % each) * size;
    }
    for (int32_t c = 0; c < count; ++c)
        columns.together &= columns.at[c] == columns.at[0] + (size_t)c * size;
    return columns;
}

struct sphgi_columns sphgi_flat_columns(const sphg_view *view, int32_t count)
{
    struct sphgi_columns columns = {
        .stride = view->stride, .count = view->x ? count : 0, .together = true};
    for (int32_t c = 0; c < columns.count && c < SPHGI_COLUMNS_MOST; ++c)
        columns.at[c] = (const char *)view->x + (size_t)c * sphgi_size_of_type(view->type);
    return columns;
}

struct sphgi_columns sphgi_some_columns(const struct sphgi_columns *columns, int32_t first,
                                        sphg_type type)
{
    const sphg_view rest = {columns->at[0] + (size_t)first * sphgi_size_of_type(type),
                            NULL,
                            NULL,
                            columns->stride,
                            type,
                            SPHG_AS_SHAPE};
    return sphgi_flat_columns(&rest, sphgi_min32(SPHGI_COLUMNS_MOST, columns->count - first));
}

struct sphgi_columns sphgi_dense_columns(const void *data, int32_t count, int32_t item_numbers,
                                         sphg_type type)
{
    const size_t size = sphgi_size_of_type(type);
    const sphg_view view = {data, NULL,         NULL, (ptrdiff_t)((size_t)item_numbers * size),
                            type, SPHG_AS_SHAPE};
    return sphgi_flat_columns(&view, count);
}
