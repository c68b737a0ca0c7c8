/* SPDX-License-Identifier: MIT */
/* One number for all results of a scene: the same for 1 to 64 threads, for every executor, wherever
 * the arrays begin and for vectors of any length; and, one on the base path and one on those that
 * fuse products and sums, the same for every compiler and machine. */
#include "support/setup.h"
#include "support/fake_host.h"
#include "support/long_counts.h"
#include "support/brute_force.h"
#include "support/pins.h"
#include <string.h>

enum { COUNT = 1600, DIMENSION = 3 };

typedef enum supply { KEPT, LIST_FREE, HOST_LISTS, SUPPLIES } supply;

static const char *const supply_names[] = {"kept lists", "list-free", "the host's lists"};

typedef struct hashes {
    uint64_t of[SUPPLIES];
} hashes;

/* ---- Scene -------------------------------------------------------------------------------- */

typedef struct setting {
    const test_case *test;
    sphg_scheme scheme;
    setup_array position, volume, density, scalar, vector, tensor;
    rows lists;
    const sphg_config *config;
    random_state *shifts; /* NULL: arrays begin at cache lines */
} setting;

static setup_array numbers_of(sphg_type type, int width, double low, double high,
                              random_state *random)
{
    double *numbers = test_memory((size_t)(COUNT * width) * sizeof *numbers);
    for (int k = 0; k < COUNT * width; ++k)
        numbers[k] = random_between(random, low, high);
    return setup_numbers(type, COUNT, width, numbers);
}

/* Thin at one side and full at the other, so that some particles are isolated and some moments are
 * decomposed. */
static setting setting_of(const test_case *test)
{
    random_state random = random_seeded(191);
    setting own = {.test = test, .scheme = setup_scheme(test, 2)};
    cloud points = cloud_random(DIMENSION, COUNT, 11, &random);
    for (int i = 0; i < COUNT; ++i)
        points.x[DIMENSION * i] *= points.x[DIMENSION * i] / 8;
    own.position = setup_positions(test, &points);
    scene particles = scene_of_cloud(test, &points);
    own.lists = rows_by_brute_force(&particles, 2);
    own.volume = numbers_of(test_field_type(test), 1, .5, 1.5, &random);
    own.density = numbers_of(test_field_type(test), 1, .5, 1.5, &random);
    own.scalar = numbers_of(test_field_type(test), 1, -1, 1, &random);
    own.vector = numbers_of(test_field_type(test), DIMENSION, -1, 1, &random);
    own.tensor = numbers_of(test_field_type(test), 6, -1, 1, &random);
    return own;
}

/* A copy at a multiple of the number's size from a cache line, any of them. */
static void *moved(const setting *own, const void *data, size_t bytes, size_t number)
{
    const size_t shift = own->shifts ? (size_t)random_index(own->shifts, (int)(64 / number)) : 0;
    char *memory = test_memory(bytes + 128);
    memory += (64 - (uintptr_t)memory % 64) % 64 + shift * number;
    if (data)
        memcpy(memory, data, bytes);
    return memory;
}

static size_t bytes_of(const setup_array *array, size_t *number)
{
    *number = array->type == SPHG_F64 ? 8 : array->type == SPHG_F32 ? 4 : 1;
    return (size_t)array->count * (size_t)array->width * *number;
}

static sphg_view view_of(const setting *own, const setup_array *array)
{
    setup_array copy = *array;
    size_t number;
    const size_t bytes = bytes_of(array, &number);
    copy.data = moved(own, array->data, bytes, number);
    return setup_view(&copy);
}

/* ---- Results ------------------------------------------------------------------------------ */

enum { OUTPUTS_MOST = 16 };

typedef struct outputs {
    setup_array arrays[OUTPUTS_MOST];
    int count;
} outputs;

static sphg_view output_of(const setting *own, outputs *all, sphg_type type, int width)
{
    setup_array array = {NULL, type, COUNT, width};
    size_t number;
    const size_t bytes = bytes_of(&array, &number);
    array.data = moved(own, NULL, bytes, number);
    all->arrays[all->count++] = array;
    return setup_view(&array);
}

static uint64_t hash_of_outputs(const outputs *all, const sphg_stats *stats)
{
    /* What came later is 0 here, and has tests of its own. */
    uint64_t hash = fnv1a(FNV1A_BEGIN, stats, offsetof(sphg_stats, quadratic));
    for (int k = 0; k < all->count; ++k) {
        size_t number;
        const size_t bytes = bytes_of(&all->arrays[k], &number);
        hash = fnv1a(hash, all->arrays[k].data, bytes);
    }
    return hash;
}

