/* SPDX-License-Identifier: MIT */
/* What the fuzz targets share: numbers from bytes, and a requirement that ends the process. A
 * target is LLVMFuzzerTestOneInput(); libFuzzer or replay.c brings main(). */
#ifndef TESTS_FUZZ_FUZZ_H
#define TESTS_FUZZ_FUZZ_H
#include <float.h>
#include <math.h>
#include <sphgrad/sphgrad.h>
#include <stdio.h>
#include <stdlib.h>
#include <string.h>

int LLVMFuzzerTestOneInput(const uint8_t *data, size_t size);

#define FUZZ_REQUIRE(condition, ...)                                                               \
    do {                                                                                           \
        if (!(condition)) {                                                                        \
            fprintf(stderr, "%s:%d: ", __FILE__, __LINE__);                                        \
            fprintf(stderr, __VA_ARGS__);                                                          \
            fputc('\n', stderr);                                                                   \
            abort();                                                                               \
        }                                                                                          \
    } while (0)

typedef struct fuzz_bytes {
    const uint8_t *at;
    size_t left;
} fuzz_bytes;

/* 0 behind the end. */
static inline int fuzz_byte(fuzz_bytes *from)
{
    if (!from->left)
        return 0;
    --from->left;
    return *from->at++;
}

/* Byte by byte: GCC 12 makes a copy of what may be no byte at all one of the byte before. */
static inline void fuzz_take(fuzz_bytes *from, void *to, size_t size)
{
    for (size_t k = 0; k < size; ++k)
        ((uint8_t *)to)[k] = (uint8_t)fuzz_byte(from);
}

/* In [0, count), count up to 65536. */
static inline int fuzz_below(fuzz_bytes *from, int count)
{
    const int high = count > 256 ? fuzz_byte(from) : 0;
    return (256 * high + fuzz_byte(from)) % count;
}

/* Multiples of 1/16, mostly; now and then what arithmetic stumbles over. */
static inline double fuzz_real(fuzz_bytes *from)
{
    static const double special[] = {
        0,       -0.0,         1,        NAN,  INFINITY, -INFINITY,    FLT_MAX, FLT_MIN, 0x1p-149,
        DBL_MAX, DBL_TRUE_MIN, -FLT_MAX, 1e30, -1e30,    0x1.fffffep0, 1e-30};
    const int kind = fuzz_byte(from);
    if (kind == 255) {
        double raw;
        fuzz_take(from, &raw, sizeof raw);
        return raw;
    }
    if (kind == 254) {
        float raw;
        fuzz_take(from, &raw, sizeof raw);
        return (double)raw;
    }
    if (kind >= 238)
        return special[kind - 238];
    return (fuzz_byte(from) - 128) / 16. + kind % 4 * 0x1p-20;
}

/* Multiples of 1/16 only. */
static inline double fuzz_tame(fuzz_bytes *from)
{
    return (fuzz_byte(from) - 128) / 16.;
}

/* A number of the array's precision. */
static inline void fuzz_put(sphg_type type, void *array, int place, double value)
{
    if (type == SPHG_F64)
        ((double *)array)[place] = value;
    else
        ((float *)array)[place] = fabs(value) > (double)FLT_MAX && isfinite(value)
                                      ? (value < 0 ? -FLT_MAX : FLT_MAX)
                                      : (float)value;
}

static inline double fuzz_get(sphg_type type, const void *array, int place)
{
    return type == SPHG_F64 ? ((const double *)array)[place]
                            : (double)((const float *)array)[place];
}

static inline sphg_view fuzz_view(sphg_type type, const void *array, int width)
{
    const sphg_view view = {array, NULL,         NULL, width * (type == SPHG_F64 ? 8 : 4),
                            type,  SPHG_AS_SHAPE};
    return view;
}

/* The baseline and the best of this machine in turn: the number of bytes decides, so an input keeps
 * its instruction set. */
static inline sphg_isa fuzz_isa(size_t size)
{
    return size % 2 ? SPHG_ISA_BASE : SPHG_ISA_BEST;
}

/* What outlives an input of so many bytes: a context of its instruction set, and neighbours. */
typedef struct fuzz_instance {
    sphg_context *context;
    sphg_neighbors *neighbors;
} fuzz_instance;

static inline const fuzz_instance *fuzz_instance_for(size_t size)
{
    static fuzz_instance instances[2];
    fuzz_instance *own = &instances[size % 2];
    const sphg_config config = {.threads = 1, .isa = fuzz_isa(size)};
    if (!own->context)
        FUZZ_REQUIRE(sphg_context_create(SPHG_VERSION, &config, &own->context) == SPHG_OK &&
                         sphg_neighbors_create(own->context, &own->neighbors) == SPHG_OK,
                     "no context");
    return own;
}

#endif
