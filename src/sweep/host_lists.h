/* SPDX-License-Identifier: MIT */
/* Lists of the host that are borrowed: from its arrays to batches. */
#ifndef SPHGI_HOST_LISTS_H
#define SPHGI_HOST_LISTS_H
#include "traverse.h"

/* An sphg_task function; data: struct sphgi_task. A range of selected items. */
void sphgi_list_task(void *data, int32_t begin, int32_t end, int32_t worker);

#endif
