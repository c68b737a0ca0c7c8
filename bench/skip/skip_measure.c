/* SPDX-License-Identifier: MIT */
/* The measurements of skip: the full evaluation of each row, and the part of it that a scene may
 * need. */
#include "skip.h"
#include "lattice.h"
#include "particles/particles.h"
#include <math.h>
#include <string.h>

#define ASKS(...)                                                                                  \
    {                                                                                              \
        .outputs = __VA_ARGS__                                                                     \
    }
#define JACOBIAN(...)                                                                              \
    {                                                                                              \
        .outputs = ASK_JACOBIAN, __VA_ARGS__                                                       \
    }
#define EVERYTHING        ASKS(ASK_MATRICES | ASK_JACOBIAN | ASK_DIVERGENCE | ASK_CURL)
#define ANEW              JACOBIAN(.neighbors = NEIGHBORS_REBUILT)
#define BESIDE(kind)      JACOBIAN(.neighbors = NEIGHBORS_REBUILT, .moved = true, .wall = (kind))
#define SCATTERED(active) JACOBIAN(.share = (active))
#define CLUSTERED(active) JACOBIAN(.share = (active), .clustered = true)

static const char all_outputs[] = "matrices, Jacobian, divergence, curl",
                  all_targets[] = "Jacobian of all particles",
                  anew[] = "search, matrices, Jacobian";

const struct skip_row skip_rows[SKIP_ROWS] = {
    {"outputs", "Jacobian, matrices not kept", all_outputs, false, JACOBIAN(), EVERYTHING},
    {"outputs", "divergence alone", all_outputs, false, ASKS(ASK_DIVERGENCE), EVERYTHING},
    {"outputs", "curl alone", all_outputs, false, ASKS(ASK_CURL), EVERYTHING},
    {"outputs", "matrices alone", all_outputs, false, ASKS(ASK_MATRICES), EVERYTHING},
    {"fields", "4 vector fields in one call", "one by one", false, JACOBIAN(.fields = 4),
     JACOBIAN(.fields = 4, .one_by_one = true)},
    {"fields", "the same with matrices given", "one by one, matrices given", false,
     JACOBIAN(.fields = 4, .by_table = true),
     JACOBIAN(.fields = 4, .by_table = true, .one_by_one = true)},
    {"active", "75 % scattered, mask", all_targets, false, SCATTERED(0.75), JACOBIAN()},
    {"active", "50 % scattered, mask", all_targets, false, SCATTERED(0.5), JACOBIAN()},
    {"active", "50 % scattered, list", all_targets, true, SCATTERED(0.5), JACOBIAN()},
    {"active", "50 % clustered, mask", all_targets, false, CLUSTERED(0.5), JACOBIAN()},
    {"active", "50 % clustered, list", all_targets, true, CLUSTERED(0.5), JACOBIAN()},
    {"active", "10 % scattered, mask", all_targets, false, SCATTERED(0.1), JACOBIAN()},
    {"active", "10 % scattered, list", all_targets, true, SCATTERED(0.1), JACOBIAN()},
    {"active", "10 % clustered, mask", all_targets, false, CLUSTERED(0.1), JACOBIAN()},
    {"active", "10 % clustered, list", all_targets, true, CLUSTERED(0.1), JACOBIAN()},
    {"active", "1 % scattered, mask", all_targets, false, SCATTERED(0.01), JACOBIAN()},
    {"active", "1 % scattered, list", all_targets, true, SCATTERED(0.01), JACOBIAN()},
    {"active", "1 % clustered, mask", all_targets, false, CLUSTERED(0.01), JACOBIAN()},
    {"active", "1 % clustered, list", all_targets, true, CLUSTERED(0.01), JACOBIAN()},
    {"reuse", "neighbours kept", anew, false, JACOBIAN(), ANEW},
    {"reuse", "neighbours and matrices kept", anew, false, JACOBIAN(.by_table = true), ANEW},
    {"reuse", "weights kept", all_targets, false, JACOBIAN(.neighbors = NEIGHBORS_WEIGHTED),
     JACOBIAN()},
    {"reuse", "moved within the skin of 0.1 H", anew, false,
     JACOBIAN(.neighbors = NEIGHBORS_SKINNED, .moved = true),
     JACOBIAN(.neighbors = NEIGHBORS_REBUILT, .moved = true)},
    {"reuse", "a wall, targets_of", "targets handed over", false, BESIDE(WALL_TARGETS_OF),
     BESIDE(WALL_APART)},
    {"reuse", "list-free, for one use", anew, false, JACOBIAN(.neighbors = NEIGHBORS_LIST_FREE),
     ANEW},
    {"problem", "2D, as many particles and pairs", "Jacobian in 3D", false,
     JACOBIAN(.neighbors = NEIGHBORS_PLANE), JACOBIAN()},
    {"problem", "no wall", "beside a wall", false, BESIDE(WALL_NONE), BESIDE(WALL_TARGETS_OF)},
    {"problem", "matrices that need no SVD", "all decomposed", false, ASKS(ASK_MATRICES),
     ASKS(ASK_MATRICES, .decomposed = true)},
    {"problem", "one volume for all", "an array of volumes", false, JACOBIAN(.one_volume = true),
     JACOBIAN()}};

