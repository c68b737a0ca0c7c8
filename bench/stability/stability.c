/* SPDX-License-Identifier: MIT */
/* The command `stability`: in each sweep one thing changes. stability.py sums up what its cases
 * come to, and says which promise one breaks. */
#include "stability.h"
#include "commands.h"
#include "numbers.h"
#include "report/report.h"
#include <float.h>
#include <math.h>

enum { CASES_MOST = 8192, PLACES_MOST = 32, METHODS = 6, POLICIES = 4, PRECISIONS = 3 };

const char *const sweep_names[] = {"slab",      "threshold", "offset",  "scale",  "neighbours",
                                   "volumes",   "jitter",    "merging", "crowds", "grading",
                                   "curvature", "thinning",  NULL};
const char *const policy_names[] = {[SPHG_BLEND] = "blend",
                                    [SPHG_REPLACE] = "replace",
                                    [SPHG_TRUNCATE] = "truncate",
                                    [SPHG_IDENTITY] = "identity",
                                    NULL};

/* ---- Cases ----------------------------------------------------------------------------------- */

/* Places of a sweep: listed, or `count` of them, each 10^exponent times the one before or `step`
 * beside it. A walk goes from one to the next. */
struct places {
    double first, exponent, step;
    bool is_walk;
    int count;
    double at[PLACES_MOST];
};

static const struct places sweeps[] = {
    [SWEEP_SLAB] = {.first = 1, .exponent = 0.5, .count = 25},
    [SWEEP_THINNING] = {.first = 1, .exponent = 0.5, .count = 25},
    [SWEEP_THRESHOLD] = {.count = 12,
                         .at = {1e-6, 3.1622776601683795e-6, 1e-5, 3.1622776601683795e-5, 1e-4,
                                3.1622776601683795e-4, 1e-3, 3.1622776601683795e-3, 1e-2,
                                3.1622776601683795e-2, 1e-1, 0.3}},
    [SWEEP_CURVATURE] = {.first = 1e-7, .exponent = 0.5, .count = 11},
    [SWEEP_GRADING] = {.count = 7, .at = {1, 4, 16, 64, 256, 1024, 4096}},
    [SWEEP_OFFSET] = {.count = 10, .at = {0, 1, 10, 100, 1e3, 1e4, 1e5, 1e6, 1e7, 1e8}},
    [SWEEP_SCALE] = {.is_walk = true, .count = 17},
    [SWEEP_NEIGHBOURS] = {.count = 24,
                          .at = {0,  1,  2,  3,  4,  5,  6,   8,   10,  12,  15,  20,
                                 25, 30, 40, 50, 60, 80, 100, 130, 160, 200, 250, 300}},
    [SWEEP_VOLUMES] = {.first = 1, .exponent = 1, .count = 13},
    [SWEEP_JITTER] = {.step = 0.1, .count = 11},
    [SWEEP_CROWDS] = {.count = 8, .at = {1, 3, 10, 30, 100, 300, 1000, 4000}},
    [SWEEP_MERGING] = {.first = 1.1, .step = -0.05, .is_walk = true, .count = 23}};

/* From the smallest normal V = 2^(3 k) to the smallest normal 1 / H^3. */
static double scale_at(int k, double support, enum precision precision)
{
    const int range = (precision == PRECISION_F64 ? -DBL_MIN_EXP : -FLT_MIN_EXP) + 1;
    const double least = -floor(range / 3.0), most = floor(range / 3.0 - log2(support));
    return round(least + (most - least) / 16 * k);
}

static double place_at(const struct stability *stability, const struct stability_case *one, int k)
{
    const struct places *places = &sweeps[one->sweep];
    if (one->sweep == SWEEP_SCALE)
        return scale_at(k, stability->settings.support, one->precision);
    if (places->exponent > 0)
        return places->first * pow(10, k * places->exponent);
    return places->step != 0 ? places->first + places->step * k : places->at[k];
}

/* All places; quick: the first, the last, and two between. */
static void add_places(struct stability *stability, struct stability_case one)
{
    enum { FEW = 4 };
    const struct places *places = &sweeps[one.sweep];
    const int count = stability->quick ? FEW : places->count;
    double at[PLACES_MOST];
    for (int k = 0; k < count; ++k)
        at[k] =
            place_at(stability, &one, stability->quick ? k * (places->count - 1) / (FEW - 1) : k);
    for (int k = 0; k < count - places->is_walk; ++k) {
        one.at = at[k];
        one.end = at[k + places->is_walk];
        if (one.sweep == SWEEP_SCALE)
            one.steps = (int32_t)fmax(1, ceil((one.end - one.at) / (stability->quick ? 8 : 1)));
        if (one.sweep == SWEEP_MERGING)
            one.steps = (int32_t)lround((one.at - one.end) * (stability->quick ? 40 : 1000));
        if (one.sweep == SWEEP_THRESHOLD)
            one.scheme.threshold = one.at;
        if (one.sweep == SWEEP_CURVATURE)
            one.scheme.threshold = 10 * one.at;
        stability->cases[stability->case_count++] = one;
    }
}

/* Without a correction there is no threshold, and nothing that could jump. */
static bool makes_sense(const struct stability_case *one)
{
    if (one->sweep == SWEEP_THRESHOLD || one->sweep == SWEEP_MERGING)
        return one->scheme.method != SPHG_PLAIN;
    if (one->scheme.order == 2 && one->scheme.method > SPHG_RKPM)
        return false;
    return one->scheme.policy == SPHG_BLEND;
}

