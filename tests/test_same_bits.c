/* SPDX-License-Identifier: MIT */
/* Two numbers for all results: one for the base path of x86-64, one for all paths that fuse
 * products and sums, x86-64-v3, x86-64-v4 and AArch64, whichever compiler made them. Every pass
 * takes part: each kernel, method and form in 2D and 3D, radii of their own, periodic boxes, order
 * 2, lenders, diffusion, pairs, small matrices. */
#include "support/setup.h"
#include "support/pins.h"

#if PINS_HOLD_HERE

/* A change that adds in another order changes these, and says so in its message. */
typedef struct pins {
    uint64_t base[3][2], fused[3][2]; /* [precision][2D, 3D] */
} pins;

/* ---- Scene ----------------------------------------------------------------------------------- */

enum { MOST_OUTPUTS = 64 };

typedef struct scene {
    const test_case *test;
    cloud points;
    sphg_type type;
    setup_array position, radius, volume, density, scalar, vector, tensor, coefficient;
    sphg_context *context;
    sphg_scheme scheme;
    sphg_sources sources;
    setup_array outputs[MOST_OUTPUTS];
    int output_count;
    uint64_t hash;
} scene;

static setup_array numbers_of(const scene *of, sphg_type type, int width, double low, double high,
                              random_state *random)
{
    const int count = of->points.count * width;
    double *numbers = test_memory((size_t)count * sizeof *numbers);
    for (int k = 0; k < count; ++k)
        numbers[k] = random_between(random, low, high);
    return setup_numbers(type, of->points.count, width, numbers);
}

/* Thin at one side and full at the other, so that some particles are isolated, some moments are
 * decomposed and some lists take several chunks. */
static scene scene_on(const test_case *test, sphg_isa isa)
{
    random_state random = random_seeded(227);
    const int d = test->dimension;
    scene of = {.test = test, .type = test_field_type(test), .hash = FNV1A_BEGIN};
    of.points = cloud_random(d, d == 2 ? 250 : 400, d == 2 ? 16 : 7, &random);
    for (int i = 0; i < of.points.count; ++i)
        of.points.x[d * i] *= of.points.x[d * i] / 8;
    of.position = setup_positions(test, &of.points);
    of.radius = numbers_of(&of, test_position_type(test), 1, 1.5, 2.5, &random);
    of.volume = numbers_of(&of, of.type, 1, .5, 1.5, &random);
    of.density = numbers_of(&of, of.type, 1, .5, 1.5, &random);
    of.scalar = numbers_of(&of, of.type, 1, -1, 1, &random);
    of.vector = numbers_of(&of, of.type, d, -1, 1, &random);
    of.tensor = numbers_of(&of, of.type, d * d, -1, 1, &random);
    of.coefficient = numbers_of(&of, of.type, 1, .1, 10, &random);
    of.context = setup_context_on(isa);
    of.scheme = setup_scheme(test, 2);
    of.sources.volume = setup_view(&of.volume);
    of.sources.density = setup_view(&of.density);
    return of;
}

typedef enum domain { OPEN, PERIODIC, OWN_RADII, RADII_AROUND, RADII_WITH_SKIN } domain;

static void search(scene *of, domain in)
{
    sphg_geometry geometry = setup_geometry(of->test, &of->points, &of->position);
    if (in == PERIODIC || in == RADII_AROUND)
        geometry.period[0] = geometry.period[1] = 15;
    if (in >= OWN_RADII) {
        geometry.source_support = setup_view(&of->radius);
        geometry.mutual = 1;
    }
    if (in == RADII_WITH_SKIN)
        geometry.skin = .5;
    of->sources.neighbors = setup_search(of->context, &of->scheme, &geometry);
}

static sphg_view output(scene *of, sphg_type type, int width)
{
    TEST_REQUIRE(of->output_count < MOST_OUTPUTS, "room for %d outputs", MOST_OUTPUTS);
    setup_array *array = &of->outputs[of->output_count++];
    *array = setup_output(type, of->points.count, width);
    return setup_view(array);
}

/* What the calls since the last one have written. */
static void mix_outputs(scene *of)
{
    for (int k = 0; k < of->output_count; ++k) {
        const setup_array *array = &of->outputs[k];
        const size_t number = array->type == SPHG_F64 ? 8 : array->type == SPHG_F32 ? 4 : 1;
        of->hash =
            fnv1a(of->hash, array->data, (size_t)array->count * (size_t)array->width * number);
    }
    of->output_count = 0;
}

