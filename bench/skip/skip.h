/* SPDX-License-Identifier: MIT */
/* What it saves not to compute what a scene does not need: what is measured. */
#ifndef SPHGRAD_BENCH_SKIP_H
#define SPHGRAD_BENCH_SKIP_H
#include "report/timing.h"
#include "settings.h"

/* Bits: what is asked for. */
enum { ASK_MATRICES = 1, ASK_JACOBIAN = 2, ASK_DIVERGENCE = 4, ASK_CURL = 8 };

/* Whose neighbours are asked. */
enum skip_neighbors {
    NEIGHBORS_KEPT,     /* found before */
    NEIGHBORS_WEIGHTED, /* the same, with weights */
    NEIGHBORS_PLANE,    /* the same in 2D: as many particles and nearly as many pairs */
    NEIGHBORS_REBUILT,  /* this one and those below: found on the way */
    NEIGHBORS_LIST_FREE,
    NEIGHBORS_SKINNED, /* with a skin of 0.1 H */
    NEIGHBOR_KINDS
};

/* A second source set: three layers around the cube. */
enum skip_wall {
    WALL_NONE,
    WALL_APART,     /* searched with the particles handed over as targets */
    WALL_TARGETS_OF /* ... with those of the particles' own neighbours */
};

/* An evaluation. */
struct skip_ask {
    int outputs;
    enum skip_neighbors neighbors;
    bool moved;      /* particles where they are in this round, less than half a skin away */
    bool by_table;   /* with matrices that are there */
    bool one_volume; /* for all, else an array */
    bool decomposed; /* as if no matrix were certified */
    int fields;      /* 0: one */
    bool one_by_one; /* a call for each of them */
    double share;    /* of active targets; 0: all */
    bool clustered;  /* in the middle, else scattered */
    enum skip_wall wall;
};

struct skip_row {
    const char *group, *what, *against;
    bool listed; /* active targets, else masked */
    struct skip_ask part, full;
};
bool skip_is_compared(const struct skip_row *row); /* else it is another problem */

struct skip_result {
    double deviation;    /* 0: same bits; else the largest |part - full|_F / |full|_F of a target */
    int64_t differences; /* targets whose bits differ */
};

enum { SKIP_ROWS = 29 };
extern const struct skip_row skip_rows[SKIP_ROWS];

struct skip {
    struct settings settings;
    int32_t count;
    double pairs, plane_pairs;
    bool skin_was_spent; /* a search with skin built its lists anew */
    struct skip_result results[SKIP_ROWS];
    struct samples times[SKIP_ROWS][2]; /* of the full evaluation, and of the part */
};

void skip_measure(struct skip *skip);
#endif
