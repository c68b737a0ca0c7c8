/* SPDX-License-Identifier: MIT */
/* Which instruction sets this machine has. */
#ifndef SPHGI_CPU_H
#define SPHGI_CPU_H
#include "internal.h"

/* Compiled into this library and offered by processor and operating system. */
bool sphgi_cpu_has(sphg_isa isa);
sphg_isa sphgi_cpu_best(void);

#endif
