/* SPDX-License-Identifier: MIT */
/* Groups whose lists stand side by side, kept or found on the spot, go from ids to sums in one
 * pass, where a few fields or the corrections are wanted; forces and other divergences of all
 * targets read records; some of the targets are put together from several groups, or read copies.
 * The bits are those of targets that are found and asked for a few at a time, which go step by
 * step. */
#include "support/setup.h"
#include <math.h>
#include <string.h>

typedef struct scene {
    const test_case *test;
    sphg_context *context;
    sphg_scheme scheme;
    cloud points;
    setup_array positions, radii, volume, one_volume, scalar, vector, matrix, density, table;
    int graded;                                   /* each particle has a radius of its own */
    int targets;                                  /* the first of the particles */
    const sphg_neighbors *found, *kept, *weighed; /* the last with weights that are kept */
} scene;

static setup_array numbers_of(const scene *of, int width, random_state *random)
{
    const setup_array numbers = setup_output(test_field_type(of->test), of->points.count, width);
    for (int k = 0; k < of->points.count * width; ++k)
        setup_put(&numbers, k, random_between(random, -1, 1));
    return numbers;
}

static const sphg_neighbors *neighbors_of(const scene *of, int list_free, int keep_weights)
{
    cloud points = of->points;
    sphg_geometry geometry = setup_geometry(of->test, &points, &of->positions);
    geometry.target_count = of->targets;
    geometry.list_free = list_free;
    geometry.keep_weights = keep_weights;
    if (of->graded)
        geometry.source_support = setup_view(&of->radii);
    return setup_search(of->context, &of->scheme, &geometry);
}

static setup_array radii_of(const scene *of, double radius, random_state *random)
{
    const setup_array radii = setup_output(test_position_type(of->test), of->points.count, 1);
    for (int k = 0; k < of->points.count; ++k)
        setup_put(&radii, k, radius * random_between(random, .8, 1));
    return radii;
}

static void find_neighbors(scene *of)
{
    of->found = neighbors_of(of, 1, 0);
    of->kept = neighbors_of(of, 0, 0);
    of->weighed = neighbors_of(of, 0, 1);
}

/* Few particles, but enough groups that one without a whole vector of targets may be left over
 * where the others read records. */
static scene scene_on(const test_case *test, sphg_context *context, double radius, int graded)
{
    scene of = {
        .test = test, .context = context, .scheme = setup_scheme(test, radius), .graded = graded};
    random_state random = random_seeded(83);
    of.points = cloud_jittered(test->dimension, test->dimension == 3 ? 7 : 19, 1, .3, &random);
    of.positions = setup_positions(test, &of.points);
    of.volume = setup_numbers(test_field_type(test), of.points.count, 1,
                              cloud_volumes(&of.points, .3, &random));
    of.one_volume = setup_numbers(test_field_type(test), 1, 1, (const double[]){.875});
    of.scalar = numbers_of(&of, 1, &random);
    of.vector = numbers_of(&of, test->dimension, &random);
    of.matrix = numbers_of(&of, test->dimension * test->dimension, &random);
    of.table = numbers_of(&of, test->dimension * (test->dimension + 1) / 2, &random);
    of.density = setup_numbers(test_field_type(test), of.points.count, 1,
                               cloud_numbers(&of.points, .5, 2, &random));
    of.radii = radii_of(&of, radius, &random);
    of.targets = of.points.count;
    find_neighbors(&of);
    return of;
}

typedef struct wish {
    const char *name;
    int corrections;  /* a table is wanted */
    sphg_shape shape; /* 0: no field */
    sphg_form form;
    int divergence; /* instead of the gradient */
    int mirror;     /* A_j = A_i */
} wish;

