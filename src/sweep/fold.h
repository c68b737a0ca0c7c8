/* SPDX-License-Identifier: MIT */
/* Terms of the sources that are multiplied out once a particle: b_j = weight_j C_j A_j. */
#ifndef SPHGI_FOLD_H
#define SPHGI_FOLD_H
#include "worker.h"

/* Numbers of b_j and what is carried behind it. */
int32_t sphgi_numbers_folded(const struct sphgi_plan *plan, const struct sphgi_field_plan *field);

/* What a source's term is multiplied with in the adjoint (symmetric false) or symmetric form. */
enum sphgi_weight sphgi_source_weight(const struct sphgi_plan *plan, bool symmetric);

/* Rows of b_j, and of what is carried behind it, of the sources order[begin] to order[end - 1] of
 * the host; order NULL: of `begin` and so on themselves. They stand at `to`; each further array of
 * rows `array` bytes behind. False: a volume is negative or not finite. */
bool sphgi_fold_rows(const struct sphgi_sweep *sweep, const struct sphgi_field_plan *field,
                     const int32_t *order, int64_t begin, int64_t end, char *to, size_t array);

/* The same where b_j are in records of `width` numbers; to: the first one's b_j. */
bool sphgi_fold_records(const struct sphgi_sweep *sweep, const struct sphgi_field_plan *field,
                        const int32_t *order, int64_t begin, int64_t end, char *to, int32_t width);

#endif