static void evaluate(scene *of, const sphg_field *fields, int count, bool corrections)
{
    sphg_request request = {
        .sources = &of->sources, .set_count = 1, .fields = fields, .field_count = count};
    if (corrections) {
        request.rank = output(of, SPHG_U8, 1);
        request.lambda_min = output(of, of->type, 1);
        request.correction = output(of, of->type, sphg_correction_width(&of->scheme));
    }
    SETUP_OK(of->context, sphg_evaluate(of->context, &of->scheme, &request));
    if (corrections)
        of->sources.correction = request.correction;
}

/* ---- What is asked for -------------------------------------------------------------------------
 */

static bool is_classic(const scene *of)
{
    return of->scheme.method == SPHG_CMLS || of->scheme.method == SPHG_CRKPM;
}

/* Corrections, with forms that need none of the sources'. */
static void one_sided(scene *of)
{
    const int d = of->test->dimension;
    const sphg_view scalar = setup_view(&of->scalar), vector = setup_view(&of->vector);
    const sphg_view tensor = setup_view(&of->tensor), volume = setup_view(&of->density);
    const bool classic = is_classic(of);
    sphg_field fields[] = {
        {.shape = SPHG_VECTOR, .at_sources = &vector},
        {.shape = SPHG_TENSOR, .at_sources = &tensor},
        {.shape = SPHG_VECTOR, .form = SPHG_DIRECT, .at_sources = &vector},
        {.shape = SPHG_SCALAR, .form = SPHG_DIRECT, .at_sources = &scalar},
        {.shape = SPHG_SCALAR, .form = SPHG_DIRECT, .at_sources = &scalar, .shepard = !classic}};
    fields[0].value = output(of, of->type, d);
    fields[0].gradient = output(of, of->type, d * d);
    fields[0].divergence = output(of, of->type, 1);
    fields[0].curl = output(of, of->type, d == 3 ? 3 : 1);
    fields[0].tensor = tensor;
    fields[0].contraction = output(of, of->type, 1);
    fields[1].divergence = output(of, of->type, d);
    fields[2].value = output(of, of->type, d);
    fields[2].divergence = output(of, of->type, 1);
    fields[3].square = output(of, of->type, 1);
    fields[4].value = output(of, of->type, 1);
    fields[4].value_volume = classic ? NULL : &volume;
    of->sources.correction = sphg_absent();
    evaluate(of, fields, 5, of->scheme.method != SPHG_PLAIN);
}

/* Forms that read the table which is there by now; of classic methods without what they have not.
 */
static void two_sided(scene *of)
{
    const int d = of->test->dimension;
    const sphg_view scalar = setup_view(&of->scalar), vector = setup_view(&of->vector);
    const sphg_view tensor = setup_view(&of->tensor), coefficient = setup_view(&of->coefficient);
    const bool flows = !is_classic(of);
    sphg_field fields[] = {{.shape = SPHG_SCALAR, .form = SPHG_ADJOINT, .at_sources = &scalar},
                           {.shape = SPHG_VECTOR, .form = SPHG_ADJOINT, .at_sources = &vector},
                           {.shape = SPHG_TENSOR, .form = SPHG_ADJOINT, .at_sources = &tensor},
                           {.shape = SPHG_VECTOR, .form = SPHG_SYMMETRIC, .at_sources = &vector},
                           {.shape = SPHG_TENSOR, .form = SPHG_SYMMETRIC, .at_sources = &tensor},
                           {.shape = SPHG_VECTOR, .form = SPHG_ADJOINT, .at_sources = &vector},
                           {.shape = SPHG_SCALAR, .form = SPHG_ADJOINT, .at_sources = &scalar}};
    fields[0].gradient = output(of, of->type, d);
    fields[1].divergence = output(of, of->type, 1);
    fields[2].divergence = output(of, of->type, d);
    fields[3].gradient = output(of, of->type, d * d);
    fields[4].divergence = output(of, of->type, d);
    if (flows) {
        fields[5].laplacian = output(of, of->type, d);
        fields[5].coefficient = &coefficient;
        fields[6].laplacian = output(of, of->type, 1);
    }
    evaluate(of, fields, flows ? 7 : 5, false);
}

