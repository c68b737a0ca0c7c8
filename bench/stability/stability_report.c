/* Stability as a table on a terminal, as CSV, and for machines. */
#include "report/machine.h"
#include "report/plot.h"
#include "report/report_json.h"
#include "stability.h"
#include "report/text.h"

#include <math.h>
#include <stdio.h>

/* What all cases of a sweep and method come to. */
struct summary {
    int cases;
    int64_t targets, compared, undecided, not_finite, wrong_ranks, other_bits;
    double rank_least, rank_most, fallback_least, fallback_most;
    double ratio[STABILITY_PRECISIONS];
};

static void add_to_summary(struct summary *sum, const struct stability_case *one)
{
    double *ratio = &sum->ratio[one->precision];
    sum->cases++;
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
    *ratio = fmax(*ratio, stability_ratio(one));
}

static struct summary summarise(const struct stability *stability, enum stability_sweep sweep,
                                sphg_method method)
{
    struct summary sum = {.rank_least = 3, .fallback_least = 1};
    for (int k = 0; k < stability->case_count; k++) {
        const struct stability_case *one = &stability->cases[k];
        if (one->sweep == sweep && one->method == method)
            add_to_summary(&sum, one);
    }
    return sum;
}

static void print_summary(const char *sweep, const char *method, const struct summary *sum)
{
    char targets[TEXT_SIZE], compared[TEXT_SIZE];
    printf("  %-12s%-7s%6d%12s%10s%8.2g%8.2g%8.2g", sweep, method, sum->cases,
           text_grouped(sum->targets, targets), text_grouped(sum->compared, compared),
           sum->ratio[PRECISION_F32], sum->ratio[PRECISION_F64], sum->ratio[PRECISION_MIXED]);
    if (sum->rank_most > 0)
        printf("%7.2f -%5.2f%7.1f -%5.1f", sum->rank_least, sum->rank_most,
               100 * sum->fallback_least, 100 * sum->fallback_most);
    else
        printf("%14s%14s", "-", "-");
    printf("%7lld%7lld%12lld\n", (long long)sum->wrong_ranks, (long long)sum->other_bits,
           (long long)sum->not_finite);
}

/* The same case in another precision. */
static const struct stability_case *beside(const struct stability *stability,
                                           const struct stability_case *one,
                                           enum precision precision)
{
    for (int k = 0; k < stability->case_count; k++) {
        const struct stability_case *other = &stability->cases[k];
        if (other->precision == precision && other->method == one->method &&
            other->policy == one->policy && other->at == one->at)
            return other;
    }
    return one;
}

/* What one sweep alone comes to, place by place. */
static void print_places(const struct stability *stability)
{
    printf("\nplaces     f32, but for the last columns; rank: particles of full rank, decomposed: "
           "shares in percent;\n           linear: mean error of a linear field, noise: largest "
           "|J| H of a random field; exact: the\n           largest error of a linear field at "
           "full rank, bound: the largest error of a random field\n           over its bound, "
           "both in f32 and f64\n");
    printf("\n  %-12s%9s  %-7s%-10s%10s%8s%12s%9s%9s%17s%18s\n", "sweep", "at", "method", "policy",
           "targets", "rank", "decomposed", "linear", "noise", "exact", "bound");
    for (int k = 0; k < stability->case_count; k++) {
        const struct stability_case *one = &stability->cases[k];
        const struct stability_case *wide = beside(stability, one, PRECISION_F64);
        if (one->precision != PRECISION_F32)
            continue;
        printf("  %-12s%9.3g  %-7s%-10s%10lld%8.2f%12.2f%9.2g%9.2g %7.1g %7.1g %8.2g %8.2g\n",
               sweep_names[one->sweep], one->at, method_names[one->method],
               policy_names[one->policy], (long long)one->targets,
               100 * (double)one->full / (double)one->targets, 100 * stability_fallback(one),
               stability_linear(one), one->noise, one->linear_full, wide->linear_full,
               stability_ratio(one), stability_ratio(wide));
    }
}

