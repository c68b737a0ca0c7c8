/* SPDX-License-Identifier: MIT */
#include "bad_arguments.h"
#include <float.h>
#include <limits.h>
#include <math.h>
#include <stdio.h>
#include <stdlib.h>
#include <string.h>

__attribute__((format(printf, 2, 3))) static void name_trial(trial *made, const char *format, ...)
{
    va_list arguments;
    va_start(arguments, format);
    vsnprintf(made->what, sizeof made->what, format, arguments);
    va_end(arguments);
}

static void expect(trial *made, int code, const char *words)
{
    made->expected = code;
    made->words = words;
}

static void *member(valid_call *own, const argument *spoilt)
{
    return (char *)own + spoilt->at;
}

/* ---- Pointers and integers ---------------------------------------------------------------- */

static int spoil_pointer(valid_call *own, const argument *spoilt, int number, trial *made)
{
    if (number > 0)
        return 0;
    memset(member(own, spoilt), 0, sizeof(void *));
    name_trial(made, "NULL");
    expect(made, SPHG_ERROR_ARGUMENT, NULL);
    strcpy(made->value, spoilt->kind == ARGUMENT_HANDLE ? "" : "NULL");
    return 1;
}

static int spoil_built(valid_call *own, const argument *spoilt, int number, trial *made)
{
    if (number == 0)
        return spoil_pointer(own, spoilt, 0, made);
    *(sphg_neighbors **)member(own, spoilt) = own->blank;
    name_trial(made, "never built");
    expect(made, SPHG_ERROR_STATE, NULL);
    strcpy(made->value, "never built");
    return number == 1;
}

static int put_integer(valid_call *own, const argument *spoilt, int value, trial *made)
{
    memcpy(member(own, spoilt), &value, sizeof value);
    name_trial(made, "%d", value);
    expect(made, SPHG_ERROR_ARGUMENT, NULL);
    snprintf(made->value, sizeof made->value, "%d", value);
    return 1;
}

static int spoil_count(valid_call *own, const argument *spoilt, int number, trial *made)
{
    static const int values[] = {-1, INT_MIN, -1000000, 0};
    if (number > 3)
        return 0;
    put_integer(own, spoilt, values[number], made);
    if (values[number] == 0 && !(spoilt->flags & ARGUMENT_POSITIVE))
        made->expected = spoilt->low < 0 ? ARGUMENT_SKIPPED : SPHG_OK;
    return 1;
}

static int spoil_enum(valid_call *own, const argument *spoilt, int number, trial *made)
{
    const int values[] = {spoilt->low - 1, spoilt->high + 1, INT_MIN, INT_MAX, 4711};
    return number < 5 && put_integer(own, spoilt, values[number], made);
}

static int spoil_dimension(valid_call *own, const argument *spoilt, int number, trial *made)
{
    const int values[] = {1, 4, -1, -3, INT_MIN, INT_MAX, spoilt->low ? 0 : 5};
    return number < 7 && put_integer(own, spoilt, values[number], made);
}

/* ---- Lengths ------------------------------------------------------------------------------ */

static int put_real(valid_call *own, const argument *spoilt, double value, trial *made)
{
    memcpy(member(own, spoilt), &value, sizeof value);
    name_trial(made, "%g", value);
    expect(made, SPHG_ERROR_ARGUMENT, NULL);
    for (int digits = 6; digits <= 17; ++digits) { /* the fewest that read back */
        snprintf(made->value, sizeof made->value, "%.*g", digits, value);
        if (strtod(made->value, NULL) == value)
            break;
    }
    return 1;
}

/* Where powers of H leave the range, a search refuses for that, an operator for being larger than
 * the search. */
static int spoil_radius(valid_call *own, const argument *spoilt, int number, trial *made)
{
    static const double values[] = {0,        -0.0,      -1,           NAN,
                                    INFINITY, -INFINITY, DBL_TRUE_MIN, DBL_MIN,
                                    DBL_MAX,  -DBL_MAX,  1e-310,       1e300};
    static const double single[] = {1e-30, 1e-20, (double)FLT_MIN, 1e-40};
    if (number < 12)
        put_real(own, spoilt, values[number], made);
    else if (number < 16 && test_position_type(own->test) == SPHG_F32)
        put_real(own, spoilt, single[number - 12], made);
    else
        return 0;
    if (number > 5)
        made->expected = ARGUMENT_REFUSED;
    made->value[number > 5 ? 0 : 39] = 0;
    return 1;
}

static int spoil_threshold(valid_call *own, const argument *spoilt, int number, trial *made)
{
    static const double values[] = {-1e-3, 1, 2, NAN, INFINITY, -INFINITY, -DBL_TRUE_MIN, DBL_MAX};
    return number < 8 && put_real(own, spoilt, values[number], made);
}

