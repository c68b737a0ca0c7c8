/* SPDX-License-Identifier: MIT */
/* What came of a run: measured over all ranks, printed beside the same run on one. */
#ifndef DISTRIBUTED_REPORT_H
#define DISTRIBUTED_REPORT_H
#include "drop.h"

struct least_most {
    double least, most;
};

struct placed {
    int32_t name;
    double x[3];
};

struct report {
    int rank_count, steps, settled;
    double seconds, waiting, settling; /* [s] a step, of the slowest rank */
    struct least_most own, ghosts;     /* particles a rank */
    double bytes, messages;            /* to ghosts, a rank and step: the most */
    double moved;                      /* particles that changed owners */
    double pairs;                      /* found when ghosts were last chosen, skin included */
    double angle, exact_angle;         /* [degree] turned about z */
    double radius;                     /* root mean square, beside that of the beginning */
    double momentum, spin;             /* change of momentum, of angular momentum; relative */
    struct placed *places;             /* by name; on rank 0 alone */
    int count;
};

/* Collective, after the run. */
struct report report_of(const struct drop *drop);
void report_free(struct report *report);

/* The largest distance of a particle from itself in the other run. */
double report_difference(const struct report *many, const struct report *one);

/* In two columns; and what is wrong, if anything: then it returns false. */
void table_print(const struct report *many, const struct report *one, double spacing);
bool table_judge(const struct report *many, const struct report *one, double spacing);

#endif
