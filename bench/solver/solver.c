/* SPDX-License-Identifier: MIT */
/* The command `solver`. */
#include "solver.h"
#include "commands.h"
#include "report/report.h"
#include <stdio.h>
#include <stdlib.h>

static void find_paths(struct solver *solver)
{
    int found = 0;
    for (int path = 0; path < LIBRARY_PATHS; ++path) {
        solver->available[path] =
            library_open_path(1, path) && (solver->path < 0 || solver->path == path);
        found += solver->available[path];
    }
    if (found == 0)
        command_line_refuse("--isa: %s does not run here", library_path_name(solver->path));
}

static void list_groups(struct solver *solver)
{
    static const sphg_type types[] = {SPHG_F32, SPHG_F64};
    const int32_t counts[] = {SOLVER_SMALL, solver->matrices};
    for (int size = 0; size < 2; ++size)
        for (int type = 0; type < 2; ++type)
            for (int32_t d = 3; d >= 2; --d)
                if (counts[size] > 0 && (solver->precision < 0 || solver->precision == type))
                    solver->groups[solver->group_count++] = (struct solver_group){
                        .type = types[type], .dimension = d, .count = counts[size]};
}

/* The worst path's. */
static double most(const double *values, const bool *available)
{
    double largest = 0;
    for (int path = 0; path < LIBRARY_PATHS; ++path)
        if (available[path])
            largest = numbers_larger(largest, values[path]);
    return largest;
}

static struct cell cell_per_matrix(const char *name, const struct solver_group *group, int k,
                                   int path)
{
    return cell_time(name, name, &group->times[k][path], 1e6 / group->count, "ns_per_matrix",
                     "%.2f (%.2f-%.2f)");
}

static void add_case(struct table *table, const struct solver *solver,
                     const struct solver_group *group, int k)
{
    static const char *const works[] = {"invert moments", "eigen", "SVD"};
    const struct solver_case *one = &solver_cases[k];
    const struct solver_result *result = &group->results[k];
    const bool copied = one->spectrum == SOLVER_COPIED;
    struct cell cells[8 + LIBRARY_PATHS] = {
        cell_text(NULL, "dimension", table_text("%dD", (int)group->dimension)),
        cell_text(NULL, "precision", group->type == SPHG_F64 ? "f64" : "f32"),
        cell_text(NULL, "matrices", table_text("%d", (int)group->count)),
        cell_text("", "work", works[one->work]),
        cell_text("", "what", one->what),
        cell_if(copied, cell_per_matrix("memcpy", group, k, 0))};
    size_t count = 6;
    for (int path = 0; path < LIBRARY_PATHS; ++path)
        if (solver->available[path])
            cells[count++] =
                cell_if(!copied, cell_per_matrix(library_path_name(path), group, k, path));
    cells[count++] = cell_if(one->spectrum == SOLVER_MOMENTS,
                             cell_number("fell %", "decomposed_percent", "%.2f",
                                         100 * most(result->decomposed, solver->available)));
    cells[count++] = cell_if(
        !copied && one->share == 0,
        cell_number("off by", "deviation", "%.1e", most(result->deviation, solver->available)));
    table_add(table, cells, count);
}

static struct table *table_of(const struct solver *solver)
{
    struct table *table = table_create("solver");
    for (int g = 0; g < solver->group_count; ++g) {
        const struct solver_group *group = &solver->groups[g];
        table_section(table, table_text("%dD, %s, %s", (int)group->dimension,
                                        group->type == SPHG_F64 ? "f64" : "f32",
                                        text_grouped(group->count)));
        for (int k = 0; k < SOLVER_CASES; ++k)
            if (solver_has(group, k))
                add_case(table, solver, group, k);
    }
    return table;
}

static void report_results(const struct solver *solver)
{
    struct report *report = report_create(&solver->settings);
    printf("matrices   3 x 3 and 2 x 2, items packed, so many in a batch; memcpy: their numbers "
           "moved from the input\n           to the results, no arithmetic; fell: share that the "
           "call sent to the decomposition\n");
    report_machine(report);
    printf("times      ns a matrix, median (min-max) of %d rounds through the cases and "
           "instruction sets of a group;\n           off by: C M - 1 of the certified, else "
           "what the factors miss of A, the largest entry over that of A\n",
           solver->settings.repetitions);
    report_table(report, table_of(solver));
    report_write(report);
}

int command_solver(int argc, char **argv)
{
    static const char *const precisions[] = {"f32", "f64", NULL};
    struct solver solver = {.settings = {.threads = 1, .repetitions = 9},
                            .matrices = 1000000,
                            .path = -1,
                            .precision = -1};
    const struct command_option options[] = {
        {"matrices", 0, "N", "of the large batches (1000000); 0: only small ones", OPTION_WHOLE,
         &solver.matrices, 0, 1e8, NULL, NULL},
        {"isa", 0, "NAME", "baseline, x86-64-v3, x86-64-v4 or neon alone (all that run here)",
         OPTION_CHOICE, &solver.path, 0, 0, isa_names + 1, NULL},
        {"precision", 0, "TYPE", "f32 or f64 alone (both)", OPTION_CHOICE, &solver.precision, 0, 0,
         precisions, NULL},
        RUN_OPTIONS(solver.settings),
        {0}};
    settings_read(&solver.settings, options,
                  "Times batches of small matrices: moments that the certificate lets pass and "
                  "moments that fall back to the decomposition, eigenvalues, SVD; on every "
                  "instruction set, in batches that stay in the cache and batches that do not. "
                  "One thread unless --threads says otherwise.",
                  argc, argv);
    find_paths(&solver);
    list_groups(&solver);
    solver_measure(&solver);
    report_results(&solver);
    return EXIT_SUCCESS;
}
