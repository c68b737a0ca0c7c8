/* SPDX-License-Identifier: MIT */
/* The views of a request: each is checked, named for messages, and remembered for overlaps. */
#include "builder.h"
#include "core/view.h"
#include <stdio.h>

const char *sphgi_name_view(struct sphgi_plan_builder *builder, const char *format, int32_t a,
                            int32_t b)
{
    char *name = builder->names[builder->extent_count];
    /* cppcheck-suppress wrongPrintfScanfArgNum ; formats of one number leave the second unread */
    snprintf(name, SPHGI_NAME_LENGTH, format, (int)a, (int)b);
    return name;
}

/* Checks one view and remembers where it lies. */
static sphg_result take_view(struct sphgi_plan_builder *builder, const sphg_view *view,
                             struct sphgi_expected expected, struct sphgi_columns *columns)
{
    expected.dimension = builder->plan->dimension;
    const sphg_result result = sphgi_check_view(builder->checker, view, &expected);
    if (result)
        return result;
    *columns = expected.shape ? sphgi_columns_of(view, expected.shape, expected.dimension)
                              : sphgi_flat_columns(view, expected.numbers);
    if (columns->count)
        builder->extents[builder->extent_count++] =
            sphgi_extent_of(expected.name, columns, expected.count,
                            sphgi_size_of_type(expected.type), expected.use == SPHGI_OUTPUT);
    return SPHG_OK;
}

sphg_result sphgi_take_input(struct sphgi_plan_builder *builder, const sphg_view *view,
                             const char *name, sphg_shape shape, int32_t numbers, int32_t count,
                             struct sphgi_columns *columns)
{
    const struct sphgi_expected expected = {.name = name,
                                            .type = builder->plan->type,
                                            .shape = shape,
                                            .numbers = numbers,
                                            .count = count,
                                            .use = SPHGI_INPUT};
    return take_view(builder, view, expected, columns);
}

sphg_result sphgi_take_output(struct sphgi_plan_builder *builder, const sphg_view *view,
                              const char *name, sphg_type type, sphg_shape shape, int32_t numbers,
                              struct sphgi_columns *columns)
{
    const struct sphgi_expected expected = {.name = name,
                                            .type = type,
                                            .shape = shape,
                                            .numbers = numbers,
                                            .count = builder->plan->target_count,
                                            .use = SPHGI_OUTPUT};
    return take_view(builder, view, expected, columns);
}

sphg_result sphgi_take_target_side(struct sphgi_plan_builder *builder, const sphg_view *own,
                                   const sphg_view *of_set, const char *name,
                                   const char *name_of_set, sphg_shape shape, int32_t numbers,
                                   struct sphgi_columns *columns)
{
    const bool from_set = sphgi_is_absent(own) && of_set;
    return sphgi_take_input(builder, from_set ? of_set : own, from_set ? name_of_set : name, shape,
                            numbers, builder->plan->target_count, columns);
}