static int spoil_length(valid_call *own, const argument *spoilt, int number, trial *made)
{
    static const double values[] = {-1, NAN, INFINITY, -INFINITY, -1e-300};
    return number < 5 && put_real(own, spoilt, values[number], made);
}

/* ---- Views -------------------------------------------------------------------------------- */

static ptrdiff_t size_of(sphg_type type)
{
    return type == SPHG_F64 ? 8 : type == SPHG_F32 ? 4 : 1;
}

static const void *moved(const void *memory, ptrdiff_t bytes)
{
    return (const void *)((uintptr_t)memory + (uintptr_t)bytes);
}

static int spoil_type(sphg_view *view, const argument *spoilt, int number, trial *made)
{
    const int other = spoilt->flags & ARGUMENT_BYTES ? SPHG_F32
                      : view->type == SPHG_F32       ? SPHG_F64
                                                     : SPHG_F32;
    const int values[] = {
        0, 4, -1, INT_MAX, INT_MIN, spoilt->flags & ARGUMENT_BYTES ? SPHG_F64 : SPHG_U8, other};
    if (number == 6 && spoilt->flags & ARGUMENT_LEADING)
        return 0;
    if (number > 6)
        return 0;
    view->type = (sphg_type)values[number];
    name_trial(made, "type %d", values[number]);
    expect(made, number < 5 ? ARGUMENT_REFUSED : SPHG_ERROR_TYPE, NULL);
    snprintf(made->value, sizeof made->value, "%d", values[number]);
    return 1;
}

/* Those that are none; which ones a view may have is tested with the views. */
static int spoil_layout(sphg_view *view, int number, trial *made)
{
    static const int values[] = {SPHG_FULL + 1, -1, INT_MAX};
    view->layout = (sphg_layout)values[number];
    name_trial(made, "layout %d", values[number]);
    expect(made, SPHG_ERROR_ARGUMENT, NULL);
    snprintf(made->value, sizeof made->value, "%d", values[number]);
    return 1;
}

static int spoil_stride(sphg_view *view, const argument *spoilt, int number, trial *made)
{
    const ptrdiff_t size = size_of(view->type), item = view->stride;
    const int is_output = (spoilt->flags & ARGUMENT_OUTPUT) != 0;
    const ptrdiff_t values[] = {item + 1,    PTRDIFF_MAX / size * size,
                                PTRDIFF_MIN, PTRDIFF_MAX / 59 / size * size + size,
                                item - 1,    0,
                                -item + size};
    if (number > (is_output ? 6 : 3))
        return 0;
    view->stride = values[number];
    name_trial(made, "stride %td", view->stride);
    expect(made, SPHG_ERROR_ARGUMENT, NULL);
    snprintf(made->value, sizeof made->value, "%td", view->stride);
    if (view->stride % size == 0 && is_output && number > 5 && item == size)
        made->expected = ARGUMENT_SKIPPED; /* of a scalar: there is no such stride but 0 */
    if (size == 1 && (number == 0 || number == 1))
        made->expected = number ? SPHG_ERROR_ARGUMENT : ARGUMENT_SKIPPED;
    return 1;
}

static int spoil_start(valid_call *own, sphg_view *view, const argument *spoilt, int number,
                       trial *made)
{
    expect(made, SPHG_ERROR_ARGUMENT, NULL);
    if (number == 0) {
        view->x = NULL;
        name_trial(made, "absent");
        made->expected = spoilt->flags & ARGUMENT_REQUIRED ? SPHG_ERROR_ARGUMENT : ARGUMENT_SKIPPED;
        return 1;
    }
    if (number < size_of(view->type)) {
        view->x = moved(view->x, number);
        name_trial(made, "misaligned by %d", number);
        return 1;
    }
    if (number < 8) {
        made->expected = ARGUMENT_SKIPPED;
        return 1;
    }
    if (number > 10 || !(spoilt->flags & ARGUMENT_VECTOR))
        return 0;
    if (number == 8 && own->test->dimension == 3) {
        view->y = moved(view->x, size_of(view->type));
        name_trial(made, "y without z");
    } else if (number == 9 && own->test->dimension == 3) {
        view->z = moved(view->x, size_of(view->type));
        name_trial(made, "z without y");
    } else {
        view->y = view->z = moved(view->x, 1);
        name_trial(made, "y misaligned");
        if (size_of(view->type) == 1)
            made->expected = ARGUMENT_SKIPPED;
    }
    return 1;
}

