/* SPDX-License-Identifier: MIT */
/* The command `solver`: time a matrix of the library's batches, in batches that stay in the
 * second-level cache and batches that do not, on every instruction set. */
#include "commands.h"
#include "library.h"
#include "report/report.h"
#include "solver_batch.h"
#include <math.h>
#include <string.h>

enum work { INVERSION, EIGEN, SVD };

static const struct solver_case {
    enum work work;
    const char *what;
    enum spectrum spectrum;
    double share; /* of moments that fall back to the decomposition */
} cases[] = {{INVERSION, "copy", SPECTRUM_NONE, 0},
             {INVERSION, "all certified", SPECTRUM_MOMENTS, 0},
             {INVERSION, "1 % fall back", SPECTRUM_MOMENTS, 0.01},
             {INVERSION, "8.5 % fall back", SPECTRUM_MOMENTS, 0.085},
             {INVERSION, "all fall back", SPECTRUM_MOMENTS, 1},
             {EIGEN, "copy", SPECTRUM_NONE, 0},
             {EIGEN, "random", SPECTRUM_RANDOM, 0},
             {EIGEN, "near the identity", SPECTRUM_NEAR, 0},
             {EIGEN, "graded", SPECTRUM_GRADED, 0},
             {SVD, "copy", SPECTRUM_NONE, 0}, /* SVD is 3D only */
             {SVD, "random", SPECTRUM_RANDOM, 0},
             {SVD, "near a rotation", SPECTRUM_NEAR, 0},
             {SVD, "graded", SPECTRUM_GRADED, 0}};

enum {
    CASES = sizeof cases / sizeof cases[0],
    PATHS = SPHG_ISA_NEON, /* path p is the instruction set p + 1 of the header */
    SMALL = 4096           /* matrices that stay in the second-level cache */
};

struct solver {
    struct settings settings;
    int32_t matrices;    /* of the large batches */
    int path, precision; /* the only one wanted, or -1 */
    bool runs[PATHS];
};

/* What is measured in turn, round by round. All cases share the results' memory. */
struct group {
    sphg_type type;
    int32_t dimension, count, threads;
    sphg_context *contexts[PATHS]; /* NULL: not measured */
    struct numbers batches[CASES], results[3];
    int32_t calls[CASES][PATHS]; /* that make a sample; 0: not measured */
    double deviation[CASES];     /* worst of C M - 1, A - Q L Q^T, A - U S V^T, over |A| */
    double decomposed[CASES];    /* share that the call says it sent there, the worst path's */
    struct samples times[CASES][PATHS]; /* of one call; a copy: only of path 0 */
};

/* Result k of the work, packed as a host would have it. */
static struct numbers result_of(const struct group *group, enum work work, int k)
{
    const int32_t d = group->dimension, symmetric = d * (d + 1) / 2;
    const int32_t widths[3][3] = {{symmetric, 0, 0}, {d, d * d, 0}, {d * d, d, d * d}};
    struct numbers result = group->results[k];
    result.width = widths[work][k];
    return result;
}

/* ---- What is timed -------------------------------------------------------------------------- */

/* Bytes of items from one on. */
static char *items(const struct numbers *table, int32_t first, int32_t count, size_t *size)
{
    const size_t item = (size_t)numbers_view(table).stride;
    *size = item * (size_t)count;
    return (char *)table->data + item * (size_t)first;
}

/* The numbers of the results from those of the input, of which wider results take some twice. In
 * pieces as the library's. */
static void copy(const struct group *group, int k)
{
    enum { PIECE = 32 };
#pragma omp parallel for num_threads(group->threads) schedule(static)
    for (int32_t first = 0; first < group->count; first += PIECE)
        for (int r = 0; r < 3; ++r) {
            const struct numbers out = result_of(group, cases[k].work, r);
            const int32_t left = group->count - first, count = left < PIECE ? left : PIECE;
            size_t in_size, out_size;
            const char *from = items(&group->batches[k], first, count, &in_size);
            char *to = items(&out, first, count, &out_size);
            memcpy(to, from, out_size < in_size ? out_size : in_size);
            if (out_size > in_size)
                memcpy(to + in_size, from, out_size - in_size);
        }
}

