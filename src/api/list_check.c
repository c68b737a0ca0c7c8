/* SPDX-License-Identifier: MIT */
/* Do lists hold what the positions demand? A search of the same positions tells. */
#include "core/digits.h"
#include "entries.h"
#include "search/build.h"
#include "core/parallel.h"
#include "core/view.h"
#include <math.h>
#include <string.h>

enum { GRAIN = 256 }; /* targets */

/* What a worker has seen. */
struct part {
    sphg_list_fault first; /* of the lowest target */
    int32_t faulty;
};

struct list_check {
    struct sphgi_checker checker;
    const sphg_neighbors *tested;
    sphg_lists lists;        /* the host's, or what those of the library come to */
    uint32_t mask;           /* of their indices */
    struct sphgi_rows found; /* by the search */
    struct sphgi_rows own;   /* of the library's lists */
    struct sphgi_buffer positions, hits, parts; /* hits: a byte per pair found */
    const char *sources, *targets;              /* rows in the order of the host */
    size_t row_size;
};

/* ---- The question --------------------------------------------------------------------------- */

static sphg_result check_tested(struct sphgi_checker checker, const sphg_neighbors *n,
                                const struct sphgi_scheme *scheme)
{
    const char *f = checker.function;
    const sphg_result missing = sphgi_check_pointer(checker, n, "neighbors");
    if (missing)
        return missing;
    if (!n->kind)
        return sphgi_fail(checker.context, SPHG_ERROR_STATE, "%s: neighbors were never built", f);
    if (!sphgi_has_its_targets(n))
        return sphgi_fail(checker.context, SPHG_ERROR_STATE,
                          "%s: neighbors have targets of an object that was built anew since", f);
    if (n->dimension != scheme->dimension)
        return sphgi_fail(checker.context, SPHG_ERROR_SIZE,
                          "%s: neighbors were built in %dD, the scheme is %dD", f,
                          (int)n->dimension, (int)scheme->dimension);
    if (!n->radii && scheme->radius > n->radius)
        return sphgi_fail(checker.context, SPHG_ERROR_SIZE,
                          "%s: scheme.support_radius is %s, neighbors were built for %s", f,
                          sphgi_digits(scheme->radius).text, sphgi_digits(n->radius).text);
    return SPHG_OK;
}

/* ---- The pairs there are -------------------------------------------------------------------- */

static void copy_in_order(const struct sphgi_grid *grid, size_t row_size, char *to)
{
    const int32_t *order = grid->order.data;
    for (int32_t k = 0; k < grid->count; ++k)
        memcpy(to + (size_t)order[k] * row_size,
               (const char *)grid->rows.data + (size_t)k * row_size, row_size);
}

/* A search keeps positions in an order of its own. */
static bool place_positions(struct list_check *check)
{
    const sphg_neighbors *n = check->tested;
    check->row_size = SPHGI_ROW * sphgi_size_of_type(n->position_type);
    check->sources = n->sources.rows.data;
    check->targets = n->part_of ? check->sources : n->targets.rows.data;
    if (n->kind == SPHGI_HOST_LISTS)
        return true;
    const size_t sources = (size_t)n->source_count, targets = (size_t)n->target_count;
    if (!sphgi_reserve(&check->checker.context->allocator, &check->positions,
                       sources + (n->part_of ? 0 : targets) + 1, check->row_size))
        return false;
    char *rows = check->positions.data;
    copy_in_order(&n->sources, check->row_size, rows);
    check->sources = check->targets = rows;
    if (!n->part_of) {
        copy_in_order(&n->targets, check->row_size, rows + sources * check->row_size);
        check->targets = rows + sources * check->row_size;
    }
    return true;
}

