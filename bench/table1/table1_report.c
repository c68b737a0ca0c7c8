/* SPDX-License-Identifier: MIT */
/* Table 1 on a terminal of 100 columns, and for programs. */
#include "library.h"
#include "particles/linear_field.h"
#include "report/machine.h"
#include "report/plot.h"
#include "report/report.h"
#include "report/text.h"
#include "table1.h"
#include <math.h>
#include <stdio.h>

/* ---- What was measured ----------------------------------------------------------------------- */

static void print_lattice(const struct table1 *table)
{
    const struct settings *settings = &table->settings;
    const int32_t side = table->source.side;
    char count[TEXT_SIZE], wanted[TEXT_SIZE];
    printf("particles  %s in a lattice of %d x %d x %d",
           text_grouped(table->particles.count, count), side, side, side);
    if (table->particles.count != settings->particles)
        printf(" (the cube nearest to %s)", text_grouped(settings->particles, wanted));
    printf(", spacing 1/128\n           ");
    if (settings->jitter > 0)
        printf("each coordinate moved by up to %g spacings, ", settings->jitter);
    printf("%s order, volume %s\n", table->source.shuffled ? "shuffled" : "lattice",
           table->particles.volume_origin);
}

static void print_input(const struct table1 *table)
{
    char count[TEXT_SIZE];
    const struct particles *particles = &table->particles;
    printf("particles  %s of %s%s%s\n", text_grouped(particles->count, count), table->source.input,
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
    char pairs[TEXT_SIZE], median[TEXT_SIZE], least[TEXT_SIZE], most[TEXT_SIZE], first[TEXT_SIZE];
    const double count = table->particles.count;
    const struct spread search = samples_wall(&table->times[TABLE1_SEARCH]);
    printf("pairs      %s, %.2f a particle; %.1f bytes a particle held by the neighbours\n",
           text_grouped(table->neighbors.pairs, pairs), (double)table->neighbors.pairs / count,
           (double)table->neighbors.bytes / count);
    text_time(search.median, median);
    text_time(search.min, least);
    text_time(search.max, most);
    text_time(table->first_search, first);
    printf("search     T_ns %s ms (%s-%s)", median, least, most);
    if (table->neighbors.pairs > 0)
        printf(", %.3f ns a pair", 1e6 * search.median / (double)table->neighbors.pairs);
    printf("; the first, with allocation, %s ms\n", first);
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
    char matrices[TEXT_SIZE], gradient[TEXT_SIZE], count[TEXT_SIZE];
    text_time(samples_median(&probe[PROBE_MATRICES]), matrices);
    text_time(samples_median(&probe[PROBE_GRADIENT]), gradient);
    printf("yardstick  %s and %s ms for matrices and gradient of %s particles by `limit --probe`;\n"
           "           a particle's T_mat and T_grad of KGC take %.2f and %.2f of its\n",
           matrices, gradient, text_grouped(table->probe_count, count),
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

static struct cell cell_per_pair(const struct table1 *table, const struct samples *samples)
{
    return samples->count > 0 && table->neighbors.pairs > 0
               ? cell_number(1e6 * samples_median(samples) / (double)table->neighbors.pairs)
               : cell_none();
}

static struct cell cell_error(double error)
{
    return isnan(error) ? cell_none() : cell_number(error);
}

static struct cell cell_paper(double time)
{
    return time > 0 ? cell_number(time) : cell_none();
}

/* Rows of methods, which are printed as columns, as in the paper. */
static const struct column columns[] = {{"", "method", NULL, NULL},
                                        {"T_mat   [ms]", "matrix", NULL, NULL},
                                        {"T_grad  [ms]", "gradient", NULL, NULL},
                                        {"fused   [ms]", "fused", NULL, NULL},
                                        {"T_mat  +weights [ms]", "matrix+weights", NULL, NULL},
                                        {"T_grad +weights [ms]", "gradient+weights", NULL, NULL},
                                        {"fused  +weights [ms]", "fused+weights", NULL, NULL},
                                        {"", NULL, NULL, NULL},
                                        {"T_mat   [ns a pair]", NULL, "%.3f", NULL},
                                        {"T_grad  [ns a pair]", NULL, "%.3f", NULL},
                                        {"fused   [ns a pair]", NULL, "%.3f", NULL},
                                        {"", NULL, NULL, NULL},
                                        {"error of T_grad", "gradient_error", "%.2e", NULL},
                                        {"error of fused", "fused_error", "%.2e", NULL},
                                        {NULL, "kept_error", NULL, NULL},
                                        {"rank 0", NULL, NULL, NULL},
                                        {"rank 1", NULL, NULL, NULL},
                                        {"rank 2", NULL, NULL, NULL},
                                        {"rank 3", NULL, NULL, NULL},
                                        {"to the eigensolver", NULL, NULL, NULL},
                                        {"", NULL, NULL, NULL},
                                        {"paper, T_mat  [ms]", "paper_matrix", "%.2f", NULL},
                                        {"paper, T_grad [ms]", "paper_gradient", "%.2f", NULL},
                                        {0}};

static void add_method(struct table *rows, const struct table1 *table, int method, bool show_ranks)
{
    const struct table1_method *one = &table->methods[method];
    struct cell cells[sizeof columns / sizeof columns[0]];
    const bool corrected = one->method != SPHG_PLAIN;
    int count = 0;
    cells[count++] = cell_text(method_names[one->method]);
    for (int kept = 0; kept < 2; ++kept)
        for (int work = WORK_MATRICES; work < WORKS; ++work)
            cells[count++] =
                cell_time(&table->times[table1_item(kept, method, (enum work)work)], 1);
    cells[count++] = cell_none();
    for (int work = WORK_MATRICES; work < WORKS; ++work)
        cells[count++] =
            cell_per_pair(table, &table->times[table1_item(0, method, (enum work)work)]);
    cells[count++] = cell_none();
    cells[count++] = cell_error(one->gradient_error);
    cells[count++] = corrected ? cell_error(one->fused_error) : cell_none();
    cells[count++] = table1_keeps_weights(one) ? cell_error(one->kept_error) : cell_none();
    for (int rank = 0; rank < 4; ++rank)
        cells[count++] = corrected && show_ranks && rank <= table->particles.dimension
                             ? cell_count(one->stats.rank[rank])
                             : cell_none();
    cells[count++] = corrected && show_ranks ? cell_count(one->stats.decomposed) : cell_none();
    cells[count++] = cell_none();
    cells[count++] = cell_paper(one->paper_matrix);
    cells[count++] = cell_paper(one->paper_gradient);
    table_add(rows, cells, (size_t)count);
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
    char count[TEXT_SIZE];
    if (!settings->output)
        return;
    table_write_csv(rows, settings->output, "table1.csv");
    plot_written(settings->output, "table1/table1", "table1.csv",
                 table_text("title = '%s particles, %s, H = %g spacings, search not included; %s, "
                            "%s, %s'\nthreads = %d\n",
                            text_grouped(table->particles.count, count),
                            kernel_title(settings->kernel), settings->support, machine_cpu(),
                            library_isa(), precision_names[settings->precision],
                            settings->threads));
}

static void write_report(const struct table1 *table, const struct table *rows,
                         struct report *report)
{
    static const struct column of_search[] = {{NULL, "search", NULL, NULL}, {0}};
    static const struct column of_probe[] = {{NULL, "matrices", NULL, NULL},
                                             {NULL, "gradient", NULL, NULL},
                                             {NULL, "particles", NULL, NULL},
                                             {0}};
    const struct settings *settings = &table->settings;
    const double count = table->particles.count;
    struct table *search = table_create("table1", of_search),
                 *probe = table_create("probe", of_probe);
    TABLE_ROW(search, cell_time(&table->times[TABLE1_SEARCH], 1));
    TABLE_ROW(probe, cell_time(&table->times[TABLE1_PROBE + PROBE_MATRICES], 1),
              cell_time(&table->times[TABLE1_PROBE + PROBE_GRADIENT], 1),
              cell_count(table->probe_count));
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
    struct table *rows = table_create("table1", columns);
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
