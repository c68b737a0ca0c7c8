/* SPDX-License-Identifier: MIT */
/* What precisions, kernels and methods are called on the command line and in tables; other texts.
 */
#ifndef SPHGRAD_BENCH_NAMES_H
#define SPHGRAD_BENCH_NAMES_H
#include <sphgrad/sphgrad.h>

enum precision {
    PRECISION_F32,
    PRECISION_F64,
    PRECISION_MIXED /* positions f64, fields and results f32 */
};

/* NULL-terminated, indexed by the value. */
extern const char *const precision_names[];
extern const char *const kernel_names[]; /* as typed */
extern const char *const method_names[]; /* as in the paper's tables */
extern const char *const isa_names[];

sphg_type position_type(enum precision precision);
sphg_type field_type(enum precision precision);

/* These last to the end of the program. */
__attribute__((format(printf, 1, 2))) const char *text_of(const char *format, ...);
const char *text_grouped(int64_t value); /* 1234567 as "1 234 567" */
#endif
