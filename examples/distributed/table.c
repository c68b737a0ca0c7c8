/* SPDX-License-Identifier: MIT */
#include "report.h"
#include <math.h>
#include <stdarg.h>
#include <stdio.h>

/* ---- Print ----------------------------------------------------------------------------------- */

static void row(const char *name, const char *format, double many, double one)
{
    char left[32], right[32];
    snprintf(left, sizeof left, format, many);
    snprintf(right, sizeof right, format, one);
    printf("%-46s %14s %14s\n", name, left, right);
}

static void range_row(const char *name, struct least_most many, struct least_most one)
{
    char left[32];
    snprintf(left, sizeof left, "%.0f to %.0f", many.least, many.most);
    printf("%-46s %14s %14.0f\n", name, left, one.most);
}

void table_print(const struct report *many, const struct report *one, double spacing)
{
    char ranks[32];
    snprintf(ranks, sizeof ranks, "%d rank%s", many->rank_count, many->rank_count > 1 ? "s" : "");
    printf("%-46s %14s %14s\n", "", ranks, "1 rank, alone");
    row("milliseconds a step", "%.3f", 1e3 * many->seconds, 1e3 * one->seconds);
    row("  waiting for ghosts (slowest rank)", "%.3f", 1e3 * many->waiting, 1e3 * one->waiting);
    row("  new owners and ghosts (slowest rank)", "%.3f", 1e3 * many->settling,
        1e3 * one->settling);
    range_row("particles a rank", many->own, one->own);
    range_row("ghosts a rank", many->ghosts, one->ghosts);
    row("kilobytes sent to ghosts, a rank and step", "%.1f", many->bytes / 1e3, one->bytes / 1e3);
    row("messages to ghosts, a rank and step", "%.1f", many->messages, one->messages);
    row("steps from one choice of ghosts to the next", "%.1f", (double)many->steps / many->settled,
        (double)one->steps / one->settled);
    row("pairs of all ranks, within H + skin", "%.0f", many->pairs, one->pairs);
    row("particles that changed ranks", "%.0f", many->moved, one->moved);
    row("angle turned [degrees]", "%.3f", many->angle, one->angle);
    row("radius of gyration, 1 at the beginning", "%.5f", many->radius, one->radius);
    row("change of momentum, relative", "%.1e", many->momentum, one->momentum);
    row("change of angular momentum, relative", "%.1e", many->spin, one->spin);
    printf("\nA rigid body turns by %.3f degrees. No particle differs between the two runs by more "
           "than\n"
           "%.1e of the spacing.\n",
           many->exact_angle, report_difference(many, one) / spacing);
}

/* ---- Judge ----------------------------------------------------------------------------------- */

/* A limit that NaN does not pass. */
static bool within(const char *what, double value, double limit)
{
    if (fabs(value) <= limit)
        return true;
    printf("Wrong: %s is off by %.2e, more than %.0e.\n", what, value, limit);
    return false;
}

static bool judge(const struct report *report)
{
    bool good = within("the angle [degrees]", report->angle - report->exact_angle, .5);
    good &= within("the radius", report->radius - 1, .01);
    good &= within("momentum", report->momentum, 1e-5);
    return within("angular momentum", report->spin, 1e-5) && good;
}

/* Ghosts within the skin count at once, by the pairs that would be missing; forces feel them only
 * when they have come nearer, which in a drop that turns like a rigid body they never do. */
bool table_judge(const struct report *many, const struct report *one, double spacing)
{
    bool same = within("a particle beside the other run, in spacings,",
                       report_difference(many, one) / spacing, 1e-2);
    same &= within("the number of pairs within H + skin", many->pairs / one->pairs - 1, 1e-4);
    return judge(many) && judge(one) && same;
}
