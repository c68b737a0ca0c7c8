/* SPDX-License-Identifier: MIT */
/* What objects keep from call to call (pairs, weights, grids of particles that did not move, the
 * targets of another object, copies of the host's lists) never shows: after any sequence of builds,
 * changes and sums a result has the bits that an object has which was built anew and keeps its
 * pairs alone. */
#include "fuzz.h"
#include "splitmix64.h"

enum { MOST = 96, OBJECTS = 3, WIDEST = 9, TABLE = 45, OUTPUTS = 4, STEPS = 24, NOBODY = -1 };

typedef double numbers[MOST * TABLE]; /* of either precision */

/* An object, what its last build was given, and what its sweeps are. */
typedef struct object {
    sphg_neighbors *neighbors;
    int built, count, target_count;
    int owner;     /* whose targets are this one's, or NOBODY */
    int has_lists; /* of the host */
    double support;
    sphg_geometry geometry;
    double x[MOST * 3], targets[MOST * 3], radii[MOST], target_radii[MOST];
    int64_t offsets[MOST + 1];
    int32_t indices[MOST * MOST];
    double volume[MOST], one_volume;
    int volumes_are_new; /* since the sweep before */
    int one_for_all;
} object;

typedef struct world {
    sphg_context *context, *fresh_context;
    sphg_type type, field_type;
    sphg_scheme scheme;
    object objects[OBJECTS];
    double field[OBJECTS][MOST * WIDEST], at_targets[MOST * WIDEST], table[OBJECTS][MOST * TABLE];
    double density[MOST], target_table[MOST * TABLE];
    numbers found[OUTPUTS], expected[OUTPUTS];
    uint8_t mask[MOST];
} world;

static void draw(sphg_type type, void *array, int count, double low, double high, int seed)
{
    uint64_t state = (uint64_t)seed;
    for (int k = 0; k < count; ++k)
        fuzz_put(type, array, k, splitmix64_between(&state, low, high));
}

/* ---- Builds ---------------------------------------------------------------------------------- */

/* Objects that have the targets of this one end before it changes. */
static void let_go(world *own, int k)
{
    for (int user = 0; user < OBJECTS; ++user) {
        object *at = &own->objects[user];
        if (user == k || !at->built || at->owner != k)
            continue;
        sphg_neighbors_destroy(at->neighbors);
        at->neighbors = NULL;
        at->built = 0;
        let_go(own, user);
    }
}

/* New ones, or those of before: all of them, or all but one that has moved. */
static void place_particles(world *own, fuzz_bytes *from, object *made, const object *before)
{
    const int d = own->scheme.dimension, seed = fuzz_byte(from);
    if (seed >= 96 && before->built && before->count) {
        made->count = before->count;
        memcpy(made->x, before->x, sizeof made->x);
        memcpy(made->radii, before->radii, sizeof made->radii);
        const int moved = fuzz_below(from, made->count * d);
        if (seed % 4)
            fuzz_put(own->type, made->x, moved, fuzz_get(own->type, made->x, moved) * .75 + .25);
        return;
    }
    const double side = .5 + fuzz_byte(from) / 64.;
    made->count = fuzz_below(from, MOST + 1);
    draw(own->type, made->x, made->count * d, 0, side, seed);
    draw(own->type, made->radii, made->count, .4, 1.4, seed + 1);
}

static void take_targets(world *own, fuzz_bytes *from, object *made, int k)
{
    const int d = own->scheme.dimension, kind = fuzz_byte(from), other = kind / 8 % OBJECTS;
    made->owner = NOBODY;
    made->target_count = made->count;
    if (kind % 8 == 1) {
        made->target_count = made->count / 2;
    } else if (kind % 8 == 2) {
        made->target_count = fuzz_below(from, MOST + 1);
        draw(own->type, made->targets, made->target_count * d, 0, 3, fuzz_byte(from));
        draw(own->type, made->target_radii, made->target_count, .4, 1.4, fuzz_byte(from));
    } else if (kind % 8 > 4 && other != k && own->objects[other].built &&
               !own->objects[other].has_lists) {
        const object *lender = &own->objects[other];
        made->owner = other;
        made->target_count = lender->target_count;
        const int apart = lender->geometry.targets.x != NULL;
        memcpy(made->targets, apart ? lender->targets : lender->x, sizeof made->targets);
        memcpy(made->target_radii, apart ? lender->target_radii : lender->radii,
               sizeof made->target_radii);
    }
    if (kind % 8 == 2 || made->owner != NOBODY)
        made->geometry.targets = fuzz_view(own->type, made->targets, d);
}

