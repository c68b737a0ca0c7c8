/* SPDX-License-Identifier: MIT */
/* Memory comes from the host's allocator, in buffers that grow and are kept. */
#ifndef SPHGI_MEMORY_H
#define SPHGI_MEMORY_H
#include "internal.h"

struct sphgi_allocator {
    void *(*allocate)(size_t size, size_t alignment, void *user);
    void (*release)(void *memory, size_t size, void *user);
    void *user;
};

struct sphgi_buffer {
    void *data;
    size_t size; /* [byte], as allocated */
};

/* The host's pair of functions, or the C library's. */
struct sphgi_allocator sphgi_allocator_of(const sphg_config *config);

void *sphgi_allocate(const struct sphgi_allocator *allocator, size_t size);
void sphgi_release(const struct sphgi_allocator *allocator, void *memory, size_t size);

/* Makes room for count items; what the buffer held is lost if it has to grow. A buffer that grows
 * again takes an eighth more, so that a slowly rising count does not allocate at each step. False:
 * out of memory, the buffer is empty. */
bool sphgi_reserve(const struct sphgi_allocator *allocator, struct sphgi_buffer *buffer,
                   size_t count, size_t item_size);
void sphgi_free(const struct sphgi_allocator *allocator, struct sphgi_buffer *buffer);

/* Arrays one after the other in one piece of memory. base NULL: they are only measured, so that the
 * same lines say how much memory there must be and what lies where. What sphgi_place returns then
 * is no place. It is worked out in whole numbers, for nothing may be added to a null pointer. */
struct sphgi_layout {
    char *base;
    size_t used; /* [byte] */
};

static inline void *sphgi_place(struct sphgi_layout *layout, size_t count, size_t item_size)
{
    void *here = (void *)((uintptr_t)layout->base + layout->used);
    layout->used += sphgi_round_up(count * item_size, SPHGI_ALIGNMENT);
    return here;
}

#endif
