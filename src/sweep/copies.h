/* SPDX-License-Identifier: MIT */
/* Rows of a few sources, copied one by one where packing those of all would not pay. */
#ifndef SPHGI_COPIES_H
#define SPHGI_COPIES_H
#include "worker.h"

/* The ids, up to SPHGI_TILE, become those of copies from place `at` on, the dummy's where there is
 * no source; whose rows these are to be is noted. */
void sphgi_number_copies(const struct sphgi_worker *worker, struct sphgi_copies *copies,
                         uint32_t *ids, int32_t count, int32_t at);

/* Copies them, so that they can be read like packed ones. */
void sphgi_copy_rows(struct sphgi_worker *worker, const struct sphgi_copies *copies, int32_t at);

/* Both, for ids of one list. */
void sphgi_make_local(struct sphgi_worker *worker, uint32_t *ids, int32_t count, int32_t at);

/* What is far apart in memory should be on its way before the first of it is read: what is read
 * to number the rows behind ids `stride` apart, and what is copied once they are numbered. */
void sphgi_ask_for_numbering(const struct sphgi_worker *worker, const uint32_t *ids, int32_t count,
                             int32_t stride);
void sphgi_ask_for_copying(const struct sphgi_worker *worker, const struct sphgi_copies *copies);

#endif