/* Each target lists every so many of the sources, itself among them. */
static void write_lists(object *made, int step)
{
    int64_t n = 0;
    for (int i = 0; i < made->target_count; ++i) {
        for (int j = i % step; j < made->count; j += step)
            made->indices[n++] = j;
        made->offsets[i + 1] = n;
    }
}

/* The geometry without what is kept: targets are handed over, lists are borrowed. */
static sphg_result build_plainly(world *own, const object *made, sphg_neighbors *neighbors)
{
    sphg_geometry geometry = made->geometry;
    sphg_scheme scheme = own->scheme;
    const sphg_lists lists = {.offsets = made->offsets, .indices = made->indices};
    scheme.support_radius = made->support;
    scheme.order =
        1; /* a search reads no more than radius and dimension, and refuses what is no scheme */
    return made->has_lists
               ? sphg_neighbors_use_lists(own->fresh_context, neighbors, &scheme, &geometry, &lists)
               : sphg_neighbors_search(own->fresh_context, neighbors, &scheme, &geometry);
}

static sphg_result build_keeping(world *own, object *made, int flags)
{
    sphg_geometry geometry = made->geometry;
    if (made->has_lists) {
        static int32_t indices[MOST * MOST];
        memcpy(indices, made->indices, sizeof indices);
        const sphg_lists lists = {.offsets = made->offsets, .indices = indices, .copy = 1};
        const sphg_result result = sphg_neighbors_use_lists(own->context, made->neighbors,
                                                            &own->scheme, &geometry, &lists);
        memset(indices, -1, sizeof indices);
        return result;
    }
    geometry.keep_weights = flags & 1;
    geometry.list_free = flags % 4 == 2;
    if (made->owner != NOBODY) {
        geometry.targets = geometry.target_support = sphg_absent();
        geometry.target_count = 0;
        geometry.targets_of = own->objects[made->owner].neighbors;
    }
    return sphg_neighbors_search(own->context, made->neighbors, &own->scheme, &geometry);
}

/* A build does not change them. */
static void take_volumes(world *own, fuzz_bytes *from, object *made, const object *before)
{
    memcpy(made->volume, before->volume, sizeof made->volume);
    made->one_volume = before->one_volume;
    made->one_for_all = before->one_for_all;
    made->volumes_are_new = before->volumes_are_new;
    if (before->built)
        return;
    draw(own->field_type, made->volume, MOST, .1, 1, fuzz_byte(from));
    fuzz_put(own->field_type, &made->one_volume, 0, .625);
    made->volumes_are_new = 1;
}

static void build(world *own, fuzz_bytes *from)
{
    static object made;
    const int k = fuzz_byte(from) % OBJECTS, flags = fuzz_byte(from), d = own->scheme.dimension;
    object *at = &own->objects[k];
    let_go(own, k);
    if (!at->neighbors && sphg_neighbors_create(own->context, &at->neighbors) != SPHG_OK)
        abort();
    made = (object){.neighbors = at->neighbors, .built = 1};
    take_volumes(own, from, &made, at);
    made.support = own->scheme.support_radius;
    place_particles(own, from, &made, at);
    made.geometry = (sphg_geometry){.sources = fuzz_view(own->type, made.x, d),
                                    .source_count = made.count,
                                    .precision = own->field_type};
    take_targets(own, from, &made, k);
    made.geometry.target_count = made.target_count;
    made.has_lists = (flags & 12) == 12 && made.owner == NOBODY;
    if (made.has_lists) {
        write_lists(&made, 1 + fuzz_byte(from) % 4);
    } else {
        /* of targets with radii, sources have theirs, too: they could be without, but not plainly
         */
        const int radii = made.owner == NOBODY
                              ? (flags & 16) != 0
                              : own->objects[made.owner].geometry.source_support.x != NULL;
        if (radii) {
            made.geometry.source_support = fuzz_view(own->type, made.radii, 1);
            if (made.geometry.targets.x)
                made.geometry.target_support = fuzz_view(own->type, made.target_radii, 1);
            made.geometry.mutual = (flags & 32) != 0;
        }
        made.geometry.period[0] = flags / 64 == 3 ? 7 : 0;
    }
    if (build_keeping(own, &made, flags) == SPHG_OK) {
        *at = made;
        at->geometry.sources.x = at->x; /* views of the copy */
        if (at->geometry.targets.x)
            at->geometry.targets.x = at->targets;
        if (at->geometry.source_support.x)
            at->geometry.source_support.x = at->radii;
        if (at->geometry.target_support.x)
            at->geometry.target_support.x = at->target_radii;
    }
}

