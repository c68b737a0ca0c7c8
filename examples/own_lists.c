/* SPDX-License-Identifier: MIT */
/* Neighbour lists of the host, in each of their three forms. They are one array (CSR), a pointer
 * per particle, or a function that the library calls. Prints the error of a gradient with each, and
 * whether all have the same bits. */
#include <sphgrad/sphgrad.h>
#include <math.h>
#include <stdio.h>
#include <stdlib.h>
#include <string.h>

enum { SIDE = 8, COUNT = SIDE * SIDE * SIDE };

static double x[COUNT][3], a[COUNT], gradient[3][COUNT][3];
static int64_t offsets[COUNT + 1];
static int32_t indices[64 * COUNT], lengths[COUNT];
static const int32_t *rows[COUNT];
static sphg_context *context;

static void check(sphg_result result)
{
    if (result != SPHG_OK) {
        fprintf(stderr, "%s\n", sphg_last_message(context));
        exit(EXIT_FAILURE);
    }
}

/* Called by the library's threads; the list must stay as it is until the worker's next call. */
static int32_t row(int32_t target, int32_t worker, const int32_t **list, void *user)
{
    (void)worker, (void)user;
    *list = rows[target];
    return lengths[target];
}

int main(void)
{
    const double h = 2, volume = 1;
    const sphg_view field = sphg_view_f64(a, sizeof a[0]);
    for (int i = 0; i < COUNT; ++i) { /* a lattice with spacing 1, and the field 2 x + 3 y - z */
        for (int k = 0, rest = i; k < 3; ++k, rest /= SIDE)
            x[i][k] = rest % SIDE;
        a[i] = 2 * x[i][0] + 3 * x[i][1] - x[i][2];
    }
    for (int i = 0; i < COUNT; ++i) { /* the host's own search; i itself may be listed or not */
        rows[i] = indices + offsets[i];
        for (int j = 0; j < COUNT; ++j)
            if (hypot(hypot(x[i][0] - x[j][0], x[i][1] - x[j][1]), x[i][2] - x[j][2]) < h)
                indices[offsets[i] + lengths[i]++] = j;
        offsets[i + 1] = offsets[i] + lengths[i];
    }
    const sphg_lists forms[3] = {
        {.offsets = offsets, .indices = indices}, {.rows = rows, .lengths = lengths}, {.row = row}};
    const char *const names[3] = {"CSR", "pointers", "function"};
    const sphg_scheme scheme = {.support_radius = h};
    const sphg_geometry block = sphg_all(sphg_view_f64(x[0], sizeof x[0]), COUNT);
    sphg_neighbors *neighbors = NULL;
    int failed = 0;
    check(sphg_context_create(SPHG_VERSION, NULL, &context));
    check(sphg_neighbors_create(context, &neighbors));
    const sphg_sources sources = {.neighbors = neighbors, .volume = sphg_same_f64(&volume)};
    for (int form = 0; form < 3; ++form) {
        double error = 0;
        const sphg_view found = sphg_view_f64(gradient[form][0], sizeof gradient[form][0]);
        check(sphg_neighbors_use_lists(context, neighbors, &scheme, &block, &forms[form]));
        check(sphg_gradient(context, &scheme, &sources, NULL, field, found));
        for (int i = 0; i < COUNT; ++i)
            error += fabs(gradient[form][i][1] - 3) / COUNT;
        const int same = memcmp(gradient[form], gradient[0], sizeof gradient[0]) == 0;
        printf("%-8s  error %.1e, %s bits\n", names[form], error, same ? "same" : "other");
        failed = failed || !same || !(error < 1e-12);
    }
    check(sphg_neighbors_check(context, &scheme, neighbors, NULL)); /* is any pair missing? */
    sphg_neighbors_destroy(neighbors);
    sphg_context_destroy(context);
    return failed;
}
