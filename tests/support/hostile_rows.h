/* Every public function with its valid calls and the arguments of each. */
#ifndef TESTS_SUPPORT_HOSTILE_ROWS_H
#define TESTS_SUPPORT_HOSTILE_ROWS_H
#include "hostile.h"

typedef struct hostile_function {
    const char *name, *parameters; /* words between blanks */
    const probe *probes;
    int count;
} hostile_function;

extern const hostile_function hostile_functions[];
extern const int hostile_function_count;

#endif
