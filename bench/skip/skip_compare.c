/* SPDX-License-Identifier: MIT */
#include "skip_compare.h"
#include <math.h>
#include <string.h>

static double relative_difference(const struct numbers *part, const struct numbers *full, int32_t i)
{
    double difference = 0, size = 0;
    for (int32_t k = 0; k < full->width; ++k) {
        const double expected = numbers_get(full, i, k), d = numbers_get(part, i, k) - expected;
        difference += d * d;
        size += expected * expected;
    }
    return sqrt(difference / size);
}

static void compare_table(const struct numbers *part, const struct numbers *full,
                          const uint8_t *mask, struct skip_result *result)
{
    const size_t size = sizeof(float) * (size_t)full->width;
    for (int32_t i = 0; i < full->count; ++i) {
        const char *a = (const char *)part->data + size * (size_t)i,
                   *b = (const char *)full->data + size * (size_t)i;
        if ((mask && !mask[i]) || memcmp(a, b, size) == 0)
            continue;
        const double deviation = relative_difference(part, full, i);
        ++result->differences;
        result->deviation = numbers_larger(result->deviation, deviation);
    }
}

/* The tables that are compared; the count is returned. */
static int tables_of(int compared, struct outputs *outputs, struct numbers *tables[SKIP_FIELDS + 3])
{
    int count = 0;
    if (compared & COMPARE_CORRECTIONS)
        tables[count++] = &outputs->corrections;
    if (compared & COMPARE_DIVERGENCE)
        tables[count++] = &outputs->divergence;
    if (compared & COMPARE_CURL)
        tables[count++] = &outputs->curl;
    const int fields =
        compared & COMPARE_ALL_FIELDS ? SKIP_FIELDS : !!(compared & COMPARE_JACOBIAN);
    for (int f = 0; f < fields; ++f)
        tables[count++] = &outputs->jacobians[f];
    return count;
}

void skip_compare(const struct skip_stage *stage, const struct skip_row *row,
                  struct skip_result *result)
{
    struct outputs part = stage->solid.part, full = stage->solid.full;
    struct numbers *parts[SKIP_FIELDS + 3], *fulls[SKIP_FIELDS + 3];
    const int count = tables_of(row->compared, &part, parts);
    tables_of(row->compared, &full, fulls);
    for (int k = 0; k < count; ++k)
        compare_table(parts[k], fulls[k],
                      row->pattern < 0 ? NULL : stage->patterns[row->pattern].mask, result);
}

void skip_spoil(const struct skip_row *row, struct outputs *outputs)
{
    struct numbers *tables[SKIP_FIELDS + 3];
    const int count = tables_of(row->compared, outputs, tables);
    for (int k = 0; k < count; ++k) /* all bits set: not a number */
        memset(tables[k]->data, 0xff,
               sizeof(float) * (size_t)tables[k]->count * (size_t)tables[k]->width);
}
