/* SPDX-License-Identifier: MIT */
/* What no case may break. The limits of errors are those of the tests. */
#include "stability.h"
#include "support/tolerances.h"
#include <math.h>
#include <stdarg.h>
#include <stdio.h>

#define LIMIT_OF(name, limit, measured, reason) limit_##name,
enum { TEST_TOLERANCES(LIMIT_OF) };
#undef LIMIT_OF
#define LIMIT_OF(name, limit, measured, reason) limit,
static const double limits[] = {TEST_TOLERANCES(LIMIT_OF)};
#undef LIMIT_OF

/* 1, with a line on stderr, unless the promise holds. */
__attribute__((format(printf, 3, 4))) static int require(const struct stability_case *one,
                                                         bool holds, const char *format, ...)
{
    if (holds)
        return 0;
    va_list arguments;
    va_start(arguments, format);
    fprintf(stderr, "BROKEN     %s at %g, %s, %s, %s: ", sweep_names[one->sweep], one->at,
            method_names[one->method], precision_names[one->precision], policy_names[one->policy]);
    vfprintf(stderr, format, arguments);
    fputc('\n', stderr);
    va_end(arguments);
    return 1;
}

/* NaN is never within. */
static int check_numbers(const struct stability_case *one, bool is_compared)
{
    int broken = 0;
    broken += require(one, one->not_finite == 0, "%lld numbers are not finite",
                      (long long)one->not_finite);
    if (one->sweep != SWEEP_CROWDS) { /* where sums of equal terms drift one way */
        const bool second = stability_order(one) == 2;
        broken += require(one,
                          one->ratio_full <=
                              limits[second ? limit_quadratic_ratio_full : limit_oracle_ratio_full],
                          "error %g times its bound at full rank", one->ratio_full);
        broken +=
            require(one,
                    one->ratio_touched <=
                        limits[second ? limit_quadratic_ratio_touched : limit_oracle_ratio_touched],
                    "error %g times its bound under the threshold", one->ratio_touched);
    }
    broken += require(one, one->wrong_ranks == 0, "%lld ranks are not those of the reference",
                      (long long)one->wrong_ranks);
    broken += require(one, one->compared > 0 || !is_compared, "nothing was compared");
    broken += require(one, one->other_bits == 0, "%lld targets changed with the unit of length",
                      (long long)one->other_bits);
    return broken;
}

/* n neighbours leave at most n directions, and nobody falls back who has none. */
static int check_neighbours(const struct stability_case *one)
{
    if (one->sweep != SWEEP_NEIGHBOURS || !stability_is_corrected(one))
        return 0;
    return require(one, stability_rank(one) <= one->at, "mean rank %g", stability_rank(one)) +
           require(one, one->at > 0 || one->empty + one->full == one->targets || one->empty == 0,
                   "%lld empty", (long long)one->empty);
}

static bool follows(const struct stability_case *one, const struct stability_case *next)
{
    return next->sweep == one->sweep && next->method == one->method &&
           next->policy == one->policy && next->precision == one->precision;
}

/* A slab that becomes thinner does not win directions, and ends as a plane. It may win some while
 * q^2 W between its layers still grows, with the narrowest kernel (Wendland C6) down to q = 0.3. */
static int check_slab(const struct stability_case *one, const struct stability_case *next,
                      double support)
{
    if (one->sweep != SWEEP_SLAB || !stability_is_corrected(one))
        return 0;
    if (next && follows(one, next))
        return support * sqrt(one->at) < 1 / 0.3
                   ? 0
                   : require(next, stability_rank(next) <= stability_rank(one),
                             "mean rank rises from %g to %g", stability_rank(one),
                             stability_rank(next));
    return require(one, stability_rank(one) <= 2, "a plane has mean rank %g", stability_rank(one));
}

/* A continuous C changes by a 256th in a 256th of a step; rounding adds u |C|, the curve of f a
 * little. Under the other policies the jump stays. */
static int check_merging(const struct stability_case *one)
{
    if (one->sweep != SWEEP_MERGING || one->policy != SPHG_BLEND)
        return 0;
    const double u = one->precision == PRECISION_F64 ? 0x1p-53 : 0x1p-24;
    return require(one, one->jump_left <= one->jump / 32 + 4096 * u * (1 + one->noise),
                   "a jump of %g is still %g after 256 times smaller steps", one->jump,
                   one->jump_left);
}

int stability_check(const struct stability *stability)
{
    int broken = 0;
    for (int k = 0; k < stability->case_count; ++k) {
        const struct stability_case *one = &stability->cases[k];
        const struct stability_case *next = k + 1 < stability->case_count ? one + 1 : NULL;
        broken += check_numbers(one, stability->compared > 0) + check_neighbours(one) +
                  check_slab(one, next, stability->settings.support) + check_merging(one);
    }
    return broken;
}
