/* SPDX-License-Identifier: MIT */
/* Does the library compute on this machine? KGC, MLS and RKPM in 2D and 3D, f32 and f64, on every
 * instruction set that is here, by one thread and by two: gradients exact on linear fields, forces
 * that sum to nothing, the adjoint of the gradient, pairs of brute force, an SVD, words of an
 * error. Prints a hash of all results for each instruction set. Nothing in the input is rounded
 * differently elsewhere, and bits are hashed by value, so that machines can be compared whatever
 * their byte order. */
#include <sphgrad/sphgrad.h>
#include <math.h>
#include <stdio.h>
#include <string.h>

enum { SIDE = 7, MOST = SIDE * SIDE * SIDE, MOST_NUMBERS = MOST * 9, MATRICES = 20 };

/* Numbers of either type; f32 holds what is put into it rounded. */
struct numbers {
    union {
        float f32[MOST_NUMBERS];
        double f64[MOST_NUMBERS];
    } of;
    sphg_type type;
};

static int failures;
static uint64_t hash;

static void put(struct numbers *to, int k, double value)
{
    if (to->type == SPHG_F32)
        to->of.f32[k] = (float)value;
    else
        to->of.f64[k] = value;
}

static double get(const struct numbers *from, int k)
{
    return from->type == SPHG_F32 ? (double)from->of.f32[k] : from->of.f64[k];
}

/* count numbers an item; 0: the first item for all. */
static sphg_view view(const struct numbers *numbers, int count)
{
    return numbers->type == SPHG_F32
               ? sphg_view_f32(numbers->of.f32, count * (ptrdiff_t)sizeof(float))
               : sphg_view_f64(numbers->of.f64, count * (ptrdiff_t)sizeof(double));
}

static void mix(uint64_t bits)
{
    for (int byte = 0; byte < 8; ++byte) { /* FNV-1a, the lowest byte first */
        hash = (hash ^ (bits & 255)) * UINT64_C(1099511628211);
        bits >>= 8;
    }
}

static void mix_numbers(const struct numbers *numbers, int count)
{
    for (int k = 0; k < count; ++k) {
        uint64_t wide = 0;
        uint32_t narrow = 0;
        if (numbers->type == SPHG_F64) {
            memcpy(&wide, &numbers->of.f64[k], sizeof wide);
            mix(wide);
        } else {
            memcpy(&narrow, &numbers->of.f32[k], sizeof narrow);
            mix(narrow);
        }
    }
}

static void expect(int holds, const char *what, const char *detail)
{
    if (!holds) {
        printf("FAILED: %s %s\n", what, detail);
        ++failures;
    }
}

/* NaN is never within. */
static void expect_within(double value, double bound, const char *what)
{
    char detail[64];
    snprintf(detail, sizeof detail, "is %.3e, may be %.1e", value, bound);
    expect(value <= bound, what, detail);
}

static uint32_t state;

static double random_number(void) /* in [-1/2, 1/2), of 24 bits: exact in f32 */
{
    state = state * UINT32_C(1664525) + UINT32_C(1013904223);
    return (double)(state >> 8) / 16777216.0 - 0.5;
}

/* ---- One scene ------------------------------------------------------------------------------- */

static struct numbers position, velocity, scalar, volume, jacobian, gradient, correction, force,
    minus_divergence;
static uint8_t rank[MOST];
static const double slope[3][3] = {{0.25, -1.5, 0.75}, {1, 0.5, -0.25}, {-0.5, 2, -1.25}};

static void fill(int d, int count, sphg_type type)
{
    struct numbers *all[] = {&position, &velocity,   &scalar, &volume,          &jacobian,
                             &gradient, &correction, &force,  &minus_divergence};
    for (size_t k = 0; k < sizeof all / sizeof *all; ++k)
        all[k]->type = type;
    put(&volume, 0, 1);
    for (int i = 0; i < count; ++i) {
        const int cell[3] = {i % SIDE, i / SIDE % SIDE, i / SIDE / SIDE};
        double x[3] = {0};
        for (int k = 0; k < d; ++k) {
            put(&position, i * d + k, cell[k] + 0.25 * random_number());
            x[k] = get(&position, i * d + k);
        }
        for (int a = 0; a < d; ++a)
            put(&velocity, i * d + a, slope[a][0] * x[0] + slope[a][1] * x[1] + slope[a][2] * x[2]);
        put(&scalar, i, random_number());
    }
}

