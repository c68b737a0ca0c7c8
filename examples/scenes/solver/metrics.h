/* SPDX-License-Identifier: MIT */
/* What a run came to, as named numbers, and the bounds that are put on them. */
#ifndef SOLVER_METRICS_H
#define SOLVER_METRICS_H
#include "options.h"

enum { METRICS_MOST = 48 };

struct metrics {
    int32_t count; /* 0: this method was not run */
    struct {
        const char *name; /* of static storage */
        double value;
    } items[METRICS_MOST];
};

void metrics_set(struct metrics *metrics, const char *name, double value);

/* Ends the program where there is no such name: a gate on nothing would never fail. */
double metrics_get(const struct metrics *metrics, const char *name);

/* One line of JSON on stdout. */
void metrics_print(const struct options *options, enum method method,
                   const struct metrics *metrics);

enum who { ONLY_SPH, ONLY_KGC, EACH_CORRECTED };
enum relation {
    AT_MOST,       /* value <= bound */
    AT_LEAST,      /* value >= bound */
    SHARE_OF_SPH,  /* value <= bound * the same of SPH */
    TIMES_SPH,     /* value >= bound * the same of SPH */
    MORE_THAN_SPH, /* value >= bound + the same of SPH */
};

/* A table of gates ends with a name of NULL. */
struct gate {
    const char *name;
    enum who who;
    enum relation relation;
    double bound;
};

/* Compares all runs that were made and prints a line per gate. true: all hold, and there are some.
 * Brief runs are compared with the gates on what they have measured. */
bool gates_hold(const struct options *options, const struct gate *gates,
                const struct metrics runs[METHOD_COUNT]);
#endif
