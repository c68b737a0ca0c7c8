/* SPDX-License-Identifier: MIT */
#include "check.h"
#include "refuse.h"
#include "view.h"

static bool is_aligned(const void *pointer, size_t size)
{
    return (uintptr_t)pointer % size == 0;
}

/* Bytes from one item to the next, whatever the direction; PTRDIFF_MIN has no opposite. */
static size_t span_of(ptrdiff_t stride)
{
    return stride < 0 ? (size_t)0 - (size_t)stride : (size_t)stride;
}

static sphg_result check_stride(struct sphgi_checker checker, const sphg_view *view,
                                const struct sphgi_expected *expected, int32_t numbers)
{
    const size_t size = sphgi_size_of_type(expected->type), span = span_of(view->stride);
    if (span % size)
        REFUSE(SPHG_ERROR_ARGUMENT, "%s: %s.stride is %td, must be a multiple of %zu",
               checker.function, expected->name, view->stride, size);
    if (expected->count > 1 && span > (size_t)PTRDIFF_MAX / (size_t)expected->count)
        REFUSE(SPHG_ERROR_ARGUMENT, "%s: %s.stride is %td, more than memory has for %d items",
               checker.function, expected->name, view->stride, (int)expected->count);
    if (expected->use == SPHGI_OUTPUT && expected->count > 1 && span < (size_t)numbers * size)
        REFUSE(SPHG_ERROR_ARGUMENT, "%s: %s.stride is %td, but an item of this output takes %zu",
               checker.function, expected->name, view->stride, (size_t)numbers * size);
    return SPHG_OK;
}

static sphg_result check_layout(struct sphgi_checker checker, const sphg_view *view,
                                const struct sphgi_expected *expected)
{
    const char *f = checker.function, *name = expected->name;
    if (view->layout < SPHG_AS_SHAPE || view->layout > SPHG_FULL)
        REFUSE(SPHG_ERROR_ARGUMENT, "%s: %s.layout is %d, not a layout", f, name,
               (int)view->layout);
    if (view->layout == SPHG_COLUMN_MAJOR && expected->shape != SPHG_TENSOR)
        REFUSE(SPHG_ERROR_ARGUMENT, "%s: %s.layout is COLUMN_MAJOR, but these are no tensors", f,
               name);
    if (view->layout == SPHG_FULL && expected->shape != SPHG_SYM_TENSOR)
        REFUSE(SPHG_ERROR_ARGUMENT,
               "%s: %s.layout is FULL, but these are no symmetric tensors or linear corrections", f,
               name);
    return SPHG_OK;
}

/* Numbers that stand behind view->x. */
static int32_t numbers_in_item(const sphg_view *view, const struct sphgi_expected *expected,
                               bool split)
{
    const int32_t d = expected->dimension;
    if (!expected->shape)
        return expected->numbers;
    if (view->layout == SPHG_FULL)
        return d * d;
    return sphgi_components(expected->shape, d) / (split ? d : 1);
}

sphg_result sphgi_check_view(struct sphgi_checker checker, const sphg_view *view,
                             const struct sphgi_expected *expected)
{
    const char *f = checker.function, *name = expected->name;
    const size_t size = sphgi_size_of_type(expected->type);
    if (sphgi_is_absent(view)) {
        if (expected->required)
            REFUSE(SPHG_ERROR_ARGUMENT, "%s: %s is absent", f, name);
        return SPHG_OK;
    }
    if (view->type < SPHG_F32 || view->type > SPHG_U8)
        REFUSE(SPHG_ERROR_ARGUMENT, "%s: %s.type is %d, not a type", f, name, (int)view->type);
    if (view->type != expected->type)
        REFUSE(SPHG_ERROR_TYPE, "%s: %s.type is %d, must be %d here (1: f32, 2: f64, 3: u8)", f,
               name, (int)view->type, (int)expected->type);
    const bool many = expected->shape == SPHG_VECTOR || expected->shape == SPHG_TENSOR;
    const bool split = many && view->y;
    if (many && expected->dimension == 3 && !view->y != !view->z)
        REFUSE(SPHG_ERROR_ARGUMENT, "%s: of %s.y and %s.z only one is set", f, name, name);
    if (!is_aligned(view->x, size) || (split && !is_aligned(view->y, size)) ||
        (split && expected->dimension == 3 && !is_aligned(view->z, size)))
        REFUSE(SPHG_ERROR_ARGUMENT, "%s: %s does not start at a multiple of %zu", f, name, size);
    const sphg_result result = check_layout(checker, view, expected);
    return result ? result
                  : check_stride(checker, view, expected, numbers_in_item(view, expected, split));
}
