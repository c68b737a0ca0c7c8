/* SPDX-License-Identifier: MIT */
/* What the command `skip` measures on: particles, neighbours of every kind, fields, outputs. */
#ifndef SPHGRAD_BENCH_SKIP_STAGE_H
#define SPHGRAD_BENCH_SKIP_STAGE_H
#include "library.h"
#include "settings.h"

enum { SKIP_FIELDS = 4, SKIP_PATTERNS = 8 };

/* A choice of targets, as mask and as list. */
struct pattern {
    uint8_t *mask;
    int32_t *indices, count;
    double share;
    int clustered; /* the middle of the cloud, else scattered */
};

struct outputs {
    struct numbers corrections, divergence, curl, jacobians[SKIP_FIELDS];
};

struct cloud {
    sphg_scheme scheme;
    struct numbers positions, moved; /* moved: each particle by less than half the skin */
    struct numbers fields[SKIP_FIELDS];
    struct outputs full, part; /* of the full evaluation, and of the part that is measured */
    sphg_neighbors *kept, *list_free, *skinned, *weighted, *rebuilt; /* weighted: keeps weights */
    sphg_neighbors_info info;                                        /* of kept */
};

struct skip_stage {
    sphg_context *context;
    struct cloud solid, plane;      /* 3D and 2D, with nearly as many pairs a particle */
    struct numbers volumes, volume; /* the same for all; volume: once */
    struct numbers corrections;     /* of the solid */
    struct pattern patterns[SKIP_PATTERNS];
    double skin;
    int positions_are_moved; /* in this round */
    int skin_was_spent;      /* a search with skin built its lists anew */
};

struct skip_stage skip_stage_create(const struct settings *settings);
void skip_stage_destroy(struct skip_stage *stage);
#endif