static sphg_neighbors *neighbors_of(const setting *own, sphg_context *context, supply how)
{
    const size_t pairs = (size_t)own->lists.offsets[COUNT];
    const sphg_geometry geometry = {.sources = view_of(own, &own->position),
                                    .source_count = COUNT,
                                    .target_count = COUNT,
                                    .precision = test_field_type(own->test),
                                    .list_free = how == LIST_FREE};
    const sphg_lists lists = {
        .offsets = moved(own, own->lists.offsets, (COUNT + 1) * sizeof(int64_t), sizeof(int64_t)),
        .indices = moved(own, own->lists.indices, pairs * sizeof(int32_t), sizeof(int32_t))};
    sphg_neighbors *neighbors = NULL;
    SETUP_OK(context, sphg_neighbors_create(context, &neighbors));
    SETUP_OK(context,
             how == HOST_LISTS
                 ? sphg_neighbors_use_lists(context, neighbors, &own->scheme, &geometry, &lists)
                 : sphg_neighbors_search(context, neighbors, &own->scheme, &geometry));
    return neighbors;
}

/* Gradients and all that is left of the corrections, into sources->correction, too. */
static void sweep_forward(const setting *own, sphg_context *context, sphg_sources *sources,
                          outputs *all, sphg_stats *stats)
{
    const sphg_type type = test_field_type(own->test);
    const sphg_view scalar = view_of(own, &own->scalar), vector = view_of(own, &own->vector);
    const sphg_field forward[] = {
        {.shape = SPHG_SCALAR, .at_sources = &scalar, .gradient = output_of(own, all, type, 3)},
        {.shape = SPHG_VECTOR,
         .at_sources = &vector,
         .gradient = output_of(own, all, type, 9),
         .divergence = output_of(own, all, type, 1),
         .curl = output_of(own, all, type, 3)},
        {.shape = SPHG_VECTOR,
         .form = SPHG_DIRECT,
         .at_sources = &vector,
         .value = output_of(own, all, type, 3),
         .gradient = output_of(own, all, type, 9)},
        {.shape = SPHG_SCALAR,
         .form = SPHG_DIRECT,
         .at_sources = &scalar,
         .square = output_of(own, all, type, 1)}};
    sphg_request request = {
        .sources = sources, .set_count = 1, .fields = forward, .field_count = 4};
    if (own->scheme.method != SPHG_PLAIN) {
        request.rank = output_of(own, all, SPHG_U8, 1);
        request.lambda_min = output_of(own, all, type, 1);
        request.stats = stats;
        request.correction = output_of(own, all, type, sphg_correction_width(&own->scheme));
    }
    SETUP_OK(context, sphg_evaluate(context, &own->scheme, &request));
    sources->correction = request.correction;
}

/* These read the table that the others leave. */
static void sweep_two_sided(const setting *own, sphg_context *context, const sphg_sources *sources,
                            outputs *all)
{
    const sphg_type type = test_field_type(own->test);
    const sphg_view scalar = view_of(own, &own->scalar), vector = view_of(own, &own->vector);
    const sphg_view tensor = view_of(own, &own->tensor);
    const sphg_field two_sided[] = {{.shape = SPHG_SCALAR,
                                     .form = SPHG_ADJOINT,
                                     .at_sources = &scalar,
                                     .gradient = output_of(own, all, type, 3)},
                                    {.shape = SPHG_SYM_TENSOR,
                                     .form = SPHG_ADJOINT,
                                     .at_sources = &tensor,
                                     .divergence = output_of(own, all, type, 3)},
                                    {.shape = SPHG_VECTOR,
                                     .form = SPHG_SYMMETRIC,
                                     .at_sources = &vector,
                                     .gradient = output_of(own, all, type, 9)}};
    const sphg_request back = {
        .sources = sources, .set_count = 1, .fields = two_sided, .field_count = 3};
    SETUP_OK(context, sphg_evaluate(context, &own->scheme, &back));
}

