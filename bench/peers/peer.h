/* SPDX-License-Identifier: MIT */
/* A search by somebody else's library. */
#ifndef SPHGRAD_BENCH_PEER_H
#define SPHGRAD_BENCH_PEER_H
#include <stdint.h>
#ifdef __cplusplus
extern "C" {
#endif

const char *peer_name(void); /* with the version */

/* Lists of all pairs at less than `radius`, without the particle itself: offsets has count + 1
 * entries, indices room for `room`. Returns how many pairs there are. */
int64_t peer_search(const double (*positions)[3], int32_t count, double radius, int64_t *offsets,
                    int32_t *indices, int64_t room);

#ifdef __cplusplus
}
#endif
#endif