static const wish wishes[] = {
    {"corrections", 1, 0, SPHG_DIFFERENCE, 0, 0},
    {"gradient of a scalar", 0, SPHG_SCALAR, SPHG_DIFFERENCE, 0, 0},
    {"gradient of a scalar, and corrections", 1, SPHG_SCALAR, SPHG_DIFFERENCE, 0, 0},
    {"Jacobian", 0, SPHG_VECTOR, SPHG_DIFFERENCE, 0, 0},
    {"Jacobian and corrections", 1, SPHG_VECTOR, SPHG_DIFFERENCE, 0, 0},
    {"direct Jacobian", 0, SPHG_VECTOR, SPHG_DIRECT, 0, 0},
    {"divergence", 0, SPHG_VECTOR, SPHG_DIFFERENCE, 1, 0},
    {"direct divergence", 0, SPHG_VECTOR, SPHG_DIRECT, 1, 0},
    {"mirrored Jacobian", 0, SPHG_VECTOR, SPHG_DIRECT, 0, 1},
    {"mirrored divergence", 0, SPHG_VECTOR, SPHG_DIRECT, 1, 1},
    {"force of a pressure", 0, SPHG_SCALAR, SPHG_ADJOINT, 0, 0},
    {"adjoint divergence", 0, SPHG_VECTOR, SPHG_ADJOINT, 1, 0},
    {"adjoint Jacobian", 0, SPHG_VECTOR, SPHG_ADJOINT, 0, 0},
    {"force of a stress", 0, SPHG_SYM_TENSOR, SPHG_ADJOINT, 1, 0},
    {"adjoint divergence of a tensor", 0, SPHG_TENSOR, SPHG_ADJOINT, 1, 0},
    {"divergence of a symmetric tensor", 0, SPHG_SYM_TENSOR, SPHG_DIFFERENCE, 1, 0},
    {"divergence of a tensor", 0, SPHG_TENSOR, SPHG_DIFFERENCE, 1, 0},
    {"symmetric force of a pressure", 0, SPHG_SCALAR, SPHG_SYMMETRIC, 0, 0},
    {"symmetric divergence", 0, SPHG_VECTOR, SPHG_SYMMETRIC, 1, 0},
    {"symmetric force of a stress", 0, SPHG_SYM_TENSOR, SPHG_SYMMETRIC, 1, 0},
    {"symmetric divergence of a tensor", 0, SPHG_TENSOR, SPHG_SYMMETRIC, 1, 0},
};
enum { WISHES = sizeof wishes / sizeof wishes[0] };

static int is_classic(const scene *of)
{
    return of->test->method == SPHG_CMLS || of->test->method == SPHG_CRKPM;
}

/* PLAIN has no corrections; lists that are not mutual lack pairs of two-sided forms. Order 2 has
 * differences. Two-sided forms of classic methods go step by step. */
static int is_offered(const scene *of, const wish *w)
{
    if (of->scheme.order == 2)
        return w->form == SPHG_DIFFERENCE;
    if (is_classic(of))
        return w->form < SPHG_SYMMETRIC;
    return !(of->test->method == SPHG_PLAIN && w->corrections) &&
           !(of->graded && w->form >= SPHG_SYMMETRIC);
}

/* Both ends of a pair are corrected: there must be a table, whatever it holds. */
static int takes_a_table(const scene *of, const wish *w)
{
    return of->test->method != SPHG_PLAIN && w->form >= SPHG_SYMMETRIC;
}

static int numbers_of_result(const wish *w, int d)
{
    const int rows = w->shape == SPHG_SCALAR || w->shape == SPHG_VECTOR ? 1 : d;
    const int components = w->shape == SPHG_SCALAR ? 1 : d;
    return w->divergence ? rows : components * d;
}

static int numbers_of_table(const scene *of)
{
    const int d = of->test->dimension, pairs = d * (d + 1) / 2, all = d + pairs;
    return of->scheme.order == 2 ? all * (all + 1) / 2 : is_classic(of) ? (d + 1) * (d + 1) : pairs;
}

typedef struct outcome {
    setup_array table, result;
} outcome;

static outcome nothing_yet(const scene *of, const wish *w)
{
    const sphg_type type = test_field_type(of->test);
    return (outcome){
        setup_output(type, of->points.count, w->corrections ? numbers_of_table(of) : 1),
        setup_output(type, of->points.count, numbers_of_result(w, of->test->dimension))};
}

static sphg_view numbers_for(const scene *of, const wish *w)
{
    return setup_view(w->shape == SPHG_SCALAR   ? &of->scalar
                      : w->shape == SPHG_VECTOR ? &of->vector
                                                : &of->matrix);
}