void stability_print(const struct stability *stability)
{
    const struct settings *settings = &stability->settings;
    char count[TEXT_SIZE];
    const int32_t side = settings_side(settings->particles, 3);
    printf("particles  %s in the largest block, jitter %g spacings, H = %g spacings, %s, "
           "eps 1e-2, but\n           for what a sweep changes; %d round%s of random "
           "numbers, seed %d\n",
           text_grouped((int64_t)side * side * side, count), settings->jitter, settings->support,
           kernel_names[stability->kernel], settings->repetitions,
           settings->repetitions > 1 ? "s" : "", (int)stability->seed);
    text_print_machine(settings->threads);
    printf("ratios     largest error of the gradient of a random field over its bound, beside "
           "brute force in\n           quadruple precision; limits: 10 at full rank, 16 where "
           "the threshold acts\n");
    printf("ranks      means over the particles of a case, least and most; decomposed: their "
           "share in percent\n");
    printf("\n  %-12s%-7s%6s%12s%10s%8s%8s%8s%14s%14s%7s%7s%12s\n", "sweep", "method", "cases",
           "targets", "compared", "f32", "f64", "mixed", "rank", "decomposed", "wrong", "bits",
           "not finite");
    for (int sweep = stability->first; sweep <= stability->last; sweep++)
        for (int method = 0; method < STABILITY_METHODS; method++) {
            const struct summary sum =
                summarise(stability, (enum stability_sweep)sweep, (sphg_method)method);
            if (sum.cases > 0)
                print_summary(sweep_names[sweep], method_names[method], &sum);
        }
    if (stability->first == stability->last)
        print_places(stability);
}

void stability_write_csv(const struct stability *stability)
{
    FILE *file = plot_file(stability->output, "stability.csv");
    fprintf(file, "# %s, %s\n", machine_cpu(), machine_date());
    fprintf(file, "sweep,policy,method,precision,at,end,targets,rank,full,decomposed,ratio_full,"
                  "ratio_touched,compared,undecided,wrong_ranks,not_finite,linear_mean,"
                  "linear_full,noise,condition,jump,jump_left,correction_jump,"
                  "correction_jump_left,other_bits\n");
    for (int k = 0; k < stability->case_count; k++) {
        const struct stability_case *one = &stability->cases[k];
        fprintf(file, "%s,%s,%s,%s,%.6g,%.6g,%lld,%.5g,%.5g,%.5g", sweep_names[one->sweep],
                policy_names[one->policy], method_names[one->method],
                precision_names[one->precision], one->at, one->end, (long long)one->targets,
                stability_rank(one), (double)one->full / (double)one->targets,
                stability_fallback(one));
        fprintf(file, ",%.4g,%.4g,%lld,%lld,%lld,%lld", one->ratio_full, one->ratio_touched,
                (long long)one->compared, (long long)one->undecided, (long long)one->wrong_ranks,
                (long long)one->not_finite);
        fprintf(file, ",%.4g,%.4g,%.4g,%.4g,%.4g,%.4g,%.4g,%.4g,%lld\n", stability_linear(one),
                one->linear_full, one->noise, one->condition, one->jump, one->jump_left,
                one->correction_jump, one->correction_jump_left, (long long)one->other_bits);
    }
    plot_close(file, "stability.csv");
}

static void write_case(struct report *report, const struct stability_case *one)
{
    char name[160];
    const struct counter counters[] = {{"at", one->at},
                                       {"end", one->end},
                                       {"threshold", stability_threshold(one)},
                                       {"targets", (double)one->targets},
                                       {"rank_mean", stability_rank(one)},
                                       {"full_share", (double)one->full / (double)one->targets},
                                       {"decomposed_share", stability_fallback(one)},
                                       {"empty", (double)one->empty},
                                       {"compared", (double)one->compared},
                                       {"undecided", (double)one->undecided},
                                       {"ratio_full", one->ratio_full},
                                       {"ratio_touched", one->ratio_touched},
                                       {"wrong_ranks", (double)one->wrong_ranks},
                                       {"not_finite", (double)one->not_finite},
                                       {"linear_error_mean", stability_linear(one)},
                                       {"linear_error_full", one->linear_full},
                                       {"noise", one->noise},
                                       {"condition", one->condition},
                                       {"jump", one->jump},
                                       {"jump_left", one->jump_left},
                                       {"correction_jump", one->correction_jump},
                                       {"correction_jump_left", one->correction_jump_left},
                                       {"other_bits", (double)one->other_bits},
                                       {NULL, 0}};
    snprintf(name, sizeof name, "stability/%s/%s/%s/%s/%g", sweep_names[one->sweep],
             policy_names[one->policy], method_names[one->method], precision_names[one->precision],
             one->at);
    report_once(report, name, one->time, counters);
}

void stability_write_json(const struct stability *stability, const char *path,
                          const char *executable)
{
    struct report *report = report_create(executable, stability->settings.threads);
    report_number(report, "particles", stability->settings.particles);
    report_number(report, "support_spacings", stability->settings.support);
    report_number(report, "jitter", stability->settings.jitter);
    report_number(report, "rounds", stability->settings.repetitions);
    report_number(report, "seed", stability->seed);
    for (int k = 0; k < stability->case_count; k++)
        write_case(report, &stability->cases[k]);
    report_write(report, path);
}
