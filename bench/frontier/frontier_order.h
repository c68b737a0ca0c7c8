/* SPDX-License-Identifier: MIT */
#ifndef SPHGRAD_BENCH_FRONTIER_ORDER_H
#define SPHGRAD_BENCH_FRONTIER_ORDER_H
#include "settings.h"

/* Order 2 beside order 1, over H and N: measures, and adds the table. */
void frontier_order(const struct settings *settings);
#endif
