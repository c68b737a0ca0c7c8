/* SPDX-License-Identifier: MIT */
/* Memory from the host's allocator, and the host's log. The log hears of each call that is refused.
 * Prints what it hears, the error of a gradient, how many bytes were in use, and how many are left
 * at the end. */
#include <sphgrad/sphgrad.h>
#include <math.h>
#include <stdio.h>
#include <stdlib.h>

enum { SIDE = 10, COUNT = SIDE * SIDE * SIDE };

static double x[COUNT][3], a[COUNT], gradient[COUNT][3];
static size_t in_use, most;

static void *allocate(size_t size, size_t alignment, void *user)
{
    (void)user;
    in_use += size;
    most = in_use > most ? in_use : most;
    return aligned_alloc(alignment, (size + alignment - 1) / alignment * alignment);
}

static void release(void *memory, size_t size, void *user)
{
    (void)user;
    in_use -= size;
    free(memory);
}

static void hear(sphg_result result, const char *message, void *user)
{
    (void)user;
    printf("log: %s: %s\n", sphg_result_string(result), message);
}

int main(void)
{
    const double volume = 1;
    for (int i = 0; i < COUNT; ++i) { /* a lattice with spacing 1, and the field 2 x + 3 y - z */
        for (int k = 0, rest = i; k < 3; ++k, rest /= SIDE)
            x[i][k] = rest % SIDE;
        a[i] = 2 * x[i][0] + 3 * x[i][1] - x[i][2];
    }
    const sphg_config config = {.allocate = allocate, .release = release, .log = hear};
    const sphg_scheme scheme = {.support_radius = 2}, wrong = {.support_radius = -2};
    const sphg_geometry block = sphg_all(sphg_view_f64(x[0], sizeof x[0]), COUNT);
    sphg_context *context = NULL;
    sphg_neighbors *neighbors = NULL;
    int failed = sphg_context_create(SPHG_VERSION, &config, &context) ||
                 sphg_neighbors_create(context, &neighbors) ||
                 sphg_neighbors_search(context, neighbors, &scheme, &block);
    const sphg_sources sources = {.neighbors = neighbors, .volume = sphg_same_f64(&volume)};
    failed =
        failed || sphg_gradient(context, &scheme, &sources, NULL, sphg_view_f64(a, sizeof a[0]),
                                sphg_view_f64(gradient[0], sizeof gradient[0]));
    double error = 0;
    for (int i = 0; i < COUNT; ++i)
        error += fabs(gradient[i][1] - 3) / COUNT;
    const int refused = sphg_neighbors_search(context, neighbors, &wrong, &block) != SPHG_OK;
    sphg_neighbors_destroy(neighbors);
    sphg_context_destroy(context);
    printf("error %.1e, %zu bytes in use, %zu at the end\n", error, most, in_use);
    return failed || !refused || !(error < 1e-12) || most == 0 || in_use != 0;
}
