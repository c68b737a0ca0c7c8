/* SPDX-License-Identifier: MIT */
/* Random scenes and what must not change them: relations that hold to the bit, so that no reference
 * is needed. SPHG_TEST_LONG=1 takes 100 000 scenes. */
#include "support/setup.h"
#include "support/long_counts.h"
#include <math.h>
#include <string.h>

enum { MOST = 56, FAR = 5 };

/* What is asked for. */
typedef enum kind {
    GRADIENT,    /* in either form of one side */
    CONTRACTION, /* J : T_i */
    VALUE,       /* sum of differences, with volumes of its own */
    SHEPARD,     /* mean, with volumes of its own */
    FLOW,        /* the adjoint Laplacian with a coefficient */
    QUADRATIC,   /* gradient of order 2 */
    BORROWED,    /* and with lenders */
    KINDS
} kind;

/* Coordinates, volumes and fields are short binary fractions: sums and products with powers of two
 * are exact in f32, too. */
typedef struct world {
    int count, searched; /* searched: or by lists, which fix the order of sums */
    int has_radii;
    kind asked;
    sphg_scheme scheme;
    sphg_form form;
    double x[MOST * 3], volume[MOST], field[MOST * 3], radius[MOST];
    double second[MOST], tensor[MOST * 9]; /* a coefficient or volumes; T_i */
    int32_t lists[MOST * MOST];            /* row i: count numbers */
} world;

typedef struct outcome {
    double result[MOST * 3];
    uint8_t rank[MOST];
    sphg_stats stats;
} outcome;

typedef struct rig {
    sphg_type type;
    sphg_context *context;
    sphg_neighbors *neighbors;
    random_state random;
} rig;

static double fraction(rig *own, int range, int bits)
{
    return ldexp(random_index(&own->random, 2 * range << bits) - (range << bits), -bits);
}

static int is_gradient(const world *on)
{
    return on->asked == GRADIENT || on->asked == QUADRATIC || on->asked == BORROWED;
}

static int width_of(const world *on)
{
    return is_gradient(on) ? on->scheme.dimension : 1;
}

/* Of ranks known for the selected targets alone. */
static int has_rank(const world *on)
{
    return on->scheme.method != SPHG_PLAIN && on->asked != FLOW && on->asked != BORROWED;
}

/* What the method has not is a gradient. */
static kind choose_kind(rig *own, sphg_method method)
{
    const kind drawn = (kind)random_index(&own->random, 2 * KINDS);
    const int classic = method == SPHG_CMLS || method == SPHG_CRKPM;
    if (drawn >= KINDS || (classic && drawn > CONTRACTION) ||
        (method == SPHG_PLAIN && drawn >= QUADRATIC))
        return GRADIENT;
    return drawn;
}

/* Blocks, sheets, lines, clumps and loners, of any method, kernel and policy. */
static void make_world(rig *own, world *made)
{
    random_state *random = &own->random;
    const int d = 2 + random_index(random, 2), flat = random_index(random, 6);
    memset(made, 0, sizeof *made);
    made->count = 1 + random_index(random, MOST - FAR);
    made->scheme.dimension = d;
    made->scheme.method = (sphg_method)random_index(random, 6);
    made->scheme.kernel = (sphg_kernel)random_index(random, 7);
    made->scheme.policy = (sphg_policy)random_index(random, 4);
    made->scheme.support_radius = ldexp(1 + random_index(random, 40), -4);
    made->scheme.threshold = random_index(random, 2) ? 0 : ldexp(1, -1 - random_index(random, 16));
    made->asked = choose_kind(own, made->scheme.method);
    made->scheme.order = made->asked >= QUADRATIC ? 2 : 1;
    made->form = made->asked == SHEPARD                                    ? SPHG_DIRECT
                 : made->asked == FLOW                                     ? SPHG_ADJOINT
                 : made->asked == GRADIENT && random_index(random, 3) == 0 ? SPHG_DIRECT
                                                                           : SPHG_DIFFERENCE;
    made->has_radii = random_index(random, 2); /* where it is searched */
    for (int k = 0; k < made->count * d; ++k)
        made->x[k] = k % d >= 3 - flat % 4 ? .25 : fraction(own, flat == 5 ? 1 : 2, 9);
    for (int i = 0; i < made->count; ++i) {
        made->volume[i] = ldexp(random_index(random, 256), -8);
        made->second[i] = ldexp(random_index(random, 256), -8);
        made->radius[i] = ldexp(1 + random_index(random, 40), -4);
        for (int k = 0; k < made->count; ++k)
            made->lists[i * made->count + k] = k;
    }
    for (int k = 0; k < made->count * d; ++k)
        made->field[k] = fraction(own, 8, 8);
    for (int k = 0; k < made->count * d * d; ++k)
        made->tensor[k] = fraction(own, 2, 6);
}

