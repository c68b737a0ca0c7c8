/* SPDX-License-Identifier: MIT */
/* Every public function with its valid calls and the arguments of each. */
#ifndef TESTS_SUPPORT_BAD_ARGUMENT_ROWS_H
#define TESTS_SUPPORT_BAD_ARGUMENT_ROWS_H
#include "bad_arguments.h"

typedef struct argument_function {
    const char *name, *parameters; /* words between blanks */
    const probe *probes;
    int count;
} argument_function;

extern const argument_function argument_functions[];
extern const int argument_function_count;

#endif