/* ---- Sums ------------------------------------------------------------------------------------ */

static int width_of(sphg_shape shape, int d)
{
    return shape == SPHG_SCALAR       ? 1
           : shape == SPHG_VECTOR     ? d
           : shape == SPHG_SYM_TENSOR ? d * (d + 1) / 2
                                      : d * d;
}

/* One request, to be put twice. */
typedef struct question {
    int objects[2], sets;
    sphg_form form;
    sphg_shape shape;
    int outputs;     /* of the field, bits */
    int accumulate;  /* to what the outputs hold */
    int tables;      /* of corrections are given */
    int corrections; /* are wanted: 1 beside the field, 2 alone */
    int at_targets;  /* values at the targets are given */
    int has_subset;
    sphg_subset subset;
} question;

static sphg_view output(world *own, numbers *to, int k, int width)
{
    return fuzz_view(own->field_type, to[k], width);
}

static sphg_field field_of(world *own, const question *q, numbers *to)
{
    const int d = own->scheme.dimension;
    sphg_field field = {.shape = q->shape, .form = q->form, .accumulate = q->accumulate};
    if (q->shape == SPHG_SCALAR)
        field.gradient = output(own, to, 0, d);
    else if (q->shape == SPHG_VECTOR && q->outputs & 1)
        field.gradient = output(own, to, 0, d * d);
    else
        field.divergence = output(own, to, 0, q->shape == SPHG_VECTOR ? 1 : d);
    if (q->shape == SPHG_VECTOR && q->outputs & 2)
        field.curl = output(own, to, 1, d == 3 ? 3 : 1);
    if (q->form <= SPHG_DIRECT && q->outputs & 4 && q->shape <= SPHG_VECTOR)
        field.value = output(own, to, 2, width_of(q->shape, d));
    if (q->at_targets)
        field.at_targets = fuzz_view(own->field_type, own->at_targets, width_of(q->shape, d));
    return field;
}

static sphg_sources sources_of(world *own, const question *q, int set, int keeping)
{
    const object *at = &own->objects[q->objects[set]];
    const sphg_type type = own->field_type;
    sphg_sources sources = {.volume = fuzz_view(type, at->volume, 1),
                            .density = fuzz_view(type, own->density, 1),
                            .same_volumes = keeping && !at->volumes_are_new};
    if (at->one_for_all)
        sources.volume = (sphg_view){.x = &at->one_volume, .type = type};
    if (q->tables)
        sources.correction =
            fuzz_view(type, own->table[q->objects[set]], sphg_correction_width(&own->scheme));
    return sources;
}

static sphg_request request_of(world *own, const question *q, numbers *to)
{
    const int width = sphg_correction_width(&own->scheme);
    const sphg_type type = own->field_type;
    sphg_request request = {.set_count = q->sets, .field_count = q->corrections != 2};
    if (q->has_subset)
        request.subset = &q->subset;
    if (q->corrections)
        request.correction = output(own, to, 3, width);
    if (q->at_targets) {
        request.target_volume = fuzz_view(type, own->density, 1);
        request.target_density = fuzz_view(type, own->density, 1);
    }
    if (q->at_targets && q->tables)
        request.target_correction = fuzz_view(type, own->target_table, width);
    return request;
}

