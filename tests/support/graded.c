/* SPDX-License-Identifier: MIT */
#include "graded.h"
#include <math.h>

graded graded_block(int d, double ratio, double support)
{
    random_state random = random_seeded(5);
    const int per_axis = d == 2 ? 9 : 5;
    graded made = {.points = cloud_jittered(d, per_axis, .125, .2, &random)};
    made.radii = test_memory((size_t)made.points.count * sizeof *made.radii);
    for (int i = 0; i < made.points.count; ++i) {
        double *x = made.points.x + i * d;
        const double wide = exp(log(ratio) * x[0] / (.125 * (per_axis - 1)));
        made.radii[i] = support * made.points.spacing * wide;
        for (int a = 0; a < d; ++a)
            x[a] = (x[a] + .5) * wide;
    }
    return made;
}

const char *graded_way_name(graded_way way)
{
    static const char *const names[] = {"graded block", "moved block", "block around",
                                        "moved block around"};
    return names[way];
}

static double largest_of(const double *numbers, int count)
{
    double largest = 0;
    for (int k = 0; k < count; ++k)
        largest = fmax(largest, numbers[k]);
    return largest;
}

static void round_all(double *numbers, int count)
{
    for (int k = 0; k < count; ++k)
        numbers[k] = cloud_rounded(numbers[k]);
}

enum { MARGIN = 4 }; /* H / MARGIN is the skin of each */

graded graded_before(int d, double ratio, double support)
{
    graded made = graded_block(d, ratio, support);
    round_all(made.points.x, made.points.count * d);
    round_all(made.radii, made.points.count);
    return made;
}

double graded_skin(const graded *before)
{
    return largest_of(before->radii, before->points.count) / MARGIN;
}

/* Each by up to nine tenths of half its margin, some of which its radius grows, or it shrinks. */
static graded moved(const graded *before)
{
    const int d = before->points.dimension;
    random_state random = random_seeded(6);
    graded after = {.points = cloud_copy(&before->points)};
    after.radii = test_memory((size_t)after.points.count * sizeof *after.radii);
    for (int i = 0; i < after.points.count; ++i) {
        const double most = .9 * before->radii[i] / MARGIN / 2;
        const double growth = most * random_between(&random, -1, .5);
        double way[3] = {0}, square = 0;
        for (int a = 0; a < d; ++a)
            square += pow(way[a] = random_between(&random, -1, 1), 2);
        for (int a = 0; a < d; ++a)
            after.points.x[i * d + a] += way[a] / sqrt(square) * (most - fmax(growth, 0));
        after.radii[i] = before->radii[i] + growth;
    }
    round_all(after.points.x, after.points.count * d);
    round_all(after.radii, after.points.count);
    return after;
}

static void search(comparison *on, const graded *block, sphg_neighbors **neighbors, double skin)
{
    const setup_array x = setup_positions(on->test, (cloud *)(uintptr_t)&block->points);
    const setup_array h =
        setup_numbers(test_position_type(on->test), block->points.count, 1, block->radii);
    sphg_geometry geometry = setup_geometry(on->test, &block->points, &x);
    geometry.source_support = setup_view(&h);
    geometry.mutual = 1;
    geometry.skin = skin;
    for (int a = 0; a < block->points.dimension; ++a)
        geometry.period[a] = on->scene.period[a];
    if (!*neighbors)
        *neighbors = setup_search(on->context, &on->scheme, &geometry);
    else
        SETUP_OK(on->context,
                 sphg_neighbors_search(on->context, *neighbors, &on->scheme, &geometry));
}

comparison graded_stage_of(const test_case *test, double ratio, double support, graded_way way)
{
    const graded before = graded_before(test->dimension, ratio, support);
    const graded now = way & GRADED_MOVED ? moved(&before) : before;
    const double skin = graded_skin(&before);
    comparison on = comparison_of_radii(test, graded_way_name(way), now.points, now.radii, 1);
    const double around = fmax(1.5 * ratio, 2.25 * (MARGIN + 1) * skin);
    for (int a = 0; way & GRADED_AROUND && a < test->dimension; ++a)
        on.scene.period[a] = cloud_rounded(around);
    on.neighbors = NULL;
    if (way & GRADED_MOVED)
        search(&on, &before, &on.neighbors, skin);
    search(&on, &now, &on.neighbors, way & GRADED_MOVED ? skin : 0);
    sphg_neighbors_info info;
    SETUP_OK(on.context, sphg_neighbors_get_info(on.context, on.neighbors, &info));
    TEST_REQUIRE(info.rebuilt == !(way & GRADED_MOVED), "%s: rebuilt is %d", on.name,
                 (int)info.rebuilt);
    return comparison_with_volumes(&on, on.scene.volume);
}

void graded_compare(const comparison *on, sphg_shape shape, sphg_form form,
                    const setup_array *table)
{
    const comparison_field field = {shape, form, comparison_random_field(on, shape, 3)};
    const comparison_result found = comparison_apply(on, &field, table);
    for (int i = 0; i < on->points.count; i += test_reference_stride() * (on->points.count / 4))
        comparison_compare(on, &field, &found, i);
}

/* |G_ij - found| beside |G_ij|, both as sums over the axes. */
static void require_pair(const comparison *on, const setup_array *table, const setup_array *found,
                         int64_t pair, int i, int j, double roundings)
{
    const int d = on->points.dimension;
    sphg_scheme own = on->scheme;
    double x[3] = {0}, row[45] = {0}, gradient[3], size = 0, off = 0;
    own.support_radius = on->scene.support[i];
    for (int a = 0; a < d; ++a)
        x[a] = on->points.x[i * d + a] - on->points.x[j * d + a];
    for (int c = 0; c < table->width; ++c)
        row[c] = setup_get(table, i, c);
    sphg_pair_gradient(&own, x, on->scene.volume[j], row, gradient);
    for (int a = 0; a < d; ++a) {
        size += fabs(gradient[a]);
        off += fabs(gradient[a] - setup_get(found, (int)pair, a));
    }
    TEST_REQUIRE(off <= roundings * test_unit_roundoff(on->test) * (size + 1e-3),
                 "pair %d %d is off by %g of %g", i, j, off, size);
}

void graded_require_pair_gradients(const comparison *on, int from_table, double roundings)
{
    const int n = on->points.count;
    const setup_array table = comparison_table(on);
    const sphg_view given = from_table ? setup_view(&table) : sphg_absent();
    const sphg_sources sources = comparison_sources(on);
    int64_t *offsets = test_memory(((size_t)n + 1) * sizeof *offsets);
    sphg_pairs pairs = {.offsets = offsets};
    SETUP_OK(on->context,
             sphg_pair_gradients(on->context, &on->scheme, &sources, NULL, sphg_absent(), &pairs));
    const setup_array found =
        setup_output(test_field_type(on->test), (int)pairs.count, on->points.dimension);
    pairs.indices = test_memory((size_t)pairs.count * sizeof *pairs.indices);
    pairs.gradient = setup_view(&found);
    pairs.capacity = pairs.count;
    SETUP_OK(on->context,
             sphg_pair_gradients(on->context, &on->scheme, &sources, NULL, given, &pairs));
    for (int i = 0; i < n; i += 5)
        for (int64_t k = offsets[i]; k < offsets[i + 1]; ++k)
            if (pairs.indices[k] != i) /* classic methods have that, too */
                require_pair(on, &table, &found, k, i, pairs.indices[k], roundings);
}
