/* SPDX-License-Identifier: MIT */
/* The command `stability`. */
#include "stability.h"
#include "commands.h"
#include "numbers.h"
#include "report/machine.h"
#include "report/plot.h"
#include "report/report.h"
#include <math.h>
#include <stdio.h>
#include <stdlib.h>

/* ---- What all cases of a sweep and method come to -------------------------------------------- */

struct summary {
    int cases;
    int64_t targets, compared, undecided, not_finite, wrong_ranks, other_bits;
    double rank_least, rank_most, fallback_least, fallback_most;
    double ratio[STABILITY_PRECISIONS];
};

static void add_to_summary(struct summary *sum, const struct stability_case *one)
{
    double *ratio = &sum->ratio[one->precision];
    ++sum->cases;
    sum->targets += one->targets;
    sum->compared += one->compared;
    sum->undecided += one->undecided;
    sum->not_finite += one->not_finite;
    sum->wrong_ranks += one->wrong_ranks;
    sum->other_bits += one->other_bits;
    sum->rank_least = fmin(sum->rank_least, stability_rank(one));
    sum->rank_most = fmax(sum->rank_most, stability_rank(one));
    sum->fallback_least = fmin(sum->fallback_least, stability_fallback(one));
    sum->fallback_most = fmax(sum->fallback_most, stability_fallback(one));
    *ratio = numbers_larger(*ratio, stability_ratio(one));
}

static struct summary summarise(const struct stability *stability, int sweep, int method)
{
    struct summary sum = {.rank_least = 9, .fallback_least = 1};
    for (int k = 0; k < stability->case_count; ++k) {
        const struct stability_case *one = &stability->cases[k];
        if ((int)one->sweep == sweep && (int)one->method == method)
            add_to_summary(&sum, one);
    }
    return sum;
}

static void add_summary(struct table *table, const char *sweep, const char *method,
                        const struct summary *sum)
{
    const bool ranked = sum->rank_most > 0;
    TABLE_ROW(
        table, cell_text("sweep", NULL, sweep), cell_text("method", NULL, method),
        cell_count("cases", NULL, sum->cases), cell_count("targets", NULL, sum->targets),
        cell_count("compared", NULL, sum->compared),
        cell_number("f32", NULL, "%.2g", sum->ratio[PRECISION_F32]),
        cell_number("f64", NULL, "%.2g", sum->ratio[PRECISION_F64]),
        cell_number("mixed", NULL, "%.2g", sum->ratio[PRECISION_MIXED]),
        cell_if(ranked, cell_text("rank", NULL,
                                  table_text("%.2f - %.2f", sum->rank_least, sum->rank_most))),
        cell_if(ranked, cell_text("decomposed", NULL,
                                  table_text("%.1f - %.1f", 100 * sum->fallback_least,
                                             100 * sum->fallback_most))),
        cell_count("wrong", NULL, sum->wrong_ranks), cell_count("bits", NULL, sum->other_bits),
        cell_count("not finite", NULL, sum->not_finite));
}

static void print_summaries(const struct stability *stability)
{
    struct table *table = table_create("");
    for (int sweep = stability->first; sweep <= stability->last; ++sweep)
        for (int method = 0; method < STABILITY_METHODS; ++method) {
            const struct summary sum = summarise(stability, sweep, method);
            if (sum.cases > 0)
                add_summary(table, sweep_names[sweep], method_names[method], &sum);
        }
    table_print(table);
}

/* ---- What one sweep alone comes to, place by place ------------------------------------------- */

/* The same case in another precision. */
static const struct stability_case *beside(const struct stability *stability,
                                           const struct stability_case *one,
                                           enum precision precision)
{
    for (int k = 0; k < stability->case_count; ++k) {
        const struct stability_case *other = &stability->cases[k];
        if (other->precision == precision && other->method == one->method &&
            other->policy == one->policy && other->at == one->at)
            return other;
    }
    return one;
}

