/* SPDX-License-Identifier: MIT */
/* What the columns of a table hold, told from the names that solvers and viewers give them. */
#ifndef SHARED_TABLES_COLUMN_NAMES_H
#define SHARED_TABLES_COLUMN_NAMES_H
#include "cells.h"

enum quantity {
    QUANTITY_X,
    QUANTITY_Y,
    QUANTITY_Z,
    QUANTITY_VX,
    QUANTITY_VY,
    QUANTITY_VZ,
    QUANTITY_DENSITY,
    QUANTITY_MASS,
    QUANTITY_VOLUME,
    QUANTITIES
};

/* The column of each quantity; -1: there is none. Positions have two axes or three, velocities
 * those of the positions or none. false: two columns of the same name could be meant, `twice` of
 * them the second; or there are no positions, `twice` is -1. */
bool columns_find(const struct cells *names, int32_t columns[QUANTITIES], int32_t *twice);
#endif
