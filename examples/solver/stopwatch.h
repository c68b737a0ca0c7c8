/* Wall-clock time. */
#ifndef SOLVER_STOPWATCH_H
#define SOLVER_STOPWATCH_H

double stopwatch_now(void); /* [s] since some moment */
#endif