/* The output begins at, behind or before another array, or its components on each other. */
static int spoil_overlap(valid_call *own, const probe *tested, const argument *spoilt, int number,
                         trial *made)
{
    if (!(spoilt->flags & ARGUMENT_OUTPUT) || number / 3 >= tested->count)
        return 0;
    sphg_view *view = member(own, spoilt);
    const argument *other = &tested->arguments[number / 3];
    const sphg_view *at = member(own, other);
    expect(made, SPHG_ERROR_ARGUMENT, "overlaps");
    if (other == spoilt && spoilt->flags & ARGUMENT_VECTOR && number % 3 == 0) {
        view->y = view->z = view->x;
        name_trial(made, "components on each other");
        return 1;
    }
    const int same = at == view, in_place = strcmp(spoilt->path, "wanted.correction") == 0 &&
                                            strcmp(other->path, "moments") == 0;
    made->expected = ARGUMENT_SKIPPED;
    if (other->kind != ARGUMENT_VIEW || same || !at->x || !view->x || (in_place && number % 3 == 0))
        return 1;
    const ptrdiff_t span = (VALID_CALL_COUNT - 1) * view->stride;
    const ptrdiff_t by[] = {0, (VALID_CALL_COUNT - 1) * at->stride, -span};
    view->x = moved(at->x, by[number % 3]);
    if ((uintptr_t)view->x % (uintptr_t)size_of(view->type))
        return 1;
    made->expected = SPHG_ERROR_ARGUMENT;
    name_trial(made, "%s %s",
               number % 3 == 0   ? "on"
               : number % 3 == 1 ? "behind"
                                 : "before",
               other->path);
    return 1;
}

static int spoil_view(valid_call *own, const probe *tested, const argument *spoilt, int number,
                      trial *made)
{
    sphg_view *view = member(own, spoilt);
    if (!view->x) /* not part of this call */
        return 0;
    if (number < 7 && spoil_type(view, spoilt, number, made))
        return 1;
    if (number >= 7 && number < 10)
        return spoil_layout(view, number - 7, made);
    if (number >= 10 && number < 20 && spoil_stride(view, spoilt, number - 10, made))
        return 1;
    if (number >= 20 && number < 40 && spoil_start(own, view, spoilt, number - 20, made))
        return 1;
    if (number < 40) {
        made->expected = ARGUMENT_SKIPPED;
        return 1;
    }
    return spoil_overlap(own, tested, spoilt, number - 40, made);
}

/* ---- Numbers behind views ----------------------------------------------------------------- */

static void put_number(sphg_view view, int item, double value, trial *made)
{
    made->place = (char *)(uintptr_t)view.x + item * view.stride;
    made->bytes = (size_t)size_of(view.type);
    memcpy(made->kept, made->place, made->bytes);
    valid_call_put(view, item, value);
    name_trial(made, "[%d] is %g", item, value);
    snprintf(made->value, sizeof made->value, "[%d]", item);
}

static int spoil_numbers(valid_call *own, const argument *spoilt, int number, trial *made)
{
    static const int items[] = {0, 1, 31, VALID_CALL_COUNT - 1};
    const sphg_view *view = member(own, spoilt);
    const double smallest = view->type == SPHG_F32 ? 0x1p-149 : DBL_TRUE_MIN;
    const double values[] = {NAN, INFINITY, -INFINITY, -1, -smallest, smallest, 1e-30, 0, -0.0};
    if (number >= 36 || !view->x)
        return 0;
    const double value = values[number / 4];
    put_number(*view, items[number % 4], value, made);
    expect(made, SPHG_OK, NULL);
    if (spoilt->kind == ARGUMENT_POSITIONS && !isfinite(value))
        made->expected = SPHG_ERROR_NOT_FINITE;
    if (spoilt->kind == ARGUMENT_VOLUMES && !(value >= 0 && isfinite(value)))
        made->expected = SPHG_ERROR_VOLUME;
    if (spoilt->kind == ARGUMENT_RADII && !(value > smallest && isfinite(value)))
        made->expected = SPHG_ERROR_ARGUMENT;
    if (spoilt->kind == ARGUMENT_RADII && value == 1e-30 && test_field_type(own->test) == SPHG_F32)
        made->expected = SPHG_ERROR_ARGUMENT;
    if (spoilt->kind == ARGUMENT_RADII && value > 0 && isfinite(value))
        made->value[0] = 0; /* so small that its powers are none */
    return 1;
}

static int spoil_offsets(valid_call *own, int number, trial *made)
{
    static const struct {
        int item;
        int64_t value;
    } ways[] = {{0, 1},        {0, -1}, {0, INT64_MAX}, {9, 0}, {9, -1}, {VALID_CALL_COUNT, 0},
                {1, INT64_MIN}};
    if (number > 6)
        return 0;
    own->offsets[ways[number].item] = ways[number].value;
    name_trial(made, "offsets[%d] = %lld", ways[number].item, (long long)ways[number].value);
    snprintf(made->value, sizeof made->value, "%lld", (long long)ways[number].value);
    expect(made, SPHG_ERROR_ARGUMENT, "offsets");
    return 1;
}