/* They stand in the rows. */
static void take_radii(const struct list_check *check, sphg_geometry *geometry)
{
    const size_t fourth = (SPHGI_ROW - 1) * check->row_size / SPHGI_ROW;
    geometry->source_support = geometry->sources;
    geometry->source_support.x = check->sources + fourth;
    if (!check->tested->part_of) {
        geometry->target_support = geometry->targets;
        geometry->target_support.x = check->targets + fourth;
    }
    geometry->mutual = check->tested->mutual;
}

static sphg_result search_again(struct list_check *check, const struct sphgi_scheme *scheme)
{
    const sphg_neighbors *n = check->tested;
    const ptrdiff_t stride = (ptrdiff_t)check->row_size;
    sphg_geometry geometry = {
        .sources = {check->sources, NULL, NULL, stride, n->position_type, SPHG_AS_SHAPE},
        .source_count = n->source_count,
        .target_count = n->target_count,
        .precision = n->position_type,
        .list_free = 1};
    if (!n->part_of)
        geometry.targets =
            (sphg_view){check->targets, NULL, NULL, stride, n->position_type, SPHG_AS_SHAPE};
    memcpy(geometry.period, n->period, sizeof n->period);
    if (n->radii)
        take_radii(check, &geometry);
    sphg_neighbors *again = sphgi_neighbors_make(check->checker.context);
    if (!again)
        return sphgi_fail_memory(check->checker.context, check->checker.function);
    sphg_result result = sphgi_build_by_search(check->checker, again, scheme, &geometry);
    if (!result)
        result = sphgi_list_pairs(check->checker, scheme, again, &check->found);
    sphg_neighbors_destroy(again);
    return result;
}

static sphg_result take_lists(struct list_check *check, const struct sphgi_scheme *scheme)
{
    const sphg_neighbors *n = check->tested;
    if (n->kind == SPHGI_HOST_LISTS) {
        check->lists = n->lists;
        check->mask = n->lists.index_mask ? (uint32_t)n->lists.index_mask : UINT32_MAX;
        return SPHG_OK;
    }
    const sphg_result result = sphgi_list_pairs(check->checker, scheme, n, &check->own);
    check->lists =
        (sphg_lists){.offsets = check->own.offsets.data, .indices = check->own.indices.data};
    check->mask = UINT32_MAX;
    return result;
}

/* ---- List by list --------------------------------------------------------------------------- */

/* Number of the pair among all found, or -1: there is none. */
static int64_t pair_of(const struct list_check *check, int32_t target, uint32_t source)
{
    const int64_t *offsets = check->found.offsets.data;
    const int32_t *indices = check->found.indices.data;
    int64_t low = offsets[target], high = offsets[target + 1];
    while (low < high) {
        const int64_t middle = low + (high - low) / 2;
        if ((uint32_t)indices[middle] < source)
            low = middle + 1;
        else
            high = middle;
    }
    return low < offsets[target + 1] && (uint32_t)indices[low] == source ? low : -1;
}

static sphg_list_fault fault_of(sphg_fault kind, int32_t target, uint32_t source)
{
    return (sphg_list_fault){.kind = kind, .target = target, .source = (int32_t)source};
}

/* Marks the pairs that the list names; the first that it cannot name, or names again. */
static sphg_list_fault mark_listed(struct list_check *check, int32_t target, const int32_t *list,
                                   int64_t count)
{
    uint8_t *hits = check->hits.data;
    for (int64_t k = 0; k < count; ++k) {
        const uint32_t source = (uint32_t)list[k] & check->mask;
        if (source >= (uint32_t)check->tested->source_count)
            return fault_of(SPHG_FAULT_INDEX, target, source);
        const int64_t pair = pair_of(check, target, source);
        if (pair >= 0 && hits[pair])
            return fault_of(SPHG_FAULT_DOUBLED, target, source);
        if (pair >= 0)
            hits[pair] = 1;
    }
    return fault_of(SPHG_FAULT_NONE, target, 0);
}

