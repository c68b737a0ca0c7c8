/* The command `solver`. */
#include "solver.h"
#include "commands.h"
#include "particles/names.h"
#include "options.h"

#include <stdlib.h>

enum { OPTION_MATRICES = 256, OPTION_ISA, OPTION_PRECISION };

static const struct argp_option option_list[] = {
    {"matrices", OPTION_MATRICES, "N", 0, "of the large batches (1000000); 0: only small ones", 0},
    {"isa", OPTION_ISA, "NAME", 0,
     "baseline, x86-64-v3, x86-64-v4 or neon alone (all that run here)", 0},
    {"precision", OPTION_PRECISION, "TYPE", 0, "f32 or f64 alone (both)", 0},
    {0}};

static error_t parse_option(int key, char *text, struct argp_state *state)
{
    static const char *const precisions[] = {"f32", "f64", NULL};
    struct solver *solver = state->input;
    switch (key) {
    case ARGP_KEY_INIT:
        state->child_inputs[0] = &solver->settings;
        return 0;
    case OPTION_MATRICES:
        solver->matrices = option_integer("matrices", text, 0, 100000000);
        return 0;
    case OPTION_ISA:
        solver->path = option_choice("isa", text, isa_names + 1);
        return 0;
    case OPTION_PRECISION:
        solver->precision = option_choice("precision", text, precisions);
        return 0;
    default:
        return ARGP_ERR_UNKNOWN;
    }
}

static void find_paths(struct solver *solver)
{
    int found = 0;
    for (int path = 0; path < LIBRARY_PATHS; path++) {
        sphg_context *context = library_open_path(1, path);
        solver->available[path] = context && (solver->path < 0 || solver->path == path);
        found += solver->available[path];
        sphg_context_destroy(context);
    }
    if (found == 0)
        options_refuse("--isa: %s does not run here", library_path_name(solver->path));
}

static void list_groups(struct solver *solver)
{
    static const sphg_type types[] = {SPHG_F32, SPHG_F64};
    const int32_t counts[] = {SOLVER_SMALL, solver->matrices};
    for (int size = 0; size < 2; size++)
        for (int type = 0; type < 2; type++)
            for (int32_t d = 3; d >= 2; d--)
                if (counts[size] > 0 && (solver->precision < 0 || solver->precision == type))
                    solver->groups[solver->group_count++] =
                        (struct solver_group){types[type], d, counts[size], {{{{0}}, {0}, {0}}}};
}

static void destroy_samples(struct solver *solver)
{
    for (int g = 0; g < solver->group_count; g++)
        for (int k = 0; k < SOLVER_CASES; k++)
            for (int path = 0; path < LIBRARY_PATHS; path++)
                samples_destroy(&solver->groups[g].results[k].times[path]);
}

int command_solver(int argc, char **argv)
{
    struct solver solver = {.settings = {.threads = 1, .repetitions = 9},
                            .matrices = 1000000,
                            .path = -1,
                            .precision = -1};
    const struct argp_child children[] = {{&settings_run_argp, 0, NULL, 0}, {NULL, 0, NULL, 0}};
    const struct argp argp = {
        .options = option_list,
        .parser = parse_option,
        .children = children,
        .doc = "Times batches of small matrices: moments that the certificate lets pass and "
               "moments that fall back to the decomposition, eigenvalues, SVD; on every "
               "instruction set, in batches that stay in the cache and batches that do not. One "
               "thread unless --threads says otherwise."};
    options_parse(&argp, argc, argv, &solver);
    find_paths(&solver);
    list_groups(&solver);
    solver_measure(&solver);
    solver_print(&solver);
    if (solver.settings.json)
        solver_write_json(&solver, solver.settings.json, "sphgrad-bench");
    destroy_samples(&solver);
    return EXIT_SUCCESS;
}