static void create_cases(struct stability *stability)
{
    const int of_sweep = POLICIES * METHODS * PRECISIONS;
    stability->cases = allocate_to_the_end(CASES_MOST, sizeof *stability->cases);
    for (int n = of_sweep * stability->first; n < of_sweep * (stability->last + 1); ++n) {
        const int sweep = n / of_sweep;
        const struct stability_case one = {
            .sweep = (enum stability_sweep)sweep,
            .precision = (enum precision)(n % PRECISIONS),
            .scheme = {.dimension = 3,
                       .method = (sphg_method)(n / PRECISIONS % METHODS),
                       .policy = (sphg_policy)(n / PRECISIONS / METHODS % POLICIES),
                       .kernel = stability->settings.kernel,
                       .threshold = 1e-2,
                       .order = sweep == SWEEP_CURVATURE || sweep == SWEEP_THINNING ? 2 : 1}};
        if (makes_sense(&one) && (!stability->one_policy || one.scheme.policy == stability->policy))
            add_places(stability, one);
    }
}

/* ---- All of it ------------------------------------------------------------------------------- */

static void add_case(struct stability_case *one)
{
    const double targets = (double)one->targets;
    const struct samples once = {&one->time, 1};
    TABLE_ROW(
        cell_text("sweep", sweep_names[one->sweep]),
        cell_text("policy", policy_names[one->scheme.policy]),
        cell_text("method", method_names[one->scheme.method]),
        cell_text("precision", precision_names[one->precision]),
        cell_text("place", text_of("%g", one->at)), cell_number("at", one->at),
        cell_number("end", one->end), cell_number("threshold", one->scheme.threshold),
        cell_count("targets", one->targets), cell_number("rank", (double)one->rank_sum / targets),
        cell_number("full", (double)one->full / targets),
        cell_number("decomposed", (double)(one->decomposed - one->empty) / targets),
        cell_count("empty", one->empty), cell_count("compared", one->compared),
        cell_count("undecided", one->undecided), cell_number("ratio_full", one->ratio_full),
        cell_number("ratio_touched", one->ratio_touched),
        cell_count("wrong_ranks", one->wrong_ranks), cell_count("not_finite", one->not_finite),
        cell_number("linear_mean", one->linear_sum / targets),
        cell_number("linear_full", one->linear_full), cell_number("noise", one->noise),
        cell_number("condition", one->condition), cell_number("jump", one->jump),
        cell_number("jump_left", one->jump_left),
        cell_number("correction_jump", one->correction_jump),
        cell_number("correction_jump_left", one->correction_jump_left),
        cell_count("other_bits", one->other_bits), cell_ms("", &once));
}

static int show(const struct stability *stability)
{
    const struct settings *settings = &stability->settings;
    const int32_t side = settings_side(settings->particles, 3);
    report_open("stability", settings);
    report_number("particles", settings->particles);
    report_number("support_spacings", settings->support);
    report_number("jitter", settings->jitter);
    report_number("rounds", settings->repetitions);
    report_number("seed", stability->seed);
    report_number(".block", (double)side * side * side);
    report_number(".compared", stability->compared);
    report_number(".all",
                  stability->first == 0 && stability->last == SWEEPS - 1 && !stability->one_policy);
    report_number(".alone", stability->first == stability->last);
    table_begin("stability");
    for (int k = 0; k < stability->case_count; ++k)
        add_case(&stability->cases[k]);
    return report_close();
}

int command_stability(int argc, char **argv)
{
    struct stability stability = {
        .settings = settings_default(512, 1, "stability"), .last = SWEEPS - 1, .compared = -1};
    bool one_sweep = false;
    const struct command_option options[] = {
        {"output", 0, "FOLDER", "where CSV, scripts and pictures go (stability)",
         AS_FOLDER(stability.settings.output)},
        {"quick", 0, NULL, "a few places of each sweep, in seconds", AS_FLAG(stability.quick)},
        {"sweep", 0, "NAME",
         "this one alone: slab, threshold, offset, scale, neighbours, volumes, jitter, merging; or "
         "crowds, which only shows how errors grow; grading, of radii; curvature (eps_q) and "
         "thinning (a slab), of order 2",
         OPTION_CHOICE, &stability.first, 0, 0, sweep_names, &one_sweep},
        {"policy", 0, "NAME", "this one alone: blend, replace, truncate, identity", OPTION_CHOICE,
         &stability.policy, 0, 0, policy_names, &stability.one_policy},
        {"compare", 0, "N",
         "targets of a case that stand beside the reference (32, quick 2); 0: none",
         AS_WHOLE(stability.compared, 0, 1 << 20)},
        {"seed", 0, "N", "other random numbers (0)", AS_WHOLE(stability.seed, 0, 9999)},
        {0}};
    settings_read(&stability.settings, TAKES_LATTICE | TAKES_RUN | TAKES_KERNEL, options,
                  "Sweeps thickness, threshold, distance from the origin, scale, neighbours, "
                  "volumes, disorder and merging layers for every method and precision, beside a "
                  "reference in quadruple precision. A round is another set of random numbers; "
                  "the exit status tells whether every promise held.",
                  argc, argv);
    if (one_sweep)
        stability.last = stability.first;
    if (stability.compared < 0)
        stability.compared = stability.quick ? 2 : 32;
    create_cases(&stability);
    stability_measure(&stability);
    return show(&stability);
}