/* ---- One run ------------------------------------------------------------------------------ */

static sphg_view numbers(const rig *own, void *memory, const double *values, int count, int width)
{
    for (int k = 0; k < count * width; ++k) {
        if (own->type == SPHG_F64)
            ((double *)memory)[k] = values[k];
        else
            ((float *)memory)[k] = (float)values[k];
    }
    const ptrdiff_t size = own->type == SPHG_F64 ? 8 : 4;
    return (sphg_view){memory, NULL, NULL, width * size, own->type, SPHG_AS_SHAPE};
}

/* What comes before a sum over both ends, or before borrowing. */
static void prepare(const rig *own, const world *on, sphg_request request, const sphg_field *field,
                    sphg_view output, outcome *found)
{
    sphg_field lends = {.shape = field->shape, .at_sources = field->at_sources};
    request.subset = NULL;
    request.stats = &found->stats;
    request.fields = on->asked == FLOW ? NULL : &lends;
    request.field_count = on->asked != FLOW;
    if (on->asked == FLOW)
        request.correction = output;
    else
        lends.curvature = output;
    SETUP_OK(own->context, sphg_evaluate(own->context, &on->scheme, &request));
}

static void evaluate(const rig *own, const world *on, sphg_view volume, const sphg_subset *subset,
                     outcome *found)
{
    const int d = on->scheme.dimension, n = on->count, width = width_of(on);
    double memory[3][MOST * 9], result[MOST * 3] = {0}, before[MOST * 7] = {0};
    const sphg_view at_sources =
                        numbers(own, memory[0], on->field, n, on->asked == CONTRACTION ? d : 1),
                    second = numbers(own, memory[1], on->second, n, 1);
    const sphg_view output = numbers(own, result, found->result, n, width),
                    room = numbers(own, before, before, n,
                                   on->asked == FLOW ? d * (d + 1) / 2
                                   : d == 2          ? 4
                                                     : 7);
    sphg_sources sources = {.neighbors = own->neighbors, .volume = volume};
    sphg_field field = {.shape = on->asked == CONTRACTION ? SPHG_VECTOR : SPHG_SCALAR,
                        .form = on->form,
                        .at_sources = &at_sources,
                        .shepard = on->asked == SHEPARD};
    sphg_request request = {
        .sources = &sources, .fields = &field, .set_count = 1, .field_count = 1, .subset = subset};
    if (on->asked == BORROWED || (on->asked == FLOW && on->scheme.method != SPHG_PLAIN))
        prepare(own, on, request, &field, room, found);
    if (is_gradient(on))
        field.gradient = output;
    if (on->asked == BORROWED)
        field.lenders = &room;
    if (on->asked == VALUE || on->asked == SHEPARD) {
        field.value = output;
        field.value_volume = &second;
    }
    if (on->asked == CONTRACTION) {
        field.contraction = output;
        field.tensor = numbers(own, memory[2], on->tensor, n, d * d);
    }
    if (on->asked == FLOW) {
        field.laplacian = output;
        field.coefficient = &second;
        sources.correction = on->scheme.method == SPHG_PLAIN ? sphg_absent() : room;
    }
    if (has_rank(on)) {
        request.rank = sphg_view_u8(found->rank, 1);
        request.stats = &found->stats;
    }
    SETUP_OK(own->context, sphg_evaluate(own->context, &on->scheme, &request));
    for (int k = 0; k < n * width; ++k)
        found->result[k] = own->type == SPHG_F64 ? result[k] : (double)((float *)result)[k];
}

