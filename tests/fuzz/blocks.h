/* SPDX-License-Identifier: MIT */
/* Memory for an allocator that is asked for the same large blocks again and again: mapping them
 * would take half of the time of a fuzz target. What nobody holds, and what is behind a block, is
 * poisoned under AddressSanitizer. */
#ifndef TESTS_FUZZ_BLOCKS_H
#define TESTS_FUZZ_BLOCKS_H
#include <stddef.h>
#include <stdlib.h>
#include <string.h>
#ifdef __has_feature /* Clang */
#if __has_feature(address_sanitizer)
#define ADDRESSES_ARE_WATCHED
#endif
#endif
#if defined(ADDRESSES_ARE_WATCHED) || defined(__SANITIZE_ADDRESS__) /* GCC */
#include <sanitizer/asan_interface.h>
#else
#define ASAN_POISON_MEMORY_REGION(memory, size)   ((void)(memory), (void)(size))
#define ASAN_UNPOISON_MEMORY_REGION(memory, size) ((void)(memory), (void)(size))
#endif

enum { BLOCK_HEADER = 64, BLOCK_LARGE = 1 << 16, BLOCKS_WAITING = 16 };

typedef struct block_waiting {
    char *memory;
    size_t size; /* of the whole: header, block, rounding */
} block_waiting;

static inline size_t block_whole(size_t size)
{
    return (size + BLOCK_HEADER + BLOCK_HEADER - 1) / BLOCK_HEADER * BLOCK_HEADER;
}

/* Bytes that were asked for. */
static inline size_t block_size(const void *memory)
{
    size_t size;
    memcpy(&size, (const char *)memory - BLOCK_HEADER, sizeof size);
    return size;
}

static inline block_waiting *blocks_waiting(void)
{
    static block_waiting waiting[BLOCKS_WAITING];
    return waiting;
}

static inline char *block_reuse(size_t whole)
{
    block_waiting *waiting = blocks_waiting();
    for (int k = 0; whole >= BLOCK_LARGE && k < BLOCKS_WAITING; ++k)
        if (waiting[k].memory && waiting[k].size == whole) {
            char *memory = waiting[k].memory;
            waiting[k].memory = NULL;
            ASAN_UNPOISON_MEMORY_REGION(memory, whole);
            return memory;
        }
    return NULL;
}

/* NULL if there is no memory; aligned to BLOCK_HEADER bytes. */
static inline void *block_take(size_t size)
{
    const size_t whole = block_whole(size);
    char *memory = block_reuse(whole);
    if (!memory)
        memory = aligned_alloc(BLOCK_HEADER, whole);
    if (!memory)
        return NULL;
    memcpy(memory, &size, sizeof size);
    ASAN_POISON_MEMORY_REGION(memory + BLOCK_HEADER + size, whole - BLOCK_HEADER - size);
    return memory + BLOCK_HEADER;
}

/* A large one takes the place of the one that has waited longest, which is freed. */
static inline void block_give(void *block)
{
    static int oldest;
    char *memory = (char *)block - BLOCK_HEADER;
    const size_t whole = block_whole(block_size(block));
    if (whole >= BLOCK_LARGE) {
        block_waiting *place = &blocks_waiting()[oldest++ % BLOCKS_WAITING];
        const block_waiting other = *place;
        ASAN_POISON_MEMORY_REGION(memory, whole);
        *place = (block_waiting){memory, whole};
        if (!other.memory)
            return;
        ASAN_UNPOISON_MEMORY_REGION(other.memory, other.size);
        memory = other.memory;
    }
    free(memory);
}

#endif
