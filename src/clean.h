/* The host's numbers of sources become ids of rows that can be read. */
#ifndef SPHGI_CLEAN_H
#define SPHGI_CLEAN_H
#include "worker.h"

/* Drops the target itself and what is no source, which is noted; returns how many numbers are left,
 * packed into `clean`. */
int32_t sphgi_clean_list(struct sphgi_worker *worker, int32_t target, const int32_t *list,
                         int32_t count, uint32_t *clean);

/* The lists of a whole piece, each into its place: what is dropped there becomes the dummy. */
void sphgi_clean_piece(struct sphgi_worker *worker);

/* Copies rows, so that they can be read like staged ones, to place `at` on; their numbers become
 * those of the copies. */
void sphgi_make_local(struct sphgi_worker *worker, uint32_t *rows, int32_t count, int32_t at);

#endif
