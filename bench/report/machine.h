/* SPDX-License-Identifier: MIT */
/* What this machine is and how the program was built. */
#ifndef SPHGRAD_BENCH_MACHINE_H
#define SPHGRAD_BENCH_MACHINE_H
#include <stdint.h>

const char *machine_cpu(void);
const char *machine_host(void);
const char *machine_date(void); /* ISO 8601, local time with offset */
const char *machine_compiler(void);
const char *machine_build(void); /* "release" or "debug" */
int32_t machine_cpus(void);      /* this process may run on */
int32_t machine_threads(void);   /* that the library uses if nothing is said */
#endif