bool skip_is_compared(const struct skip_row *row)
{
    return row->part.neighbors != NEIGHBORS_PLANE && !row->full.decomposed &&
           !row->part.wall == !row->full.wall;
}

enum { FIELDS = 4, TABLES_MOST = FIELDS + 3 };

struct outputs {
    struct numbers matrices, divergence, curl, jacobians[FIELDS];
};

/* Of active targets. */
struct pattern {
    uint8_t *mask;
    int32_t *indices, count;
};

struct bench {
    struct skip *skip;
    struct scene scenes[NEIGHBOR_KINDS];
    struct scene wall;
    struct numbers moved; /* positions, less than half a skin away */
    struct numbers fields[FIELDS], matrices;
    struct outputs outputs[2]; /* of the full evaluation, and of the part that is measured */
    struct pattern patterns[SKIP_ROWS];
    bool positions_are_moved; /* in this round */
};

/* ---- An evaluation --------------------------------------------------------------------------- */

static sphg_view if_asked(int asked, const struct numbers *numbers)
{
    return asked ? numbers_view(numbers) : sphg_absent();
}

/* Searches on the way where the neighbours are not those found before. */
static struct scene scene_of(struct bench *bench, const struct skip_ask *ask)
{
    struct scene scene = bench->scenes[ask->neighbors];
    if (ask->moved && bench->positions_are_moved)
        scene.geometry.sources = numbers_view(&bench->moved);
    if (ask->neighbors >= NEIGHBORS_REBUILT)
        scene_run(&scene, WORK_SEARCH);
    if (ask->neighbors == NEIGHBORS_SKINNED)
        bench->skip->skin_was_spent |= library_info(scene.context, scene.neighbors).rebuilt != 0;
    if (ask->one_volume)
        scene.volumes.count = 1;
    if (ask->decomposed) /* 4 eps is more than any of their eigenvalues */
        scene.scheme.threshold = 0.5;
    return scene;
}

/* Of a scene whose own neighbours are found. */
static void search_wall(const struct scene *wall, const struct scene *scene, enum skip_wall how)
{
    struct scene beside = *wall;
    const sphg_view sources = numbers_view(&wall->positions);
    beside.geometry =
        how == WALL_TARGETS_OF
            ? sphg_targets_of(scene->neighbors, sources, wall->count)
            : sphg_targets_apart(scene->geometry.sources, scene->count, sources, wall->count);
    scene_run(&beside, WORK_SEARCH);
}

static void evaluate(struct bench *bench, const struct skip_row *row, int part)
{
    const struct skip_ask *ask = part ? &row->part : &row->full;
    const struct pattern *pattern = &bench->patterns[row - skip_rows];
    const struct outputs *outputs = &bench->outputs[part];
    const struct scene scene = scene_of(bench, ask);
    const bool plane = ask->neighbors == NEIGHBORS_PLANE;
    const sphg_subset subset = row->listed ? sphg_listed(pattern->indices, pattern->count)
                                           : sphg_masked(pattern->mask, scene.count);
    sphg_sources sources[] = {scene_sources(&scene), scene_sources(&bench->wall)};
    sphg_view views[FIELDS][2];
    sphg_field fields[FIELDS];
    sources[0].same_volumes = ask->neighbors == NEIGHBORS_WEIGHTED;
    if (ask->by_table)
        sources[0].correction = numbers_view(&bench->matrices);
    if (ask->wall)
        search_wall(&bench->wall, &scene, ask->wall);
    for (int f = 0; f < FIELDS; ++f) {
        views[f][0] = numbers_view(plane ? &scene.field : &bench->fields[f]);
        views[f][1] = numbers_view(&bench->wall.field);
        fields[f] = (sphg_field){
            .shape = SPHG_VECTOR,
            .at_sources = views[f],
            .gradient = if_asked(ask->outputs & ASK_JACOBIAN,
                                 plane ? &scene.jacobians : &outputs->jacobians[f]),
            .divergence = if_asked(ask->outputs & ASK_DIVERGENCE, &outputs->divergence),
            .curl = if_asked(ask->outputs & ASK_CURL, &outputs->curl)};
    }
    const int count = ask->outputs == ASK_MATRICES ? 0 : ask->fields ? ask->fields : 1;
    const int calls = ask->one_by_one ? count : 1;
    for (int f = 0; f < calls; ++f) {
        const sphg_request request = {
            .sources = sources,
            .set_count = ask->wall ? 2 : 1,
            .subset = ask->share > 0 ? &subset : NULL,
            .fields = count > 0 ? fields + f : NULL,
            .field_count = count / calls,
            .correction = if_asked(ask->outputs & ASK_MATRICES, &outputs->matrices)};
        scene_evaluate(&scene, &request);
    }
}

