/* SPDX-License-Identifier: MIT */
#include "pair_order.h"
#include "core/parallel.h"
#include <string.h>

enum { GRAIN = 256 /* rows */, INSERTION_MOST = 128 };

static void swap_pairs(const struct sphgi_pair_order *s, int64_t a, int64_t b)
{
    const int32_t index = s->indices[a];
    s->indices[a] = s->indices[b];
    s->indices[b] = index;
    for (int32_t c = 0; c < s->gradient.columns.count; ++c) {
        char *x = sphgi_pair_number(&s->gradient, c, a);
        char *y = sphgi_pair_number(&s->gradient, c, b);
        char held[sizeof(double)];
        memcpy(held, x, s->gradient.size);
        memcpy(x, y, s->gradient.size);
        memcpy(y, held, s->gradient.size);
    }
}

static void sift_down(const struct sphgi_pair_order *s, int64_t first, int64_t root, int64_t count)
{
    while (2 * root + 1 < count) {
        int64_t child = 2 * root + 1;
        if (child + 1 < count && s->indices[first + child] < s->indices[first + child + 1])
            ++child;
        if (s->indices[first + root] >= s->indices[first + child])
            return;
        swap_pairs(s, first + root, first + child);
        root = child;
    }
}

/* Item k becomes what item `place` (the lower half of keys[k]) was. */
static inline void permute(char *first, ptrdiff_t stride, size_t size, const uint64_t *keys,
                           int64_t count)
{
    char held[INSERTION_MOST * sizeof(double)];
    for (int64_t k = 0; k < count; ++k)
        memcpy(held + (size_t)k * size, first + k * stride, size);
    for (int64_t k = 0; k < count; ++k)
        memcpy(first + k * stride, held + (size_t)(uint32_t)keys[k] * size, size);
}

/* The same in blocks. */
static void permute_blocks(const struct sphgi_pair_order *s, int32_t component, int64_t first,
                           const uint64_t *keys, int64_t count)
{
    const size_t size = s->gradient.size;
    char held[INSERTION_MOST * sizeof(double)];
    for (int64_t k = 0; k < count; ++k)
        memcpy(held + (size_t)k * size, sphgi_pair_number(&s->gradient, component, first + k),
               size);
    for (int64_t k = 0; k < count; ++k)
        memcpy(sphgi_pair_number(&s->gradient, component, first + k),
               held + (size_t)(uint32_t)keys[k] * size, size);
}

/* Keys are sorted alone, index before place; each gradient then moves once. */
static void sort_short_row(const struct sphgi_pair_order *s, int64_t first, int64_t count)
{
    uint64_t keys[INSERTION_MOST];
    for (int64_t k = 0; k < count; ++k) {
        const uint64_t key = (uint64_t)(uint32_t)s->indices[first + k] << 32 | (uint64_t)k;
        int64_t at = k;
        for (; at > 0 && keys[at - 1] > key; --at)
            keys[at] = keys[at - 1];
        keys[at] = key;
    }
    for (int64_t k = 0; k < count; ++k)
        s->indices[first + k] = (int32_t)(keys[k] >> 32);
    for (int32_t c = 0; c < s->gradient.columns.count; ++c) {
        if (s->gradient.block)
            permute_blocks(s, c, first, keys, count);
        else if (s->gradient.size == sizeof(double)) /* constant sizes: no calls for eight bytes */
            permute(sphgi_pair_number(&s->gradient, c, first), s->gradient.columns.stride,
                    sizeof(double), keys, count);
        else
            permute(sphgi_pair_number(&s->gradient, c, first), s->gradient.columns.stride,
                    sizeof(float), keys, count);
    }
}

static void sort_row(const struct sphgi_pair_order *s, int64_t first, int64_t count)
{
    if (count <= INSERTION_MOST) {
        sort_short_row(s, first, count);
        return;
    }
    for (int64_t root = count / 2; root-- > 0;)
        sift_down(s, first, root, count);
    for (int64_t end = count - 1; end > 0; --end) {
        swap_pairs(s, first, first + end);
        sift_down(s, first, 0, end);
    }
}

static void sort_task(void *data, int32_t begin, int32_t end, int32_t worker)
{
    const struct sphgi_pair_order *s = data;
    (void)worker;
    for (int32_t row = begin; row < end; ++row) {
        const int64_t first = s->offsets[row];
        const int64_t count = s->lengths ? s->lengths[row] : s->offsets[row + 1] - first;
        sort_row(s, first, count);
        sphgi_fill_up_row(&s->gradient, s->indices, first, count);
    }
}

void sphgi_sort_pairs(sphg_context *context, const struct sphgi_pair_order *order, int32_t rows)
{
    sphgi_parallel_for(context, sort_task, (void *)(uintptr_t)order, rows, GRAIN);
}
