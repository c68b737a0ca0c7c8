/* SPDX-License-Identifier: MIT */
/* A loop of the host over pairs, in blocks of targets. The library gives the pairs and their
 * gradients G_ij, the blocks stay in the cache, and the host forms any sums. Prints the error of
 * the divergence of v = (x, y, z), which is 3, and the mean distance of neighbours. */
#include <sphgrad/sphgrad.h>
#include <math.h>
#include <stdio.h>
#include <stdlib.h>

enum { SIDE = 10, COUNT = SIDE * SIDE * SIDE, BLOCK = 64 };

static double x[COUNT][3]; /* positions, and the velocity field */
static sphg_context *context;

static void check(sphg_result result)
{
    if (result != SPHG_OK) {
        fprintf(stderr, "%s\n", sphg_last_message(context));
        exit(EXIT_FAILURE);
    }
}

int main(void)
{
    const double volume = 1;
    const sphg_scheme scheme = {.support_radius = 2};
    for (int i = 0; i < COUNT; ++i) /* a lattice with spacing 1 */
        for (int k = 0, rest = i; k < 3; ++k, rest /= SIDE)
            x[i][k] = rest % SIDE;
    const sphg_geometry block = sphg_all(sphg_view_f64(x[0], sizeof x[0]), COUNT);
    sphg_neighbors *neighbors = NULL;
    check(sphg_context_create(SPHG_VERSION, NULL, &context));
    check(sphg_neighbors_create(context, &neighbors));
    check(sphg_neighbors_search(context, neighbors, &scheme, &block));
    const sphg_sources sources = {.neighbors = neighbors, .volume = sphg_same_f64(&volume)};

    int64_t offsets[BLOCK + 1], capacity = 0, count = 0;
    int32_t *indices = NULL;
    double(*gradients)[3] = NULL;
    double distance = 0, error = 0;
    for (int32_t begin = 0; begin < COUNT; begin += BLOCK) {
        const sphg_subset some = sphg_range(begin, begin + BLOCK < COUNT ? begin + BLOCK : COUNT);
        sphg_pairs pairs = {.offsets = offsets};
        check(sphg_pair_gradients(context, &scheme, &sources, &some, sphg_absent(), &pairs));
        if (pairs.count > capacity) { /* the first call counts, the second fills */
            capacity = pairs.count;
            indices = realloc(indices, (size_t)capacity * sizeof *indices);
            gradients = realloc(gradients, (size_t)capacity * sizeof *gradients);
        }
        pairs = (sphg_pairs){offsets, indices, sphg_view_f64(gradients[0], sizeof *gradients),
                             .capacity = capacity, .any_order = 1};
        check(sphg_pair_gradients(context, &scheme, &sources, &some, sphg_absent(), &pairs));
        for (int32_t i = begin; i < some.end; ++i) {
            double divergence = 0;
            for (int64_t n = offsets[i - begin]; n < offsets[i - begin + 1]; ++n) {
                double squared = 0;
                for (int k = 0; k < 3; ++k) {
                    const double apart = x[indices[n]][k] - x[i][k]; /* x_j - x_i, and v_j - v_i */
                    squared += apart * apart;
                    divergence += apart * gradients[n][k];
                }
                distance += sqrt(squared);
            }
            error += fabs(divergence - 3) / COUNT;
        }
        count += pairs.count;
    }
    printf("%lld pairs, mean distance %.4f, error of the divergence %.1e\n", (long long)count,
           distance / (double)count, error);
    free(indices);
    free(gradients);
    sphg_neighbors_destroy(neighbors);
    sphg_context_destroy(context);
    return !(error < 1e-12);
}
