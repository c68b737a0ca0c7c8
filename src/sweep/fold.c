/* SPDX-License-Identifier: MIT */
#include "fold.h"
#include "core/view.h"
#include "table.h"
#include <string.h>

/* As many sources as a bundle has targets, [number][SPHGI_WIDTH] of either type. */
struct folding {
    const struct sphgi_sweep *sweep;
    const struct sphgi_field_plan *field;
    struct sphgi_table_unit table_units[SPHGI_TABLE_UNITS];
    int32_t count, width;
    int32_t items[SPHGI_WIDTH];  /* of the host ... */
    int32_t places[SPHGI_WIDTH]; /* ... and among the rows */
    double a[9 * SPHGI_WIDTH], whole[9 * SPHGI_WIDTH];
    double raw[6 * SPHGI_WIDTH], correction[6 * SPHGI_WIDTH];
    double volume[SPHGI_WIDTH], density[SPHGI_WIDTH], weight[SPHGI_WIDTH];
    double b[12 * SPHGI_WIDTH];
    bool bad_volume;
};

enum sphgi_weight sphgi_source_weight(const struct sphgi_plan *plan, bool symmetric)
{
    const bool volume = plan->scheme.method == SPHG_MLS || plan->classic; /* else it is in s_ij */
    if (symmetric)
        return volume ? SPHGI_WEIGHT_V_PER_DENSITY : SPHGI_WEIGHT_PER_DENSITY;
    return volume ? SPHGI_WEIGHT_V : SPHGI_WEIGHT_ONE;
}

static char *number(const struct folding *f, void *lanes, int32_t n)
{
    return (char *)lanes + (size_t)n * SPHGI_WIDTH * sphgi_size_of_type(f->sweep->plan->type);
}

/* What is absent is 0. */
static void load(struct folding *f, const struct sphgi_columns *columns, int32_t numbers,
                 double *to)
{
    if (columns->count)
        f->sweep->passes->load_lanes(f->width, columns, f->items, to);
    else
        memset(to, 0, (size_t)numbers * SPHGI_WIDTH * sizeof *to);
}

static void load_weights(struct folding *f)
{
    const struct sphgi_passes *p = f->sweep->passes;
    const struct sphgi_plan *plan = f->sweep->plan;
    const bool symmetric = f->field->form == SPHG_SYMMETRIC;
    load(f, &f->sweep->set->volume, 1, f->volume);
    f->bad_volume |= !p->valid_volumes(f->width, f->volume);
    p->scale(f->width, 1, f->volume, sphgi_volume_unit(f->sweep), NULL, f->volume);
    if (symmetric)
        load(f, &f->sweep->set->streams[plan->density_stream].columns, 1, f->density);
    p->source_weights(f->width, sphgi_source_weight(plan, symmetric), f->volume, f->density,
                      f->weight);
}

/* Where both ends of a pair have radii of their own, sums have w or w' / q of the source's: the
 * weight takes what s_ji has besides, V_j first and H_j a few powers at a time, lest one of them
 * leaves the range of the type. */
static void weigh_by_radii(struct folding *f, int64_t first)
{
    const struct sphgi_passes *p = f->sweep->passes;
    const struct sphgi_scheme *scheme = &f->sweep->plan->scheme;
    const sphg_neighbors *n = f->sweep->set->neighbors;
    const bool slope = scheme->method == SPHG_KGC || scheme->method == SPHG_PLAIN;
    const struct sphgi_lane_units units = {.largest = scheme->radius,
                                           .dimension = scheme->dimension};
    double radius[SPHGI_WIDTH], ratio[SPHGI_WIDTH], inverse[SPHGI_WIDTH], square[SPHGI_WIDTH];
    double factor[SPHGI_WIDTH];
    for (int32_t k = 0; k < f->width; ++k)
        radius[k] =
            sphgi_row_radius(n, n->sources.rows.data, (int32_t)first + (k < f->count ? k : 0));
    p->lane_units(f->width, &units, radius, ratio, inverse, square, factor);
    if (scheme->method != SPHG_MLS)
        p->scale(f->width, 1, f->weight, 1, f->volume, f->weight);
    p->scale(f->width, 1, f->weight, 1, ratio, f->weight);
    if (slope)
        p->scale(f->width, 1, f->weight, sphgi_factor_of_h(scheme) * scheme->radius, square,
                 f->weight);
    else
        p->scale(f->width, 1, f->weight, -sphgi_factor_of_h(scheme) / scheme->radius, NULL,
                 f->weight);
}

/* What stands behind b_j of the field that carries sum o_j s_ij x_ij: rho_j, and with two radii
 * V_j, which is in s_ij otherwise. */
static void put_carried(struct folding *f, int32_t numbers)
{
    const struct sphgi_passes *p = f->sweep->passes;
    const struct sphgi_plan *plan = f->sweep->plan;
    const bool symmetric = f->field->form == SPHG_SYMMETRIC;
    char *to = number(f, f->b, numbers);
    if (f->field != plan->fields + plan->carrier[symmetric] || !(symmetric || plan->both_sides))
        return;
    p->fill(f->width, 1, to);
    if (symmetric)
        p->scale(f->width, 1, to, 1, f->density, to);
    if (plan->both_sides && plan->scheme.method != SPHG_MLS)
        p->scale(f->width, 1, to, 1, f->volume, to);
}

/* A symmetric tensor with all its components. */
static void make_whole(struct folding *f)
{
    const int32_t d = f->sweep->plan->dimension;
    const size_t lane = SPHGI_WIDTH * sphgi_size_of_type(f->sweep->plan->type);
    for (int32_t m = 0, k = 0; m < d; ++m)
        for (int32_t n = m; n < d; ++n, ++k) {
            memcpy(number(f, f->whole, m * d + n), number(f, f->a, k), lane);
            memcpy(number(f, f->whole, n * d + m), number(f, f->a, k), lane);
        }
}

