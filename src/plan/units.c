#include "units.h"
#include "core/kernel.h"
#include <math.h>

/* Linearised (theory.md, section 3): KGC C; RKPM C / (mu2 H^2); MLS C H^(d - 2) / mu2, where ours
 * contains V_i / H^d. Classic: w is W H^d (CMLS) or V W (CRKPM). */
struct sphgi_scales sphgi_table_scales(const struct sphgi_scheme *scheme)
{
    const double h = scheme->radius, mu2 = sphgi_kernel_mu2(scheme->kernel, scheme->dimension);
    const double volume = sphgi_power(h, scheme->dimension);
    switch (scheme->method) {
    case SPHG_MLS:
        return (struct sphgi_scales){volume / (h * h) / mu2, 0};
    case SPHG_RKPM:
        return (struct sphgi_scales){1 / (mu2 * h * h), 0};
    case SPHG_CMLS:
        return (struct sphgi_scales){volume, volume / h};
    case SPHG_CRKPM:
        return (struct sphgi_scales){1, 1 / h};
    default:
        return (struct sphgi_scales){1, 0};
    }
}

void sphgi_shares_of(const struct sphgi_plan *plan, struct sphgi_share shares[2])
{
    const struct sphgi_scales scales = sphgi_table_scales(&plan->scheme);
    const int32_t width = sphgi_correction_width(plan->scheme.method, plan->dimension);
    const int32_t values = plan->classic ? plan->dimension + 1 : width;
    for (int k = 0; k < 2; ++k) {
        int exponent;
        struct sphgi_share *share = &shares[k];
        share->first = k ? values : 0;
        share->count = k ? width - values : values;
        share->mantissa = frexp(k ? scales.slope : scales.value, &exponent);
        if (share->mantissa == 0.5) { /* a power of two: nothing is rounded */
            share->mantissa = 1;
            --exponent;
        }
        share->power[0] = ldexp(1, exponent / 2);
        share->power[1] = ldexp(1, exponent - exponent / 2);
    }
}