static void pairs(scene *of)
{
    const int d = of->test->dimension, n = of->points.count;
    sphg_pairs found = {.offsets = test_memory((size_t)(n + 1) * sizeof(int64_t))};
    SETUP_OK(of->context, sphg_pair_gradients(of->context, &of->scheme, &of->sources, NULL,
                                              sphg_absent(), &found));
    setup_array gradient = setup_output(of->type, (int)found.count, d);
    found.indices = test_memory((size_t)found.count * sizeof(int32_t));
    found.gradient = setup_view(&gradient);
    found.capacity = found.count;
    SETUP_OK(of->context, sphg_pair_gradients(of->context, &of->scheme, &of->sources, NULL,
                                              sphg_absent(), &found));
    of->outputs[of->output_count++] = gradient;
}

static void every_form(scene *of)
{
    one_sided(of);
    two_sided(of);
    pairs(of);
    mix_outputs(of);
}

/* Derivatives of order 2; their table, and who reads it; then what is lent and borrowed. */
static void second_order(scene *of)
{
    const int d = of->test->dimension, products = d * (d + 1) / 2;
    const sphg_view scalar = setup_view(&of->scalar), vector = setup_view(&of->vector);
    const sphg_view tensor = setup_view(&of->tensor);
    sphg_field own[] = {{.shape = SPHG_SCALAR, .at_sources = &scalar},
                        {.shape = SPHG_VECTOR, .at_sources = &vector}};
    own[0].gradient = output(of, of->type, d);
    own[0].hessian = output(of, of->type, products);
    own[1].gradient = output(of, of->type, d * d);
    own[1].divergence = output(of, of->type, 1);
    own[1].laplacian = output(of, of->type, d);
    evaluate(of, own, 2, true);
    sphg_field force = {.shape = SPHG_TENSOR, .form = SPHG_ADJOINT, .at_sources = &tensor};
    force.divergence = output(of, of->type, d);
    evaluate(of, &force, 1, false);
    pairs(of);
    of->sources.correction = sphg_absent();
    sphg_view lent = sphg_absent();
    sphg_field lends = {.shape = SPHG_VECTOR, .at_sources = &vector};
    for (int round = 0; round < 3; ++round) {
        lends.lenders = round ? &lent : NULL;
        lends.gradient = output(of, of->type, d * d);
        lends.laplacian = output(of, of->type, d);
        lends.curvature = output(of, of->type, 1 + d * products);
        evaluate(of, &lends, 1, false);
        lent = lends.curvature;
    }
    mix_outputs(of);
}

/* The tensors of the scene as moments, from nearly the unit matrix to far from positive. */
static void small_matrices(scene *of)
{
    const int d = of->test->dimension, n = of->points.count, width = d * (d + 1) / 2;
    setup_array moments = setup_output(of->type, n, width);
    for (int i = 0; i < n; ++i)
        for (int a = 0, k = 0; a < d; ++a)
            for (int b = a; b < d; ++b, ++k)
                setup_put(&moments, i * width + k,
                          (a == b) + 1.5 * i / n * setup_get(&of->tensor, i, a * d + b));
    for (int policy = SPHG_BLEND; policy <= SPHG_IDENTITY; ++policy) {
        of->scheme.policy = (sphg_policy)policy;
        const sphg_inversion wanted = {.correction = output(of, of->type, width),
                                       .rank = output(of, SPHG_U8, 1),
                                       .lambda_min = output(of, of->type, 1)};
        SETUP_OK(of->context, sphg_invert_moments(of->context, &of->scheme, n, setup_view(&moments),
                                                  of->sources.volume, &wanted));
    }
    const sphg_view values = output(of, of->type, d), vectors = output(of, of->type, d * d);
    SETUP_OK(of->context, sphg_eigen(of->context, d, n, setup_view(&moments), values, vectors));
    mix_outputs(of);
}

/* ---- Properties --------------------------------------------------------------------------------
 */

static void every_method(scene *of)
{
    search(of, OPEN);
    for (int method = SPHG_KGC; method <= SPHG_PLAIN; ++method) {
        of->scheme.method = (sphg_method)method;
        every_form(of);
    }
}

static void every_kernel(scene *of)
{
    search(of, OPEN);
    for (int kernel = SPHG_CUBIC_SPLINE; kernel <= SPHG_SPIKY; ++kernel)
        for (int method = SPHG_KGC; method <= SPHG_CMLS; ++method) {
            of->scheme.kernel = (sphg_kernel)kernel;
            of->scheme.method = (sphg_method)method;
            one_sided(of);
            mix_outputs(of);
        }
}

