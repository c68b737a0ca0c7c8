/* SPDX-License-Identifier: MIT */
/* Run time against error of every way to a velocity gradient: what is measured and reported. */
#ifndef SPHGRAD_BENCH_FRONTIER_H
#define SPHGRAD_BENCH_FRONTIER_H
#include "report/report.h"

enum frontier_path { PATH_KEPT, PATH_LIST_FREE, PATH_HOST_LISTS, PATHS };
enum frontier_field { FRONTIER_TRIGONOMETRIC, FRONTIER_LINEAR, FRONTIER_FIELDS };

enum { FRONTIER_METHODS = 6, FRONTIER_KERNELS = 7, FRONTIER_PRECISIONS = 3 };

/* One way. */
struct frontier_point {
    sphg_method method;
    sphg_kernel kernel;
    enum precision precision;
    enum frontier_path path;
    bool by_table;       /* matrices first, then the gradient by their table; else in one sweep */
    struct samples time; /* [ms] search or taking over lists, matrices, gradient */
    /* |J_i - J|_F over the root mean square of |J|_F, over all particles. */
    double mean[FRONTIER_FIELDS], most[FRONTIER_FIELDS];
    bool on_frontier[FRONTIER_FIELDS]; /* nothing of its side is as fast and as accurate */
};

struct frontier {
    struct settings settings;
    int32_t count; /* particles */
    double pairs;  /* a particle */
    int point_count;
    struct frontier_point *points;
};

/* The field's mean error for the trigonometric field, its largest for the linear one. */
double frontier_error(const struct frontier_point *point, enum frontier_field field);

/* Ways that search for themselves and ways over lists of the host, who searched, do not compete:
 * each side has a frontier of its own. */
enum frontier_side { SIDE_SEARCH, SIDE_HOST, SIDES };
enum frontier_side frontier_side(const struct frontier_point *point);

/* Leaves the points in the order of their times, the fastest first. */
void frontier_measure(struct frontier *frontier);

/* Order 2 beside order 1: measures over H and N, prints, writes and draws. */
void frontier_order(const struct settings *settings, struct report *report);
#endif
