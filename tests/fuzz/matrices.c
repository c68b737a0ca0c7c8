/* SPDX-License-Identifier: MIT */
/* Any 2 x 2 or 3 x 3 matrix: factors that are orthogonal and multiply to it, corrections that are
 * finite where the matrix is; NaN and infinity stay in their own item. */
#include "fuzz.h"

enum { ITEMS = 5 };

typedef struct batch {
    sphg_context *context;
    sphg_type type;
    int dimension;
    double unit, grain;
    double in[ITEMS * 9], first[ITEMS * 9], second[ITEMS * 9], third[ITEMS * 9];
} batch;

static long double largest(const batch *on, const void *array, int first, int count)
{
    long double most = 0;
    for (int k = first; k < first + count; ++k) {
        const double x = fuzz_get(on->type, array, k);
        if (!isfinite(x))
            return INFINITY;
        most = fmaxl(most, fabsl(x));
    }
    return most;
}

static void require_orthogonal(const batch *on, const void *array, int item)
{
    const int d = on->dimension;
    for (int j = 0; j < d; ++j)
        for (int k = 0; k <= j; ++k) {
            long double dot = j == k ? -1 : 0;
            for (int r = 0; r < d; ++r)
                dot += (long double)fuzz_get(on->type, array, item * d * d + r * d + j) *
                       fuzz_get(on->type, array, item * d * d + r * d + k);
            FUZZ_REQUIRE(fabsl(dot) <= 64 * on->unit, "columns %d, %d: %Lg", j, k, dot);
        }
}

/* |A - U diag(values) V^T| entry by entry, against the largest entry. */
static void require_product(const batch *on, const long double *a, const void *u,
                            const void *values, const void *v, int item)
{
    const int d = on->dimension;
    long double size = 0;
    for (int k = 0; k < d * d; ++k)
        size = fmaxl(size, fabsl(a[k]));
    for (int k = 0; k < d * d; ++k) {
        long double rest = a[k];
        for (int m = 0; m < d; ++m)
            rest -= (long double)fuzz_get(on->type, u, item * d * d + k / d * d + m) *
                    fuzz_get(on->type, values, item * d + m) *
                    fuzz_get(on->type, v, item * d * d + k % d * d + m);
        FUZZ_REQUIRE(fabsl(rest) <= 200 * on->unit * size + 4 * (long double)on->grain,
                     "entry %d off by %Lg of %Lg", k, rest, size);
    }
}

static void try_eigen(batch *on)
{
    const int d = on->dimension, width = d * (d + 1) / 2;
    FUZZ_REQUIRE(sphg_eigen(on->context, d, ITEMS, fuzz_view(on->type, on->in, width),
                            fuzz_view(on->type, on->first, d),
                            fuzz_view(on->type, on->second, d * d)) == SPHG_OK,
                 "eigen");
    const long double top = on->type == SPHG_F64 ? DBL_MAX / 8 : (long double)FLT_MAX / 8;
    for (int i = 0; i < ITEMS; ++i) {
        long double a[9];
        if (largest(on, on->in, i * width, width) > top)
            continue;
        for (int r = 0, k = i * width; r < d; ++r)
            for (int c = r; c < d; ++c, ++k)
                a[r * d + c] = a[c * d + r] = fuzz_get(on->type, on->in, k);
        require_orthogonal(on, on->second, i);
        require_product(on, a, on->second, on->first, on->second, i);
    }
}

static void try_svd(batch *on)
{
    FUZZ_REQUIRE(sphg_svd(on->context, ITEMS, fuzz_view(on->type, on->in, 9),
                          fuzz_view(on->type, on->first, 9), fuzz_view(on->type, on->second, 3),
                          fuzz_view(on->type, on->third, 9)) == SPHG_OK,
                 "svd");
    const long double top = on->type == SPHG_F64 ? DBL_MAX / 8 : (long double)FLT_MAX / 8;
    for (int i = 0; i < ITEMS && on->dimension == 3; ++i) {
        long double a[9];
        if (largest(on, on->in, i * 9, 9) > top)
            continue;
        for (int k = 0; k < 9; ++k)
            a[k] = fuzz_get(on->type, on->in, 9 * i + k);
        require_orthogonal(on, on->first, i);
        require_orthogonal(on, on->third, i);
        require_product(on, a, on->first, on->second, on->third, i);
    }
}

static void try_inversion(batch *on, fuzz_bytes *from)
{
    const int d = on->dimension, width = d * (d + 1) / 2;
    uint8_t rank[ITEMS];
    double volume[ITEMS];
    sphg_stats stats;
    const sphg_scheme scheme = {.dimension = d,
                                .method = (sphg_method)(fuzz_byte(from) % 3),
                                .policy = (sphg_policy)(fuzz_byte(from) % 4),
                                .support_radius = 1,
                                .threshold = fuzz_byte(from) / 256.};
    for (int i = 0; i < ITEMS; ++i)
        fuzz_put(on->type, volume, i, fuzz_byte(from) / 64.);
    const sphg_inversion wanted = {.correction = fuzz_view(on->type, on->first, width),
                                   .rank = sphg_view_u8(rank, 1),
                                   .lambda_min = fuzz_view(on->type, on->second, 1),
                                   .stats = &stats};
    FUZZ_REQUIRE(sphg_invert_moments(on->context, &scheme, ITEMS,
                                     fuzz_view(on->type, on->in, width),
                                     fuzz_view(on->type, volume, 1), &wanted) == SPHG_OK,
                 "invert: %s", sphg_last_message(on->context));
    for (int i = 0; i < ITEMS; ++i) {
        FUZZ_REQUIRE(rank[i] <= d, "rank %d", rank[i]);
        const long double size = largest(on, on->in, i * width, width);
        if (isinf(size))
            FUZZ_REQUIRE(rank[i] == 0, "rank of a matrix that is not finite");
        else if (size < 1e15L)
            FUZZ_REQUIRE(isfinite(largest(on, on->first, i * width, width)),
                         "C of a finite matrix is not finite");
    }
}

int LLVMFuzzerTestOneInput(const uint8_t *data, size_t size)
{
    fuzz_bytes from = {data, size};
    batch on;
    memset(&on, 0, sizeof on);
    on.context = fuzz_instance_for(size)->context;
    const int flags = fuzz_byte(&from);
    on.type = flags & 1 ? SPHG_F64 : SPHG_F32;
    on.dimension = flags & 2 ? 3 : 2;
    on.unit = on.type == SPHG_F64 ? 0x1p-53 : 0x1p-24;
    on.grain = on.type == SPHG_F64 ? 0x1p-1074 : 0x1p-149;
    for (int k = 0; k < ITEMS * 9; ++k)
        fuzz_put(on.type, on.in, k, fuzz_real(&from));
    try_eigen(&on);
    try_svd(&on);
    try_inversion(&on, &from);
    return 0;
}