static void print_places(const struct stability *stability)
{
    struct table *table = table_create("");
    printf("\nplaces     f32, but for the last columns; rank: particles of full rank, decomposed: "
           "shares in percent;\n           linear: mean error of a linear field, noise: largest "
           "|J| H of a random field; exact: the\n           largest error of a linear field at "
           "full rank, bound: the largest error of a random field\n           over its bound\n");
    for (int k = 0; k < stability->case_count; ++k) {
        const struct stability_case *one = &stability->cases[k];
        const struct stability_case *wide = beside(stability, one, PRECISION_F64);
        if (one->precision == PRECISION_F32)
            TABLE_ROW(
                table, cell_text("sweep", NULL, sweep_names[one->sweep]),
                cell_number("at", NULL, "%.3g", one->at),
                cell_text("method", NULL, method_names[one->method]),
                cell_text("policy", NULL, policy_names[one->policy]),
                cell_count("targets", NULL, one->targets),
                cell_number("rank", NULL, "%.2f", 100 * (double)one->full / (double)one->targets),
                cell_number("decomposed", NULL, "%.2f", 100 * stability_fallback(one)),
                cell_number("linear", NULL, "%.2g", stability_linear(one)),
                cell_number("noise", NULL, "%.2g", one->noise),
                cell_number("exact f32", NULL, "%.1g", one->linear_full),
                cell_number("f64", NULL, "%.1g", wide->linear_full),
                cell_number("bound f32", NULL, "%.2g", stability_ratio(one)),
                cell_number("f64", NULL, "%.2g", stability_ratio(wide)));
    }
    table_print(table);
}

/* ---- All of it ------------------------------------------------------------------------------- */

static struct cell counted(const char *key, int64_t count)
{
    return cell_count(NULL, key, count);
}

static struct cell measured(const char *key, double number)
{
    return cell_number(NULL, key, NULL, number);
}

static struct table *table_of_cases(const struct stability *stability)
{
    struct table *table = table_create("stability");
    for (int k = 0; k < stability->case_count; ++k) {
        struct stability_case *one = &stability->cases[k];
        one->once = (struct samples){&one->time, 1, 1};
        TABLE_ROW(table, cell_text(NULL, "sweep", sweep_names[one->sweep]),
                  cell_text(NULL, "policy", policy_names[one->policy]),
                  cell_text(NULL, "method", method_names[one->method]),
                  cell_text(NULL, "precision", precision_names[one->precision]),
                  cell_text(NULL, "place", table_text("%g", one->at)), measured("at", one->at),
                  measured("end", one->end), measured("threshold", stability_threshold(one)),
                  counted("targets", one->targets), measured("rank", stability_rank(one)),
                  measured("full", (double)one->full / (double)one->targets),
                  measured("decomposed", stability_fallback(one)), counted("empty", one->empty),
                  counted("compared", one->compared), counted("undecided", one->undecided),
                  measured("ratio_full", one->ratio_full),
                  measured("ratio_touched", one->ratio_touched),
                  counted("wrong_ranks", one->wrong_ranks), counted("not_finite", one->not_finite),
                  measured("linear_mean", stability_linear(one)),
                  measured("linear_full", one->linear_full), measured("noise", one->noise),
                  measured("condition", one->condition), measured("jump", one->jump),
                  measured("jump_left", one->jump_left),
                  measured("correction_jump", one->correction_jump),
                  measured("correction_jump_left", one->correction_jump_left),
                  counted("other_bits", one->other_bits), cell_ms(NULL, "", &one->once));
    }
    return table;
}

/* What bounds the errors, who can be corrected, and what a solver's author reads from it. */
static bool draw(const struct stability *stability)
{
    static const char *const scripts[] = {"ratios", "ranks", "reading"};
    const struct settings *settings = &stability->settings;
    const char *given =
        table_text("support = '%g'\nmachine = \"%s\"\n", settings->support, machine_cpu());
    for (int k = 0; k < 3; ++k) {
        const char *script = table_text("stability_%s.gp", scripts[k]);
        const char *const parts[] = {"stability/stability_common.gp",
                                     table_text("stability/%s", script), NULL};
        if (!plot_draw(settings->output, script, given, parts))
            return false;
    }
    return true;
}

