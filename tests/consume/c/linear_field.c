/* SPDX-License-Identifier: MIT */
/* A host in C: the gradient of a linear field must come out, at corners too. */
#include <math.h>
#include <sphgrad/sphgrad.h>
#include <stdio.h>

enum { SIDE = 5, COUNT = SIDE * SIDE * SIDE };
static const double slope[3] = {2.0, -3.0, 0.5};

static int is_exact(const double (*gradient)[3])
{
    for (int i = 0; i < COUNT; ++i)
        for (int a = 0; a < 3; ++a)
            if (!(fabs(gradient[i][a] - slope[a]) < 1e-12))
                return 0;
    return 1;
}

int main(void)
{
    static double position[COUNT][3], field[COUNT], gradient[COUNT][3];
    for (int i = 0; i < COUNT; ++i) {
        const int cell[3] = {i % SIDE, i / SIDE % SIDE, i / SIDE / SIDE};
        field[i] = 7.0;
        for (int a = 0; a < 3; ++a) {
            position[i][a] = cell[a] + 0.01 * ((i * (a + 3)) % 17);
            field[i] += slope[a] * position[i][a];
            gradient[i][a] = NAN;
        }
    }
    const double volume = 1;
    const sphg_view positions = sphg_view_f64(position[0], sizeof position[0]);
    const sphg_scheme scheme = {.support_radius = 2};
    const sphg_geometry geometry = {
        .sources = positions, .source_count = COUNT, .target_count = COUNT};
    sphg_context *context = NULL;
    sphg_neighbors *neighbors = NULL;
    sphg_result result = sphg_context_create(SPHG_VERSION, NULL, &context);
    if (!result)
        result = sphg_neighbors_create(context, &neighbors);
    if (!result)
        result = sphg_neighbors_search(context, neighbors, &scheme, &geometry);
    const sphg_sources sources = {.neighbors = neighbors, .volume = sphg_view_f64(&volume, 0)};
    if (!result)
        result =
            sphg_gradient(context, &scheme, &sources, NULL, sphg_view_f64(field, sizeof field[0]),
                          sphg_view_f64(gradient[0], sizeof gradient[0]));
    sphg_neighbors_destroy(neighbors);
    sphg_context_destroy(context);

    const int exact = is_exact((const double(*)[3])gradient);
    printf("%s, version %d, %s\n", sphg_result_string(result), (int)sphg_version(),
           exact ? "exact" : "not exact");
    return result || sphg_version() != SPHG_VERSION || !exact;
}
