/* The picture of frontier. */
#include "frontier.h"
#include "report/machine.h"
#include "report/plot.h"

#include <stdio.h>

bool frontier_draw(const struct frontier *frontier)
{
    const struct settings *settings = &frontier->settings;
    char given[256];
    snprintf(given, sizeof given, "title = \"%d particles, H = %g spacings, %d thread%s, %s\"\n",
             frontier->count, settings->support, settings->threads,
             settings->threads > 1 ? "s" : "", machine_cpu());
    static const char *const parts[] = {"frontier/frontier.gp", NULL};
    return plot_draw(frontier->output, "frontier.gp", given, parts);
}
