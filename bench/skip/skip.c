/* SPDX-License-Identifier: MIT */
/* The command `skip`: what it saves not to compute what a scene does not need. The full evaluation
 * of each row is timed, and the part of it that a scene may need. */
#include "commands.h"
#include "lattice.h"
#include "particles/errors.h"
#include "particles/particles.h"
#include "report/report.h"
#include <math.h>
#include <string.h>

/* Tables of results; and bits: which are asked for. */
enum { MATRICES, DIVERGENCE, CURL, JACOBIANS, FIELDS = 4, TABLES = JACOBIANS + FIELDS };
enum { ASK_MATRICES = 1, ASK_DIVERGENCE = 2, ASK_CURL = 4, ASK_JACOBIAN = 8 };

/* Whose neighbours are asked. */
enum neighbors {
    NEIGHBORS_KEPT,     /* found before */
    NEIGHBORS_WEIGHTED, /* the same, with weights */
    NEIGHBORS_PLANE,    /* the same in 2D: as many particles and nearly as many pairs */
    NEIGHBORS_REBUILT,  /* this one and those below: found on the way */
    NEIGHBORS_LIST_FREE,
    NEIGHBORS_SKINNED, /* with a skin of 0.1 H */
    NEIGHBOR_KINDS
};

/* A second source set: three layers around the cube. */
enum wall {
    WALL_NONE,
    WALL_APART,     /* searched with the particles handed over as targets */
    WALL_TARGETS_OF /* ... with those of the particles' own neighbours */
};

/* An evaluation. */
struct ask {
    int outputs;
    enum neighbors neighbors;
    bool moved;      /* particles where they are in this round, less than half a skin away */
    bool by_table;   /* with matrices that are there */
    bool one_volume; /* for all, else an array */
    bool decomposed; /* as if no matrix were certified */
    int fields;      /* 0: one */
    bool one_by_one; /* a call for each of them */
    double share;    /* of active targets; 0: all */
    bool clustered;  /* in the middle, else scattered */
    enum wall wall;
};

struct row {
    const char *group, *what, *against;
    bool listed; /* active targets, else masked */
    struct ask part, full;
};

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

static const struct row rows[] = {
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

enum { ROWS = sizeof rows / sizeof rows[0] };

/* Of active targets. */
struct pattern {
    uint8_t *mask;
    int32_t *indices, count;
};

struct skip {
    struct settings settings;
    struct scene scenes[NEIGHBOR_KINDS];
    struct scene wall;
    struct numbers moved; /* positions, less than half a skin away */
    struct numbers fields[FIELDS], matrices;
    struct numbers outputs[2][TABLES]; /* of the full evaluation, and of the part */
    struct pattern patterns[ROWS];
    bool positions_are_moved;      /* in this round */
    bool skin_was_spent;           /* a search with skin built its lists anew */
    double deviation[ROWS];        /* largest |part - full|_F / |full|_F of a target */
    int64_t differences[ROWS];     /* targets whose bits differ */
    struct samples times[ROWS][2]; /* of the full evaluation, and of the part */
};

/* Else it is another problem. */
static bool is_compared(const struct row *row)
{
    return row->part.neighbors != NEIGHBORS_PLANE && !row->full.decomposed &&
           !row->part.wall == !row->full.wall;
}

/* ---- An evaluation --------------------------------------------------------------------------- */

static sphg_view if_asked(int asked, const struct numbers *numbers)
{
    return asked ? numbers_view(numbers) : sphg_absent();
}

/* Searches on the way where the neighbours are not those found before. */
static struct scene scene_of(struct skip *skip, const struct ask *ask)
{
    struct scene scene = skip->scenes[ask->neighbors];
    if (ask->moved && skip->positions_are_moved)
        scene.geometry.sources = numbers_view(&skip->moved);
    if (ask->neighbors >= NEIGHBORS_REBUILT)
        scene_run(&scene, WORK_SEARCH);
    if (ask->neighbors == NEIGHBORS_SKINNED)
        skip->skin_was_spent |= library_info(scene.context, scene.neighbors).rebuilt != 0;
    if (ask->one_volume)
        scene.volumes.count = 1;
    if (ask->decomposed) /* 4 eps is more than any of their eigenvalues */
        scene.scheme.threshold = 0.5;
    return scene;
}

/* Of a scene whose own neighbours are found. */
static void search_wall(const struct scene *wall, const struct scene *scene, enum wall how)
{
    struct scene beside = *wall;
    const sphg_view sources = numbers_view(&wall->positions);
    beside.geometry =
        how == WALL_TARGETS_OF
            ? sphg_targets_of(scene->neighbors, sources, wall->count)
            : sphg_targets_apart(scene->geometry.sources, scene->count, sources, wall->count);
    scene_run(&beside, WORK_SEARCH);
}

static void evaluate(struct skip *skip, const struct row *row, int part)
{
    const struct ask *ask = part ? &row->part : &row->full;
    const struct pattern *pattern = &skip->patterns[row - rows];
    const struct numbers *outputs = skip->outputs[part];
    const struct scene scene = scene_of(skip, ask);
    const bool plane = ask->neighbors == NEIGHBORS_PLANE;
    const sphg_subset subset = row->listed ? sphg_listed(pattern->indices, pattern->count)
                                           : sphg_masked(pattern->mask, scene.count);
    sphg_sources sources[] = {scene_sources(&scene), scene_sources(&skip->wall)};
    sphg_view views[FIELDS][2];
    sphg_field fields[FIELDS];
    if (ask->by_table)
        sources[0].correction = numbers_view(&skip->matrices);
    if (ask->wall)
        search_wall(&skip->wall, &scene, ask->wall);
    for (int f = 0; f < FIELDS; ++f) {
        views[f][0] = numbers_view(plane ? &scene.field : &skip->fields[f]);
        views[f][1] = numbers_view(&skip->wall.field);
        fields[f] = (sphg_field){
            .shape = SPHG_VECTOR,
            .at_sources = views[f],
            .gradient = if_asked(ask->outputs & ASK_JACOBIAN,
                                 plane ? &scene.jacobians : &outputs[JACOBIANS + f]),
            .divergence = if_asked(ask->outputs & ASK_DIVERGENCE, &outputs[DIVERGENCE]),
            .curl = if_asked(ask->outputs & ASK_CURL, &outputs[CURL])};
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
            .correction = if_asked(ask->outputs & ASK_MATRICES, &outputs[MATRICES])};
        scene_evaluate(&scene, &request);
    }
}