/* Derivatives of order 2, and what is left of their corrections. */
static void sweep_second(const setting *own, sphg_context *context, const sphg_sources *sources,
                         outputs *all, sphg_stats *stats)
{
    const sphg_type type = test_field_type(own->test);
    const sphg_view scalar = view_of(own, &own->scalar), vector = view_of(own, &own->vector);
    const sphg_field fields[] = {{.shape = SPHG_SCALAR,
                                  .at_sources = &scalar,
                                  .gradient = output_of(own, all, type, 3),
                                  .hessian = output_of(own, all, type, 6)},
                                 {.shape = SPHG_VECTOR,
                                  .at_sources = &vector,
                                  .gradient = output_of(own, all, type, 9),
                                  .divergence = output_of(own, all, type, 1),
                                  .curl = output_of(own, all, type, 3),
                                  .hessian = output_of(own, all, type, 18),
                                  .laplacian = output_of(own, all, type, 3)}};
    sphg_request request = {
        .sources = sources, .set_count = 1, .fields = fields, .field_count = 2, .stats = stats};
    request.rank = output_of(own, all, SPHG_U8, 1);
    request.lambda_min = output_of(own, all, type, 1);
    request.correction = output_of(own, all, type, 45);
    SETUP_OK(context, sphg_evaluate(context, &own->scheme, &request));
}

static uint64_t hash_of_sweeps(const setting *own, sphg_context *context,
                               const sphg_neighbors *neighbors)
{
    sphg_sources sources = {.neighbors = neighbors,
                            .volume = view_of(own, &own->volume),
                            .density = view_of(own, &own->density)};
    outputs all = {.count = 0};
    sphg_stats stats;
    memset(&stats, 0, sizeof stats);
    if (own->scheme.order == 2) {
        sweep_second(own, context, &sources, &all, &stats);
    } else {
        sweep_forward(own, context, &sources, &all, &stats);
        sweep_two_sided(own, context, &sources, &all);
    }
    return hash_of_outputs(&all, &stats);
}

static hashes run(const setting *own)
{
    sphg_context *context = NULL;
    hashes found;
    SETUP_OK(NULL, sphg_context_create(SPHG_VERSION, own->config, &context));
    for (supply how = KEPT; how < SUPPLIES; ++how) {
        sphg_neighbors *neighbors = neighbors_of(own, context, how);
        found.of[how] = hash_of_sweeps(own, context, neighbors);
        sphg_neighbors_destroy(neighbors);
    }
    sphg_context_destroy(context);
    return found;
}

static hashes run_under(const setting *own, const sphg_config *config, random_state *shifts)
{
    setting other = *own;
    other.config = config;
    other.shifts = shifts;
    return run(&other);
}

static void require_same(const hashes *found, const hashes *expected, const char *where)
{
    for (supply how = KEPT; how < SUPPLIES; ++how)
        TEST_REQUIRE(found->of[how] == expected->of[how], "%s, %s: %016llx, not %016llx", where,
                     supply_names[how], (unsigned long long)found->of[how],
                     (unsigned long long)expected->of[how]);
}

/* ---- Properties --------------------------------------------------------------------------- */

/* Unless there is time for all, every second path tries the other numbers and executors. */
static void try_threads(const setting *own, sphg_isa isa, const hashes *expected)
{
    static const int32_t some[2][2] = {{3, 64}, {2, 16}};
    random_state shifts = random_seeded(193);
    const int count = long_or(64, TEST_SLOWED ? 1 : 2);
    for (int k = 0; k < count; ++k) {
        const int32_t threads = count == 64 ? k + 1 : some[(int)isa % 2][k];
        const sphg_config config = {.isa = isa, .threads = threads};
        const hashes found = run_under(own, &config, &shifts);
        require_same(&found, expected, test_text("path %d, %d threads", (int)isa, threads));
    }
}

static void try_executors(const setting *own, sphg_isa isa, const hashes *expected)
{
    fake_host_executor *const executors[] = {fake_host_odd_splits, fake_host_reversed,
                                             fake_host_pthreads};
    random_state shifts = random_seeded(197);
    const int all = long_or(1, 0), first = TEST_SLOWED ? 4 : 2;
    const int most = long_or(64, 16); /* each worker has memory, all of which the fake host fills */
    for (int k = all ? 2 : first + (int)isa % 2; k < 6; k += all ? 1 : 2) {
        fake_host host;
        fake_host_open(&host);
        host.workers = k == 2 ? most : k == 3 ? 1 : 7;
        sphg_config config = fake_host_config(&host, host.workers);
        config.parallel_for = executors[k % 3];
        config.isa = isa;
        const hashes found = run_under(own, &config, &shifts);
        require_same(&found, expected,
                     test_text("path %d, executor %d, %d workers", (int)isa, k % 3, host.workers));
        fake_host_close(&host);
    }
}

