/* SPDX-License-Identifier: MIT */
/* The measurements of solver. */
#include "report/table.h"
#include "solver.h"
#include "team.h"
#include <math.h>
#include <string.h>

/* Short calls are repeated until a sample takes so long [ms]. */
static const double sample_time = 2;

/* What a group runs on. All cases share the results' memory. */
struct scene {
    struct solver_group *group;
    sphg_context *contexts[LIBRARY_PATHS]; /* NULL: not measured */
    struct numbers batches[SOLVER_CASES], results[3];
    int32_t threads, calls[SOLVER_CASES][LIBRARY_PATHS];
};

static struct scene open_scene(const struct solver *solver, struct solver_group *group)
{
    struct scene scene = {.group = group, .threads = solver->settings.threads};
    for (int path = 0; path < LIBRARY_PATHS; ++path)
        if (solver->available[path])
            scene.contexts[path] = library_open_path(scene.threads, path);
    for (int k = 0; k < SOLVER_CASES; ++k)
        if (solver_has(group, k))
            scene.batches[k] =
                solver_batch(&solver_cases[k], group->type, group->dimension, group->count);
    for (int k = 0; k < 3; ++k)
        scene.results[k] = numbers_create(group->type, group->count, 9);
    return scene;
}

/* Result k of the work, packed as a host would have it. */
static struct numbers result_of(const struct scene *scene, enum solver_work work, int k)
{
    struct numbers result = scene->results[k];
    result.width = solver_widths_of(work, scene->group->dimension).out[k];
    return result;
}

/* ---- What is timed -------------------------------------------------------------------------- */

struct copy {
    const struct scene *scene;
    int k;
};

/* Bytes of items [begin, end) of a table. */
static char *items(const struct numbers *table, int32_t begin, int32_t end, size_t *size)
{
    const size_t item = (size_t)numbers_view(table).stride;
    *size = item * (size_t)(end - begin);
    return (char *)table->data + item * (size_t)begin;
}

/* Results wider than the input take some of it twice. In pieces as the library's. */
static void copy_share(void *data, int32_t begin, int32_t end)
{
    enum { PIECE = 32 };
    const struct copy *copy = data;
    const enum solver_work work = solver_cases[copy->k].work;
    for (int32_t first = begin; first < end; first += PIECE)
        for (int k = 0; k < 3; ++k) {
            const struct numbers out = result_of(copy->scene, work, k);
            const int32_t last = end - first < PIECE ? end : first + PIECE;
            size_t in_size, out_size;
            const char *from = items(&copy->scene->batches[copy->k], first, last, &in_size);
            char *to = items(&out, first, last, &out_size);
            memcpy(to, from, out_size < in_size ? out_size : in_size);
            if (out_size > in_size)
                memcpy(to + in_size, from, out_size - in_size);
        }
}

static void invert(const struct scene *scene, int k, int path, sphg_stats *stats)
{
    const struct solver_group *group = scene->group;
    const sphg_scheme scheme = {.dimension = group->dimension, .support_radius = 1};
    const struct numbers corrections = result_of(scene, SOLVER_INVERSION, 0);
    const sphg_inversion wanted = {.correction = numbers_view(&corrections), .stats = stats};
    library_check(scene->contexts[path],
                  sphg_invert_moments(scene->contexts[path], &scheme, group->count,
                                      numbers_view(&scene->batches[k]), sphg_absent(), &wanted));
}

static void run_case(const struct scene *scene, int k, int path)
{
    const struct solver_case *one = &solver_cases[k];
    const struct solver_group *group = scene->group;
    sphg_context *context = scene->contexts[path];
    const sphg_view matrices = numbers_view(&scene->batches[k]);
    sphg_view out[3];
    for (int r = 0; r < 3; ++r) {
        const struct numbers result = result_of(scene, one->work, r);
        out[r] = numbers_view(&result);
    }
    if (one->spectrum == SOLVER_COPIED) {
        struct copy copy = {scene, k};
        team_run(scene->threads, copy_share, &copy, group->count, SOLVER_SMALL / 8);
    } else if (one->work == SOLVER_INVERSION)
        invert(scene, k, path, NULL);
    else if (one->work == SOLVER_EIGEN)
        library_check(
            context, sphg_eigen(context, group->dimension, group->count, matrices, out[0], out[1]));
    else
        library_check(context, sphg_svd(context, group->count, matrices, out[0], out[1], out[2]));
}

