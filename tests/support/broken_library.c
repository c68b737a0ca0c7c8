/* SPDX-License-Identifier: MIT */
/* Stands before the library (LD_PRELOAD) and spoils what corrected methods find, as BROKEN_LIBRARY
 * says: "zero", "minus" (the other sign), "late" (what the call before wrote to this place, at
 * first 0), "1.01" (times that), "random" (1e-6 of each number), "hole" (item 3 of each result is
 * NaN) or "none". Gates of scenes that hold all the same would say nothing about the library.
 * Values, which linearised methods do not correct, densities and plain SPH stay. */
#include <dlfcn.h>
#include <math.h>
#include <sphgrad/sphgrad.h>
#include <stdio.h>
#include <stdlib.h>
#include <string.h>

static double noise(void)
{
    static uint64_t state = 1;
    state = state * 6364136223846793005u + 1442695040888963407u;
    return (double)(state >> 11) * 0x1p-52 - 1;
}

/* The letter that the word begins with. */
static int how(void)
{
    static const char *const words[] = {"zero", "minus", "late", "1.01", "random", "hole", "none"};
    static int letter;
    const char *word = getenv("BROKEN_LIBRARY");
    for (int k = 0; !letter && word && k < 7; ++k)
        if (strcmp(word, words[k]) == 0)
            letter = *word;
    if (!letter) {
        fprintf(stderr, "BROKEN_LIBRARY is to be zero, minus, late, 1.01, random, hole or none\n");
        abort();
    }
    return letter;
}

enum { PLACES = 1 << 22 };

/* What was kept of a place; 0 where nothing was. */
static double *kept(const void *place)
{
    static struct {
        const void *place;
        double value;
    } table[PLACES];
    size_t at = (size_t)((uintptr_t)place * 0x9e3779b97f4a7c15u >> 42);
    for (size_t tried = 0; table[at].place && table[at].place != place; ++tried) {
        if (tried == PLACES) {
            fprintf(stderr, "results at more places than can be kept\n");
            abort();
        }
        at = (at + 1) % PLACES;
    }
    table[at].place = place;
    return &table[at].value;
}

static double late(const void *place, double value)
{
    double *old = kept(place), before = *old;
    *old = value;
    return before;
}

static double spoiled(const void *place, double value)
{
    switch (how()) {
    case 'z':
        return 0;
    case 'm':
        return -value;
    case 'l':
        return late(place, value);
    case '1':
        return 1.01 * value;
    case 'h':
        return NAN;
    case 'r':
        return value * (1 + 1e-6 * noise());
    default:
        return value;
    }
}

static void *real(const char *name)
{
    void *found = dlsym(RTLD_NEXT, name);
    if (!found) {
        fprintf(stderr, "the library has no %s\n", name);
        abort();
    }
    return found;
}

/* ISO C has no cast from an object to a function, so the pointer's bytes are copied. */
#define REAL(function, name)                                                                       \
    do {                                                                                           \
        void *address = real(name);                                                                \
        memcpy(&(function), &address, sizeof address);                                             \
    } while (0)

/* ---- Results --------------------------------------------------------------------------------- */

static void spoil_number(const sphg_view *view, const void *part, int32_t item, int32_t number)
{
    char *start = (char *)(uintptr_t)part + item * view->stride;
    double *wide = (double *)(void *)start + number;
    float *narrow = (float *)(void *)start + number;
    if (how() == 'h' && item != 3)
        return;
    if (view->type == SPHG_F64)
        *wide = spoiled(wide, *wide);
    else
        *narrow = (float)spoiled(narrow, (double)*narrow);
}

/* An item has rows x columns numbers; where y is set each row, or each component of a vector,
 * stands in an array of its own. */
static void spoil_item(const sphg_view *view, int32_t item, int32_t rows, int32_t columns)
{
    const void *const parts[3] = {view->x, view->y, view->z};
    const int32_t apart = !view->y ? 1 : rows > 1 ? rows : columns;
    for (int32_t part = 0; part < apart; ++part)
        for (int32_t number = 0; number < rows * columns / apart; ++number)
            spoil_number(view, parts[part], item, number);
}

/* Those targets that the call wrote. */
static void spoil(sphg_context *context, const sphg_sources *sources, const sphg_subset *subset,
                  const sphg_view *view, int32_t rows, int32_t columns)
{
    sphg_neighbors_info info = {0};
    if (!view->x || sphg_neighbors_get_info(context, sources->neighbors, &info) != SPHG_OK)
        return;
    const int32_t begin = subset ? subset->begin : 0;
    const int32_t end = subset ? subset->end : info.target_count;
    for (int32_t k = begin; k < end; ++k) {
        const int32_t item = subset && subset->indices ? subset->indices[k] : k;
        if (!subset || !subset->mask || subset->mask[item])
            spoil_item(view, item, rows, columns);
    }
}

static int32_t dimension_of(const sphg_scheme *scheme)
{
    return scheme->dimension == 2 ? 2 : 3;
}

