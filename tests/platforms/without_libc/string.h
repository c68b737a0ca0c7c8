/* SPDX-License-Identifier: MIT */
/* What the public headers use of a C library, for a compiler whose own is not at hand. */
#ifndef SPHGRAD_WITHOUT_LIBC_STRING_H
#define SPHGRAD_WITHOUT_LIBC_STRING_H
#include <stddef.h>

#ifdef __cplusplus
extern "C" {
#endif
void *memset(void *to, int value, size_t count);
#ifdef __cplusplus
}
#endif

#endif
