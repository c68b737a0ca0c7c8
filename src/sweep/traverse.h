/* SPDX-License-Identifier: MIT */
/* The tasks of a sweep: they walk over targets and hand groups of them to a worker. */
#ifndef SPHGI_TRAVERSE_H
#define SPHGI_TRAVERSE_H
#include "selection.h"
#include "worker.h"

struct sphgi_task {
    struct sphgi_sweep sweep;
    const struct sphgi_selection *selection;
};

/* sphg_task functions; data: struct sphgi_task. */
void sphgi_group_task(void *data, int32_t begin, int32_t end, int32_t worker); /* groups */
void sphgi_list_task(void *data, int32_t begin, int32_t end, int32_t worker);  /* selected items */

#endif
