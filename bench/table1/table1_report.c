/* SPDX-License-Identifier: MIT */
/* Table 1 on a terminal of 100 columns, and for programs. */
#include "library.h"
#include "particles/linear_field.h"
#include "report/machine.h"
#include "report/plot.h"
#include "report/report.h"
#include "table1.h"
#include <math.h>
#include <stdio.h>

/* ---- What was measured ----------------------------------------------------------------------- */

static void print_lattice(const struct table1 *table)
{
    const struct settings *settings = &table->settings;
    const int32_t side = table->source.side;
    printf("particles  %s in a lattice of %d x %d x %d", text_grouped(table->particles.count), side,
           side, side);
    if (table->particles.count != settings->particles)
        printf(" (the cube nearest to %s)", text_grouped(settings->particles));
    printf(", spacing 1/128\n           ");
    if (settings->jitter > 0)
        printf("each coordinate moved by up to %g spacings, ", settings->jitter);
    printf("%s order, volume %s\n", table->source.shuffled ? "shuffled" : "lattice",
           table->particles.volume_origin);
}

static void print_input(const struct table1 *table)
{
    const struct particles *particles = &table->particles;
    printf("particles  %s of %s%s%s\n", text_grouped(particles->count), table->source.input,
           particles->flat[0] ? ", " : "", particles->flat);
    if (particles->more)
        printf("           the first of several frames in the file\n");
    printf("           columns %s\n", particles->columns);
    printf("           %s order, volume %s, timed field: %s\n",
           table->source.shuffled ? "shuffled" : "file's", particles->volume_origin,
           particles->velocities.count ? "the file's velocities"
                                       : linear_field_formula(particles->dimension));
}

static void print_set_up(const struct table1 *table, const struct report *report)
{
    const struct settings *settings = &table->settings;
    printf("Table 1 of Westhofen, Jeske, Bender 2023, doi:10.1145/3606933\n\n");
    if (table->source.input)
        print_input(table);
    else
        print_lattice(table);
    printf("scheme     %s, H = %g%s, threshold 0.01 (blend), %s%s\n",
           kernel_title(settings->kernel), settings->support,
           table->source.input ? "" : " spacings", precision_names[settings->precision],
           settings->precision == PRECISION_MIXED ? ": positions f64, the rest f32" : "");
    report_machine(report);
}

static void print_search(const struct table1 *table)
{
    const double count = table->particles.count;
    const struct spread search = samples_wall(&table->times[TABLE1_SEARCH]);
    printf("pairs      %s, %.2f a particle; %.1f bytes a particle held by the neighbours\n",
           text_grouped(table->neighbors.pairs), (double)table->neighbors.pairs / count,
           (double)table->neighbors.bytes / count);
    printf("search     T_ns %s ms (%s-%s)", text_time(search.median), text_time(search.min),
           text_time(search.max));
    if (table->neighbors.pairs > 0)
        printf(", %.3f ns a pair", 1e6 * search.median / (double)table->neighbors.pairs);
    printf("; the first, with allocation, %s ms\n", text_time(table->first_search));
}

/* How much longer a particle takes here than with the probe. */
static double over_probe(const struct table1 *table, enum work work, enum probe_work probe)
{
    return samples_median(&table->times[table1_item(0, 1, work)]) / table->particles.count /
           (samples_median(&table->times[TABLE1_PROBE + probe]) / table->probe_count);
}

static void print_probe(const struct table1 *table)
{
    const struct samples *probe = &table->times[TABLE1_PROBE];
    printf("yardstick  %s and %s ms for matrices and gradient of %s particles by `limit --probe`;\n"
           "           a particle's T_mat and T_grad of KGC take %.2f and %.2f of its\n",
           text_time(samples_median(&probe[PROBE_MATRICES])),
           text_time(samples_median(&probe[PROBE_GRADIENT])), text_grouped(table->probe_count),
           over_probe(table, WORK_MATRICES, PROBE_MATRICES),
           over_probe(table, WORK_GRADIENT, PROBE_GRADIENT));
}