static void require_one_hash(const test_case *test, int order)
{
    setting own = setting_of(test);
    own.scheme.order = order;
    hashes of_fused; /* of the paths that fuse products and sums: their vectors differ in length */
    int paths = 0, fused = 0;
    for (sphg_isa isa = SPHG_ISA_BASE; isa <= SPHG_ISA_NEON; ++isa) {
        const sphg_config serial = {.isa = isa, .threads = 1};
        if (!setup_context_on(isa))
            continue;
        const hashes expected = run_under(&own, &serial, NULL);
        TEST_REQUIRE(expected.of[KEPT] == expected.of[LIST_FREE], "path %d: list-free", (int)isa);
        if (isa != SPHG_ISA_BASE && fused)
            require_same(&expected, &of_fused, test_text("path %d beside another", (int)isa));
        if (isa != SPHG_ISA_BASE) {
            of_fused = expected;
            fused = 1;
        }
        try_threads(&own, isa, &expected);
        try_executors(&own, isa, &expected);
        ++paths;
    }
    assert_true(paths > 0);
}

static void results_have_one_hash_whoever_works_and_wherever_arrays_begin(const test_case *test)
{
    require_one_hash(test, 1);
}

static void order_2_has_one_hash_whoever_works_and_wherever_arrays_begin(const test_case *test)
{
    require_one_hash(test, 2);
}

#if PINS_HOLD_HERE
/* Of lists of ours, and of the host's: on the base path of x86-64, and on those that fuse products
 * and sums, which AArch64 does always. */
typedef struct pins {
    uint64_t base[2], fused[2];
} pins;

static void require_pinned(const test_case *test, int order, const pins *expected)
{
    if (random_chosen()) { /* the pins are those of the tests' own numbers */
        print_message("skipped: SPHG_TEST_SEED is set (%d)\n", (int)test->precision);
        return;
    }
    setting own = setting_of(test);
    own.scheme.order = order;
    for (sphg_isa isa = SPHG_ISA_BASE; isa <= SPHG_ISA_NEON; ++isa) {
        if (!setup_context_on(isa))
            continue;
        const uint64_t *pinned = pins_are_of_fused(isa) ? expected->fused : expected->base;
        const sphg_config serial = {.isa = isa, .threads = 1};
        const hashes found = run_under(&own, &serial, NULL);
        TEST_REQUIRE(found.of[KEPT] == pinned[0] && found.of[HOST_LISTS] == pinned[1],
                     "path %d: {UINT64_C(0x%016llx), UINT64_C(0x%016llx)}", (int)isa,
                     (unsigned long long)found.of[KEPT], (unsigned long long)found.of[HOST_LISTS]);
    }
}
#endif

/* No compiler chooses what is rounded: these hold for all. A change that adds in another order
 * changes them, and says so in its message. */
