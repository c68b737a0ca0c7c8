/* The pictures of the command `fields`: scripts for gnuplot, left beside the data so that they can
 * be changed and run again. */
#include "fields.h"
#include "report/plot.h"

#include <stdio.h>

/* Three panels of a field, or, without a quantity, convergence. */
struct picture {
    const char *name, *quantity;
    enum study_field field;
};

static const struct picture pictures[] = {
    {"fields_rotation", "gradient", FIELD_ROTATION},
    {"fields_trigonometric", "gradient", FIELD_TRIGONOMETRIC},
    {"fields_curl", "curl", FIELD_ROTATION},
    {"fields_convergence", NULL, FIELD_TRIGONOMETRIC},
};

static bool draw(const char *directory, const struct lattice_results *results,
                 const struct picture *picture)
{
    const struct study_setting *setting = &results->setting;
    const char *ending = setting->jitter > 0 ? "_jittered" : "";
    const char *const parts[] = {
        "fields/fields_common.gp",
        picture->quantity ? "fields/fields_panels.gp" : "fields/fields_convergence.gp", NULL};
    char script[64], given[512];
    snprintf(script, sizeof script, "%s%s.gp", picture->name, ending);
    snprintf(given, sizeof given,
             "output = '%s%s.png'\nfield = '%s'\nformula = '%s'\nlattice = '%s'\n"
             "support = '%g'\nkernel = '%s'\nprecision = '%s'\nside = %d\nquantity = '%s'\n",
             picture->name, ending, study_field_name(picture->field),
             study_field_formula(picture->field), results->name, setting->support,
             kernel_title(setting->kernel), precision_names[setting->precision], setting->side,
             picture->quantity ? picture->quantity : "");
    return plot_draw(directory, script, given, parts);
}

bool fields_draw(const char *directory, const struct lattice_results results[2])
{
    for (int lattice = 0; lattice < 2; lattice++)
        for (size_t k = 0; k < sizeof pictures / sizeof pictures[0]; k++)
            if (!draw(directory, &results[lattice], &pictures[k]))
                return false;
    return true;
}
