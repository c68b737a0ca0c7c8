/* SPDX-License-Identifier: MIT */
#include "graded_halves.h"

static sphg_view half_of(const graded_halves *of, int s, const setup_array *array)
{
    sphg_view view = setup_view(array);
    view.x = (const char *)view.x + of->first[s] * view.stride;
    return view;
}

static void search_half(const comparison *on, const graded *at, const graded_halves *of, int s,
                        double skin, sphg_neighbors **neighbors)
{
    const int n = at->points.count, count = s ? n - of->first[1] : of->first[1];
    const setup_array x = setup_positions(on->test, (cloud *)(uintptr_t)&at->points);
    const setup_array h = setup_numbers(test_position_type(on->test), n, 1, at->radii);
    sphg_geometry geometry = sphg_targets_apart(setup_view(&x), n, half_of(of, s, &x), count);
    geometry.source_support = half_of(of, s, &h);
    geometry.target_support = setup_view(&h);
    geometry.precision = test_field_type(on->test);
    geometry.mutual = 1;
    geometry.skin = skin;
    for (int a = 0; a < at->points.dimension; ++a)
        geometry.period[a] = on->scene.period[a];
    if (*neighbors)
        SETUP_OK(on->context,
                 sphg_neighbors_search(on->context, *neighbors, &on->scheme, &geometry));
    else
        *neighbors = setup_search(on->context, &on->scheme, &geometry);
}

graded_halves graded_halves_of(const comparison *on, double ratio, double support, graded_way way,
                               const setup_array *table, const setup_array *numbers)
{
    graded_halves made = {.first = {0, on->points.count / 2}, .at_targets = setup_view(numbers)};
    const graded now = {on->points, (double *)(uintptr_t)on->scene.support};
    const graded before = graded_before(on->points.dimension, ratio, support);
    for (int s = 0; s < GRADED_SETS; ++s) {
        sphg_neighbors *neighbors = NULL;
        if (way & GRADED_MOVED)
            search_half(on, &before, &made, s, graded_skin(&before), &neighbors);
        search_half(on, &now, &made, s, way & GRADED_MOVED ? graded_skin(&before) : 0, &neighbors);
        made.sets[s].neighbors = neighbors;
        made.sets[s].volume = half_of(&made, s, &on->volume);
        made.sets[s].density = half_of(&made, s, &on->density);
        if (on->scheme.method != SPHG_PLAIN)
            made.sets[s].correction = half_of(&made, s, table);
        made.numbers[s] = half_of(&made, s, numbers);
    }
    return made;
}

comparison_result graded_apply_to_halves(const comparison *on, const graded_halves *of,
                                         const comparison_field *field, const setup_array *table,
                                         int given)
{
    sphg_field asked = {.shape = field->shape,
                        .form = field->form,
                        .at_sources = of->numbers,
                        .at_targets = of->at_targets};
    comparison_result found = comparison_outputs(on, field, on->points.count);
    sphg_request request = {
        .sources = of->sets, .fields = &asked, .set_count = GRADED_SETS, .field_count = 1};
    comparison_ask_for(&found, &asked);
    request.target_volume = setup_view(&on->volume);
    request.target_density = setup_view(&on->density);
    if (given)
        request.target_correction = comparison_table_view(on, table);
    SETUP_OK(on->context, sphg_evaluate(on->context, &on->scheme, &request));
    return found;
}