static sphg_field field_for(const wish *w, const sphg_view *numbers, const outcome *to)
{
    static const sphg_view absent;
    sphg_field wanted = {.shape = w->shape,
                         .form = w->form,
                         .at_sources = w->mirror ? &absent : numbers,
                         .mirror = w->mirror};
    if (w->mirror)
        wanted.at_targets = *numbers;
    if (w->divergence)
        wanted.divergence = setup_view(&to->result);
    else
        wanted.gradient = setup_view(&to->result);
    return wanted;
}

static void evaluate(const scene *of, const wish *w, const sphg_neighbors *neighbors,
                     sphg_view volume, const sphg_subset *subset, const outcome *to)
{
    const sphg_view field = numbers_for(of, w);
    sphg_sources sources = {.neighbors = neighbors, .volume = volume, .same_volumes = 1};
    if (w->form == SPHG_SYMMETRIC)
        sources.density = setup_view(&of->density);
    if (takes_a_table(of, w))
        sources.correction = setup_view(&of->table);
    const sphg_field wanted = field_for(w, &field, to);
    sphg_request request = {.sources = &sources,
                            .fields = w->shape ? &wanted : NULL,
                            .set_count = 1,
                            .field_count = w->shape ? 1 : 0,
                            .subset = subset};
    if (w->corrections)
        request.correction = setup_view(&to->table);
    SETUP_OK(of->context, sphg_evaluate(of->context, &of->scheme, &request));
}

/* Memory of a wish, for one evaluation after the other; `all`: by one volume, by one for each. */
typedef struct outcomes {
    outcome none, all[2], expected, got;
} outcomes;

/* Of all offered wishes, which have the corrections of the long way in common. */
static outcomes *outcomes_of(const scene *of)
{
    static const wish corrections = {.corrections = 1};
    const outcome common[] = {nothing_yet(of, &corrections), nothing_yet(of, &corrections)};
    outcomes *own = test_memory(WISHES * sizeof *own);
    for (int k = 0; k < WISHES; ++k) {
        const wish *w = &wishes[k];
        if (!is_offered(of, w))
            continue;
        own[k] = (outcomes){nothing_yet(of, w),
                            {nothing_yet(of, w), nothing_yet(of, w)},
                            nothing_yet(of, w),
                            nothing_yet(of, w)};
        for (int each = 0; w->corrections && each < 2; ++each)
            own[k].all[each].table = common[each].table;
    }
    return own;
}

/* Items of the first targets that a mask selects; the others' are those of `none`. */
static void take(const setup_array *to, const setup_array *from, const setup_array *none,
                 const uint8_t *mask, int targets)
{
    const size_t number = to->type == SPHG_F64 ? sizeof(double) : sizeof(float);
    const size_t item = (size_t)to->width * number;
    for (int i = 0; i < to->count; ++i) {
        const setup_array *source = mask && i < targets && mask[i] ? from : none;
        memcpy((char *)to->data + (size_t)i * item, (char *)source->data + (size_t)i * item, item);
    }
}

static void take_both(const outcomes *own, const outcome *from, const outcome *to,
                      const uint8_t *mask, int targets)
{
    take(&to->table, &from->table, &own->none.table, mask, targets);
    take(&to->result, &from->result, &own->none.result, mask, targets);
}

static sphg_view volume_of(const scene *of, int each)
{
    sphg_view volume = setup_view(each ? &of->volume : &of->one_volume);
    if (!each)
        volume.stride = 0;
    return volume;
}

/* Wishes that may stand in one request: they want the same of the sources. */
static int stands_with(const scene *of, const wish *w, int table)
{
    return is_offered(of, w) && takes_a_table(of, w) == table;
}