/* The operator sums over the host's lists, one of whose indices is no source. */
static int spoil_indices(valid_call *own, int number, trial *made)
{
    static const int32_t values[] = {-1, VALID_CALL_COUNT, INT32_MAX, INT32_MIN, 65536};
    static const int32_t places[] = {0, VALID_CALL_COUNT + 17, 4 * VALID_CALL_COUNT - 1};
    if (number >= 15)
        return 0;
    own->sources[0].neighbors = own->listed;
    own->indices[places[number % 3]] = values[number / 3];
    name_trial(made, "%d in a list", values[number / 3]);
    snprintf(made->value, sizeof made->value, "%d", values[number / 3]);
    expect(made, SPHG_ERROR_INDEX, "list of target");
    return 1;
}

/* ---- Subsets ------------------------------------------------------------------------------ */

static int spoil_range(valid_call *own, int number, trial *made)
{
    static const int ways[][2] = {{-1, 4},      {0, VALID_CALL_COUNT + 1},
                                  {10, 9},      {INT_MIN, 0},
                                  {0, INT_MAX}, {INT_MAX, INT_MIN},
                                  {3, -1},      {VALID_CALL_COUNT + 1, VALID_CALL_COUNT + 1}};
    if (number > 7)
        return 0;
    own->subset.begin = ways[number][0];
    own->subset.end = ways[number][1];
    name_trial(made, "[%d, %d)", own->subset.begin, own->subset.end);
    snprintf(made->value, sizeof made->value, "[%d, %d)", own->subset.begin, own->subset.end);
    expect(made, SPHG_ERROR_ARGUMENT, "subset");
    return 1;
}

static int spoil_picked(valid_call *own, int number, trial *made)
{
    static const int values[] = {-1, VALID_CALL_COUNT, INT_MIN, INT_MAX};
    if (number > 7)
        return 0;
    own->subset.indices = own->picked;
    own->subset.end = 4;
    own->picked[number % 2 ? 3 : 0] = values[number / 2];
    name_trial(made, "%d", values[number / 2]);
    snprintf(made->value, sizeof made->value, "%d", values[number / 2]);
    expect(made, SPHG_ERROR_ARGUMENT, "subset.indices");
    return 1;
}

/* ---- Every kind --------------------------------------------------------------------------- */

int argument_is_about_numbers(argument_kind kind)
{
    return kind == ARGUMENT_POSITIONS || kind == ARGUMENT_VOLUMES || kind == ARGUMENT_OFFSETS ||
           kind == ARGUMENT_RADII || kind == ARGUMENT_INDICES;
}

int argument_spoil(valid_call *own, const probe *tested, int a, int number, trial *made)
{
    const argument *spoilt = &tested->arguments[a];
    memset(made, 0, sizeof *made);
    switch (spoilt->kind) {
    case ARGUMENT_FREE:
        return 0;
    case ARGUMENT_HANDLE:
    case ARGUMENT_POINTER:
        return spoil_pointer(own, spoilt, number, made);
    case ARGUMENT_BUILT:
        return spoil_built(own, spoilt, number, made);
    case ARGUMENT_COUNT:
        return spoil_count(own, spoilt, number, made);
    case ARGUMENT_ENUM:
        return spoil_enum(own, spoilt, number, made);
    case ARGUMENT_DIMENSION:
        return spoil_dimension(own, spoilt, number, made);
    case ARGUMENT_RADIUS:
        return spoil_radius(own, spoilt, number, made);
    case ARGUMENT_THRESHOLD:
        return spoil_threshold(own, spoilt, number, made);
    case ARGUMENT_LENGTH:
        return spoil_length(own, spoilt, number, made);
    case ARGUMENT_VIEW:
        return spoil_view(own, tested, spoilt, number, made);
    case ARGUMENT_POSITIONS:
    case ARGUMENT_VOLUMES:
    case ARGUMENT_RADII:
    case ARGUMENT_NUMBERS:
        return spoil_numbers(own, spoilt, number, made);
    case ARGUMENT_OFFSETS:
        return spoil_offsets(own, number, made);
    case ARGUMENT_INDICES:
        return spoil_indices(own, number, made);
    case ARGUMENT_RANGE:
        return spoil_range(own, number, made);
    case ARGUMENT_PICKED:
        return spoil_picked(own, number, made);
    case ARGUMENT_SPECIAL:
        return spoilt->special(own, number, made);
    }
    return 0;
}

void argument_restore(const trial *made)
{
    if (made->place)
        memcpy(made->place, made->kept, made->bytes);
}