static int64_t brute_force_pairs(int d, int count, double radius)
{
    int64_t pairs = 0;
    for (int i = 0; i < count; ++i)
        for (int j = 0; j < count; ++j) {
            double square = 0;
            for (int k = 0; k < d; ++k) {
                const double x = get(&position, i * d + k) - get(&position, j * d + k);
                square += x * x;
            }
            pairs += i != j && square < radius * radius;
        }
    return pairs;
}

/* Sums that should vanish, beside the sum of their terms' sizes. */
static double force_left(int d, int count)
{
    double worst = 0;
    for (int k = 0; k < d; ++k) {
        double sum = 0, size = 0;
        for (int i = 0; i < count; ++i) {
            sum += get(&force, i * d + k);
            size += fabs(get(&force, i * d + k));
        }
        worst = fabs(sum) <= worst * size ? worst : fabs(sum) / size;
    }
    return worst;
}

static double adjoint_gap(int d, int count) /* V sum grad s . v + sum s div v */
{
    double sum = 0, size = 0;
    for (int i = 0; i < count; ++i) {
        double term = get(&scalar, i) * get(&minus_divergence, i);
        size += fabs(term);
        for (int k = 0; k < d; ++k)
            term += get(&gradient, i * d + k) * get(&velocity, i * d + k);
        sum += term;
    }
    return fabs(sum) / size;
}

static double slope_error(int d, int count)
{
    double worst = 0;
    for (int i = 0; i < count; ++i)
        for (int a = 0; a < d; ++a)
            for (int b = 0; b < d; ++b) {
                const double error = fabs(get(&jacobian, (i * d + a) * d + b) - slope[a][b]);
                worst = error <= worst ? worst : error;
            }
    return worst;
}

static void compute(sphg_context *context, const sphg_scheme *scheme, sphg_type type)
{
    const int d = scheme->dimension, count = d == 3 ? MOST : SIDE * SIDE,
              width = sphg_correction_width(scheme);
    const double unit = type == SPHG_F32 ? 0x1p-24 : 0x1p-53;
    sphg_neighbors *neighbors = NULL;
    sphg_neighbors_info info = {0};
    fill(d, count, type);
    const sphg_geometry geometry = sphg_all(view(&position, d), count);
    sphg_sources sources = {.volume = view(&volume, 0)};
    int failed = sphg_neighbors_create(context, &neighbors) ||
                 sphg_neighbors_search(context, neighbors, scheme, &geometry) ||
                 sphg_neighbors_get_info(context, neighbors, &info);
    sources.neighbors = neighbors;
    failed = failed ||
             sphg_jacobian(context, scheme, &sources, NULL, view(&velocity, d),
                           view(&jacobian, d * d)) ||
             sphg_correction(context, scheme, &sources, NULL, view(&correction, width),
                             sphg_view_u8(rank, 1));
    sources.correction = view(&correction, width);
    const sphg_view at_sources = view(&velocity, d);
    const sphg_field field = {.shape = SPHG_VECTOR,
                              .form = SPHG_ADJOINT,
                              .at_sources = &at_sources,
                              .divergence = view(&minus_divergence, 1)};
    const sphg_request request = {
        .sources = &sources, .fields = &field, .set_count = 1, .field_count = 1};
    failed = failed ||
             sphg_gradient(context, scheme, &sources, NULL, view(&scalar, 1), view(&gradient, d)) ||
             sphg_force(context, scheme, &sources, NULL, SPHG_SCALAR, view(&scalar, 1),
                        view(&force, d)) ||
             sphg_evaluate(context, scheme, &request);
    expect(!failed, "a call", sphg_last_message(context));
    expect(info.pairs == brute_force_pairs(d, count, scheme->support_radius), "the number of pairs",
           "");
    expect(rank[0] == d && rank[count - 1] == d, "the rank", "");
    expect_within(slope_error(d, count), 200 * unit, "the error of a linear field");
    expect_within(force_left(d, count), 200 * unit, "the sum of forces");
    expect_within(adjoint_gap(d, count), 200 * unit, "the gap of the adjoint");
    mix((uint64_t)info.pairs);
    mix_numbers(&jacobian, count * d * d);
    mix_numbers(&correction, count * width);
    mix_numbers(&gradient, count * d);
    mix_numbers(&force, count * d);
    mix_numbers(&minus_divergence, count);
    sphg_neighbors_destroy(neighbors);
}

