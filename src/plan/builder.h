/* SPDX-License-Identifier: MIT */
/* What the files that make a plan share. */
#ifndef SPHGI_BUILDER_H
#define SPHGI_BUILDER_H
#include "plan.h"
#include "core/overlap.h"

#define SPHGI_REFUSE(result, ...) return sphgi_fail(builder->checker.context, result, __VA_ARGS__)

enum { SPHGI_NAME_LENGTH = 64 };

struct sphgi_plan_builder {
    struct sphgi_checker checker;
    const sphg_request *request;
    enum sphgi_purpose purpose;
    struct sphgi_plan *plan;
    struct sphgi_stream *streams;
    struct sphgi_extent *extents;
    int32_t extent_count;
    char (*names)[SPHGI_NAME_LENGTH];
};

/* The name of the next view, for messages; the format takes up to two numbers. */
const char *sphgi_name_view(struct sphgi_plan_builder *builder, const char *format, int32_t a,
                            int32_t b);

/* Check a view and remember where it lies. shape 0: a flat array of `numbers` an item. */
sphg_result sphgi_take_input(struct sphgi_plan_builder *builder, const sphg_view *view,
                             const char *name, sphg_shape shape, int32_t numbers, int32_t count,
                             struct sphgi_columns *columns);
sphg_result sphgi_take_output(struct sphgi_plan_builder *builder, const sphg_view *view,
                              const char *name, sphg_type type, sphg_shape shape, int32_t numbers,
                              struct sphgi_columns *columns);

/* The targets' own view, else the view of the set that they are part of. */
sphg_result sphgi_take_target_side(struct sphgi_plan_builder *builder, const sphg_view *own,
                                   const sphg_view *of_set, const char *name,
                                   const char *name_of_set, sphg_shape shape, int32_t numbers,
                                   struct sphgi_columns *columns);

/* plan->fields[k] but for what is read of sources: that comes with the streams, of all fields, once
 * sphgi_plan_decide() knows which corrections and densities are read, too. */
sphg_result sphgi_take_field(struct sphgi_plan_builder *builder, int32_t k);
sphg_result sphgi_take_streams(struct sphgi_plan_builder *builder);

/* A view of set s with `numbers` an item (shape 0: flat), `width` of them a stream from stream
 * `first` on. `missing`: refused if it is absent and the set is not empty, with these words; NULL:
 * it may be absent. */
sphg_result sphgi_take_of_set(struct sphgi_plan_builder *builder, int32_t s, const sphg_view *view,
                              const char *name, sphg_shape shape, int32_t numbers, int32_t first,
                              int32_t width, const char *missing);

/* What set s has of `columns`, `width` numbers a stream from stream `first` on. */
void sphgi_add_streams(struct sphgi_plan_builder *builder, int32_t s, int32_t first,
                       const struct sphgi_columns *columns, int32_t components, int32_t width);

/* Curvature that is lent and borrowed: what is refused, what a field offers and reads, who borrows.
 */
sphg_result sphgi_check_lending(struct sphgi_plan_builder *builder, int32_t k);
sphg_result sphgi_take_lending(struct sphgi_plan_builder *builder, int32_t k);
sphg_result sphgi_take_lenders(struct sphgi_plan_builder *builder, int32_t s, int32_t k);
sphg_result sphgi_take_borrows(struct sphgi_plan_builder *builder);
/* Diffusion: what is refused, and the coefficients of both sides. */
sphg_result sphgi_check_diffusion(struct sphgi_plan_builder *builder, int32_t k);
sphg_result sphgi_take_coefficient_at_target(struct sphgi_plan_builder *builder, int32_t k);
sphg_result sphgi_take_coefficient_at_sources(struct sphgi_plan_builder *builder, int32_t s,
                                              int32_t k);
/* Sums of values: what is refused, and volumes of their own. */
sphg_result sphgi_check_value(struct sphgi_plan_builder *builder, int32_t k);
sphg_result sphgi_take_value_volume(struct sphgi_plan_builder *builder, int32_t k);
sphg_result sphgi_take_value_volume_of_set(struct sphgi_plan_builder *builder, int32_t s,
                                           int32_t k);

/* J : T_i: what is refused, T_i, and where it goes. */
sphg_result sphgi_check_contraction(struct sphgi_plan_builder *builder, int32_t k);
sphg_result sphgi_take_contraction(struct sphgi_plan_builder *builder, int32_t k);

/* Streams that a field takes of a set, at most, and views that it has of each beside A_j. */
int32_t sphgi_streams_of(const sphg_field *field);
size_t sphgi_views_of(const sphg_field *field);

#endif