static sphg_result ask(world *own, const question *q, sphg_neighbors *const *neighbors, int keeping,
                       numbers *to, sphg_stats *stats)
{
    sphg_scheme scheme = own->scheme;
    sphg_sources sources[2];
    sphg_view views[2];
    sphg_field field = field_of(own, q, to);
    sphg_request request = request_of(own, q, to);
    for (int s = 0; s < q->sets; ++s) {
        const object *at = &own->objects[q->objects[s]];
        sources[s] = sources_of(own, q, s, keeping);
        sources[s].neighbors = neighbors[s];
        views[s] = fuzz_view(own->field_type, own->field[q->objects[s]],
                             width_of(q->shape, scheme.dimension));
        scheme.support_radius = fmin(scheme.support_radius, at->support);
    }
    field.at_sources = views;
    request.sources = sources;
    request.fields = request.field_count ? &field : NULL;
    request.stats = q->corrections ? stats : NULL;
    return sphg_evaluate(keeping ? own->context : own->fresh_context, &scheme, &request);
}

static sphg_result ask_afresh(world *own, const question *q, sphg_stats *stats)
{
    sphg_neighbors *neighbors[2] = {NULL, NULL};
    sphg_result result = SPHG_OK;
    for (int s = 0; s < q->sets && !result; ++s) {
        result = sphg_neighbors_create(own->fresh_context, &neighbors[s]);
        if (!result)
            result = build_plainly(own, &own->objects[q->objects[s]], neighbors[s]);
        FUZZ_REQUIRE(!result, "a geometry that was taken is refused: %s",
                     sphg_last_message(own->fresh_context));
    }
    result = ask(own, q, neighbors, 0, own->expected, stats);
    for (int s = 0; s < q->sets; ++s)
        sphg_neighbors_destroy(neighbors[s]);
    return result;
}

static void take_subset(world *own, fuzz_bytes *from, question *q, int n)
{
    const int selected = fuzz_byte(from), kind = selected % 4;
    q->has_subset = n && kind;
    if (!q->has_subset)
        return;
    for (int i = 0; i < n; ++i)
        own->mask[i] = (selected / 4 + i) % (2 + selected % 7) == 0;
    q->subset = kind == 1 ? sphg_range(selected % n, n) : sphg_masked(own->mask, n);
}

/* What the library would refuse is asked now and then, not mostly. */
static question question_of(world *own, fuzz_bytes *from)
{
    question q = {.objects = {fuzz_byte(from) % OBJECTS}, .sets = 1};
    const object *first = &own->objects[q.objects[0]];
    const int flags = fuzz_byte(from);
    for (int k = 0; k < OBJECTS; ++k)
        if (flags & 1 && own->objects[k].built && own->objects[k].owner == q.objects[0]) {
            q.objects[1] = k;
            q.sets = 2;
        }
    q.form = (sphg_form)(fuzz_byte(from) % 4);
    q.shape = (sphg_shape)(1 + fuzz_byte(from) % 4);
    q.outputs = fuzz_byte(from);
    q.accumulate = (flags & 2) != 0;
    if (own->scheme.method != SPHG_PLAIN) {
        q.tables = q.form >= SPHG_SYMMETRIC ? flags % 32 != 31 : (flags & 4) != 0;
        q.corrections = q.tables ? 0 : flags / 8 % 3;
    }
    q.at_targets = first->geometry.targets.x || flags & 128;
    take_subset(own, from, &q, first->target_count);
    return q;
}

static void sum(world *own, fuzz_bytes *from)
{
    const question q = question_of(own, from);
    sphg_neighbors *neighbors[2] = {own->objects[q.objects[0]].neighbors,
                                    own->objects[q.objects[1]].neighbors};
    sphg_stats stats = {0}, expected_stats = {0};
    if (!own->objects[q.objects[0]].built)
        return;
    memset(own->found, 0x21, sizeof own->found);
    memset(own->expected, 0x21, sizeof own->expected);
    const sphg_result result = ask(own, &q, neighbors, 1, own->found, &stats);
    const sphg_result expected = ask_afresh(own, &q, &expected_stats);
    FUZZ_REQUIRE(result == expected, "%d (%s) instead of %d (%s)", (int)result,
                 sphg_last_message(own->context), (int)expected,
                 sphg_last_message(own->fresh_context));
    for (int s = 0; s < q.sets; ++s)
        own->objects[q.objects[s]].volumes_are_new |= result != SPHG_OK;
    if (result)
        return;
    for (int k = 0; k < OUTPUTS; ++k)
        FUZZ_REQUIRE(memcmp(own->found[k], own->expected[k], sizeof own->found[k]) == 0,
                     "output %d of form %d, shape %d, method %d, order %d", k, (int)q.form,
                     (int)q.shape, (int)own->scheme.method, (int)own->scheme.order);
    FUZZ_REQUIRE(memcmp(&stats, &expected_stats, sizeof stats) == 0, "other counts");
    for (int s = 0; s < q.sets; ++s)
        own->objects[q.objects[s]].volumes_are_new = 0;
}

