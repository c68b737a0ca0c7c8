/* SPDX-License-Identifier: MIT */
#include "lattice_block.h"
#include <math.h>

comparison lattice_block_of(const test_case *test, int per_axis, double support, double jitter)
{
    const int d = test->dimension;
    const double spacing = 2. / per_axis;
    random_state random = random_seeded(5);
    cloud points = cloud_lattice(d, per_axis, spacing);
    for (int k = 0; k < points.count * d; ++k)
        points.x[k] = -1 + (floor(points.x[k] / spacing + .5) + .5) * spacing +
                      (jitter > 0 ? jitter * spacing * random_between(&random, -1, 1) : 0);
    const comparison on = comparison_of(test, "block", points, support * spacing * (1 + 1e-6));
    sphg_scheme plain = on.scheme;
    plain.method = SPHG_PLAIN;
    const double one = 1;
    double *volumes = test_memory((size_t)points.count * sizeof *volumes);
    const sphg_view ones = sphg_same_f64(&one);
    const sphg_sources sources = {.neighbors = on.neighbors, .volume = ones};
    sphg_field field = {.shape = SPHG_SCALAR, .form = SPHG_DIRECT, .at_sources = &ones};
    field.value = sphg_view_f64(volumes, sizeof *volumes);
    const sphg_request request = {
        .sources = &sources, .fields = &field, .set_count = 1, .field_count = 1};
    SETUP_OK(on.context, sphg_evaluate(on.context, &plain, &request));
    for (int i = 0; i < points.count; ++i)
        volumes[i] = 1 / volumes[i];
    return second_order_comparison(comparison_with_volumes(&on, volumes));
}

int lattice_block_is_boundary(const comparison *on, int i)
{
    const int d = on->points.dimension;
    for (int a = 0; a < d; ++a)
        if (1 - fabs(on->points.x[i * d + a]) < 2 * on->points.spacing)
            return 1;
    return 0;
}