/* ---- What has no scene ----------------------------------------------------------------------- */

static void decompose(sphg_context *context)
{
    static struct numbers matrix, u, sigma, v;
    double worst = 0;
    matrix.type = u.type = sigma.type = v.type = SPHG_F64;
    for (int k = 0; k < 9 * MATRICES; ++k)
        put(&matrix, k, random_number());
    expect(
        !sphg_svd(context, MATRICES, view(&matrix, 9), view(&u, 9), view(&sigma, 3), view(&v, 9)),
        "the SVD", "");
    for (int k = 0; k < 9 * MATRICES; ++k) {
        const int m = k / 9, a = k % 9 / 3, b = k % 3;
        double gap = -get(&matrix, k);
        for (int c = 0; c < 3; ++c)
            gap += get(&u, 9 * m + 3 * a + c) * get(&sigma, 3 * m + c) * get(&v, 9 * m + 3 * b + c);
        worst = fabs(gap) <= worst ? worst : fabs(gap);
    }
    expect_within(worst, 1e-14, "the error of an SVD");
    mix_numbers(&u, 9 * MATRICES);
    mix_numbers(&sigma, 3 * MATRICES);
}

/* Numbers as wide as pointers are where printf and its formats differ. */
static void refuse(sphg_context *context, const sphg_scheme *scheme)
{
    const sphg_geometry geometry = sphg_all(sphg_view_f64(position.of.f64, 12), 2);
    sphg_neighbors *neighbors = NULL;
    expect(!sphg_neighbors_create(context, &neighbors), "neighbours", "");
    expect(sphg_neighbors_search(context, neighbors, scheme, &geometry) == SPHG_ERROR_ARGUMENT,
           "a bad stride", "");
    expect(strstr(sphg_last_message(context), ".stride is 12, must be a multiple of 8") != NULL,
           "the message:", sphg_last_message(context));
    sphg_neighbors_destroy(neighbors);
}

/* All of it on one instruction set, unless this machine lacks it: then 0. */
static int compute_all(sphg_isa isa, int threads)
{
    const sphg_config config = {.isa = isa, .threads = threads};
    sphg_context *context = NULL;
    if (sphg_context_create(SPHG_VERSION, &config, &context))
        return 0;
    hash = UINT64_C(14695981039346656037);
    state = 1;
    sphg_scheme scheme = {.support_radius = 2.25};
    for (int d = 2; d <= 3; ++d)
        for (int method = SPHG_KGC; method <= SPHG_RKPM; ++method)
            for (int type = SPHG_F32; type <= SPHG_F64; ++type) {
                scheme.dimension = d;
                scheme.method = (sphg_method)method;
                compute(context, &scheme, (sphg_type)type);
            }
    decompose(context);
    refuse(context, &scheme);
    sphg_context_destroy(context);
    return 1;
}

int main(void)
{
    static const struct {
        sphg_isa isa;
        const char *name;
    } sets[] = {{SPHG_ISA_BASE, "base"}, {SPHG_ISA_X86_V3, "v3"}, {SPHG_ISA_X86_V4, "v4"}};
    for (size_t k = 0; k < sizeof sets / sizeof *sets; ++k) {
        if (!compute_all(sets[k].isa, 1))
            continue;
        const uint64_t alone = hash;
        compute_all(sets[k].isa, 2);
        expect(hash == alone, "the bits of two threads on", sets[k].name);
        printf("%s %08lx%08lx\n", sets[k].name, (unsigned long)(alone >> 32),
               (unsigned long)(alone & 0xffffffffu));
    }
    return failures != 0;
}