static sphg_list_fault examine(struct list_check *check, int32_t target, int32_t worker)
{
    const int64_t *offsets = check->found.offsets.data;
    const int32_t *indices = check->found.indices.data, *list;
    const uint8_t *hits = check->hits.data;
    const int64_t count = sphgi_host_row(&check->lists, target, worker, &list);
    if (!sphgi_is_host_row(list, count))
        return fault_of(SPHG_FAULT_LENGTH, target, UINT32_MAX);
    const sphg_list_fault fault = mark_listed(check, target, list, count);
    for (int64_t k = offsets[target]; !fault.kind && k < offsets[target + 1]; ++k)
        if (!hits[k])
            return fault_of(SPHG_FAULT_MISSING, target, (uint32_t)indices[k]);
    return fault;
}

static void examine_task(void *data, int32_t begin, int32_t end, int32_t worker)
{
    struct list_check *check = data;
    struct part *part = (struct part *)check->parts.data + worker;
    for (int32_t target = begin; target < end; ++target) {
        const sphg_list_fault fault = examine(check, target, worker);
        part->faulty += fault.kind != SPHG_FAULT_NONE;
        if (fault.kind && (!part->first.kind || target < part->first.target))
            part->first = fault;
    }
}

/* ---- The first fault ------------------------------------------------------------------------ */

static sphg_list_fault first_fault(const struct list_check *check)
{
    const struct part *parts = check->parts.data;
    sphg_list_fault first = {.kind = SPHG_FAULT_NONE, .target = -1, .source = -1};
    int32_t faulty = 0;
    for (int32_t k = 0; k < check->checker.context->threads; ++k) {
        faulty += parts[k].faulty;
        if (parts[k].first.kind && (!first.kind || parts[k].first.target < first.target))
            first = parts[k].first;
    }
    first.faulty = faulty;
    return first;
}

/* Of a missing pair: does the other end name it? */
static bool is_one_sided(const struct list_check *check, const sphg_list_fault *fault)
{
    const sphg_neighbors *n = check->tested;
    if (fault->kind != SPHG_FAULT_MISSING || !n->part_of || fault->source >= n->target_count)
        return false;
    const int32_t *list;
    const int64_t count = sphgi_host_row(&check->lists, fault->source, 0, &list);
    for (int64_t k = 0; sphgi_is_host_row(list, count) && k < count; ++k)
        if (((uint32_t)list[k] & check->mask) == (uint32_t)fault->target)
            return true;
    return false;
}

static double coordinate(const struct list_check *check, const char *rows, int32_t item, int32_t a)
{
    const char *row = rows + (size_t)item * check->row_size;
    return check->tested->position_type == SPHG_F64 ? ((const double *)(const void *)row)[a]
                                                    : (double)((const float *)(const void *)row)[a];
}

static double distance_of(const struct list_check *check, const sphg_list_fault *fault)
{
    double square = 0;
    for (int32_t a = 0; a < check->tested->dimension; ++a) {
        const double period = check->tested->period[a];
        double difference = coordinate(check, check->targets, fault->target, a) -
                            coordinate(check, check->sources, fault->source, a);
        if (period > 0)
            difference = remainder(difference, period);
        square += difference * difference;
    }
    return sqrt(square);
}