/* Offsets of the host are read by operators: build and evaluation stand in one function. */
static void run(const rig *own, const world *on, const sphg_subset *subset, outcome *found)
{
    const int d = on->scheme.dimension, n = on->count;
    double memory[3][MOST * 3];
    int64_t offsets[MOST + 1];
    for (int i = 0; i <= n; ++i)
        offsets[i] = (int64_t)i * n;
    sphg_geometry geometry = {
        .sources = numbers(own, memory[0], on->x, n, d), .source_count = n, .target_count = n};
    const sphg_lists lists = {.offsets = offsets, .indices = on->lists};
    if (on->searched && on->has_radii) {
        geometry.source_support = numbers(own, memory[2], on->radius, n, 1);
        geometry.mutual = on->asked == FLOW || on->count % 2;
    }
    SETUP_OK(own->context, on->searched ? sphg_neighbors_search(own->context, own->neighbors,
                                                                &on->scheme, &geometry)
                                        : sphg_neighbors_use_lists(own->context, own->neighbors,
                                                                   &on->scheme, &geometry, &lists));
    evaluate(own, on, numbers(own, memory[1], on->volume, n, 1), subset, found);
}

/* ---- Relations ---------------------------------------------------------------------------- */

static const char *const names_of_kinds[KINDS] = {
    "gradients", "contractions", "sums of differences", "means", "flows", "order 2", "borrowed"};

/* Of the first `count` targets: result = factor[axis] * expected, ranks alike. */
static void require_related(const world *on, const outcome *expected, const outcome *found,
                            const double *factor, const char *relation)
{
    const int width = width_of(on);
    for (int k = 0; k < on->count * width; ++k)
        TEST_REQUIRE(expected->result[k] * factor[k % width] == found->result[k],
                     "%s of %s: %a, not %a; %s, kernel %d, policy %d, H %g, eps %g, %dD, "
                     "%d particles, radii %d",
                     relation, names_of_kinds[on->asked], found->result[k],
                     expected->result[k] * factor[k % width], test_method_name(on->scheme.method),
                     (int)on->scheme.kernel, (int)on->scheme.policy, on->scheme.support_radius,
                     on->scheme.threshold, on->scheme.dimension, on->count, on->has_radii);
    TEST_REQUIRE(memcmp(expected->rank, found->rank, (size_t)on->count) == 0, "%s: other ranks",
                 relation);
}

static const double one[] = {1, 1, 1};

static void translation(rig *own, const world *on, const outcome *expected)
{
    world moved = *on;
    outcome found = {.rank = {0}};
    const int d = on->scheme.dimension;
    double by[3];
    for (int a = 0; a < 3; ++a)
        by[a] = fraction(own, 1024, 0);
    for (int k = 0; k < on->count * d; ++k)
        moved.x[k] += by[k % d];
    run(own, &moved, NULL, &found);
    require_related(on, expected, &found, one, "translation");
}

/* Not of matrices that were decomposed: of two equal diagonal entries Jacobi's rotation takes
 * either eigenvector first, and the sum over both is rounded in that order. */
static void mirror(rig *own, const world *on, const outcome *expected)
{
    world mirrored = *on;
    outcome found = {.rank = {0}};
    const int d = on->scheme.dimension, axis = random_index(&own->random, d);
    double factor[] = {1, 1, 1};
    if (is_gradient(on))
        factor[axis] = -1;
    if (expected->stats.decomposed > 0)
        return;
    for (int k = axis; k < on->count * d * d; k += d)
        mirrored.tensor[k] = -mirrored.tensor[k];
    for (int i = 0; i < on->count; ++i)
        mirrored.x[i * d + axis] = -mirrored.x[i * d + axis];
    run(own, &mirrored, NULL, &found);
    require_related(on, expected, &found, factor, "mirror");
}

