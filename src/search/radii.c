/* SPDX-License-Identifier: MIT */
#include "radii.h"
#include "core/digits.h"
#include "core/parallel.h"
#include "core/view.h"
#include "extremes.h"
#include <math.h>
#include <string.h>

enum { GRAIN = 4096 }; /* particles */

bool sphgi_has_radii(const sphg_geometry *given)
{
    return !sphgi_is_absent(&given->source_support) || !sphgi_is_absent(&given->target_support);
}

static double radius_at(const sphg_view *view, int32_t item)
{
    const char *at = (const char *)view->x + (ptrdiff_t)item * view->stride;
    return view->type == SPHG_F64 ? *(const double *)(const void *)at
                                  : (double)*(const float *)(const void *)at;
}

/* ---- Looking -------------------------------------------------------------------------------- */

struct look {
    const sphg_view *view;
    atomic_int_least64_t bad; /* first that is no radius, or INT64_MAX */
    sphgi_extreme least, largest;
};

static void look_task(void *data, int32_t begin, int32_t end, int32_t worker)
{
    struct look *look = data;
    double least = (double)INFINITY, largest = 0;
    int64_t bad = INT64_MAX;
    (void)worker;
    for (int32_t k = begin; k < end; ++k) {
        const double radius = radius_at(look->view, k);
        if (!(radius > 0 && radius < (double)INFINITY)) {
            bad = k < bad ? k : bad;
            continue;
        }
        least = radius < least ? radius : least;
        largest = radius > largest ? radius : largest;
    }
    int_least64_t first = atomic_load(&look->bad);
    while (bad < first && !atomic_compare_exchange_weak(&look->bad, &first, bad))
        ;
    sphgi_lower(&look->least, least);
    sphgi_raise(&look->largest, largest);
}

static sphg_result look_at(struct sphgi_checker checker, const sphg_view *view, const char *name,
                           int32_t count, struct sphgi_radii *radii)
{
    struct look look = {.view = view};
    atomic_store(&look.bad, INT64_MAX);
    sphgi_extreme_set(&look.least, radii->least);
    sphgi_extreme_set(&look.largest, radii->largest);
    const int32_t items = view->stride ? count : sphgi_min32(count, 1);
    if (sphgi_is_absent(view))
        return SPHG_OK;
    sphgi_parallel_for(checker.context, look_task, &look, items, GRAIN);
    radii->least = sphgi_extreme_get(&look.least);
    radii->largest = sphgi_extreme_get(&look.largest);
    const int64_t bad = atomic_load(&look.bad);
    if (bad == INT64_MAX)
        return SPHG_OK;
    return sphgi_fail(checker.context, SPHG_ERROR_ARGUMENT,
                      "%s: %s[%lld] is %s, must be positive and finite", checker.function, name,
                      (long long)bad, sphgi_digits(radius_at(view, (int32_t)bad)).text);
}

sphg_result sphgi_look_at_radii(struct sphgi_checker checker, const sphg_geometry *given,
                                struct sphgi_radii *radii)
{
    *radii = (struct sphgi_radii){(double)INFINITY, 0};
    sphg_result result = look_at(checker, &given->source_support, "geometry.source_support",
                                 given->source_count, radii);
    if (!result)
        result = look_at(checker, &given->target_support, "geometry.target_support",
                         given->target_count, radii);
    if (!(radii->largest > 0))
        *radii = (struct sphgi_radii){1, 1};
    return result;
}

/* ---- Putting -------------------------------------------------------------------------------- */

struct put {
    const sphg_view *view;
    void *rows;
};

static void put_task(void *data, int32_t begin, int32_t end, int32_t worker)
{
    const struct put *put = data;
    (void)worker;
    for (int32_t k = begin; k < end; ++k) {
        const size_t at = SPHGI_ROW * (size_t)k + SPHGI_ROW - 1;
        const double radius = radius_at(put->view, k);
        if (put->view->type == SPHG_F64)
            ((double *)put->rows)[at] = radius;
        else
            ((float *)put->rows)[at] = (float)radius;
    }
}

void sphgi_put_radii(sphg_context *context, const sphg_view *radii, int32_t count, void *rows)
{
    struct put put = {radii, rows};
    sphgi_parallel_for(context, put_task, &put, count, GRAIN);
}
