#include "guarded.h"
#include <stdlib.h>
#include <string.h>
#include <sys/mman.h>
#include <unistd.h>

/* Stands right in front of the array, at whatever alignment that leaves. */
typedef struct mapping {
    void *begin;
    size_t bytes;
} mapping;

void *guarded_create(size_t bytes)
{
    if (TEST_SANITIZED)
        return calloc(bytes ? bytes : 1, 1);
    const size_t page = (size_t)sysconf(_SC_PAGESIZE);
    const size_t open = (bytes + sizeof(mapping) + page - 1) / page * page;
    const mapping made = {
        mmap(NULL, open + page, PROT_READ | PROT_WRITE, MAP_PRIVATE | MAP_ANONYMOUS, -1, 0),
        open + page};
    if (made.begin == MAP_FAILED)
        return NULL;
    char *array = (char *)made.begin + open - bytes;
    memcpy(array - sizeof made, &made, sizeof made);
    if (mprotect((char *)made.begin + open, page, PROT_NONE)) {
        munmap(made.begin, made.bytes);
        return NULL;
    }
    return array;
}

void guarded_destroy(void *memory)
{
    mapping made;
    if (TEST_SANITIZED) {
        free(memory);
        return;
    }
    memcpy(&made, (char *)memory - sizeof made, sizeof made);
    munmap(made.begin, made.bytes);
}
