/* SPDX-License-Identifier: MIT */
/* Time of the operators that a solver iterates: forces and divergences, with lists alone and with
 * weights that neighbours keep. */
#ifndef SPHGRAD_BENCH_FORCES_H
#define SPHGRAD_BENCH_FORCES_H
#include "report/timing.h"
#include "settings.h"

struct force_case {
    const char *name;
    sphg_method method;
    sphg_form form;
    sphg_shape shape;
    bool divergence; /* of a vector; else the gradient, of a tensor its divergence */
};

enum { FORCE_CASES = 11, FORCE_SUPPLIES = 2 /* lists; lists and weights */ };
extern const struct force_case force_cases[FORCE_CASES];

/* Errors: of adjoint and symmetric forms, whose results add up to zero, |sum f| / sum |f|; of
 * differences the largest relative error of a linear field's divergence. */
struct forces {
    struct settings settings;
    int32_t count;
    double pairs; /* a particle */
    struct samples times[FORCE_CASES][FORCE_SUPPLIES];
    double error[FORCE_CASES];
};

void forces_measure(struct forces *forces);
#endif