static void evaluate_together(const scene *of, int table, const sphg_subset *subset, int each,
                              const outcomes *own)
{
    sphg_view numbers[WISHES];
    sphg_field fields[WISHES];
    sphg_sources sources = {
        .neighbors = of->found, .volume = volume_of(of, each), .same_volumes = 1};
    sphg_request request = {
        .sources = &sources, .fields = fields, .set_count = 1, .subset = subset};
    sources.density = setup_view(&of->density); /* of no matter to those that are not symmetric */
    if (table)
        sources.correction = setup_view(&of->table);
    for (int k = 0; k < WISHES; ++k) {
        const wish *w = &wishes[k];
        const outcome *to = &own[k].all[each];
        if (!stands_with(of, w, table))
            continue;
        if (w->corrections)
            request.correction = setup_view(&to->table);
        if (!w->shape)
            continue;
        numbers[request.field_count] = numbers_for(of, w);
        fields[request.field_count] = field_for(w, &numbers[request.field_count], to);
        ++request.field_count;
    }
    if (request.field_count)
        SETUP_OK(of->context, sphg_evaluate(of->context, &of->scheme, &request));
}

/* Of all: lists that are found on the spot, of each group so few targets at a time that they are
 * not laid side by side, and more fields than one pass takes. */
static void long_way(const scene *of, int each, const outcomes *own)
{
    enum { PARTS = 4 };
    uint8_t mask[1024];
    for (int part = 0; part < PARTS; ++part) {
        for (int i = 0; i < of->targets; ++i)
            mask[i] = i % PARTS == part;
        const sphg_subset some = sphg_masked(mask, of->targets);
        evaluate_together(of, 0, &some, each, own);
        evaluate_together(of, 1, &some, each, own);
    }
}

/* Every way to have neighbours. Weights are written by the first sweep, unless those of the same
 * volumes stand, and read by the next. */
enum { SUPPLIES = 4 };
static const char *const supply_names[SUPPLIES] = {"found", "kept", "weights kept",
                                                   "weights kept, again"};

static const sphg_neighbors *supply(const scene *of, int number)
{
    return number == 0 ? of->found : number == 1 ? of->kept : of->weighed;
}

/* Some of the targets by every second supply, of one wish these and of the next the others. */
static void require_same(const scene *of, const wish *w, const outcomes *own, int each,
                         const sphg_subset *subset, const char *how)
{
    const outcome *all = &own->all[each], *expected = subset ? &own->expected : all;
    if (subset)
        take_both(own, all, expected, subset->mask, of->targets);
    for (int k = subset ? (int)(w - wishes) % 2 : 0; k < SUPPLIES; k += subset ? 2 : 1) {
        take_both(own, &own->none, &own->got, NULL, 0);
        evaluate(of, w, supply(of, k), volume_of(of, each), subset, &own->got);
        TEST_REQUIRE(setup_same_bits(&expected->table, &own->got.table), "%s, %s, %s: corrections",
                     w->name, how, supply_names[k]);
        TEST_REQUIRE(setup_same_bits(&expected->result, &own->got.result), "%s, %s, %s", w->name,
                     how, supply_names[k]);
    }
}

/* Most: groups are summed whole. Some: those of several are put together. Few: the rows of their
 * neighbours are copied. */
enum { MOST, SOME, FEW, SHARES };

static sphg_subset share_of(const scene *of, int share)
{
    uint8_t *mask = test_memory((size_t)of->targets);
    for (int i = 0; i < of->targets; ++i)
        mask[i] = (uint8_t)(share == MOST   ? i % 8 != 3
                            : share == SOME ? i * i % 7 == 2
                                            : i % 49 == 5);
    return sphg_masked(mask, of->targets);
}

static void require_all(const scene *of, const char *how)
{
    static const char *const names[] = {"most", "some", "few"};
    const sphg_subset shares[] = {share_of(of, MOST), share_of(of, SOME), share_of(of, FEW)};
    const outcomes *all = outcomes_of(of);
    long_way(of, 0, all);
    long_way(of, 1, all);
    for (int k = 0; k < WISHES; ++k) {
        const wish *w = &wishes[k];
        const outcomes *own = &all[k];
        if (!is_offered(of, w))
            continue;
        require_same(of, w, own, 0, NULL, test_text("%s, one volume", how));
        require_same(of, w, own, 0, &shares[FEW], test_text("%s, few, one volume", how));
        require_same(of, w, own, 1, NULL, how);
        for (int share = 0; share < SHARES; ++share)
            require_same(of, w, own, 1, &shares[share], test_text("%s, %s", how, names[share]));
    }
}

