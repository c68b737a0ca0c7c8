/* SPDX-License-Identifier: MIT */
/* The pair arithmetic of KGC with the cubic spline, on a few targets whose pairs lie packed in the
 * first-level cache: what an evaluation costs when lists, staging and memory cost nothing. One
 * set of passes per instruction set. */
#ifndef SPHGRAD_BENCH_LIMIT_PASSES_H
#define SPHGRAD_BENCH_LIMIT_PASSES_H
#include <stdbool.h>
#include <stdint.h>

enum limit_work { LIMIT_MATRICES, LIMIT_GRADIENT, LIMIT_FUSED, LIMIT_WORKS };

enum {
    LIMIT_TARGETS = 16,   /* a whole number of vectors in every set */
    LIMIT_COMPONENTS = 7, /* of a pair: x y z (units of H), 6 sigma V/H^3, field a b c */
    LIMIT_OWN = 6,        /* of a target: x y z, field a b c */
    LIMIT_SUMS = 15,      /* xx xy xz yy yz zz, then the field's ax ay az bx by bz cx cy cz */
    LIMIT_LANES_MOST = 16
};

/* The faster one counts. Each lane is a target, and weights of all its pairs come before their
 * sums: lanes that are pairs of one target, and one loop for both, were slower everywhere. */
enum limit_root {
    LIMIT_SQUARE_ROOT /* and division */,
    LIMIT_NEWTON /* and estimate */,
    LIMIT_ROOTS
};

/* One thread's data; group: as many targets as lanes. Pairs beyond a target's own have volume 0. */
struct limit_data {
    int32_t slots;      /* pairs of a target */
    float *pairs;       /* [group][slot][component][lane] */
    float *own;         /* [group][own][lane] */
    float *corrections; /* [group][6][lane] */
    float *weights;     /* room for [slot][lane] */
    float *sums;        /* [sum][lane] */
    float *results;     /* [group][15][lane]: C, then J */
};

struct limit_set {
    const char *name;
    int32_t lanes;
    /* Goes through so many targets, round and round. finished: C is inverted or J = B C formed, and
     * left in results; else sums stay where they are. */
    void (*run)(const struct limit_data *data, enum limit_work work, enum limit_root root,
                bool finished, int32_t targets);
};

enum { LIMIT_SETS_MOST = 3 };
extern const struct limit_set limit_set_base, limit_set_v3, limit_set_v4;
#endif