/* C A, C_j in units of H; PLAIN: A. */
static const double *product(struct folding *f)
{
    const struct sphgi_passes *p = f->sweep->passes;
    const struct sphgi_plan *plan = f->sweep->plan;
    const int32_t d = plan->dimension, numbers = d * (d + 1) / 2;
    if (plan->correction_stream < 0)
        return f->a;
    load(f, &f->sweep->set->streams[plan->correction_stream].columns, numbers, f->raw);
    sphgi_take_from_table(p, f->table_units, f->width, plan->type, number(f, f->raw, 0),
                          number(f, f->correction, 0));
    if (f->field->shape == SPHG_SYM_TENSOR)
        make_whole(f);
    if (f->field->shape == SPHG_SCALAR)
        p->scale(f->width, numbers, f->correction, 1, f->a, f->b);
    else
        p->apply(f->width, d, f->field->shape == SPHG_VECTOR ? 1 : d, f->correction,
                 f->field->shape == SPHG_SYM_TENSOR ? f->whole : f->a, 1, NULL, f->b);
    return f->b;
}

/* Order of storage is not the host's: what the next ones need should be on its way. */
static void ask_for_next(const struct folding *f, const int32_t *order, int64_t end)
{
    const struct sphgi_passes *p = f->sweep->passes;
    const struct sphgi_plan *plan = f->sweep->plan;
    const struct sphgi_stream *streams = f->sweep->set->streams;
    const int32_t count = end < SPHGI_WIDTH ? (int32_t)end : SPHGI_WIDTH;
    p->ask_for_lanes(count, &streams[f->field->stream].columns, order, false);
    if (plan->correction_stream >= 0)
        p->ask_for_lanes(count, &streams[plan->correction_stream].columns, order, false);
    if (f->field->form == SPHG_SYMMETRIC)
        p->ask_for_lanes(count, &streams[plan->density_stream].columns, order, false);
    p->ask_for_lanes(count, &f->sweep->set->volume, order, false);
}

int32_t sphgi_numbers_folded(const struct sphgi_plan *plan, const struct sphgi_field_plan *field)
{
    const bool symmetric = field->form == SPHG_SYMMETRIC;
    const bool carries = field == plan->fields + plan->carrier[symmetric];
    return sphgi_folded_numbers(field->fold, plan->dimension) +
           (carries && (symmetric || plan->both_sides) ? 1 : 0);
}

/* Where b_j of all sources go. */
struct folded_columns {
    struct sphgi_columns columns[3];
    int32_t count, numbers; /* of them, and of each */
};

static void fold_some(struct folding *f, int64_t first, const struct folded_columns *to)
{
    const struct sphgi_passes *p = f->sweep->passes;
    const struct sphgi_plan *plan = f->sweep->plan;
    const int32_t numbers = sphgi_folded_numbers(f->field->fold, plan->dimension);
    load(f, &f->sweep->set->streams[f->field->stream].columns, f->field->components, f->a);
    load_weights(f);
    if (plan->both_sides)
        weigh_by_radii(f, first);
    p->scale(f->width, numbers, product(f), 1, f->weight, f->b);
    put_carried(f, numbers);
    for (int32_t k = 0; k < to->count; ++k)
        p->store_lanes(f->count, &to->columns[k], f->places, number(f, f->b, k * to->numbers),
                       false);
}

static bool fold_into(const struct sphgi_sweep *sweep, const struct sphgi_field_plan *field,
                      const int32_t *order, int64_t begin, int64_t end,
                      const struct folded_columns *to)
{
    const size_t lanes = (size_t)sweep->passes->lanes;
    struct folding f;
    f.sweep = sweep;
    f.field = field;
    f.bad_volume = false;
    memset(f.b, 0, sizeof f.b); /* what is behind the last number of a row */
    sphgi_table_units(sweep->plan, f.table_units);
    for (int64_t at = begin; at < end; at += f.count) {
        f.count = end - at < SPHGI_WIDTH ? (int32_t)(end - at) : SPHGI_WIDTH;
        f.width = (int32_t)sphgi_round_up((size_t)f.count, lanes);
        for (int32_t k = 0; k < f.width; ++k) {
            const int64_t item = at + (k < f.count ? k : 0);
            f.items[k] = order ? order[item] : (int32_t)item;
            f.places[k] = (int32_t)(at - begin) + k;
        }
        if (order)
            ask_for_next(&f, order + at + f.count, end - at - f.count);
        fold_some(&f, at, to);
    }
    return !f.bad_volume;
}

bool sphgi_fold_rows(const struct sphgi_sweep *sweep, const struct sphgi_field_plan *field,
                     const int32_t *order, int64_t begin, int64_t end, char *to, size_t array)
{
    struct folded_columns rows = {.count = field->folded_rows, .numbers = SPHGI_ROW};
    for (int32_t k = 0; k < field->folded_rows; ++k)
        rows.columns[k] =
            sphgi_dense_columns(to + (size_t)k * array, SPHGI_ROW, SPHGI_ROW, sweep->plan->type);
    return fold_into(sweep, field, order, begin, end, &rows);
}

bool sphgi_fold_records(const struct sphgi_sweep *sweep, const struct sphgi_field_plan *field,
                        const int32_t *order, int64_t begin, int64_t end, char *to, int32_t width)
{
    const int32_t numbers = sphgi_numbers_folded(sweep->plan, field);
    const struct folded_columns records = {
        .columns = {sphgi_dense_columns(to, numbers, width, sweep->plan->type)},
        .count = 1,
        .numbers = numbers};
    return fold_into(sweep, field, order, begin, end, &records);
}