/* Lists of one chunk, of several, and of so many that rounding is carried along. */
static void the_bits_are_those_of_the_long_way(const test_case *test)
{
    const double radius[] = {2, 3, 4.5};
    for (sphg_isa isa = SPHG_ISA_BASE; isa <= SPHG_ISA_NEON; ++isa) {
        sphg_context *context = setup_watched_context_on(isa);
        for (int k = 0; context && k < 3; ++k) {
            if (!test_takes(test, k, 3))
                continue;
            const scene of = scene_on(test, context, radius[k], 0);
            require_all(&of, test_text("path %d, H = %g", (int)isa, radius[k]));
        }
    }
}

/* Forces, with radii of both ends, do not go it. */
static void radii_of_their_own_go_it(const test_case *test)
{
    const double radius[] = {2.2, 4.5};
    for (sphg_isa isa = SPHG_ISA_BASE; isa <= SPHG_ISA_NEON; ++isa) {
        sphg_context *context = setup_watched_context_on(isa);
        for (int k = 0; context && k < 2; ++k) {
            if (!test_takes(test, k, 2))
                continue;
            const scene of = scene_on(test, context, radius[k], 1);
            require_all(&of, test_text("path %d, radii up to %g", (int)isa, radius[k]));
        }
    }
}

/* Targets among which A_i is not found at their place, for they stand in a grid of their own. */
static void some_of_the_particles_go_it(const test_case *test)
{
    for (sphg_isa isa = SPHG_ISA_BASE; isa <= SPHG_ISA_NEON; ++isa) {
        sphg_context *context = setup_watched_context_on(isa);
        for (int graded = 0; context && graded < 2; ++graded) {
            if (!test_takes(test, graded, 2))
                continue;
            scene of = scene_on(test, context, 3, graded);
            of.targets -= of.targets / 4;
            find_neighbors(&of);
            require_all(&of, test_text("path %d, %s", (int)isa, graded ? "radii" : "one radius"));
        }
    }
}

/* ---- Several fields -------------------------------------------------------------------------- */

/* A letter for each field: of a scalar the gradient (s) or the force of a pressure (p), of a vector
 * the Jacobian (v) or the divergence (d); large letters: direct, not differences. */
static const char *const mixtures[] = {"vv", "vs",   "sv",       "ss",        "Vs", "sV",
                                       "vS", "VsvS", "svvssvVs", "vvvvsssss", "dv", "vd",
                                       "sD", "dsDs", "pv",       "sdp",       "pp"};
enum { MIXTURES = sizeof mixtures / sizeof mixtures[0], FIELDS_MOST = 9 };

typedef struct mixed_fields {
    int count;
    sphg_view views[FIELDS_MOST];
    sphg_field fields[FIELDS_MOST];
    setup_array results[FIELDS_MOST];
} mixed_fields;

static sphg_field field_of(const scene *of, char letter, const sphg_view *view, setup_array *result)
{
    const int d = of->test->dimension, scalar = letter == 's' || letter == 'S' || letter == 'p';
    const int divergence = letter == 'd' || letter == 'D';
    sphg_field field = {.shape = scalar ? SPHG_SCALAR : SPHG_VECTOR, .at_sources = view};
    if (letter == 'p')
        field.form = SPHG_ADJOINT;
    else if (letter < 'a')
        field.form = SPHG_DIRECT;
    *result = setup_output(test_field_type(of->test), of->points.count,
                           divergence ? 1
                           : scalar   ? d
                                      : d * d);
    if (divergence)
        field.divergence = setup_view(result);
    else
        field.gradient = setup_view(result);
    return field;
}

static mixed_fields *mixed(const scene *of, const char *letters)
{
    mixed_fields *all = test_memory(sizeof *all);
    random_state random = random_seeded(17);
    for (all->count = 0; letters[all->count]; ++all->count) {
        const char letter = letters[all->count];
        const int width = strchr("sSp", letter) ? 1 : of->test->dimension;
        const setup_array numbers = numbers_of(of, width, &random);
        sphg_view *view = &all->views[all->count];
        *view = setup_view(&numbers);
        all->fields[all->count] = field_of(of, letter, view, &all->results[all->count]);
    }
    return all;
}