static void unit_of_length(rig *own, const world *on, const outcome *expected)
{
    world scaled = *on;
    outcome found = {.rank = {0}};
    const int d = on->scheme.dimension, k = random_index(&own->random, 31) - 15;
    const int values = on->asked == VALUE || on->asked == SHEPARD;
    const double by = ldexp(1, values ? 0 : on->asked == FLOW ? k * (d - 2) : -k);
    const double factor[] = {by, by, by};
    for (int n = 0; n < on->count * d; ++n)
        scaled.x[n] = ldexp(scaled.x[n], k);
    for (int i = 0; i < on->count; ++i) {
        scaled.volume[i] = ldexp(scaled.volume[i], d * k);
        scaled.second[i] = ldexp(scaled.second[i], values ? d * k : 0);
        scaled.radius[i] = ldexp(scaled.radius[i], k);
    }
    scaled.scheme.support_radius = ldexp(scaled.scheme.support_radius, k);
    run(own, &scaled, NULL, &found);
    require_related(on, expected, &found, factor, "unit of length");
}

static void unit_of_field(rig *own, const world *on, const outcome *expected)
{
    world scaled = *on;
    outcome found = {.rank = {0}};
    const int k = random_index(&own->random, 41) - 20;
    const double factor[] = {ldexp(1, k), ldexp(1, k), ldexp(1, k)};
    for (int i = 0; i < on->count * on->scheme.dimension; ++i)
        scaled.field[i] = ldexp(scaled.field[i], k);
    run(own, &scaled, NULL, &found);
    require_related(on, expected, &found, factor, "unit of the field");
}

/* Of a coefficient, of volumes that a sum has of its own, of T. */
static void unit_of_what_is_beside(rig *own, const world *on, const outcome *expected)
{
    world scaled = *on;
    outcome found = {.rank = {0}};
    const int k = random_index(&own->random, 21) - 10;
    const double factor[] = {ldexp(1, on->asked == SHEPARD ? 0 : k)};
    if (is_gradient(on))
        return;
    for (int i = 0; i < on->count; ++i)
        scaled.second[i] = ldexp(scaled.second[i], k);
    for (int i = 0; i < on->count * 9; ++i)
        scaled.tensor[i] = ldexp(scaled.tensor[i], k);
    run(own, &scaled, NULL, &found);
    require_related(on, expected, &found, factor, "unit of what is beside");
}

static void constant(rig *own, const world *on, const outcome *expected)
{
    world raised = *on;
    outcome found = {.rank = {0}};
    const double by = fraction(own, 2048, 0);
    if (on->form == SPHG_DIRECT)
        return;
    for (int i = 0; i < on->count * on->scheme.dimension; ++i)
        raised.field[i] += by;
    run(own, &raised, NULL, &found);
    require_related(on, expected, &found, one, "constant");
}

/* Particles beyond everybody's reach, which the lists name last. */
static void strangers(rig *own, const world *on, const outcome *expected)
{
    world more = *on;
    outcome found = {.rank = {0}};
    const int d = on->scheme.dimension;
    more.count += FAR;
    for (int i = on->count; i < more.count; ++i) {
        for (int a = 0; a < d; ++a) {
            more.x[i * d + a] = 512 + 64 * i;
            more.field[i * d + a] = 3;
        }
        more.volume[i] = more.second[i] = more.radius[i] = 1;
    }
    for (int k = 0; k < more.count * more.count; ++k)
        more.lists[k] = k % more.count;
    run(own, &more, NULL, &found);
    require_related(on, expected, &found, one, "strangers");
}

