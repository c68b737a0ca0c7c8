/* SPDX-License-Identifier: MIT */
/* The context: the host's hooks, the chosen passes, scratch memory, the last message. */
#ifndef SPHGI_CONTEXT_H
#define SPHGI_CONTEXT_H
#include "float_environment.h"
#include "memory.h"
#include "passes/passes.h"
#include <stdatomic.h>

enum { SPHGI_MESSAGE_LENGTH = 256 };

struct sphg_context {
    sphg_config config;
    struct sphgi_allocator allocator;
    int32_t threads;
    sphg_isa isa;
    const struct sphgi_passes *passes_f32, *passes_f64;
    uint64_t pack_order[256]; /* of each byte: the positions of its set bits, a byte each */
    _Alignas(16) uint8_t pack_bytes[256][16]; /* the same for items of two bytes */
    atomic_flag busy;
    struct sphgi_floats host_floats; /* of the thread whose call is under way */
    char message[SPHGI_MESSAGE_LENGTH];
    /* Scratch that outlives a call only to spare the next one its allocation. */
    struct sphgi_buffer workers;       /* a slice per thread */
    struct sphgi_buffer packed;        /* rows of fields and volumes in storage order */
    struct sphgi_buffer sums;          /* of several source sets */
    struct sphgi_buffer marks;         /* a byte a target: has it any there? */
    struct sphgi_buffer waits;         /* ... had it any, at the first step? */
    struct sphgi_buffer coefficients;  /* corrections computed for a second sweep */
    struct sphgi_buffer selection;     /* active targets and the groups that hold them */
    struct sphgi_buffer input;         /* positions as rows, in the order of the host */
    struct sphgi_buffer sort;          /* of the grid */
    struct sphgi_buffer plan;          /* of a request */
    struct sphgi_buffer order_grid[4]; /* of sphg_neighbors_get_order() for the host's lists */
};

/* Fills a new one, but for `threads`. The configuration was checked. */
void sphgi_context_open(sphg_context *context, const sphg_config *config);

const struct sphgi_passes *sphgi_passes_of(const sphg_context *context, sphg_type type);

/* A call begins: refuses a context in use, and sets the default floating-point environment. Every
 * sphgi_enter() that gave SPHG_OK needs a leave, which puts the host's back. */
sphg_result sphgi_enter(sphg_context *context);
sphg_result sphgi_leave(sphg_context *context, sphg_result result);

/* Tells the host's log. */
void sphgi_report(const sphg_config *config, sphg_result result, const char *message);

/* Notes what was objected to, tells the host's log, returns result. */
SPHGI_FORMAT(3, 4)
sphg_result sphgi_fail(sphg_context *context, sphg_result result, const char *format, ...);

/* Memory failures all read alike: who asked, and for how much. */
sphg_result sphgi_fail_memory(sphg_context *context, const char *function);

#endif