static void sum_fields(const scene *of, const sphg_neighbors *neighbors, const sphg_subset *subset,
                       const sphg_field *fields, int count, const setup_array *table)
{
    const sphg_sources sources = {
        .neighbors = neighbors, .volume = setup_view(&of->volume), .same_volumes = 1};
    sphg_request request = {.sources = &sources,
                            .fields = fields,
                            .set_count = 1,
                            .field_count = count,
                            .subset = subset};
    if (table)
        request.correction = setup_view(table);
    SETUP_OK(of->context, sphg_evaluate(of->context, &of->scheme, &request));
}

static void require_as_alone(const scene *of, const char *letters, const sphg_subset *subset,
                             int corrections, const char *how)
{
    const mixed_fields *alone = mixed(of, letters);
    for (int k = 0; k < alone->count; ++k)
        sum_fields(of, of->found, subset, &alone->fields[k], 1, NULL);
    const wish table_alone = {"corrections", 1, 0, SPHG_DIFFERENCE, 0, 0};
    const outcome expected = nothing_yet(of, &table_alone);
    if (corrections)
        evaluate(of, &table_alone, of->found, setup_view(&of->volume), subset, &expected);
    for (int n = 0; n < SUPPLIES; ++n) {
        const mixed_fields *together = mixed(of, letters);
        const setup_array table =
            setup_output(test_field_type(of->test), of->points.count, numbers_of_table(of));
        sum_fields(of, supply(of, n), subset, together->fields, together->count,
                   corrections ? &table : NULL);
        if (corrections)
            TEST_REQUIRE(setup_same_bits(&expected.table, &table), "%s, %s, %s: corrections",
                         letters, how, supply_names[n]);
        for (int k = 0; k < together->count; ++k)
            TEST_REQUIRE(setup_same_bits(&alone->results[k], &together->results[k]),
                         "%s, %s, %s: field %d", letters, how, supply_names[n], k);
    }
}

/* Two of them in one loop, one beside the moments, and more than one pass takes. */
static void several_fields_go_it(const test_case *test)
{
    const double radius[] = {2, 4.5};
    const int plain = test->method == SPHG_PLAIN;
    for (sphg_isa isa = SPHG_ISA_BASE; isa <= SPHG_ISA_NEON; ++isa) {
        sphg_context *context = setup_watched_context_on(isa);
        for (int k = 0; context && k < 3; ++k) {
            if (!test_takes(test, k, 3))
                continue;
            const scene of = scene_on(test, context, radius[k > 0], k == 1);
            const sphg_subset shares[] = {share_of(&of, MOST), share_of(&of, SOME),
                                          share_of(&of, FEW)};
            const char *how = test_text("path %d, scene %d", (int)isa, k);
            for (int m = 0; m < MIXTURES; ++m) {
                const int of_plain = strpbrk(mixtures[m], "dDp") != NULL;
                if (of_plain && (!plain || (of.graded && strchr(mixtures[m], 'p'))))
                    continue;
                require_as_alone(&of, mixtures[m], m % 4 < SHARES ? &shares[m % 4] : NULL,
                                 !plain && m % 3, how);
            }
        }
    }
}

static void every_kernel_goes_it(const test_case *test)
{
    scene of = scene_on(test, setup_context(), 2, 0);
    for (int kernel = SPHG_CUBIC_SPLINE; kernel <= SPHG_SPIKY; ++kernel) {
        if (!test_takes(test, kernel, 3))
            continue;
        of.scheme.kernel = (sphg_kernel)kernel;
        require_all(&of, test_text("kernel %d", kernel));
    }
}

static void order_2_goes_it(const test_case *test)
{
    static const char *const letters[] = {"vv", "vs", "sv", "ss", "vsvsssvv"};
    const double radius[] = {2, 4.5};
    for (sphg_isa isa = SPHG_ISA_BASE; isa <= SPHG_ISA_NEON; ++isa) {
        sphg_context *context = setup_watched_context_on(isa);
        for (int k = 0; context && k < 2; ++k) {
            if (!test_takes(test, k, 2))
                continue;
            scene of = scene_on(test, context, radius[k], 0);
            of.scheme.order = 2;
            const char *how = test_text("path %d, H = %g, order 2", (int)isa, radius[k]);
            require_all(&of, how);
            for (int m = 0; m < 5; ++m)
                require_as_alone(&of, letters[m], NULL, m % 2, how);
        }
    }
}

