/* SPDX-License-Identifier: MIT */
/* Tables of corrections: from the coefficients of a batch to the numbers of the host, and back. */
#ifndef SPHGI_TABLE_H
#define SPHGI_TABLE_H
#include "worker.h"

/* worker->coefficients from the host's table, or from the one that this call made. */
void sphgi_load_corrections(struct sphgi_worker *worker);

/* worker->raw into the host's table, if there is one. */
void sphgi_store_table(struct sphgi_worker *worker);

/* Numbers of a table, `width` lanes, in units of H; raw is used up. */
void sphgi_take_from_table(const struct sphgi_passes *passes, const struct sphgi_table_unit *units,
                           int32_t width, sphg_type type, char *raw, char *ours);

/* Rounds coefficients as a table would, so that both give the same bits; worker->raw: what a table
 * holds, if one is wanted. */
void sphgi_round_as_table(struct sphgi_worker *worker, char *coefficients, bool wanted);

#endif