static void every_domain(scene *of)
{
    for (domain in = PERIODIC; in <= OWN_RADII; ++in) {
        search(of, in);
        for (int method = SPHG_KGC; method <= SPHG_RKPM; ++method) {
            of->scheme.method = (sphg_method)method;
            every_form(of);
        }
    }
}

/* What both radii of a pair take part in. */
static void every_radius(scene *of)
{
    for (domain in = OWN_RADII; in <= RADII_WITH_SKIN; ++in) {
        search(of, in);
        for (int method = SPHG_KGC; method <= SPHG_PLAIN; ++method) {
            of->scheme.method = (sphg_method)method;
            of->scheme.kernel = (sphg_kernel)((method + (int)in) % (SPHG_SPIKY + 1));
            every_form(of);
            if (method > SPHG_RKPM)
                continue;
            of->sources.correction = sphg_absent();
            of->scheme.order = 2;
            second_order(of);
            of->scheme.order = 1;
        }
    }
}

static void every_order(scene *of)
{
    search(of, OPEN);
    of->scheme.order = 2;
    for (int method = SPHG_KGC; method <= SPHG_RKPM; ++method) {
        of->scheme.method = (sphg_method)method;
        second_order(of);
    }
}

static int try_paths(const test_case *test, void (*compute)(scene *), const pins *expected)
{
    int paths = 0;
    for (sphg_isa isa = SPHG_ISA_BASE; isa <= SPHG_ISA_NEON; ++isa) {
        if (!setup_context_on(isa))
            continue;
        scene of = scene_on(test, isa);
        compute(&of);
        const uint64_t pinned =
            (pins_are_of_fused(isa) ? expected->fused
                                    : expected->base)[test->precision][test->dimension == 3];
        TEST_REQUIRE(of.hash == pinned, "path %d, precision %d, %dD: UINT64_C(0x%016llx)", (int)isa,
                     (int)test->precision, test->dimension, (unsigned long long)of.hash);
        ++paths;
    }
    return paths;
}

/* All in one case: no build is to leave out some of them. */
static void require_pinned(void (*compute)(scene *), const pins *expected)
{
    if (random_chosen()) { /* the pins are those of the tests' own numbers */
        print_message("skipped: SPHG_TEST_SEED is set\n");
        return;
    }
    for (int precision = TEST_F32; precision <= TEST_MIXED; ++precision)
        for (int d = 2; d <= 3; ++d) {
            const test_case test = {.precision = (test_precision)precision, .dimension = d};
            assert_true(try_paths(&test, compute, expected) > 0);
        }
}

static void methods_and_forms_have_one_hash_a_kind_of_path(const test_case *test)
{
    (void)test;
    static const pins pinned = {{{UINT64_C(0x3e7d2c966a2c01cd), UINT64_C(0x62bc35ba8f3843c4)},
                                 {UINT64_C(0x061de9d6a48c36a3), UINT64_C(0xecff00539be85a19)},
                                 {UINT64_C(0x74b487e9da60c52d), UINT64_C(0x38e03767f45487c2)}},
                                {{UINT64_C(0xbf26d75702d56d7e), UINT64_C(0x54a15cdc1e89e8ba)},
                                 {UINT64_C(0xcf40f3f34c9a608f), UINT64_C(0xe931baf057f0ba84)},
                                 {UINT64_C(0xa3b5ce086d3a6699), UINT64_C(0x085f7054c53ebff3)}}};
    require_pinned(every_method, &pinned);
}

static void kernels_have_one_hash_a_kind_of_path(const test_case *test)
{
    (void)test;
    static const pins pinned = {{{UINT64_C(0x9dce1a6c642998b3), UINT64_C(0xc130778ff51dd206)},
                                 {UINT64_C(0x73f6b7dce01d954f), UINT64_C(0x3263895da88ef6a9)},
                                 {UINT64_C(0x18761071bf6e8397), UINT64_C(0x31b0c189dc6f9b3b)}},
                                {{UINT64_C(0x78a0f3246d09f157), UINT64_C(0xdb947ecd2b839a67)},
                                 {UINT64_C(0xe07fa965952f4c26), UINT64_C(0xf70f47f4c3b4d3f0)},
                                 {UINT64_C(0x50085fda9c3bef8f), UINT64_C(0xb64589753bb79767)}}};
    require_pinned(every_kernel, &pinned);
}