static void every_kernel_of_order_2_goes_it(const test_case *test)
{
    scene of = scene_on(test, setup_context(), 2, 0);
    of.scheme.order = 2;
    for (int kernel = SPHG_CUBIC_SPLINE; kernel <= SPHG_SPIKY; ++kernel) {
        if (!test_takes(test, kernel, 3))
            continue;
        of.scheme.kernel = (sphg_kernel)kernel;
        require_all(&of, test_text("kernel %d, order 2", kernel));
    }
}

/* ---- Classic methods ------------------------------------------------------------------------- */

/* Lists of one tile, of several, and of so many that rounding is carried along. */
static void classic_methods_go_it(const test_case *test)
{
    static const char *const letters[] = {"vs", "Vs", "dv", "vsvsssvv"};
    const double radius[] = {2, 3, 4.5};
    for (sphg_isa isa = SPHG_ISA_BASE; isa <= SPHG_ISA_NEON; ++isa) {
        sphg_context *context = setup_watched_context_on(isa);
        for (int k = 0; context && k < 3; ++k) {
            if (!test_takes(test, k, 3))
                continue;
            const scene of = scene_on(test, context, radius[k], 0);
            const char *how = test_text("path %d, H = %g", (int)isa, radius[k]);
            require_all(&of, how);
            for (int m = 0; m < 4; ++m)
                require_as_alone(&of, letters[m], NULL, m % 2, how);
        }
    }
}

/* Corrections that are there: fields alone are summed. */
static void classic_gradients_from_a_table_go_it(const test_case *test)
{
    const double radius[] = {2, 4.5};
    const wish both = {"", 1, SPHG_VECTOR, SPHG_DIFFERENCE, 0, 0};
    for (sphg_isa isa = SPHG_ISA_BASE; isa <= SPHG_ISA_NEON; ++isa) {
        sphg_context *context = setup_watched_context_on(isa);
        for (int k = 0; context && k < 2; ++k) {
            if (!test_takes(test, k, 2))
                continue;
            const scene of = scene_on(test, context, radius[k], 0);
            const outcome expected = nothing_yet(&of, &both), got = nothing_yet(&of, &both);
            evaluate(&of, &both, of.kept, setup_view(&of.volume), NULL, &expected);
            for (int s = 0; s < 2; ++s) {
                const sphg_sources sources = {.neighbors = supply(&of, s),
                                              .volume = setup_view(&of.volume),
                                              .correction = setup_view(&expected.table)};
                SETUP_OK(of.context,
                         sphg_jacobian(of.context, &of.scheme, &sources, NULL,
                                       setup_view(&of.vector), setup_view(&got.result)));
                TEST_REQUIRE(setup_same_bits(&expected.result, &got.result), "path %d, H = %g, %s",
                             (int)isa, radius[k], supply_names[s]);
            }
        }
    }
}

static void every_kernel_of_classic_methods_goes_it(const test_case *test)
{
    scene of = scene_on(test, setup_context(), 2, 0);
    for (int kernel = SPHG_CUBIC_SPLINE; kernel <= SPHG_SPIKY; ++kernel) {
        of.scheme.kernel = (sphg_kernel)kernel;
        require_all(&of, test_text("kernel %d", kernel));
    }
}

/* ---- What must not get into sums ------------------------------------------------------------- */

/* A_i that is not finite reaches no sum of the direct form at i. */
static void the_direct_form_does_not_look_at_the_target(const test_case *test)
{
    const scene of = scene_on(test, setup_context(), 2, 0);
    const int odd = of.points.count / 2, d = test->dimension;
    setup_put(&of.vector, d * odd, NAN);
    const wish direct = {"direct Jacobian", 0, SPHG_VECTOR, SPHG_DIRECT, 0, 0};
    const outcome got = nothing_yet(&of, &direct);
    evaluate(&of, &direct, of.kept, setup_view(&of.volume), NULL, &got);
    for (int c = 0; c < d * d; ++c)
        TEST_REQUIRE(isfinite(setup_get(&got.result, odd, c)), "number %d is not", c);
}

