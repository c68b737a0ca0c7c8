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

/* An sphg_task function; data: struct sphgi_task. A range of groups. */
void sphgi_group_task(void *data, int32_t begin, int32_t end, int32_t worker);

#endif