static int32_t numbers_of_curl(const sphg_scheme *scheme)
{
    return dimension_of(scheme) == 2 ? 1 : 3;
}

/* ---- The calls ------------------------------------------------------------------------------- */

static void spoil_field(sphg_context *context, const sphg_scheme *scheme,
                        const sphg_request *request, const sphg_field *field)
{
    const int32_t d = dimension_of(scheme);
    const int32_t vector = field->shape == SPHG_VECTOR;
    const int32_t numbers[] = {0, 1, d, d * (d + 1) / 2, d * d};
    if (field->accumulate) {
        fprintf(stderr, "accumulated results cannot be told from what was there\n");
        abort();
    }
    spoil(context, request->sources, request->subset, &field->gradient, vector ? d : 1, d);
    spoil(context, request->sources, request->subset, &field->divergence, 1, vector ? 1 : d);
    spoil(context, request->sources, request->subset, &field->curl, 1, numbers_of_curl(scheme));
    spoil(context, request->sources, request->subset, &field->square, 1, 1);
    spoil(context, request->sources, request->subset, &field->laplacian, 1, numbers[field->shape]);
    spoil(context, request->sources, request->subset, &field->contraction, 1, 1);
}

sphg_result sphg_evaluate(sphg_context *context, const sphg_scheme *scheme,
                          const sphg_request *request)
{
    sphg_result (*evaluate)(sphg_context *, const sphg_scheme *, const sphg_request *);
    REAL(evaluate, "sphg_evaluate");
    const sphg_result result = evaluate(context, scheme, request);
    if (result == SPHG_OK && scheme->method != SPHG_PLAIN)
        for (int32_t k = 0; k < request->field_count; ++k)
            spoil_field(context, scheme, request, &request->fields[k]);
    return result;
}

/* A short call of so many numbers an item. */
#define SHORT_CALL(name, rows, columns)                                                            \
    sphg_result name(sphg_context *context, const sphg_scheme *scheme,                             \
                     const sphg_sources *sources, const sphg_subset *subset, sphg_view field,      \
                     sphg_view found)                                                              \
    {                                                                                              \
        sphg_result (*call)(sphg_context *, const sphg_scheme *, const sphg_sources *,             \
                            const sphg_subset *, sphg_view, sphg_view);                            \
        REAL(call, #name);                                                                         \
        const sphg_result result = call(context, scheme, sources, subset, field, found);           \
        if (result == SPHG_OK && scheme->method != SPHG_PLAIN)                                     \
            spoil(context, sources, subset, &found, rows, columns);                                \
        return result;                                                                             \
    }

SHORT_CALL(sphg_gradient, 1, dimension_of(scheme))
SHORT_CALL(sphg_jacobian, dimension_of(scheme), dimension_of(scheme))
SHORT_CALL(sphg_divergence, 1, 1)
SHORT_CALL(sphg_curl, 1, numbers_of_curl(scheme))

sphg_result sphg_force(sphg_context *context, const sphg_scheme *scheme,
                       const sphg_sources *sources, const sphg_subset *subset, sphg_shape shape,
                       sphg_view stress, sphg_view force)
{
    sphg_result (*call)(sphg_context *, const sphg_scheme *, const sphg_sources *,
                        const sphg_subset *, sphg_shape, sphg_view, sphg_view);
    REAL(call, "sphg_force");
    const sphg_result result = call(context, scheme, sources, subset, shape, stress, force);
    if (result == SPHG_OK && scheme->method != SPHG_PLAIN)
        spoil(context, sources, subset, &force, 1, dimension_of(scheme));
    return result;
}

sphg_result sphg_pair_gradients(sphg_context *context, const sphg_scheme *scheme,
                                const sphg_sources *sources, const sphg_subset *subset,
                                sphg_view target_correction, sphg_pairs *pairs)
{
    sphg_result (*call)(sphg_context *, const sphg_scheme *, const sphg_sources *,
                        const sphg_subset *, sphg_view, sphg_pairs *);
    REAL(call, "sphg_pair_gradients");
    const sphg_result result = call(context, scheme, sources, subset, target_correction, pairs);
    if (result == SPHG_OK && scheme->method != SPHG_PLAIN && pairs->gradient.x)
        for (int64_t k = 0; k < pairs->count; ++k)
            spoil_item(&pairs->gradient, (int32_t)k, 1, dimension_of(scheme));
    return result;
}

void sphg_pair_gradient(const sphg_scheme *scheme, const double *x_ij, double volume,
                        const double *correction, double *gradient)
{
    void (*call)(const sphg_scheme *, const double *, double, const double *, double *);
    REAL(call, "sphg_pair_gradient");
    call(scheme, x_ij, volume, correction, gradient);
    for (int32_t k = 0; scheme->method != SPHG_PLAIN && k < dimension_of(scheme); ++k)
        gradient[k] = spoiled(&gradient[k], gradient[k]);
}