static void bits_are_those_of_any_compiler(const test_case *test)
{
#if PINS_HOLD_HERE
    /* [precision][method] */
    static const pins pinned[2][6] = {
        {{{UINT64_C(0xbd75a902352cc917), UINT64_C(0x88b0d72a2a57e908)},
          {UINT64_C(0xe149dd747e5230ff), UINT64_C(0x1fbb9279e308133e)}},
         {{UINT64_C(0x694ff23c70f53c67), UINT64_C(0x33ecd9d6330dae62)},
          {UINT64_C(0x75457816a0453e4d), UINT64_C(0x3ba2105518a46a51)}},
         {{UINT64_C(0xef4fe7d9828ca6c4), UINT64_C(0xb0f7324a18daa78e)},
          {UINT64_C(0xc15791ec22c96aea), UINT64_C(0x4d0e24eef692d31c)}},
         {{UINT64_C(0x215d5c48d8c43ce2), UINT64_C(0x61aae0d65c0c7eb6)},
          {UINT64_C(0x14f421505c4d8d51), UINT64_C(0xaaff1525e51fb215)}},
         {{UINT64_C(0x5f27f190cb964802), UINT64_C(0x128ccfba91a30420)},
          {UINT64_C(0x3c148f12f9f4f3a1), UINT64_C(0xf67f520a6721a7c4)}},
         {{UINT64_C(0x999ce37f9ea84ec0), UINT64_C(0xe67862ac8b6701c5)},
          {UINT64_C(0x6d759fcf330592a4), UINT64_C(0x0d414a4f2a1e4d96)}}},
        {{{UINT64_C(0xf9689d7fb9dab180), UINT64_C(0xaf386a342473c692)},
          {UINT64_C(0x83bdd29957cb1b00), UINT64_C(0x0e08dfd691f1c1d2)}},
         {{UINT64_C(0x62970dc93691b018), UINT64_C(0xc5d16be4bd36db79)},
          {UINT64_C(0x88cbd168cdc56cd7), UINT64_C(0xbd557d17b8019963)}},
         {{UINT64_C(0x1f4ecd5c13169f14), UINT64_C(0xde7475f27cdd4084)},
          {UINT64_C(0xc2290fe8afc3d31a), UINT64_C(0xef0bfc1d0a5d3250)}},
         {{UINT64_C(0x46937ed88bb32b64), UINT64_C(0x564b268ed905abbc)},
          {UINT64_C(0x739b9d94e3cf2403), UINT64_C(0x8132038c8e7a2110)}},
         {{UINT64_C(0xbaac13bc165c7963), UINT64_C(0xee36f6b52820d2fa)},
          {UINT64_C(0xa5fa59dbc3113f00), UINT64_C(0xfd60110b53cb82e7)}},
         {{UINT64_C(0x1dd3ced0fd2c8e8c), UINT64_C(0x30b2a4d6b9e394e2)},
          {UINT64_C(0x9ef99864057a8d15), UINT64_C(0xcd3a11c0241bf1c0)}}}};
    require_pinned(test, 0, &pinned[test->precision == TEST_F64][test->method]);
#else
    print_message("skipped: no pinned values for this machine (%d)\n", (int)test->precision);
#endif
}

static void bits_of_order_2_are_those_of_any_compiler(const test_case *test)
{
#if PINS_HOLD_HERE
    static const pins pinned[2][3] = {
        {{{UINT64_C(0xf827b1d2957a8a6c), UINT64_C(0x7fd6dc7f0e366270)},
          {UINT64_C(0x451e9069f1d6a886), UINT64_C(0x0149c79bb46bf4b7)}},
         {{UINT64_C(0x0fa9a3e21590d4c3), UINT64_C(0xb60ea372f151b440)},
          {UINT64_C(0x19c689d100ed2b59), UINT64_C(0xd7ce743767b7ccf7)}},
         {{UINT64_C(0x492cf90cd8d21f02), UINT64_C(0x7861af8707a49dda)},
          {UINT64_C(0x84ba9e97fcc05054), UINT64_C(0xa6cacf29c2037c97)}}},
        {{{UINT64_C(0xde04177888348137), UINT64_C(0xca053ae48070f5b4)},
          {UINT64_C(0x88f8203561a2de1e), UINT64_C(0x683b67418b90f0ac)}},
         {{UINT64_C(0x810f0292e251dc54), UINT64_C(0x527fc685713d0ee4)},
          {UINT64_C(0x54efd44c6f5932fe), UINT64_C(0xe4bacd11da4a780a)}},
         {{UINT64_C(0x44c9cc6f33401b88), UINT64_C(0x4ad23b11f2a2562f)},
          {UINT64_C(0x67594b8db36d9a47), UINT64_C(0x25f861c9a40e09c1)}}}};
    require_pinned(test, 2, &pinned[test->precision == TEST_F64][test->method]);
#else
    print_message("skipped: no pinned values for this machine (%d)\n", (int)test->precision);
#endif
}

static const test_entry entries[] = {
    TEST_ENTRY(results_have_one_hash_whoever_works_and_wherever_arrays_begin,
               TEST_SINGLE_AND_DOUBLE, 0, TEST_ALL_METHODS, 0),
    TEST_ENTRY(order_2_has_one_hash_whoever_works_and_wherever_arrays_begin, TEST_SINGLE_AND_DOUBLE,
               0, TEST_LINEARISED, 0),
    TEST_ENTRY(bits_of_order_2_are_those_of_any_compiler, TEST_SINGLE_AND_DOUBLE, 0,
               TEST_LINEARISED, 0),
    TEST_ENTRY(bits_are_those_of_any_compiler, TEST_SINGLE_AND_DOUBLE, 0, TEST_ALL_METHODS, 0),
};
TEST_MAIN(entries)