static void domains_and_radii_have_one_hash_a_kind_of_path(const test_case *test)
{
    (void)test;
    static const pins pinned = {{{UINT64_C(0x037b2f758448d8bd), UINT64_C(0x9b7cf25141156395)},
                                 {UINT64_C(0xd7e1d7da65183255), UINT64_C(0x827f4ab47242e181)},
                                 {UINT64_C(0xeb456e97db4e239d), UINT64_C(0xbf819e31a7f82791)}},
                                {{UINT64_C(0x4b276be2cc356ae1), UINT64_C(0x3a65a27599f50fb1)},
                                 {UINT64_C(0x3d3d55109df41a90), UINT64_C(0x7e9a71b9e8293d40)},
                                 {UINT64_C(0xbc03744ecb42cac9), UINT64_C(0x92e6b2fb8eeafc4e)}}};
    require_pinned(every_domain, &pinned);
}

static void both_radii_have_one_hash_a_kind_of_path(const test_case *test)
{
    (void)test;
    static const pins pinned = {{{UINT64_C(0xf6dffb3415e0bb1d), UINT64_C(0x3d5c16af8e5269fb)},
                                 {UINT64_C(0x08e8ee9e482385b9), UINT64_C(0xac882a0dfe667890)},
                                 {UINT64_C(0x14aa8671903eacb6), UINT64_C(0xbb731e179a0b8161)}},
                                {{UINT64_C(0x7eecbe23bf7e3e3d), UINT64_C(0x000ff98db5ad2cd1)},
                                 {UINT64_C(0x32015f4565fe17cd), UINT64_C(0x678bdb5e0472d684)},
                                 {UINT64_C(0xab99530fe866712e), UINT64_C(0x6a335b812d621f76)}}};
    require_pinned(every_radius, &pinned);
}

static void order_2_has_one_hash_a_kind_of_path(const test_case *test)
{
    (void)test;
    static const pins pinned = {{{UINT64_C(0x98f2ce27da1e7f3d), UINT64_C(0x78d09b39b72f0a61)},
                                 {UINT64_C(0x4a76620b18579ecd), UINT64_C(0xbf38c2ce7a5a68cc)},
                                 {UINT64_C(0x80a865db11915037), UINT64_C(0x1c066d2cb35c5521)}},
                                {{UINT64_C(0x1c2c4fc8b16c5b57), UINT64_C(0x91e5b8c7878012e3)},
                                 {UINT64_C(0x9db38a8fdb93dc3e), UINT64_C(0x3d39516f36a9e42b)},
                                 {UINT64_C(0x3a2c0091747d4ac6), UINT64_C(0x266d7eaadee50ca5)}}};
    require_pinned(every_order, &pinned);
}

static void small_matrices_have_one_hash_a_kind_of_path(const test_case *test)
{
    (void)test;
    static const pins pinned = {{{UINT64_C(0x1de49512d9ae6aa2), UINT64_C(0x656add1ca3e1ecd5)},
                                 {UINT64_C(0x243b089d16ef8c4e), UINT64_C(0x382ba7510879e220)},
                                 {UINT64_C(0x1de49512d9ae6aa2), UINT64_C(0x656add1ca3e1ecd5)}},
                                {{UINT64_C(0xba1de007aeb2a6d3), UINT64_C(0x9f7f05c4cd14f553)},
                                 {UINT64_C(0x78096c891e6d7d6a), UINT64_C(0xdf503149a2f577f8)},
                                 {UINT64_C(0xba1de007aeb2a6d3), UINT64_C(0x9f7f05c4cd14f553)}}};
    require_pinned(small_matrices, &pinned);
}

static const test_entry entries[] = {TEST_ONCE(methods_and_forms_have_one_hash_a_kind_of_path),
                                     TEST_ONCE(kernels_have_one_hash_a_kind_of_path),
                                     TEST_ONCE(domains_and_radii_have_one_hash_a_kind_of_path),
                                     TEST_ONCE(both_radii_have_one_hash_a_kind_of_path),
                                     TEST_ONCE(order_2_has_one_hash_a_kind_of_path),
                                     TEST_ONCE(small_matrices_have_one_hash_a_kind_of_path)};
#else
static void nothing_is_pinned_for_this_machine(const test_case *test)
{
    (void)test;
    test_skip();
}

static const test_entry entries[] = {TEST_ONCE(nothing_is_pinned_for_this_machine)};
#endif
TEST_MAIN(entries)