/* By whichever way the targets that have it as neighbour go: the number is named. */
static void a_bad_volume_is_named(const test_case *test)
{
    static const int bad[] = {[MOST] = 5, [SOME] = 5, [FEW] = 6}; /* beside one that is selected */
    const scene of = scene_on(test, setup_context(), 2, 0);
    const outcome to = nothing_yet(&of, &(wish){"", 0, SPHG_VECTOR, SPHG_DIFFERENCE, 0, 0});
    for (int k = 0; k < 3 * SHARES; ++k) {
        const int share = k % SHARES, way = k / SHARES;
        const sphg_subset some = share_of(&of, share);
        const double good = setup_get(&of.volume, bad[share], 0);
        const sphg_sources sources = {.neighbors = supply(&of, way),
                                      .volume = setup_view(&of.volume)};
        setup_put(&of.volume, bad[share], -1);
        TEST_REQUIRE(sphg_jacobian(of.context, &of.scheme, &sources, &some, setup_view(&of.vector),
                                   setup_view(&to.result)) == SPHG_ERROR_VOLUME &&
                         strstr(sphg_last_message(of.context), "-1"),
                     "share %d, %s: %s", share, supply_names[way], sphg_last_message(of.context));
        setup_put(&of.volume, bad[share], good);
    }
}

static const test_entry entries[] = {
    TEST_ENTRY(the_bits_are_those_of_the_long_way, TEST_ALL_PRECISIONS, TEST_BOTH_DIMENSIONS,
               TEST_LINEARISED | TEST_BIT(SPHG_PLAIN), 0),
    TEST_ENTRY(radii_of_their_own_go_it, TEST_SINGLE_AND_DOUBLE, TEST_BOTH_DIMENSIONS,
               TEST_LINEARISED | TEST_BIT(SPHG_PLAIN), 0),
    TEST_ENTRY(some_of_the_particles_go_it, TEST_SINGLE_AND_DOUBLE, TEST_BOTH_DIMENSIONS,
               TEST_LINEARISED | TEST_BIT(SPHG_PLAIN), 0),
    TEST_ENTRY(several_fields_go_it, TEST_ALL_PRECISIONS, TEST_BOTH_DIMENSIONS,
               TEST_LINEARISED | TEST_BIT(SPHG_PLAIN), 0),
    TEST_ENTRY(every_kernel_goes_it, TEST_SINGLE_AND_DOUBLE, TEST_BOTH_DIMENSIONS,
               TEST_BIT(SPHG_KGC) | TEST_BIT(SPHG_PLAIN), 0),
    TEST_ENTRY(order_2_goes_it, TEST_ALL_PRECISIONS, TEST_BOTH_DIMENSIONS, TEST_LINEARISED, 0),
    TEST_ENTRY(every_kernel_of_order_2_goes_it, TEST_SINGLE_AND_DOUBLE, TEST_BOTH_DIMENSIONS,
               TEST_LINEARISED, 0),
    TEST_ENTRY(classic_methods_go_it, TEST_ALL_PRECISIONS, TEST_BOTH_DIMENSIONS, TEST_CLASSIC, 0),
    TEST_ENTRY(classic_gradients_from_a_table_go_it, TEST_ALL_PRECISIONS, TEST_BOTH_DIMENSIONS,
               TEST_CLASSIC, 0),
    TEST_ENTRY(every_kernel_of_classic_methods_goes_it, TEST_SINGLE_AND_DOUBLE,
               TEST_BOTH_DIMENSIONS, TEST_CLASSIC, 0),
    TEST_ENTRY(a_bad_volume_is_named, TEST_ALL_PRECISIONS, TEST_BOTH_DIMENSIONS,
               TEST_BIT(SPHG_KGC) | TEST_BIT(SPHG_RKPM) | TEST_BIT(SPHG_PLAIN), 0),
    TEST_ENTRY(the_direct_form_does_not_look_at_the_target, TEST_SINGLE_AND_DOUBLE,
               TEST_BOTH_DIMENSIONS, TEST_BIT(SPHG_KGC) | TEST_BIT(SPHG_PLAIN), 0),
};
TEST_MAIN(entries)
