/* The picture of scaling. */
#include "report/machine.h"
#include "report/plot.h"
#include "scaling.h"

#include <stdio.h>

bool scaling_draw(const struct scaling *scaling)
{
    const struct settings *settings = &scaling->settings;
    char given[512];
    snprintf(given, sizeof given,
             "title = \"%d particles, H = %g spacings, %d thread%s, %s, but for what a panel "
             "changes\"\nthreads = %d\n",
             settings->particles, settings->support, settings->threads,
             settings->threads > 1 ? "s" : "", machine_cpu(), settings->threads);
    static const char *const parts[] = {"scaling/scaling.gp", NULL};
    return plot_draw(scaling->output, "scaling.gp", given, parts);
}