/* ---- Comparison ------------------------------------------------------------------------------ */

static bool has_table(const struct ask *ask, int table)
{
    const int field = table - JACOBIANS;
    return field < 0 ? ask->outputs & 1 << table
                     : ask->outputs & ASK_JACOBIAN && (field == 0 || field < ask->fields);
}

static void compare_table(struct skip *skip, int k, const struct numbers *part,
                          const struct numbers *full)
{
    const uint8_t *mask = skip->patterns[k].mask;
    const size_t size = (size_t)numbers_view(full).stride;
    for (int32_t i = 0; i < full->count; ++i) {
        const char *a = (const char *)part->data + size * (size_t)i,
                   *b = (const char *)full->data + size * (size_t)i;
        if ((mask && !mask[i]) || memcmp(a, b, size) == 0)
            continue;
        double expected[9];
        for (int32_t c = 0; c < full->width; ++c)
            expected[c] = numbers_get(full, i, c);
        ++skip->differences[k];
        skip->deviation[k] = numbers_larger(skip->deviation[k], relative_error(part, i, expected));
    }
}

/* Untimed, and warms up. What a run does not write cannot look like what the run before wrote: all
 * bits are set, which is not a number. */
static void compare_row(struct skip *skip, int k)
{
    for (int part = 0; part < 2; ++part) {
        for (int t = 0; t < TABLES; ++t) {
            const struct numbers *table = &skip->outputs[part][t];
            if (has_table(&rows[k].part, t))
                memset(table->data, 0xff,
                       (size_t)table->count * (size_t)numbers_view(table).stride);
        }
        evaluate(skip, &rows[k], part);
    }
    for (int t = 0; t < TABLES && is_compared(&rows[k]); ++t)
        if (has_table(&rows[k].part, t))
            compare_table(skip, k, &skip->outputs[1][t], &skip->outputs[0][t]);
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
                                     const struct ask *ask)
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
static void fill(struct skip *skip, const struct numbers *positions, double skin)
{
    const double wave = 2 * 3.14159265358979323846 / (32 * lattice_spacing);
    skip->moved = numbers_create(SPHG_F32, positions->count, 3);
    for (int f = 0; f < FIELDS; ++f)
        skip->fields[f] = numbers_create(SPHG_F32, positions->count, 3);
    for (int32_t i = 0; i < positions->count; ++i)
        for (int32_t axis = 0; axis < 3; ++axis) {
            const double shift = 0.25 * skin * (2 * lattice_random(3 * (int64_t)i + axis) - 1);
            numbers_set(&skip->moved, i, axis, numbers_get(positions, i, axis) + shift);
            for (int f = 0; f < FIELDS; ++f)
                numbers_set(&skip->fields[f], i, axis,
                            sin(wave * numbers_get(positions, i, (axis + f) % 3) + f));
        }
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
static void open_scenes(struct skip *skip, double skin)
{
    const struct settings *settings = &skip->settings;
    struct scene *scenes = skip->scenes;
    struct settings in_plane = *settings;
    scenes[0] = scene_of_lattice(library_open(settings->threads), settings, 3);
    for (int k = 1; k < NEIGHBOR_KINDS; ++k)
        scenes[k] = scene_beside(&scenes[0]);
    scenes[NEIGHBORS_WEIGHTED].geometry.keep_weights = 1;
    scenes[NEIGHBORS_WEIGHTED].same_volumes = true;
    scenes[NEIGHBORS_LIST_FREE].geometry.list_free = 1;
    scenes[NEIGHBORS_SKINNED].geometry.skin = skin;
    scene_run(&scenes[NEIGHBORS_KEPT], WORK_SEARCH);
    skip->wall = wall_around(&scenes[0], settings_side(settings->particles, 3));
    in_plane.support = sqrt((scene_pairs(&scenes[0]) + 1) / 3.14159265358979323846);
    scenes[NEIGHBORS_PLANE] = scene_of_lattice(scenes[0].context, &in_plane, 2);
    for (int k = 1; k < NEIGHBOR_KINDS; ++k)
        scene_run(&scenes[k], WORK_SEARCH);
    scene_run(&scenes[0], WORK_MATRICES);
    skip->matrices = scenes[0].corrections;
}

/* Items are rows, first the full evaluation of each. */
static double run(void *data, int32_t item)
{
    evaluate(data, &rows[item / 2], item % 2);
    return 1;
}

static double begin_round(void *data, int32_t item)
{
    struct skip *skip = data;
    skip->positions_are_moved ^= item == 0;
    return 0;
}

static void measure(struct skip *skip)
{
    static const int32_t widths[TABLES] = {6, 1, 3, 9, 9, 9, 9};
    const struct settings *settings = &skip->settings;
    const double skin = 0.1 * settings->support * lattice_spacing;
    const double middle = 0.5 * (settings_side(settings->particles, 3) - 1) * lattice_spacing;
    open_scenes(skip, skin);
    fill(skip, &skip->scenes[0].positions, skin);
    for (int n = 0; n < 2 * TABLES; ++n)
        skip->outputs[n / TABLES][n % TABLES] =
            numbers_create(SPHG_F32, skip->scenes[0].count, widths[n % TABLES]);
    for (int k = 0; k < ROWS; ++k)
        skip->patterns[k] = create_pattern(&skip->scenes[0].positions, middle, &rows[k].part);
    for (int round = 0; round < 2; ++round, skip->positions_are_moved ^= true)
        for (int k = 0; k < ROWS; ++k)
            compare_row(skip, k);
    rounds_measure(
        &(struct rounds){"skip", settings->repetitions, 2 * ROWS, run, begin_round, skip},
        &skip->times[0][0]);
}

static int show(const struct skip *skip)
{
    report_open("skip", &skip->settings);
    report_lattice(&skip->settings, skip->scenes[0].count, scene_pairs(&skip->scenes[0]));
    report_number(".plane_pairs", scene_pairs(&skip->scenes[NEIGHBORS_PLANE]));
    report_number("skin_was_spent", skip->skin_was_spent);
    table_begin("skip");
    for (int k = 0; k < ROWS; ++k) {
        const struct samples *full = &skip->times[k][0], *part = &skip->times[k][1];
        TABLE_ROW(cell_text("group", rows[k].group), cell_text("what", rows[k].what),
                  cell_text(".against", rows[k].against), cell_ms("full", full),
                  cell_ms("this", part), cell_number("compared", is_compared(&rows[k])),
                  cell_count("targets_with_other_bits", skip->differences[k]),
                  cell_number("deviation", skip->deviation[k]));
    }
    return report_close();
}

int command_skip(int argc, char **argv)
{
    struct skip skip = {.settings = settings_default(1000000, 9, NULL)};
    settings_read(&skip.settings, TAKES_LATTICE | TAKES_RUN, NULL,
                  "Times parts of an evaluation beside the whole: outputs that are not wanted, "
                  "particles that are not active, neighbours that are still known. Says where "
                  "results are the same to the bit.",
                  argc, argv);
    measure(&skip);
    return show(&skip);
}
