/* SPDX-License-Identifier: MIT */
#include "names.h"
#include "numbers.h"
#include <stdarg.h>
#include <stdio.h>

const char *const precision_names[] = {"f32", "f64", "mixed", NULL};

const char *const kernel_names[] = {[SPHG_CUBIC_SPLINE] = "cubic",
                                    [SPHG_QUINTIC_SPLINE] = "quintic",
                                    [SPHG_WENDLAND_C2] = "wendland-c2",
                                    [SPHG_WENDLAND_C4] = "wendland-c4",
                                    [SPHG_WENDLAND_C6] = "wendland-c6",
                                    [SPHG_POLY6] = "poly6",
                                    [SPHG_SPIKY] = "spiky",
                                    NULL};

const char *const method_names[] = {[SPHG_KGC] = "KGC",
                                    [SPHG_MLS] = "MLS",
                                    [SPHG_RKPM] = "RKPM",
                                    [SPHG_CMLS] = "CMLS",
                                    [SPHG_CRKPM] = "CRKPM",
                                    [SPHG_PLAIN] = "SPH",
                                    NULL};

const char *const isa_names[] = {
    [SPHG_ISA_BEST] = "best",        [SPHG_ISA_BASE] = "baseline", [SPHG_ISA_X86_V3] = "x86-64-v3",
    [SPHG_ISA_X86_V4] = "x86-64-v4", [SPHG_ISA_NEON] = "neon",     NULL};

sphg_type position_type(enum precision precision)
{
    return precision == PRECISION_F32 ? SPHG_F32 : SPHG_F64;
}

sphg_type field_type(enum precision precision)
{
    return precision == PRECISION_F64 ? SPHG_F64 : SPHG_F32;
}

const char *text_of(const char *format, ...)
{
    va_list arguments;
    va_start(arguments, format);
    const size_t size = (size_t)vsnprintf(NULL, 0, format, arguments) + 1;
    va_end(arguments);
    char *text = allocate_to_the_end(1, size);
    va_start(arguments, format);
    vsnprintf(text, size, format, arguments);
    va_end(arguments);
    return text;
}

const char *text_grouped(int64_t value)
{
    return value < 1000 ? text_of("%d", (int)value)
                        : text_of("%s %03d", text_grouped(value / 1000), (int)(value % 1000));
}
