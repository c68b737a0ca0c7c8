/* SPDX-License-Identifier: MIT */
/* Borrowed curvature (theory.md, section 9): what targets lend, and what they take from lenders. */
#ifndef SPHGI_BORROW_H
#define SPHGI_BORROW_H
#include "worker.h"

/* Of a field, from the tile into the sums. */
void sphgi_sum_lent(struct sphgi_worker *worker, const struct sphgi_field_plan *field);

/* With the linear corrections at hand: what the whole ones are to note for lenders and borrowers.
 */
struct sphgi_borrowing sphgi_before_borrowing(struct sphgi_worker *worker, const void *scale);

/* Corrections of a field that borrows: they depend on what it is lent. */
const char *sphgi_invert_borrowing(struct sphgi_worker *worker,
                                   const struct sphgi_field_plan *field);
void sphgi_add_borrowed(struct sphgi_worker *worker, const struct sphgi_field_plan *field,
                        char *laplacian);

/* The views that lend, and who would borrow. */
void sphgi_store_lent(struct sphgi_worker *worker, const struct sphgi_field_plan *field);
void sphgi_store_borrows(struct sphgi_worker *worker);

#endif
