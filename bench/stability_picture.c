/* The pictures of stability: what bounds the errors, who can be corrected, and what a solver's
 * author reads from it. */
#include "machine.h"
#include "plot.h"
#include "stability.h"

#include <stdio.h>

bool stability_draw(const struct stability *stability)
{
    static const char *const scripts[] = {"stability_ratios.gp", "stability_ranks.gp",
                                          "stability_reading.gp"};
    char given[256];
    snprintf(given, sizeof given, "support = '%g'\nmachine = \"%s\"\n", stability->settings.support,
             machine_cpu());
    for (int k = 0; k < 3; k++) {
        const char *const parts[] = {"stability_common.gp", scripts[k], NULL};
        if (!plot_draw(stability->output, scripts[k], given, parts))
            return false;
    }
    return true;
}
