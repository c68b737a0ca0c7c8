/* Time. */
#ifndef SOLVER_STOPWATCH_H
#define SOLVER_STOPWATCH_H

double stopwatch_wall(void); /* [s] since some moment */

/* [s] that the calling thread has worked, so that other programs on a busy machine do not count.
 * While the library's threads work this one does, too, or waits for them awake. */
double stopwatch_now(void);
#endif
