/* The pictures of stability: what bounds the errors, who can be corrected, and what a solver's
 * author reads from it. */
#include "report/machine.h"
#include "report/plot.h"
#include "stability.h"

#include <stdio.h>

bool stability_draw(const struct stability *stability)
{
    static const char *const scripts[] = {"ratios", "ranks", "reading"};
    char given[256];
    snprintf(given, sizeof given, "support = '%g'\nmachine = \"%s\"\n", stability->settings.support,
             machine_cpu());
    for (int k = 0; k < 3; k++) {
        char script[64], part[96];
        snprintf(script, sizeof script, "stability_%s.gp", scripts[k]);
        snprintf(part, sizeof part, "stability/%s", script);
        const char *const parts[] = {"stability/stability_common.gp", part, NULL};
        if (!plot_draw(stability->output, script, given, parts))
            return false;
    }
    return true;
}
