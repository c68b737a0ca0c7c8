/* SPDX-License-Identifier: MIT */
#define _DEFAULT_SOURCE /* madvise */
#include "memory.h"
#include <stdlib.h>
#ifdef __linux__
#include <sys/mman.h>
#endif
#ifdef _WIN32 /* aligned memory is apart from other memory there, and has functions of its own */
#include <malloc.h>
#endif

/* Lists and rows are read at many places at once: with pages of 2 MiB, where the system has them to
 * give, addresses are looked up far less often. What is smaller stays on the pages of others. */
#if defined(__linux__) && defined(MADV_HUGEPAGE)
enum { LARGE_PAGE = 1 << 21, LARGE = 1 << 23 /* bytes */ };

static void *allocate_large(size_t size)
{
    size = sphgi_round_up(size, LARGE_PAGE);
    void *memory = aligned_alloc(LARGE_PAGE, size);
    if (memory)
        (void)madvise(memory, size, MADV_HUGEPAGE); /* a wish: without it, all works the same */
    return memory;
}
#endif

static void *libc_allocate(size_t size, size_t alignment, void *user)
{
    (void)user;
#if defined(__linux__) && defined(MADV_HUGEPAGE)
    if (size >= LARGE)
        return allocate_large(size);
#endif
#ifdef _WIN32
    return _aligned_malloc(size, alignment);
#else
    return aligned_alloc(alignment, sphgi_round_up(size, alignment));
#endif
}

static void libc_release(void *memory, size_t size, void *user)
{
    (void)size;
    (void)user;
#ifdef _WIN32
    _aligned_free(memory);
#else
    free(memory);
#endif
}

struct sphgi_allocator sphgi_allocator_of(const sphg_config *config)
{
    if (config->allocate)
        return (struct sphgi_allocator){config->allocate, config->release, config->user};
    return (struct sphgi_allocator){libc_allocate, libc_release, NULL};
}

void *sphgi_allocate(const struct sphgi_allocator *allocator, size_t size)
{
    return allocator->allocate(size, SPHGI_ALIGNMENT, allocator->user);
}

void sphgi_release(const struct sphgi_allocator *allocator, void *memory, size_t size)
{
    if (memory)
        allocator->release(memory, size, allocator->user);
}

bool sphgi_reserve(const struct sphgi_allocator *allocator, struct sphgi_buffer *buffer,
                   size_t count, size_t item_size)
{
    if (item_size && count > (SIZE_MAX - SPHGI_ALIGNMENT) / 2 / item_size)
        return false;
    size_t size = sphgi_round_up(count * item_size, SPHGI_ALIGNMENT);
    if (!size)
        size = SPHGI_ALIGNMENT; /* an empty array still has an address */
    if (size <= buffer->size)
        return true;
    if (buffer->data)
        size = sphgi_round_up(size + size / 8, SPHGI_ALIGNMENT);
    sphgi_free(allocator, buffer);
    buffer->data = sphgi_allocate(allocator, size);
    buffer->size = buffer->data ? size : 0;
    return buffer->data != NULL;
}

void sphgi_free(const struct sphgi_allocator *allocator, struct sphgi_buffer *buffer)
{
    sphgi_release(allocator, buffer->data, buffer->size);
    buffer->data = NULL;
    buffer->size = 0;
}
