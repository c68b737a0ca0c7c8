/* SPDX-License-Identifier: MIT */
/* Particles that have not moved since the build before keep their grid. */
#include "support/brute_force.h"
#include "support/setup.h"
#include <string.h>

enum { STEPS = 80, SOURCES_MOST = 400, TARGETS_MOST = 300 };

static void scatter(const scene *particles, double *x, int count, double side, random_state *random)
{
    for (int k = 0; k < count * particles->dimension; ++k)
        x[k] = scene_rounded(particles, random_between(random, 0, side));
}

static void drift(const scene *particles, double *x, int count, double by)
{
    for (int k = 0; k < count * particles->dimension; ++k)
        x[k] = scene_rounded(particles, x[k] + by);
}

static void move_one(const scene *particles, double *x, int item, random_state *random)
{
    double *at = x + item * particles->dimension;
    for (int a = 0; a < particles->dimension; ++a)
        at[a] = scene_rounded(particles, random_between(random, 0, 4));
}

/* Sources, targets, both or neither move, one of them or all; they become more or fewer. */
static void move_some(scene *particles, random_state *random)
{
    double *sides[] = {particles->sources, particles->targets};
    int *counts[] = {&particles->source_count, &particles->target_count};
    const int most[] = {SOURCES_MOST, TARGETS_MOST};
    for (int side = 0; side < 2; ++side) {
        const int what = random_index(random, 8), count = *counts[side];
        if (what == 1) /* of the last one, too, there are no two by chance */
            move_one(particles, sides[side], random_index(random, 2) ? count - 1 : 0, random);
        if (what == 2)
            scatter(particles, sides[side], count, random_index(random, 2) ? 4 : 40, random);
        if (what == 3)
            drift(particles, sides[side], count, .05);
        if (what == 4)
            *counts[side] =
                1 + random_index(random, count > most[side] / 2 ? most[side] : 2 * count);
    }
}

/* Where only a few things change from build to build. */
static void change_question(scene *particles, double *H, random_state *random)
{
    if (random_index(random, 8) == 0)
        *H = *H < .6 ? .75 : .5;
    if (random_index(random, 8) == 0)
        particles->list_free = !particles->list_free;
    if (random_index(random, 8) == 0)
        particles->period[0] = particles->period[0] > 0 ? 0 : 4;
    if (random_index(random, 8) == 0)
        particles->skin = particles->skin > 0 ? 0 : .25;
    if (particles->skin > 0)
        particles->list_free = 0;
}

static scene two_sides(const test_case *test, random_state *random)
{
    scene made = scene_empty(test, SOURCES_MOST);
    made.target_count = TARGETS_MOST;
    made.targets = test_memory(TARGETS_MOST * 3 * sizeof *made.targets);
    scatter(&made, made.sources, SOURCES_MOST, 4, random);
    scatter(&made, made.targets, TARGETS_MOST, 4, random);
    return made;
}

/* One object for all builds, now and then one that the targets are part of. */
static void what_stands_has_the_pairs_of_brute_force(const test_case *test)
{
    for (int threads = 1; threads < 3; ++threads) {
        sphg_context *context = setup_context_of(threads);
        sphg_neighbors *neighbors = brute_force_neighbors(context);
        random_state random = random_seeded(77 + (uint64_t)threads);
        scene particles = two_sides(test, &random);
        double H = .5;
        particles.source_count = particles.target_count = 20;
        for (int step = 0; step < STEPS; ++step) {
            scene now = particles;
            if (random_index(&random, 3) == 0) {
                now.targets = NULL;
                now.target_count = now.source_count;
            }
            rows_require_search_exact(context, neighbors, &now, H,
                                      test_text("%d threads, step %d", threads, step));
            move_some(&particles, &random);
            change_question(&particles, &H, &random);
        }
    }
}

/* Tables of grids share memory with lists: more targets than ever before ask for more. */
static void what_stands_survives_growth(const test_case *test)
{
    const sphg_config config = fake_host_config(setup_hooks(), 2);
    sphg_context *context = setup_context_with(&config);
    random_state random = random_seeded(80);
    for (int list_free = 0; list_free < 2; ++list_free) {
        sphg_neighbors *neighbors = brute_force_neighbors(context);
        scene particles = two_sides(test, &random);
        particles.list_free = list_free;
        for (int count = 1; count < TARGETS_MOST; count *= 2) {
            particles.target_count = count;
            scatter(&particles, particles.targets, count, 40, &random);
            rows_require_search_exact(context, neighbors, &particles, .5,
                                      test_text("%d targets, list_free %d", count, list_free));
        }
    }
}

/* What a skin has kept stands in the cells of its old places. */
static void what_a_skin_kept_is_sorted_again(const test_case *test)
{
    sphg_context *context = setup_context_of(2);
    sphg_neighbors *neighbors = brute_force_neighbors(context);
    random_state random = random_seeded(79);
    scene particles = two_sides(test, &random);
    particles.skin = .25;
    for (int step = 0; step < STEPS; ++step) {
        rows_require_search_exact(context, neighbors, &particles, .5, test_text("step %d", step));
        if (step % 2)
            scatter(&particles, particles.sources, SOURCES_MOST, 4, &random);
        else
            drift(&particles, particles.targets, TARGETS_MOST, step < STEPS / 2 ? .06 : -.06);
    }
}

/* ... and with radii of their own, which count as places do. */
static void what_stands_has_the_pairs_of_its_radii(const test_case *test)
{
    sphg_context *context = setup_context_of(2);
    sphg_neighbors *neighbors = brute_force_neighbors(context);
    random_state random = random_seeded(78);
    scene particles = two_sides(test, &random);
    double support[SOURCES_MOST], target_support[TARGETS_MOST];
    for (int k = 0; k < SOURCES_MOST; ++k)
        support[k] = scene_rounded(&particles, random_between(&random, .2, .8));
    for (int k = 0; k < TARGETS_MOST; ++k)
        target_support[k] = scene_rounded(&particles, random_between(&random, .2, .8));
    particles.support = support;
    particles.target_support = target_support;
    for (int step = 0; step < STEPS / 2; ++step) {
        particles.mutual = step % 5 == 4;
        rows_require_search_exact(context, neighbors, &particles, 1, test_text("step %d", step));
        move_some(&particles, &random);
        if (random_index(&random, 3) == 0)
            support[random_index(&random, SOURCES_MOST)] = .25;
        if (random_index(&random, 3) == 0)
            target_support[random_index(&random, TARGETS_MOST)] = .25;
    }
}

#define EACH(property) TEST_ENTRY(property, TEST_ALL_PRECISIONS, TEST_BOTH_DIMENSIONS, 0, 0)

static const test_entry entries[] = {
    EACH(what_stands_has_the_pairs_of_brute_force),
    EACH(what_stands_has_the_pairs_of_its_radii),
    EACH(what_stands_survives_growth),
    EACH(what_a_skin_kept_is_sorted_again),
};
TEST_MAIN(entries)
