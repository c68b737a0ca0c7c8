/* SPDX-License-Identifier: MIT */
/* What it saves not to compute what a scene does not need: what is measured and reported. */
#ifndef SPHGRAD_BENCH_SKIP_H
#define SPHGRAD_BENCH_SKIP_H
#include "skip_stage.h"
#include "report/timing.h"

/* Bits: which outputs of a part must be those of the full evaluation. */
enum {
    COMPARE_CORRECTIONS = 1,
    COMPARE_JACOBIAN = 2,
    COMPARE_DIVERGENCE = 4,
    COMPARE_CURL = 8,
    COMPARE_ALL_FIELDS = 16
};

typedef void skip_action(struct skip_stage *stage, struct outputs *outputs, int parameter);

struct skip_row {
    const char *group, *what, *against;
    skip_action *part, *full;
    int parameter; /* of part */
    int compared;  /* 0: another problem, nothing to compare */
    int pattern;   /* compare its targets only; -1: all */
};

struct skip_result {
    struct samples part, full;
    double deviation;    /* 0: same bits; else the largest |part - full|_F / |full|_F of a target */
    int64_t differences; /* targets whose bits differ */
};

extern const struct skip_row skip_rows[];
extern const int skip_row_count;

struct skip {
    struct settings settings;
    int32_t count;
    double pairs, plane_pairs;
    int skin_was_spent;
    struct skip_result *results;
};
#endif
