/* SPDX-License-Identifier: MIT */
/* Order 2 beside order 1, over H and N: time from positions to Jacobians against the error at the
 * boundary and inside, of one field on a cube of ever finer particles. */
#include "fields/fig2_trigonometric_measure.h"
#include "frontier_order.h"
#include "report/report.h"

enum { WAYS = 4, SUPPORTS = 3, CUBES = 3 * SUPPORTS, POINTS = WAYS * CUBES };

static const struct study_way ways[WAYS] = {{.name = "order 1", .method = SPHG_KGC},
                                            {.name = "classic", .method = SPHG_CMLS},
                                            {.name = "order 2", .order = 2},
                                            {.name = "order 2 lent", .order = 2, .lent = true}};
static const double supports[SUPPORTS] = {2, 2.5, 3};

/* Of half, once and twice the particles an axis. */
static struct study open_cube(const struct settings *settings, int k)
{
    const int32_t side = (settings_side(settings->particles, 3) << k / SUPPORTS) / 2;
    const struct study_setting setting = {.dimension = 3,
                                          .threads = settings->threads,
                                          .side = side > 6 ? side : 6,
                                          .support = supports[k % SUPPORTS],
                                          .jitter = settings->jitter};
    struct study study = study_open(&setting);
    study_fill(&study, FIELD_TRIGONOMETRIC);
    return study;
}

static double run(void *cubes, int32_t item)
{
    const struct study *cube = (const struct study *)cubes + item / WAYS;
    study_search(cube);
    study_derive(cube, &ways[item % WAYS]);
    return 1;
}

static void add_points(const struct study cubes[CUBES], const struct study_errors errors[POINTS],
                       const struct samples times[POINTS])
{
    table_begin("order");
    for (int k = 0; k < POINTS; ++k) {
        const struct study *cube = &cubes[k / WAYS];
        TABLE_ROW(cell_text("way", ways[k % WAYS].name),
                  cell_text("support", text_of("%g", cube->setting.support)),
                  cell_text("side", text_of("%d", cube->setting.side)),
                  cell_time("", &times[k], 1e6 / cube->scene.count, "ns_per_particle"),
                  cell_time("all", &times[k], 1, NULL),
                  cell_number("boundary_max", errors[k].most[STUDY_BOUNDARY]),
                  cell_number("boundary_mean", errors[k].mean[STUDY_BOUNDARY]),
                  cell_number("inside_max", errors[k].most[STUDY_INSIDE]),
                  cell_number("inside_mean", errors[k].mean[STUDY_INSIDE]));
    }
}

void frontier_order(const struct settings *settings)
{
    struct study cubes[CUBES];
    struct study_errors errors[POINTS];
    struct samples times[POINTS] = {{0}};
    for (int k = 0; k < CUBES; ++k)
        cubes[k] = open_cube(settings, k);
    for (int k = 0; k < POINTS; ++k) {
        run(cubes, k);
        errors[k] = study_compare(&cubes[k / WAYS], NULL, NULL);
    }
    rounds_measure(&(struct rounds){"order 2", settings->repetitions, POINTS, run, NULL, cubes},
                   times);
    add_points(cubes, errors, times);
}