/* ---- Comparison ------------------------------------------------------------------------------ */

/* What is asked for; the count is returned. */
static int tables_of(const struct skip_ask *ask, const struct outputs *outputs,
                     struct numbers tables[TABLES_MOST])
{
    int count = 0;
    if (ask->outputs & ASK_MATRICES)
        tables[count++] = outputs->matrices;
    if (ask->outputs & ASK_DIVERGENCE)
        tables[count++] = outputs->divergence;
    if (ask->outputs & ASK_CURL)
        tables[count++] = outputs->curl;
    for (int f = 0; ask->outputs & ASK_JACOBIAN && (f == 0 || f < ask->fields); ++f)
        tables[count++] = outputs->jacobians[f];
    return count;
}

static double relative_difference(const struct numbers *part, const struct numbers *full, int32_t i)
{
    double difference = 0, size = 0;
    for (int32_t k = 0; k < full->width; ++k) {
        const double expected = numbers_get(full, i, k), d = numbers_get(part, i, k) - expected;
        difference += d * d;
        size += expected * expected;
    }
    return sqrt(difference / size);
}

static void compare_table(const struct numbers *part, const struct numbers *full,
                          const uint8_t *mask, struct skip_result *result)
{
    const size_t size = (size_t)numbers_view(full).stride;
    for (int32_t i = 0; i < full->count; ++i) {
        const char *a = (const char *)part->data + size * (size_t)i,
                   *b = (const char *)full->data + size * (size_t)i;
        if ((mask && !mask[i]) || memcmp(a, b, size) == 0)
            continue;
        ++result->differences;
        result->deviation = numbers_larger(result->deviation, relative_difference(part, full, i));
    }
}

/* Untimed, and warms up. What a run does not write cannot look like what the run before wrote: all
 * bits are set, which is not a number. */
static void compare_row(struct bench *bench, int k)
{
    const struct skip_row *row = &skip_rows[k];
    struct numbers tables[2][TABLES_MOST];
    int count = 0;
    for (int part = 0; part < 2; ++part) {
        count = tables_of(&row->part, &bench->outputs[part], tables[part]);
        for (int t = 0; t < count; ++t)
            memset(tables[part][t].data, 0xff,
                   (size_t)tables[part][t].count * (size_t)numbers_view(&tables[part][t]).stride);
        evaluate(bench, row, part);
    }
    for (int t = 0; t < count && skip_is_compared(row); ++t)
        compare_table(&tables[1][t], &tables[0][t], bench->patterns[k].mask,
                      &bench->skip->results[k]);
}

/* ---- The whole ------------------------------------------------------------------------------- */

/* Largest distance from the middle on any axis, over half the side. */
static double off_centre(const struct numbers *positions, int32_t i, double middle)
{
    double most = 0;
    for (int32_t axis = 0; axis < positions->width; ++axis)
        most = fmax(most, fabs(numbers_get(positions, i, axis) - middle));
    return most / (middle + 0.5 * lattice_spacing);
}

static struct pattern create_pattern(const struct numbers *positions, double middle,
                                     const struct skip_ask *ask)
{
    const size_t count = (size_t)positions->count;
    struct pattern pattern = {.mask = NULL};
    if (ask->share <= 0)
        return pattern;
    pattern.mask = allocate_held(count, sizeof *pattern.mask);
    pattern.indices = allocate_held(count, sizeof *pattern.indices);
    for (int32_t i = 0; i < positions->count; ++i) {
        pattern.mask[i] = ask->clustered ? off_centre(positions, i, middle) < cbrt(ask->share)
                                         : lattice_random(i) < ask->share;
        if (pattern.mask[i])
            pattern.indices[pattern.count++] = i;
    }
    return pattern;
}

/* Waves; and where particles move to: each coordinate by at most a quarter of the skin, which is
 * less than half of it in any direction. */
static void fill(struct bench *bench, const struct numbers *positions, double skin)
{
    const double wave = 2 * 3.14159265358979323846 / (32 * lattice_spacing);
    bench->moved = numbers_create(SPHG_F32, positions->count, 3);
    for (int f = 0; f < FIELDS; ++f)
        bench->fields[f] = numbers_create(SPHG_F32, positions->count, 3);
    for (int32_t i = 0; i < positions->count; ++i)
        for (int32_t axis = 0; axis < 3; ++axis) {
            const double shift = 0.25 * skin * (2 * lattice_random(3 * (int64_t)i + axis) - 1);
            numbers_set(&bench->moved, i, axis, numbers_get(positions, i, axis) + shift);
            for (int f = 0; f < FIELDS; ++f)
                numbers_set(&bench->fields[f], i, axis,
                            sin(wave * numbers_get(positions, i, (axis + f) % 3) + f));
        }
}

