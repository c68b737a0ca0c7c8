/* SPDX-License-Identifier: MIT */
/* Time. */
#ifndef SOLVER_STOPWATCH_H
#define SOLVER_STOPWATCH_H

double stopwatch_wall(void); /* [s] since some moment */

/* [s] that the threads of this program have worked, all together, so that other programs on a busy
 * machine do not count. Waiting counts where threads wait awake: OMP_WAIT_POLICY=passive. */
double stopwatch_now(void);
#endif
