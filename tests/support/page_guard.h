/* SPDX-License-Identifier: MIT */
/* Arrays that end where a page begins that nobody may touch: reading behind them is a fault, with
 * no sanitizer at hand. */
#ifndef TESTS_SUPPORT_PAGE_GUARD_H
#define TESTS_SUPPORT_PAGE_GUARD_H
#include <stddef.h>

/* Zeroed; NULL: no memory. Under a sanitizer, which sees more, memory like any other. */
void *page_guard_create(size_t bytes);
void page_guard_destroy(void *memory);

#endif
