/* SPDX-License-Identifier: MIT */
/* What the targets of a batch bring: A_i, V_i, rho_i; and what they weigh as their own sources. */
#ifndef SPHGI_OWN_H
#define SPHGI_OWN_H
#include "worker.h"

/* Once a worker: which fields of targets stand in packed rows. */
void sphgi_find_targets_in_rows(struct sphgi_worker *worker);

/* A_i, V_i, rho_i of the targets at work, once a batch. */
void sphgi_load_targets(struct sphgi_worker *worker);

/* Of these V_i and rho_i alone. */
void sphgi_load_target_volumes(struct sphgi_worker *worker);

/* The host's arrays may have another order than the targets: what these will read and write there
 * comes while their pairs are summed. */
void sphgi_ask_for_targets(const struct sphgi_worker *worker, int32_t count,
                           const int32_t *targets);

/* The sources' A_j are taken to be A_i. */
bool sphgi_is_mirrored(const struct sphgi_worker *worker, const struct sphgi_field_plan *field);

/* V / H^d of the targets at work; notes volumes that are not valid. */
void sphgi_load_volume(struct sphgi_worker *worker, const struct sphgi_columns *columns, char *to);
/* The same in units of the target's own H^d. */
void sphgi_load_own_volume(struct sphgi_worker *worker, const struct sphgi_columns *columns,
                           char *to);

/* Classic: w_0 of targets that are sources, else 0; and G_ii = w_0 z_k[0], d lanes. */
void sphgi_self_weight(struct sphgi_worker *worker, char *to);
void sphgi_self_gradient(struct sphgi_worker *worker, char *gradient);

/* The targets are sources of this set, with the same values of the field. */
bool sphgi_are_targets_sources(const struct sphgi_sweep *sweep,
                               const struct sphgi_field_plan *field);

#endif
