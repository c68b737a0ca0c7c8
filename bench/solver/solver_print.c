/* Times of small matrices on a terminal and for machines. */
#include "report/report_json.h"
#include "solver.h"
#include "report/text.h"

#include <stdio.h>

static const char *const work_names[] = {"invert moments", "eigen", "SVD"};

static const char *precision_of(const struct solver_group *group)
{
    return group->type == SPHG_F64 ? "f64" : "f32";
}

static void print_time(const struct solver_group *group, const struct samples *samples)
{
    const double scale = 1e6 / group->count;
    char text[TEXT_SIZE] = "-";
    if (samples->count > 0) {
        const struct spread spread = samples_wall(samples);
        snprintf(text, sizeof text, "%.2f (%.2f-%.2f)", scale * spread.median, scale * spread.min,
                 scale * spread.max);
    }
    printf("%26s", text);
}

/* The worst path's. */
static double most(const double *values, const bool *available)
{
    double largest = 0;
    for (int path = 0; path < LIBRARY_PATHS; path++)
        if (available[path] && values[path] > largest)
            largest = values[path];
    return largest;
}

static void print_case(const struct solver *solver, const struct solver_group *group, int k)
{
    const struct solver_case *one = &solver_cases[k];
    const struct solver_result *result = &group->results[k];
    printf("  %-16s%-20s", work_names[one->work], one->what);
    if (one->spectrum == SOLVER_MOMENTS)
        printf("%8.2f", 100 * most(result->decomposed, solver->available));
    else
        printf("%8s", "-");
    if (one->spectrum == SOLVER_COPIED)
        print_time(group, &result->times[0]);
    for (int path = 0; path < LIBRARY_PATHS && one->spectrum != SOLVER_COPIED; path++)
        if (solver->available[path])
            print_time(group, &result->times[path]);
    if (one->spectrum != SOLVER_COPIED && one->share == 0)
        printf("%10.1e", most(result->deviation, solver->available));
    printf("\n");
}

static void print_group(const struct solver *solver, const struct solver_group *group)
{
    char count[TEXT_SIZE], title[2 * TEXT_SIZE];
    snprintf(title, sizeof title, "%dD, %s, %s matrices", (int)group->dimension,
             precision_of(group), text_grouped(group->count, count));
    printf("\n  %-36s%8s", title, "fell %");
    for (int path = 0; path < LIBRARY_PATHS; path++)
        if (solver->available[path])
            printf("%26s", library_path_name(path));
    printf("%10s\n", "off by");
    for (int k = 0; k < SOLVER_CASES; k++)
        if (solver_has(group, k))
            print_case(solver, group, k);
}

void solver_print(const struct solver *solver)
{
    const struct settings *settings = &solver->settings;
    printf("matrices   3 x 3 and 2 x 2, items packed; copy: their numbers moved from the input to "
           "the results,\n           no arithmetic; fell: share that the call sent to the "
           "decomposition\n");
    text_print_machine(settings->threads);
    printf("times      ns a matrix, median (min-max) of %d rounds through the cases and "
           "instruction sets of a group;\n           off by: C M - 1 of the certified, else "
           "what the factors miss of A, the largest entry over that of A\n",
           settings->repetitions);
    for (int g = 0; g < solver->group_count; g++)
        print_group(solver, &solver->groups[g]);
}

static void report_result(struct report *report, const struct solver_group *group, int k, int path)
{
    const struct solver_case *one = &solver_cases[k];
    const struct solver_result *result = &group->results[k];
    const struct samples *samples = &result->times[path];
    const bool copied = one->spectrum == SOLVER_COPIED;
    char name[160];
    if (samples->count == 0)
        return;
    const struct counter counters[] = {
        {"matrices", group->count},
        {"ns_per_matrix", 1e6 * samples_wall(samples).median / group->count},
        {"decomposed_percent", 100 * result->decomposed[path]},
        {"deviation", result->deviation[path]},
        {NULL, 0}};
    snprintf(name, sizeof name, "solver/%dD/%s/%d/%s/%s/%s", (int)group->dimension,
             precision_of(group), (int)group->count, work_names[one->work], one->what,
             copied ? "memcpy" : library_path_name(path));
    report_benchmark(report, name, samples, counters);
}

void solver_write_json(const struct solver *solver, const char *path, const char *executable)
{
    struct report *report = report_create(executable, solver->settings.threads);
    for (int g = 0; g < solver->group_count; g++)
        for (int k = 0; k < SOLVER_CASES; k++)
            for (int isa = 0; isa < LIBRARY_PATHS; isa++)
                report_result(report, &solver->groups[g], k, isa);
    report_write(report, path);
}
