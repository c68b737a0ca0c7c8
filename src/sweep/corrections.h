/* From the moments of a group to its corrections, or from the host's table; and what the targets
 * weigh as their own sources. */
#ifndef SPHGI_CORRECTIONS_H
#define SPHGI_CORRECTIONS_H
#include "worker.h"

/* worker->coefficients: from the sums, or from the table; writes what is wanted of them. */
void sphgi_finish_corrections(struct sphgi_worker *worker);
void sphgi_load_corrections(struct sphgi_worker *worker);

/* Numbers of a table, `width` lanes, in units of H; raw is used up. */
void sphgi_take_from_table(const struct sphgi_passes *passes, const struct sphgi_share *shares,
                           int32_t width, sphg_type type, char *raw, char *ours);

/* Rounds coefficients as a table would, so that both give the same bits; worker->raw: what a table
 * holds, if one is wanted. */
void sphgi_round_as_table(struct sphgi_worker *worker, char *coefficients, bool wanted);

/* V / H^d of the group's targets; notes volumes that are not valid. */
void sphgi_load_volume(struct sphgi_worker *worker, const struct sphgi_columns *columns, char *to);
/* The same in units of the target\'s own H^d. */
void sphgi_load_own_volume(struct sphgi_worker *worker, const struct sphgi_columns *columns,
                           char *to);

/* Classic: w_0 of targets that are sources, else 0; and G_ii = w_0 z_k[0], d lanes. */
void sphgi_self_weight(struct sphgi_worker *worker, char *to);
void sphgi_self_gradient(struct sphgi_worker *worker, char *gradient);

#endif