/* ---- What came out -------------------------------------------------------------------------- */

/* An item as a full matrix. */
static void matrix_of(const struct numbers *table, int32_t item, int32_t d, double a[3][3])
{
    const bool symmetric = table->width < d * d;
    int32_t n = 0;
    for (int32_t r = 0; r < d; ++r)
        for (int32_t c = symmetric ? r : 0; c < d; ++c) {
            a[r][c] = numbers_get(table, item, n++);
            if (symmetric)
                a[c][r] = a[r][c];
        }
}

/* |C M - 1|, |Q L Q^T - A| or |U S V^T - A|, the largest entry, over that of A. M is its own
 * transpose. */
static double deviation_of(const struct scene *scene, int k, int32_t item)
{
    const int32_t d = scene->group->dimension;
    const enum solver_work work = solver_cases[k].work;
    const bool inverse = work == SOLVER_INVERSION, eigen = work == SOLVER_EIGEN;
    const struct numbers *matrices = &scene->batches[k];
    const struct numbers results[3] = {result_of(scene, work, 0), result_of(scene, work, 1),
                                       result_of(scene, work, 2)};
    double a[3][3], p[3][3], q[3][3], worst = 0, largest = 0;
    matrix_of(matrices, item, d, a);
    matrix_of(&results[eigen], item, d, p);
    matrix_of(inverse ? matrices : &results[eigen ? 1 : 2], item, d, q);
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
 * written. Corrections that the threshold touched are no inverses. */
static void check_case(struct scene *scene, int k, int path)
{
    const struct solver_case *one = &solver_cases[k];
    struct solver_result *result = &scene->group->results[k];
    const int32_t count = scene->group->count;
    sphg_stats stats = {.decomposed = 0};
    for (int r = 0; r < 3; ++r)
        memset(scene->results[r].data, 0xff,
               (size_t)count * (size_t)numbers_view(&scene->results[r]).stride);
    run_case(scene, k, path);
    if (one->spectrum == SOLVER_MOMENTS)
        invert(scene, k, path, &stats);
    result->decomposed[path] = (double)stats.decomposed / count;
    result->deviation[path] = 0;
    if (one->spectrum != SOLVER_COPIED && one->share == 0)
        for (int32_t i = 0; i < count && i < SOLVER_SMALL; ++i)
            result->deviation[path] =
                numbers_larger(result->deviation[path], deviation_of(scene, k, i));
}

/* ---- The whole ------------------------------------------------------------------------------ */

/* A copy is by no path, and only once. */
static bool is_measured(const struct scene *scene, int k, int path)
{
    if (!solver_has(scene->group, k))
        return false;
    return solver_cases[k].spectrum == SOLVER_COPIED ? path == 0 : scene->contexts[path] != NULL;
}

/* How many calls make a sample, from one call in the warm state. */
static int32_t calls_of_sample(const struct scene *scene, int k, int path)
{
    const struct moment start = now();
    run_case(scene, k, path);
    const double calls = ceil(sample_time / fmax(since(start).wall, 1e-4));
    return (int32_t)fmin(calls, 1e5);
}

static double run(void *data, int32_t item)
{
    const struct scene *scene = data;
    const int k = item / LIBRARY_PATHS, path = item % LIBRARY_PATHS;
    const int32_t calls = scene->calls[k][path];
    for (int32_t call = 0; call < calls; ++call)
        run_case(scene, k, path);
    return calls;
}

void solver_measure(struct solver *solver)
{
    for (int g = 0; g < solver->group_count; ++g) {
        struct held *mark = held_so_far();
        struct solver_group *group = &solver->groups[g];
        struct scene scene = open_scene(solver, group);
        for (int k = 0; k < SOLVER_CASES; ++k)
            for (int path = 0; path < LIBRARY_PATHS; ++path)
                if (is_measured(&scene, k, path)) {
                    check_case(&scene, k, path);
                    scene.calls[k][path] = calls_of_sample(&scene, k, path);
                }
        rounds_measure(&(struct rounds){table_text("group %d of %d", g + 1, solver->group_count),
                                        solver->settings.repetitions, SOLVER_CASES * LIBRARY_PATHS,
                                        run, NULL, &scene},
                       &group->times[0][0]);
        release_held(mark);
    }
}
