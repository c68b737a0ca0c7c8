/* SPDX-License-Identifier: MIT */
#include "numbers.h"
#include <stdio.h>
#include <stdlib.h>

void *allocate_or_exit(size_t count, size_t size)
{
    void *memory = calloc(count > 0 ? count : 1, size);
    if (!memory) {
        fprintf(stderr, "out of memory (%zu items of %zu bytes)\n", count, size);
        exit(EXIT_FAILURE);
    }
    return memory;
}

/* What lasts to the end, as a list. */
struct lasting {
    _Alignas(16) struct lasting *next;
};
static struct lasting *lasting;

static void release_lasting(void)
{
    while (lasting) {
        struct lasting *next = lasting->next;
        free(lasting);
        lasting = next;
    }
}

void *allocate_to_the_end(size_t count, size_t size)
{
    struct lasting *block = allocate_or_exit(1, sizeof *block + count * size);
    if (!lasting)
        atexit(release_lasting);
    block->next = lasting;
    lasting = block;
    return block + 1;
}

static size_t size_of_type(sphg_type type)
{
    return type == SPHG_F64 ? sizeof(double) : type == SPHG_F32 ? sizeof(float) : 1;
}

struct numbers numbers_create(sphg_type type, int32_t count, int32_t width)
{
    const size_t total = (size_t)count * (size_t)width;
    return (struct numbers){allocate_or_exit(total, size_of_type(type)), type, count, width};
}

void numbers_destroy(struct numbers *numbers)
{
    free(numbers->data);
    *numbers = (struct numbers){0};
}

static ptrdiff_t position_of(const struct numbers *numbers, int32_t item, int32_t component)
{
    return (ptrdiff_t)item * numbers->width + component;
}

double numbers_get(const struct numbers *numbers, int32_t item, int32_t component)
{
    const ptrdiff_t k = position_of(numbers, item, component);
    if (numbers->type == SPHG_F64)
        return ((const double *)numbers->data)[k];
    if (numbers->type == SPHG_F32)
        return (double)((const float *)numbers->data)[k];
    return ((const uint8_t *)numbers->data)[k];
}

void numbers_set(const struct numbers *numbers, int32_t item, int32_t component, double value)
{
    const ptrdiff_t k = position_of(numbers, item, component);
    if (numbers->type == SPHG_F64)
        ((double *)numbers->data)[k] = value;
    else if (numbers->type == SPHG_F32)
        ((float *)numbers->data)[k] = (float)value;
    else
        ((uint8_t *)numbers->data)[k] = (uint8_t)value;
}

sphg_view numbers_view(const struct numbers *numbers)
{
    const ptrdiff_t stride = numbers->width * (ptrdiff_t)size_of_type(numbers->type);
    return (sphg_view){.x = numbers->data, .stride = stride, .type = numbers->type};
}