static struct outputs create_outputs(int32_t count)
{
    struct outputs outputs = {.matrices = numbers_create(SPHG_F32, count, 6),
                              .divergence = numbers_create(SPHG_F32, count, 1),
                              .curl = numbers_create(SPHG_F32, count, 3)};
    for (int f = 0; f < FIELDS; ++f)
        outputs.jacobians[f] = numbers_create(SPHG_F32, count, 9);
    return outputs;
}

/* So many layers around a cube of so many particles a side. */
static struct scene wall_around(const struct scene *cube, int32_t side)
{
    enum { LAYERS = 3 };
    const int32_t all = side + 2 * LAYERS, inner = side * side * side;
    struct numbers positions = numbers_create(SPHG_F32, all * all * all - inner, 3);
    for (int32_t k = 0, at = 0; k < all * all * all; ++k) {
        const int32_t place[3] = {k % all - LAYERS, k / all % all - LAYERS, k / all / all - LAYERS};
        bool inside = true;
        for (int32_t axis = 0; axis < 3; ++axis)
            inside = inside && place[axis] >= 0 && place[axis] < side;
        for (int32_t axis = 0; axis < 3 && !inside; ++axis)
            numbers_set(&positions, at, axis, place[axis] * lattice_spacing);
        at += !inside;
    }
    struct numbers volume = numbers_create(SPHG_F32, 1, 1);
    numbers_set(&volume, 0, 0, lattice_spacing * lattice_spacing * lattice_spacing);
    return scene_open(cube->context, &cube->scheme, positions, volume);
}

/* All kinds of neighbours of one cube; and a square whose radius reaches as many particles. */
static void open_scenes(struct bench *bench, const struct settings *settings, double skin)
{
    struct scene *scenes = bench->scenes;
    struct settings in_plane = *settings;
    scenes[0] = scene_of_lattice(library_open(settings->threads), settings, 3);
    for (int k = 1; k < NEIGHBOR_KINDS; ++k)
        scenes[k] = scene_beside(&scenes[0]);
    scenes[NEIGHBORS_WEIGHTED].geometry.keep_weights = 1;
    scenes[NEIGHBORS_LIST_FREE].geometry.list_free = 1;
    scenes[NEIGHBORS_SKINNED].geometry.skin = skin;
    scene_run(&scenes[NEIGHBORS_KEPT], WORK_SEARCH);
    bench->wall = wall_around(&scenes[0], settings_side(settings->particles, 3));
    in_plane.support = sqrt((scene_pairs(&scenes[0]) + 1) / 3.14159265358979323846);
    scenes[NEIGHBORS_PLANE] = scene_of_lattice(scenes[0].context, &in_plane, 2);
    for (int k = 1; k < NEIGHBOR_KINDS; ++k)
        scene_run(&scenes[k], WORK_SEARCH);
    scene_run(&scenes[0], WORK_MATRICES);
    bench->matrices = scenes[0].corrections;
}

/* Items are rows, first the full evaluation of each. */
static double run(void *data, int32_t item)
{
    evaluate(data, &skip_rows[item / 2], item % 2);
    return 1;
}

static double begin_round(void *data, int32_t item)
{
    struct bench *bench = data;
    bench->positions_are_moved ^= item == 0;
    return 0;
}

void skip_measure(struct skip *skip)
{
    const struct settings *settings = &skip->settings;
    const double skin = 0.1 * settings->support * lattice_spacing;
    const double middle = 0.5 * (settings_side(settings->particles, 3) - 1) * lattice_spacing;
    struct bench bench = {.skip = skip};
    open_scenes(&bench, settings, skin);
    skip->count = bench.scenes[0].count;
    skip->pairs = scene_pairs(&bench.scenes[0]);
    skip->plane_pairs = scene_pairs(&bench.scenes[NEIGHBORS_PLANE]);
    fill(&bench, &bench.scenes[0].positions, skin);
    for (int part = 0; part < 2; ++part)
        bench.outputs[part] = create_outputs(skip->count);
    for (int k = 0; k < SKIP_ROWS; ++k)
        bench.patterns[k] = create_pattern(&bench.scenes[0].positions, middle, &skip_rows[k].part);
    for (int round = 0; round < 2; ++round, bench.positions_are_moved ^= true)
        for (int k = 0; k < SKIP_ROWS; ++k)
            compare_row(&bench, k);
    rounds_measure(
        &(struct rounds){"skip", settings->repetitions, 2 * SKIP_ROWS, run, begin_round, &bench},
        &skip->times[0][0]);
}
