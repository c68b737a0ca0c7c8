/* Arrays that end where a page begins that nobody may touch: reading behind them is a fault, with
 * no sanitizer at hand. */
#ifndef TESTS_SUPPORT_GUARDED_H
#define TESTS_SUPPORT_GUARDED_H
#include <stddef.h>

/* Zeroed; NULL: no memory. Under a sanitizer, which sees more, memory like any other. */
void *guarded_create(size_t bytes);
void guarded_destroy(void *memory);

#endif