static void print_results(const struct stability *stability, const struct report *report)
{
    const struct settings *settings = &stability->settings;
    const int32_t side = settings_side(settings->particles, 3);
    printf("particles  %s in the largest block, jitter %g spacings, H = %g spacings, %s, "
           "eps 1e-2, but\n           for what a sweep changes; %d round%s of random "
           "numbers, seed %d\n",
           text_grouped((int64_t)side * side * side), settings->jitter, settings->support,
           kernel_names[settings->kernel], settings->repetitions,
           settings->repetitions > 1 ? "s" : "", (int)stability->seed);
    report_machine(report);
    printf("ratios     largest error of the gradient of a random field over its bound, beside "
           "brute force in\n           quadruple precision; limits: 10 at full rank, 16 where "
           "the threshold acts; order 2: 1 and 4\n");
    printf("ranks      means over the particles of a case, least and most; decomposed: their "
           "share in percent\n");
    print_summaries(stability);
    if (stability->first == stability->last)
        print_places(stability);
}

static void write_results(const struct stability *stability, struct report *report)
{
    const struct settings *settings = &stability->settings;
    const struct table *cases = table_of_cases(stability);
    const bool all = stability->first == 0 && stability->last == SWEEPS - 1;
    table_write_csv(cases, settings->output, "stability.csv");
    const bool drawn = all && draw(stability);
    printf("\nwritten to %s: stability.csv%s%s\n", settings->output, all ? ", three scripts" : "",
           drawn ? " and their pictures" : "");
    report_number(report, "particles", settings->particles);
    report_number(report, "support_spacings", settings->support);
    report_number(report, "jitter", settings->jitter);
    report_number(report, "rounds", settings->repetitions);
    report_number(report, "seed", stability->seed);
    report_times(report, cases);
    report_write(report);
}

int command_stability(int argc, char **argv)
{
    struct stability stability = {
        .settings = settings_default(512, 1, "stability"), .last = SWEEPS - 1, .compared = -1};
    bool one_sweep = false;
    const struct command_option options[] = {
        OUTPUT_OPTION(stability.settings, "CSV, scripts and pictures", "stability"),
        {"quick", 0, NULL, "a few places of each sweep, in seconds", OPTION_FLAG, &stability.quick,
         0, 0, NULL, NULL},
        {"sweep", 0, "NAME",
         "this one alone: slab, threshold, offset, scale, neighbours, volumes, jitter, merging; or "
         "crowds, which only shows how errors grow; grading, of radii; curvature (eps_q) and "
         "thinning (a slab), of order 2",
         OPTION_CHOICE, &stability.first, 0, 0, sweep_names, &one_sweep},
        KERNEL_OPTION(stability.settings),
        {"compare", 0, "N",
         "targets of a case that stand beside the reference (32, quick 2); 0: none", OPTION_WHOLE,
         &stability.compared, 0, 1 << 20, NULL, NULL},
        {"seed", 0, "N", "other random numbers (0)", OPTION_WHOLE, &stability.seed, 0, 9999, NULL,
         NULL},
        LATTICE_OPTIONS(stability.settings),
        {0}};
    settings_read(&stability.settings, options,
                  "Sweeps thickness, threshold, distance from the origin, scale, neighbours, "
                  "volumes, disorder and merging layers for every method and precision, beside a "
                  "reference in quadruple precision. A round is another set of random numbers; "
                  "the exit status tells whether every promise held.",
                  argc, argv);
    if (one_sweep)
        stability.last = stability.first;
    if (stability.compared < 0)
        stability.compared = stability.quick ? 2 : 32;
    stability_create_cases(&stability);
    stability_measure(&stability);
    struct report *report = report_create(&stability.settings);
    print_results(&stability, report);
    write_results(&stability, report);
    return stability_check(&stability) == 0 ? EXIT_SUCCESS : EXIT_FAILURE;
}