/* ---- Sequences ------------------------------------------------------------------------------- */

/* One thing at a time: what is kept must know each of them. */
static void change_scheme(world *own, fuzz_bytes *from)
{
    const int member = fuzz_byte(from) % 5, to = fuzz_byte(from);
    sphg_scheme *scheme = &own->scheme;
    if (member == 0)
        scheme->method = (sphg_method)(to % 6);
    else if (member == 1)
        scheme->kernel = (sphg_kernel)(to % 7);
    else if (member == 2)
        scheme->policy = (sphg_policy)(to % 4);
    else if (member == 3)
        scheme->support_radius = .5 + to % 16 / 16.;
    scheme->order = scheme->method <= SPHG_RKPM && member == 4 ? 1 + to % 2 : 1;
}

static void change_volumes(world *own, fuzz_bytes *from)
{
    object *at = &own->objects[fuzz_byte(from) % OBJECTS];
    const int kind = fuzz_byte(from);
    at->volumes_are_new = 1;
    at->one_for_all = kind & 1;
    if (kind & 2)
        fuzz_put(own->field_type, &at->one_volume, 0, .1 + kind / 128.);
    if (kind & 4)
        fuzz_put(own->field_type, at->volume, kind % MOST, .5 + kind / 256.);
    else if (kind & 8)
        draw(own->field_type, at->volume, MOST, .1, 1, kind);
}

static void begin(world *own, fuzz_bytes *from, size_t size)
{
    static world blank;
    const sphg_config config = {.threads = 1, .isa = fuzz_isa(size)};
    const int flags = fuzz_byte(from);
    *own = blank;
    own->type = flags & 1 ? SPHG_F64 : SPHG_F32;
    own->field_type = flags & 2 ? SPHG_F32 : own->type;
    own->scheme = (sphg_scheme){.dimension = flags & 4 ? 2 : 3, .support_radius = 1};
    FUZZ_REQUIRE(sphg_context_create(SPHG_VERSION, &config, &own->context) == SPHG_OK &&
                     sphg_context_create(SPHG_VERSION, &config, &own->fresh_context) == SPHG_OK,
                 "no context");
    for (int k = 0; k < OBJECTS; ++k) {
        draw(own->field_type, own->field[k], MOST * WIDEST, -1, 1, 10 + k);
        draw(own->field_type, own->table[k], MOST * TABLE, -1, 1, 20 + k);
    }
    draw(own->field_type, own->at_targets, MOST * WIDEST, -1, 1, 30);
    draw(own->field_type, own->target_table, MOST * TABLE, -1, 1, 31);
    draw(own->field_type, own->density, MOST, .5, 2, 32);
}

int LLVMFuzzerTestOneInput(const uint8_t *data, size_t size)
{
    static world own;
    fuzz_bytes from = {data, size};
    begin(&own, &from, size);
    for (int k = 0; k < STEPS && from.left; ++k) {
        const int step = fuzz_byte(&from) % 8;
        if (step < 2)
            build(&own, &from);
        else if (step == 2)
            change_scheme(&own, &from);
        else if (step == 3)
            change_volumes(&own, &from);
        else
            sum(&own, &from);
    }
    for (int k = OBJECTS - 1; k >= 0; --k)
        let_go(&own, k);
    for (int k = 0; k < OBJECTS; ++k)
        sphg_neighbors_destroy(own.objects[k].neighbors);
    sphg_context_destroy(own.context);
    sphg_context_destroy(own.fresh_context);
    return 0;
}