static sphg_result report(const struct list_check *check, const sphg_list_fault *fault)
{
    sphg_context *context = check->checker.context;
    const char *f = check->checker.function;
    const int target = (int)fault->target, source = (int)fault->source;
    switch (fault->kind) { /* NOLINT(bugprone-branch-clone): the messages differ */
    case SPHG_FAULT_NONE:
        return SPHG_OK;
    case SPHG_FAULT_LENGTH:
        return sphgi_fail(context, SPHG_ERROR_INDEX,
                          "%s: the list of target %d has a negative length or is NULL", f, target);
    case SPHG_FAULT_INDEX:
        return sphgi_fail(context, SPHG_ERROR_INDEX,
                          "%s: the list of target %d holds %d, which is no source", f, target,
                          source);
    case SPHG_FAULT_DOUBLED:
        return sphgi_fail(context, SPHG_ERROR_LISTS,
                          "%s: the list of target %d names source %d twice (%d lists are wrong)", f,
                          target, source, (int)fault->faulty);
    case SPHG_FAULT_ONE_SIDED:
        return sphgi_fail(context, SPHG_ERROR_LISTS,
                          "%s: the list of target %d lacks source %d at the distance %s, whose "
                          "own list has %d: half a list? (%d lists are wrong)",
                          f, target, source, sphgi_digits(fault->distance).text, target,
                          (int)fault->faulty);
    case SPHG_FAULT_MISSING:
        break;
    }
    return sphgi_fail(context, SPHG_ERROR_LISTS,
                      "%s: the list of target %d lacks source %d at the distance %s (%d lists "
                      "are wrong)",
                      f, target, source, sphgi_digits(fault->distance).text, (int)fault->faulty);
}

/* ---- The call ------------------------------------------------------------------------------- */

static sphg_result compare(struct list_check *check, sphg_list_fault *fault)
{
    sphg_context *context = check->checker.context;
    const int32_t targets = check->tested->target_count;
    const size_t pairs = (size_t)((const int64_t *)check->found.offsets.data)[targets];
    const size_t threads = (size_t)context->threads;
    if (!sphgi_reserve(&context->allocator, &check->hits, pairs + 1, 1) ||
        !sphgi_reserve(&context->allocator, &check->parts, threads, sizeof(struct part)))
        return sphgi_fail_memory(context, check->checker.function);
    memset(check->hits.data, 0, pairs + 1);
    memset(check->parts.data, 0, threads * sizeof(struct part));
    sphgi_parallel_for(context, examine_task, check, targets, GRAIN);
    sphg_list_fault first = first_fault(check);
    if (is_one_sided(check, &first))
        first.kind = SPHG_FAULT_ONE_SIDED;
    if (first.kind >= SPHG_FAULT_DOUBLED)
        first.distance = distance_of(check, &first);
    if (fault)
        *fault = first;
    return report(check, &first);
}

static void close_check(struct list_check *check)
{
    const struct sphgi_allocator *allocator = &check->checker.context->allocator;
    struct sphgi_buffer *const buffers[] = {
        &check->found.offsets, &check->found.indices, &check->own.offsets, &check->own.indices,
        &check->positions,     &check->hits,          &check->parts};
    for (size_t k = 0; k < sizeof buffers / sizeof *buffers; ++k)
        sphgi_free(allocator, buffers[k]);
}

static sphg_result check_lists(struct list_check *check, const struct sphgi_scheme *scheme,
                               sphg_list_fault *fault)
{
    sphg_result result = SPHG_OK;
    if (!place_positions(check))
        result = sphgi_fail_memory(check->checker.context, check->checker.function);
    if (!result)
        result = search_again(check, scheme);
    if (!result)
        result = take_lists(check, scheme);
    if (!result)
        result = compare(check, fault);
    close_check(check);
    return result;
}

sphg_result sphg_neighbors_check(sphg_context *context, const sphg_scheme *scheme,
                                 const sphg_neighbors *neighbors, sphg_list_fault *fault)
{
    struct list_check check = {.checker = {context, "sphg_neighbors_check"}, .tested = neighbors};
    struct sphgi_scheme checked = {0};
    sphg_result result = sphgi_enter(context);
    if (result)
        return result;
    if (neighbors && neighbors->radii)
        result = sphgi_check_scheme_beside_radii(check.checker, scheme, &checked);
    else
        result = sphgi_check_scheme(check.checker, scheme, &checked);
    if (!result)
        result = check_tested(check.checker, neighbors, &checked);
    if (!result)
        result = check_lists(&check, &checked, fault);
    return sphgi_leave(context, result);
}
