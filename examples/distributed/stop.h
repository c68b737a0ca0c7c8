/* SPDX-License-Identifier: MIT */
/* The one way out when something is wrong: all ranks end. */
#ifndef DISTRIBUTED_STOP_H
#define DISTRIBUTED_STOP_H
#include <stddef.h>

_Noreturn void stop(const char *why);

/* As realloc, for `count` items, and never NULL. */
void *resized(void *memory, size_t count, size_t size);

#endif
