/* SPDX-License-Identifier: MIT */
#include "places.h"
#include "core/parallel.h"

enum { GRAIN = 4096 }; /* targets */

static double number_of(const char *row, int32_t axis, sphg_type type)
{
    return type == SPHG_F64 ? ((const double *)(const void *)row)[axis]
                            : (double)((const float *)(const void *)row)[axis];
}

/* ---- One number for all places -------------------------------------------------------------- */

/* The targets of two objects stand in different orders of storage: what is summed over them does
 * not depend on the order, and tells with each place whose it is. */
struct summing {
    const sphg_neighbors *neighbors;
    const int32_t *order; /* NULL: storage has the order of the host */
    size_t row_size;
    atomic_uint_least64_t sum;
};

/* Any change of a bit changes about half of the result's: multiply, and fold the high half down. */
static uint64_t mixed(uint64_t h, uint64_t bits)
{
    h = (h ^ bits) * UINT64_C(0x9e3779b97f4a7c15);
    return h ^ h >> 32;
}

static uint64_t place_of(const char *row, int32_t target, int32_t dimension, sphg_type type)
{
    uint64_t h = mixed(0, (uint64_t)target + 1);
    for (int32_t a = 0; a < dimension; ++a) {
        const double x = number_of(row, a, type) + 0; /* -0 is 0 */
        uint64_t bits;
        memcpy(&bits, &x, sizeof bits);
        h = mixed(h, bits);
    }
    return h;
}

static void sum_task(void *data, int32_t begin, int32_t end, int32_t worker)
{
    struct summing *summing = data;
    const sphg_neighbors *n = summing->neighbors;
    const char *row = sphgi_target_row(n, begin);
    uint64_t sum = 0;
    (void)worker;
    for (int32_t k = begin; k < end; ++k, row += summing->row_size)
        sum +=
            place_of(row, summing->order ? summing->order[k] : k, n->dimension, n->position_type);
    atomic_fetch_add(&summing->sum, sum);
}

/* The number is kept with the object, although that is shared: whoever comes second writes the
 * same. 0 stands for "not known". */
static uint64_t sum_of_places(sphg_context *context, const sphg_neighbors *n)
{
    atomic_uint_least64_t *kept = &((sphg_neighbors *)(uintptr_t)n)->places;
    uint64_t sum = atomic_load(kept);
    if (sum)
        return sum;
    struct summing summing = {
        .neighbors = n,
        .order = n->kind == SPHGI_HOST_LISTS ? NULL : sphgi_target_grid(n)->order.data,
        .row_size = SPHGI_ROW * sphgi_size_of_type(n->position_type)};
    atomic_store(&summing.sum, 0);
    sphgi_parallel_for(context, sum_task, &summing, n->target_count, GRAIN);
    sum = atomic_load(&summing.sum);
    sum += !sum;
    atomic_store(kept, sum);
    return sum;
}

/* ---- The question --------------------------------------------------------------------------- */

static const char *row_of_target(const sphg_neighbors *n, int32_t target)
{
    const int32_t *place = n->target_place.data;
    return sphgi_target_row(n, n->kind == SPHGI_HOST_LISTS ? target : place[target]);
}

int32_t sphgi_first_elsewhere(sphg_context *context, const sphg_neighbors *a,
                              const sphg_neighbors *b)
{
    const bool same = sphgi_target_grid(a)->rows.data == sphgi_target_grid(b)->rows.data;
    if (same || sum_of_places(context, a) == sum_of_places(context, b))
        return -1;
    for (int32_t k = 0; k < a->target_count; ++k)
        for (int32_t axis = 0; axis < a->dimension; ++axis)
            if (number_of(row_of_target(a, k), axis, a->position_type) !=
                number_of(row_of_target(b, k), axis, b->position_type))
                return k;
    return -1;
}
