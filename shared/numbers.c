/* SPDX-License-Identifier: MIT */
#include "numbers.h"
#include <stdatomic.h>
#include <stdio.h>
#include <stdlib.h>
#include <string.h>

static void *required(void *memory, size_t count, size_t size)
{
    if (!memory) {
        fprintf(stderr, "out of memory (%zu items of %zu bytes)\n", count, size);
        exit(EXIT_FAILURE);
    }
    return memory;
}

void *allocate_or_exit(size_t count, size_t size)
{
    return required(calloc(count > 0 ? count : 1, size), count, size);
}

/* Of memory, an object, or both: what lies behind this, and what a function releases. */
struct held {
    _Alignas(16) struct held *next;
    void *object;
    void (*release)(void *object); /* or NULL */
};
static struct held *lasting;
static _Thread_local struct held *holding;

static void release_back_to(struct held **list, const struct held *mark)
{
    while (*list != mark) {
        struct held *last = *list;
        *list = last->next;
        if (last->release)
            last->release(last->object);
        free(last);
    }
}

static void release_all(void)
{
    release_back_to(&holding, NULL);
    release_back_to(&lasting, NULL);
}

static struct held *add_to(struct held **list, size_t bytes)
{
    static atomic_flag registered = ATOMIC_FLAG_INIT;
    struct held *entry = allocate_or_exit(1, sizeof *entry + bytes);
    if (!atomic_flag_test_and_set(&registered))
        atexit(release_all);
    entry->next = *list;
    return *list = entry;
}

void *allocate_to_the_end(size_t count, size_t size)
{
    return add_to(&lasting, count * size) + 1;
}

void *allocate_held(size_t count, size_t size)
{
    return add_to(&holding, count * size) + 1;
}

void hold(void *object, void (*release)(void *object))
{
    struct held *entry = add_to(&holding, 0);
    entry->object = object;
    entry->release = release;
}

void *allocate_lines(size_t count, size_t size)
{
    enum { CACHE_LINE = 64 };
    const size_t bytes = (count * size / CACHE_LINE + 1) * CACHE_LINE;
    void *memory = required(aligned_alloc(CACHE_LINE, bytes), bytes, 1);
    hold(memory, free);
    return memset(memory, 0, bytes);
}

struct held *held_so_far(void)
{
    return holding;
}

void release_held(struct held *mark)
{
    release_back_to(&holding, mark);
}

static size_t size_of_type(sphg_type type)
{
    return type == SPHG_F64 ? sizeof(double) : type == SPHG_F32 ? sizeof(float) : 1;
}

struct numbers numbers_create(sphg_type type, int32_t count, int32_t width)
{
    const size_t total = (size_t)count * (size_t)width;
    return (struct numbers){allocate_held(total, size_of_type(type)), type, count, width};
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
