/* SPDX-License-Identifier: MIT */
/* A function that knows its kernel, compiled once for each of them, and the one that takes that of
 * `shape`. A list of kernels cannot hand such things on, so they are defined before it is included:
 *   BY_KERNEL      the function's name
 *   PARAMETERS     its parameters, in parentheses; one of them is `shape`
 *   ARGUMENTS      their names, in parentheses
 *   CALL(kernel)   what it does */

#define JOINED_(a, b) a##_##b
#define JOINED(a, b)  JOINED_(a, b)

#define INSTANCE(name, prefix, sigma2, sigma3, mu2_2, mu2_3)                                       \
    static void JOINED(BY_KERNEL, prefix) PARAMETERS                                               \
    {                                                                                              \
        CALL(SPHG_##name);                                                                         \
    }
SPHGI_KERNELS(INSTANCE)
#undef INSTANCE

static void BY_KERNEL PARAMETERS
{
    static void(*const instance[]) PARAMETERS = {
#define ENTRY(name, prefix, sigma2, sigma3, mu2_2, mu2_3) [SPHG_##name] = JOINED(BY_KERNEL, prefix),
        SPHGI_KERNELS(ENTRY)
#undef ENTRY
    };
    instance[shape->kernel] ARGUMENTS;
}

#undef JOINED
#undef JOINED_
#undef BY_KERNEL
#undef PARAMETERS
#undef ARGUMENTS
#undef CALL