static void run_case(const struct group *group, int k, int path, sphg_stats *stats)
{
    const sphg_scheme scheme = {.dimension = group->dimension, .support_radius = 1};
    sphg_context *context = group->contexts[path];
    const sphg_view matrices = numbers_view(&group->batches[k]);
    sphg_view out[3];
    for (int r = 0; r < 3; ++r) {
        const struct numbers result = result_of(group, cases[k].work, r);
        out[r] = numbers_view(&result);
    }
    const sphg_inversion wanted = {.correction = out[0], .stats = stats};
    if (cases[k].spectrum == SPECTRUM_NONE) {
        copy(group, k);
    } else if (cases[k].work == INVERSION) {
        library_check(context, sphg_invert_moments(context, &scheme, group->count, matrices,
                                                   sphg_absent(), &wanted));
    } else if (cases[k].work == EIGEN) {
        library_check(
            context, sphg_eigen(context, group->dimension, group->count, matrices, out[0], out[1]));
    } else {
        library_check(context, sphg_svd(context, group->count, matrices, out[0], out[1], out[2]));
    }
}

static double run(void *data, int32_t item)
{
    const struct group *group = data;
    const int32_t calls = group->calls[item / PATHS][item % PATHS];
    for (int32_t call = 0; call < calls; ++call)
        run_case(group, item / PATHS, item % PATHS, NULL);
    return calls;
}

/* ---- What came out -------------------------------------------------------------------------- */

/* |C M - 1|, |Q L Q^T - A| or |U S V^T - A|, the largest entry, over that of A. M is its own
 * transpose. */
static double deviation_of(const struct group *group, int k, int32_t item)
{
    const int32_t d = group->dimension;
    const enum work work = cases[k].work;
    const bool inverse = work == INVERSION, eigen = work == EIGEN;
    const struct numbers *matrices = &group->batches[k];
    const struct numbers results[3] = {result_of(group, work, 0), result_of(group, work, 1),
                                       result_of(group, work, 2)};
    double a[3][3], p[3][3], q[3][3], worst = 0, largest = 0;
    batch_matrix(matrices, item, d, a);
    batch_matrix(&results[eigen], item, d, p);
    batch_matrix(inverse ? matrices : &results[eigen ? 1 : 2], item, d, q);
    for (int32_t r = 0; r < d; ++r)
        for (int32_t c = 0; c < d; ++c) {
            double off = inverse ? r == c : a[r][c];
            for (int32_t n = 0; n < d; ++n)
                off -= p[r][n] * q[c][n] * (inverse ? 1 : numbers_get(&results[!eigen], item, n));
            worst = numbers_larger(worst, fabs(off));
            largest = fmax(largest, fabs(a[r][c]));
        }
    return worst / largest;
}

/* Runs the case once, which also warms up, and looks at its first results, NaN until they are
 * written. Corrections that the threshold touched are no inverses. Short calls are repeated until a
 * sample takes 2 ms. */
static void check_case(struct group *group, int k, int path)
{
    sphg_stats stats = {.decomposed = 0};
    for (int r = 0; r < 3; ++r)
        memset(group->results[r].data, 0xff,
               (size_t)group->count * (size_t)numbers_view(&group->results[r]).stride);
    run_case(group, k, path, cases[k].spectrum == SPECTRUM_MOMENTS ? &stats : NULL);
    group->decomposed[k] = fmax(group->decomposed[k], (double)stats.decomposed / group->count);
    for (int32_t i = 0;
         cases[k].spectrum != SPECTRUM_NONE && cases[k].share == 0 && i < group->count && i < SMALL;
         ++i)
        group->deviation[k] = numbers_larger(group->deviation[k], deviation_of(group, k, i));
    const struct moment start = now();
    run_case(group, k, path, NULL);
    group->calls[k][path] = (int32_t)fmin(ceil(2 / fmax(since(start).wall, 1e-4)), 1e5);
}

/* A copy is by no path, and only once. */
static void measure_group(const struct solver *solver, struct group *group)
{
    group->threads = solver->settings.threads;
    for (int path = 0; path < PATHS; ++path)
        if (solver->runs[path])
            group->contexts[path] = library_open_isa(group->threads, (sphg_isa)(path + 1));
    for (int k = 0; k < 3; ++k)
        group->results[k] = numbers_create(group->type, group->count, 9);
    for (int k = 0; k < CASES && (group->dimension == 3 || cases[k].work != SVD); ++k) {
        group->batches[k] = batch_create(cases[k].spectrum, cases[k].share, cases[k].work != SVD,
                                         group->type, group->dimension, group->count);
        for (int path = 0; path < PATHS; ++path)
            if (cases[k].spectrum == SPECTRUM_NONE ? path == 0 : group->contexts[path] != NULL)
                check_case(group, k, path);
    }
    rounds_measure(&(struct rounds){text_of("%dD, %d", group->dimension, group->count),
                                    solver->settings.repetitions, CASES * PATHS, run, NULL, group},
                   &group->times[0][0]);
}

