/* SPDX-License-Identifier: MIT */
/* A target whose list comes in pieces: it is too long to be kept, or found as it is summed. */
#ifndef SPHGI_PIECES_H
#define SPHGI_PIECES_H
#include "worker.h"

/* begin; do { add ... } while (again); end. */
void sphgi_pieces_begin(struct sphgi_worker *worker);
void sphgi_pieces_add(struct sphgi_worker *worker, const uint32_t *ids, int32_t count);
bool sphgi_pieces_again(struct sphgi_worker *worker);
void sphgi_pieces_end(struct sphgi_worker *worker);

#endif
