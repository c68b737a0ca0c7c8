/* SPDX-License-Identifier: MIT */
/* Streams: numbers that are read of each source, up to four at a time. */
#include "builder.h"
#include "core/view.h"

void sphgi_add_streams(struct sphgi_plan_builder *builder, int32_t s, int32_t first,
                       const struct sphgi_columns *columns, int32_t components, int32_t width)
{
    struct sphgi_stream *stream =
        builder->streams + (ptrdiff_t)s * builder->plan->stream_count + first;
    const bool in_parts = columns->count > SPHGI_COLUMNS_MOST;
    for (int32_t c = 0; c < components; c += width, ++stream) {
        *stream = (struct sphgi_stream){*columns, c, sphgi_min32(width, components - c), false};
        if (in_parts) {
            stream->columns = sphgi_some_columns(columns, c, builder->plan->type);
            stream->first = 0;
        }
    }
}

sphg_result sphgi_take_of_set(struct sphgi_plan_builder *builder, int32_t s, const sphg_view *view,
                              const char *name, sphg_shape shape, int32_t numbers, int32_t first,
                              int32_t width, const char *missing)
{
    const int32_t count = builder->plan->sets[s].neighbors->source_count;
    struct sphgi_columns columns = {.count = 0};
    if (missing && sphgi_is_absent(view) && count > 0)
        SPHGI_REFUSE(SPHG_ERROR_ARGUMENT, "%s: %s is absent%s", builder->checker.function, name,
                     missing);
    const sphg_result result =
        sphgi_take_input(builder, view, name, shape, numbers, count, &columns);
    sphgi_add_streams(builder, s, first, &columns, numbers, width);
    return result;
}
