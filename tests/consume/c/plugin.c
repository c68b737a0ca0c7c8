/* SPDX-License-Identifier: MIT */
/* A plugin: the gradient of a linear field on as many threads as there are, then nothing remains;
 * or, if its host says so, what it made. */
#include <math.h>
#include <sphgrad/sphgrad.h>

enum { SIDE = 20, COUNT = SIDE * SIDE * SIDE }; /* so many that threads are worth their while */
static float position[COUNT][3], gradient[COUNT][3];

/* 0: every gradient is that of the first coordinate. */
__attribute__((visibility("default"))) int plugin_run(int leave);
int plugin_run(int leave)
{
    const float volume = 1;
    for (int i = 0; i < COUNT; ++i) {
        position[i][0] = (float)(i % SIDE);
        position[i][1] = (float)(i / SIDE % SIDE);
        position[i][2] = (float)(i / SIDE / SIDE);
    }
    const sphg_view positions = sphg_view_f32(position[0], sizeof position[0]);
    const sphg_scheme scheme = {.support_radius = 2};
    const sphg_geometry geometry = {
        .sources = positions, .source_count = COUNT, .target_count = COUNT};
    sphg_context *context = NULL;
    sphg_neighbors *neighbors = NULL;
    sphg_sources sources = {.volume = sphg_view_f32(&volume, 0)};
    int failed = sphg_context_create(SPHG_VERSION, NULL, &context) ||
                 sphg_neighbors_create(context, &neighbors) ||
                 sphg_neighbors_search(context, neighbors, &scheme, &geometry);
    sources.neighbors = neighbors;
    failed = failed || sphg_gradient(context, &scheme, &sources, NULL, positions,
                                     sphg_view_f32(gradient[0], sizeof gradient[0]));
    if (!leave) {
        sphg_neighbors_destroy(neighbors);
        sphg_context_destroy(context);
    }
    for (int i = 0; i < COUNT; ++i)
        for (int a = 0; a < 3; ++a)
            failed |= !(fabsf(gradient[i][a] - (a == 0)) < 1e-5f);
    return failed;
}
