/* SPDX-License-Identifier: MIT */
#include "time_step.h"
#include <math.h>

double time_step(const struct particles *particles, double spacing, double most)
{
    const double fastest = particles_fastest(particles);
    const double step = fastest > 0 ? 0.4 * spacing / fastest : most;
    return fmax(0.01 * most, fmin(step, most));
}
