/* SPDX-License-Identifier: MIT */
/* Put in front of every file by tests/run --analyse: what an analyser that sees one file at a time
 * cannot know of the others. Nothing that fails returns SPHG_OK; what was reserved is there. */
#include "core/check.h"
#include "core/context.h"

#define sphgi_fail(context, result, ...)                                                           \
    ((void)(sphgi_fail)(context, result, __VA_ARGS__), (result))
#define sphgi_fail_memory(context, function)                                                       \
    ((void)(sphgi_fail_memory)(context, function), SPHG_ERROR_MEMORY)
#define sphgi_check_pointer(checker, pointer, name)                                                \
    ((pointer) ? SPHG_OK                                                                           \
               : ((void)(sphgi_check_pointer)(checker, pointer, name), SPHG_ERROR_ARGUMENT))
#define sphgi_reserve(allocator, buffer, count, item_size)                                         \
    ((sphgi_reserve)(allocator, buffer, count, item_size) && (buffer)->data)