/* ---- The whole ------------------------------------------------------------------------------ */

static struct cell cell_per_matrix(const char *name, const struct group *group, int k, int path)
{
    return cell_time(name, &group->times[k][path], 1e6 / group->count, "ns_per_matrix");
}

static void add_case(const struct solver *solver, const struct group *group, int k)
{
    static const char *const works[] = {"invert moments", "eigen", "SVD"};
    const bool copied = cases[k].spectrum == SPECTRUM_NONE;
    struct cell cells[8 + PATHS] = {
        cell_text("dimension", text_of("%dD", (int)group->dimension)),
        cell_text("precision", precision_names[group->type == SPHG_F64]),
        cell_text("matrices", text_of("%d", (int)group->count)),
        cell_text("work", works[cases[k].work]),
        cell_text("what", cases[k].what),
        cell_if(copied, cell_per_matrix("memcpy", group, k, 0))};
    size_t count = 6;
    for (int path = 0; path < PATHS; ++path)
        if (solver->runs[path])
            cells[count++] = cell_if(!copied, cell_per_matrix(isa_names[path + 1], group, k, path));
    cells[count++] = cell_if(cases[k].spectrum == SPECTRUM_MOMENTS,
                             cell_number("decomposed_percent", 100 * group->decomposed[k]));
    cells[count++] =
        cell_if(!copied && cases[k].share == 0, cell_number("deviation", group->deviation[k]));
    table_add(cells, count);
}

static void find_paths(struct solver *solver)
{
    int found = 0;
    for (int path = 0; path < PATHS; ++path)
        found += solver->runs[path] =
            library_runs((sphg_isa)(path + 1)) && (solver->path < 0 || solver->path == path);
    if (found == 0)
        command_line_refuse("--isa: %s does not run here", isa_names[solver->path + 1]);
}

/* Small and large batches, f32 and f64, 3D and 2D. */
static void measure(const struct solver *solver)
{
    for (int n = 0; n < 8; ++n) {
        struct held *mark = held_so_far();
        struct group group = {.count = n / 4 ? solver->matrices : SMALL,
                              .type = n / 2 % 2 ? SPHG_F64 : SPHG_F32,
                              .dimension = 3 - n % 2};
        if (group.count == 0 || (solver->precision >= 0 && solver->precision != n / 2 % 2))
            continue;
        measure_group(solver, &group);
        for (int k = 0; k < CASES; ++k)
            if (group.dimension == 3 || cases[k].work != SVD)
                add_case(solver, &group, k);
        release_held(mark);
    }
}

int command_solver(int argc, char **argv)
{
    static const char *const precisions[] = {"f32", "f64", NULL};
    struct solver solver = {.settings = {.threads = 1, .repetitions = 9},
                            .matrices = 1000000,
                            .path = -1,
                            .precision = -1};
    const struct command_option options[] = {
        {"matrices", 0, "N", "of the large batches (1000000); 0: only small ones",
         AS_WHOLE(solver.matrices, 0, 1e8)},
        {"isa", 0, "NAME", "baseline, x86-64-v3, x86-64-v4 or neon alone (all that run here)",
         AS_CHOICE(solver.path, isa_names + 1)},
        {"precision", 0, "TYPE", "f32 or f64 alone (both)",
         AS_CHOICE(solver.precision, precisions)},
        {0}};
    settings_read(&solver.settings, TAKES_RUN, options,
                  "Times batches of small matrices: moments that the certificate lets pass and "
                  "moments that fall back to the decomposition, eigenvalues, SVD; on every "
                  "instruction set, in batches that stay in the cache and batches that do not. "
                  "One thread unless --threads says otherwise.",
                  argc, argv);
    find_paths(&solver);
    report_open("solver", &solver.settings);
    table_begin("solver");
    measure(&solver);
    return report_close();
}
