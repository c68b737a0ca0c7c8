/* SPDX-License-Identifier: MIT */
/* A library of some host, linked with -ffast-math: GCC up to version 12 (and Clang) then have
 * denormals flushed in every process that loads it, from the loading thread on. */
int fast_math_host(void);

int fast_math_host(void)
{
    return 1;
}
