/* SPDX-License-Identifier: MIT */
/* Builds: positions in, and who is near whom, found by a search or told by the host. */
#ifndef SPHGI_BUILD_H
#define SPHGI_BUILD_H
#include "core/check.h"
#include "neighbors.h"

/* The two ways to build, from arguments that were checked. What fails before the old state is given
 * up leaves it as it was (any refusal); after a failed allocation the object is to be built again.
 */
sphg_result sphgi_build_by_search(struct sphgi_checker checker, sphg_neighbors *neighbors,
                                  const struct sphgi_scheme *checked, const sphg_geometry *given);
sphg_result sphgi_build_on_lists(struct sphgi_checker checker, sphg_neighbors *neighbors,
                                 const struct sphgi_scheme *scheme, const sphg_geometry *given,
                                 const sphg_lists *lists);

/* Whether that search would give up the pairs that the object holds. */
sphg_result sphgi_would_rebuild(struct sphgi_checker checker, const sphg_neighbors *neighbors,
                                const struct sphgi_scheme *checked, const sphg_geometry *given,
                                int32_t *rebuild);

#endif