/* ---- The table ------------------------------------------------------------------------------- */

static bool some_are_deficient(const struct table1 *table)
{
    for (int k = 0; k < TABLE1_METHODS; ++k)
        if (table->methods[k].method != SPHG_PLAIN &&
            table->methods[k].stats.rank[table->particles.dimension] != table->particles.count)
            return true;
    return false;
}

static struct cell cell_per_pair(const char *head, const struct table1 *table,
                                 const struct samples *samples)
{
    const double pairs = (double)table->neighbors.pairs;
    return cell_if(samples->count > 0 && pairs > 0,
                   cell_number(head, NULL, "%.3f", 1e6 * samples_median(samples) / pairs));
}

static struct cell cell_error(const char *head, const char *key, bool there, double error)
{
    return cell_if(there && !isnan(error), cell_number(head, key, "%.2e", error));
}

static struct cell cell_paper(const char *head, const char *key, double time)
{
    return cell_if(time > 0, cell_number(head, key, "%.2f", time));
}

/* Rows of methods, which are printed as columns, as in the paper. */
static void add_method(struct table *rows, const struct table1 *table, int method, bool show_ranks)
{
    const struct cell blank = {.head = ""};
    const struct table1_method *one = &table->methods[method];
    const struct samples *plain = &table->times[table1_item(0, method, WORK_SEARCH)],
                         *kept = &table->times[table1_item(1, method, WORK_SEARCH)];
    const bool corrected = one->method != SPHG_PLAIN, ranked = corrected && show_ranks;
    TABLE_ROW(rows, cell_text("", "method", method_names[one->method]),
              cell_ms("T_mat   [ms]", "matrix", &plain[WORK_MATRICES]),
              cell_ms("T_grad  [ms]", "gradient", &plain[WORK_GRADIENT]),
              cell_ms("fused   [ms]", "fused", &plain[WORK_FUSED]),
              cell_ms("T_mat  +weights [ms]", "matrix+weights", &kept[WORK_MATRICES]),
              cell_ms("T_grad +weights [ms]", "gradient+weights", &kept[WORK_GRADIENT]),
              cell_ms("fused  +weights [ms]", "fused+weights", &kept[WORK_FUSED]), blank,
              cell_per_pair("T_mat   [ns a pair]", table, &plain[WORK_MATRICES]),
              cell_per_pair("T_grad  [ns a pair]", table, &plain[WORK_GRADIENT]),
              cell_per_pair("fused   [ns a pair]", table, &plain[WORK_FUSED]), blank,
              cell_error("error of T_grad", "gradient_error", true, one->gradient_error),
              cell_error("error of fused", "fused_error", corrected, one->fused_error),
              cell_error(NULL, "kept_error", table1_keeps_weights(one), one->kept_error),
              cell_if(ranked, cell_count("rank 0", NULL, one->stats.rank[0])),
              cell_if(ranked, cell_count("rank 1", NULL, one->stats.rank[1])),
              cell_if(ranked, cell_count("rank 2", NULL, one->stats.rank[2])),
              cell_if(ranked && table->particles.dimension == 3,
                      cell_count("rank 3", NULL, one->stats.rank[3])),
              cell_if(ranked, cell_count("to the eigensolver", NULL, one->stats.decomposed)), blank,
              cell_paper("paper, T_mat  [ms]", "paper_matrix", one->paper_matrix),
              cell_paper("paper, T_grad [ms]", "paper_gradient", one->paper_gradient));
}

/* ---- What it means --------------------------------------------------------------------------- */

/* Volumes are what a file gets wrong most easily, and what lambda takes as it is. */
static void print_suspect(const struct table1 *table)
{
    const int32_t dimension = table->particles.dimension;
    const double count = table->particles.count;
    const double neighbors = (double)table->neighbors.pairs / count;
    if (!table->source.input || (double)table->methods[1].stats.rank[dimension] >= count / 10)
        return;
    printf("\nHardly any particle has full rank. First suspect: ");
    if (neighbors < dimension)
        printf("--support, which leaves %.2g neighbours a particle.\n", neighbors);
    else
        printf("the unit of the volumes (mass / density),\nwhich are %.2g times what the positions "
               "give (1 / sum W).\n",
               table->volume_ratio);
}