/* Other names; rows keep the order of the particles that they mean. */
static void names(rig *own, const world *on, const outcome *expected)
{
    world renamed = *on;
    outcome found = {.rank = {0}}, back = {.rank = {0}};
    const int d = on->scheme.dimension, n = on->count, width = width_of(on);
    const int wide = on->asked == CONTRACTION ? d : 1; /* of the field */
    int32_t name[MOST];
    for (int i = 0; i < n; ++i) {
        const int k = random_index(&own->random, i + 1);
        name[i] = name[k];
        name[k] = i;
    }
    for (int i = 0; i < n; ++i) {
        const size_t d_numbers = (size_t)d * sizeof(double);
        memcpy(renamed.x + name[i] * d, on->x + i * d, d_numbers);
        memcpy(renamed.tensor + name[i] * d * d, on->tensor + i * d * d, (size_t)d * d_numbers);
        memcpy(renamed.field + name[i] * wide, on->field + i * wide, (size_t)wide * sizeof(double));
        renamed.volume[name[i]] = on->volume[i];
        renamed.second[name[i]] = on->second[i];
        for (int k = 0; k < n; ++k)
            renamed.lists[name[i] * n + k] = name[on->lists[i * n + k]];
    }
    run(own, &renamed, NULL, &found);
    for (int i = 0; i < n; ++i) {
        memcpy(back.result + i * width, found.result + name[i] * width,
               (size_t)width * sizeof(double));
        back.rank[i] = found.rank[name[i]];
    }
    require_related(on, expected, &back, one, "names");
}

static void subset(rig *own, const world *on, const outcome *expected)
{
    uint8_t mask[MOST];
    outcome found, mixed = *expected;
    const int width = width_of(on);
    const sphg_subset chosen = {0, on->count, NULL, mask};
    memset(&found, 0, sizeof found);
    for (int i = 0; i < on->count; ++i) {
        mask[i] = (uint8_t)random_index(&own->random, 2);
        for (int a = 0; a < width && !mask[i]; ++a)
            mixed.result[i * width + a] = found.result[i * width + a] = 7;
        if (!mask[i])
            mixed.rank[i] = found.rank[i] = 77;
    }
    run(own, on, &chosen, &found);
    if (!has_rank(on))
        memcpy(found.rank, mixed.rank, sizeof mixed.rank);
    require_related(on, &mixed, &found, one, "subset");
}

/* Radii that are all the same are one radius. */
static void one_radius(rig *own, const world *on, const outcome *expected)
{
    world alike = *on, alone = *on;
    outcome found = {.rank = {0}}, of_one = {.rank = {0}};
    (void)expected;
    alike.has_radii = 1;
    alone.has_radii = 0;
    for (int i = 0; i < on->count; ++i)
        alike.radius[i] = on->scheme.support_radius;
    run(own, &alike, NULL, &found);
    run(own, &alone, NULL, &of_one);
    require_related(on, &of_one, &found, one, "one radius");
}

/* ---- Scenes ------------------------------------------------------------------------------- */

typedef void relation(rig *own, const world *on, const outcome *expected);

static void each_scene(const test_case *test, int searched, relation *const *relations, int count)
{
    rig own = {test_field_type(test), setup_context_of(1), NULL, random_seeded(601)};
    const int scenes = long_or(100000, 400);
    SETUP_OK(own.context, sphg_neighbors_create(own.context, &own.neighbors));
    for (int k = 0; k < scenes; ++k) {
        world on;
        outcome expected = {.rank = {0}};
        make_world(&own, &on);
        on.searched = searched;
        run(&own, &on, NULL, &expected);
        for (int r = 0; r < count; ++r)
            relations[r](&own, &on, &expected);
    }
    sphg_neighbors_destroy(own.neighbors);
    print_message("%d scenes, %d relations\n", scenes, count);
}

static void relations_hold_to_the_bit_in_the_order_of_lists(const test_case *test)
{
    relation *const relations[] = {
        translation, mirror,    unit_of_length, unit_of_field, unit_of_what_is_beside,
        constant,    strangers, names,          subset};
    each_scene(test, 0, relations, 9);
}

/* Where the search decides the order of sums, moving particles may change it. */
static void relations_hold_to_the_bit_after_a_search(const test_case *test)
{
    relation *const relations[] = {unit_of_length, unit_of_field, unit_of_what_is_beside,
                                   constant,       subset,        one_radius};
    each_scene(test, 1, relations, 6);
}

static const test_entry entries[] = {
    TEST_ENTRY(relations_hold_to_the_bit_in_the_order_of_lists, TEST_SINGLE_AND_DOUBLE, 0, 0, 0),
    TEST_ENTRY(relations_hold_to_the_bit_after_a_search, TEST_SINGLE_AND_DOUBLE, 0, 0, 0),
};
TEST_MAIN(entries)
