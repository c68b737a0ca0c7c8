/* SPDX-License-Identifier: MIT */
#include "page_guard.h"
#include <stdlib.h>
#include <string.h>
#include <sys/mman.h>
#include <unistd.h>

enum { POOLED_MOST = 512 }; /* pages in front of the guard */

/* Stands right in front of the array, at whatever alignment that leaves. */
typedef struct mapping {
    char *begin;
    size_t open; /* bytes in front of the guard */
} mapping;

/* Mappings that were given back, by their pages: a system call for each array took most of the time
 * of some tests. Used by the thread that runs the cases alone. */
typedef struct spare {
    struct spare *next;
} spare;

static spare *spares[POOLED_MOST + 1];

static spare **pool_of(size_t open)
{
    const size_t pages = open / (size_t)sysconf(_SC_PAGESIZE);
    return pages <= POOLED_MOST ? &spares[pages] : NULL;
}

static char *map(size_t open)
{
    const size_t page = (size_t)sysconf(_SC_PAGESIZE);
    char *begin =
        mmap(NULL, open + page, PROT_READ | PROT_WRITE, MAP_PRIVATE | MAP_ANONYMOUS, -1, 0);
    if (begin == MAP_FAILED)
        return NULL;
    if (mprotect(begin + open, page, PROT_NONE)) {
        munmap(begin, open + page);
        return NULL;
    }
    return begin;
}

static char *take(size_t open)
{
    spare **pool = pool_of(open);
    if (!pool || !*pool)
        return map(open);
    char *begin = (char *)*pool;
    *pool = (*pool)->next;
    memset(begin, 0, open);
    return begin;
}

void *page_guard_create(size_t bytes)
{
    if (TEST_SANITIZED)
        return calloc(bytes ? bytes : 1, 1);
    const size_t page = (size_t)sysconf(_SC_PAGESIZE);
    const size_t open = (bytes + sizeof(mapping) + page - 1) / page * page;
    const mapping made = {take(open), open};
    if (!made.begin)
        return NULL;
    char *array = made.begin + open - bytes;
    memcpy(array - sizeof made, &made, sizeof made);
    return array;
}

void page_guard_destroy(void *memory)
{
    mapping made;
    if (TEST_SANITIZED) {
        free(memory);
        return;
    }
    memcpy(&made, (char *)memory - sizeof made, sizeof made);
    spare **pool = pool_of(made.open), *given = (spare *)(void *)made.begin;
    if (!pool) {
        munmap(made.begin, made.open + (size_t)sysconf(_SC_PAGESIZE));
        return;
    }
    given->next = *pool;
    *pool = given;
}