static void print_footer(const struct table1 *table, bool deficient)
{
    int64_t not_finite = 0;
    for (int k = 0; k < TABLE1_METHODS; ++k)
        not_finite += table->methods[k].not_finite;
    printf("\nerror: max |J_i - J|_F / |J|_F on %s over all particles%s rank %d%s\n",
           linear_field_formula(table->particles.dimension), deficient ? " of" : ", all of",
           (int)table->particles.dimension, deficient ? " (SPH: over all)" : "");
    if (table->source.input && table->settings.precision == PRECISION_MIXED)
        printf("(mixed: v itself is rounded to f32 here, which shows as error)\n");
    if (not_finite > 0)
        printf("NOT FINITE: %lld numbers of the Jacobians are NaN or infinite\n",
               (long long)not_finite);
    else
        printf("all numbers of all Jacobians are finite\n");
    printf("+weights: the sweep before, which is not timed, kept what kernel and volume give each "
           "pair\n");
    printf("paper: one million particles on 32 cores of a Threadripper PRO 5975WX\n");
}

/* Beside a file's particles the paper's lattice would say nothing. */
static void draw(const struct table1 *table, const struct table *rows)
{
    const struct settings *settings = &table->settings;
    if (!settings->output)
        return;
    table_write_csv(rows, settings->output, "table1.csv");
    plot_written(settings->output, "table1/table1", "table1.csv",
                 table_text("title = '%s particles, %s, H = %g spacings, search not included; %s, "
                            "%s, %s'\nthreads = %d\n",
                            text_grouped(table->particles.count), kernel_title(settings->kernel),
                            settings->support, machine_cpu(), library_isa(),
                            precision_names[settings->precision], settings->threads));
}

static void write_report(const struct table1 *table, const struct table *rows,
                         struct report *report)
{
    const struct settings *settings = &table->settings;
    const double count = table->particles.count;
    struct table *search = table_create("table1"), *probe = table_create("probe");
    TABLE_ROW(search, cell_ms(NULL, "search", &table->times[TABLE1_SEARCH]));
    TABLE_ROW(probe, cell_ms(NULL, "matrices", &table->times[TABLE1_PROBE + PROBE_MATRICES]),
              cell_ms(NULL, "gradient", &table->times[TABLE1_PROBE + PROBE_GRADIENT]),
              cell_count(NULL, "particles", table->probe_count));
    report_text(report, "particles_from", table->source.input ? table->source.input : "lattice");
    report_lattice_numbers(report, table->particles.count, (double)table->neighbors.pairs / count);
    report_number(report, "dimension", table->particles.dimension);
    report_number(report, "bytes_per_particle", (double)table->neighbors.bytes / count);
    report_text(report, "kernel", kernel_names[settings->kernel]);
    report_text(report, "precision", precision_names[settings->precision]);
    report_text(report, "order", table->source.shuffled ? "shuffled" : "lattice");
    report_number(report, "support_radius", table->support_radius);
    report_number(report, "search_first_ms", table->first_search);
    report_times(report, search);
    report_times(report, probe);
    report_times(report, rows);
    report_write(report);
}

void table1_report(const struct table1 *table)
{
    const bool deficient = some_are_deficient(table);
    struct report *report = report_create(&table->settings);
    struct table *rows = table_create("table1");
    for (int k = 0; k < TABLE1_METHODS; ++k)
        add_method(rows, table, k, deficient || table->source.input);
    print_set_up(table, report);
    print_search(table);
    print_probe(table);
    printf("\nmedian of %d repetition%s after a warm-up, methods in turn; search not included\n\n",
           table->settings.repetitions, table->settings.repetitions > 1 ? "s" : "");
    table_print_turned(rows);
    print_suspect(table);
    print_footer(table, deficient);
    draw(table, rows);
    write_report(table, rows, report);
}
