/* Table 1 on a terminal of 100 columns. */
#include "library.h"
#include "report/machine.h"
#include "table1.h"
#include "report/text.h"

#include <math.h>
#include <stdio.h>
#include <string.h>

static void format_range(const struct samples *samples, char text[2 * TEXT_SIZE])
{
    const struct spread spread = samples_wall(samples);
    char least[TEXT_SIZE], most[TEXT_SIZE];
    text_time(spread.min, least);
    text_time(spread.max, most);
    snprintf(text, 2 * TEXT_SIZE, "%s-%s", least, most);
}

static void print_label(const char *label)
{
    printf("  %-20s", label);
}

static void print_cell(const char *text)
{
    printf("%13s", text);
}

static const struct samples *samples_of(const struct column *column, int which)
{
    const struct samples *const all[] = {&column->matrix,        &column->gradient,
                                         &column->fused,         &column->matrix_kept,
                                         &column->gradient_kept, &column->fused_kept};
    return all[which];
}

static void print_medians(const struct table1 *table, const char *label, int which)
{
    print_label(label);
    for (int k = 0; k < TABLE1_COLUMNS; k++) {
        char text[TEXT_SIZE] = "-";
        const struct samples *samples = samples_of(&table->columns[k], which);
        if (samples->count > 0)
            text_time(samples_wall(samples).median, text);
        print_cell(text);
    }
    printf("\n");
}

static void print_ranges(const struct table1 *table, int which)
{
    print_label("  min-max");
    for (int k = 0; k < TABLE1_COLUMNS; k++) {
        char text[2 * TEXT_SIZE] = "";
        const struct samples *samples = samples_of(&table->columns[k], which);
        if (samples->count > 0)
            format_range(samples, text);
        print_cell(text);
    }
    printf("\n");
}

static void print_per_pair(const struct table1 *table, const char *label, int which)
{
    print_label(label);
    for (int k = 0; k < TABLE1_COLUMNS; k++) {
        char text[TEXT_SIZE] = "-";
        const struct samples *samples = samples_of(&table->columns[k], which);
        if (samples->count > 0 && table->neighbors.pairs > 0)
            snprintf(text, sizeof text, "%.3f",
                     1e6 * samples_wall(samples).median / (double)table->neighbors.pairs);
        print_cell(text);
    }
    printf("\n");
}

static void print_errors(const struct table1 *table, const char *label, int fused)
{
    print_label(label);
    for (int k = 0; k < TABLE1_COLUMNS; k++) {
        char text[TEXT_SIZE] = "-";
        const struct column *column = &table->columns[k];
        const int none = column->method == SPHG_PLAIN
                             ? fused
                             : column->stats.rank[table->particles.dimension] == 0;
        if (!none)
            snprintf(text, sizeof text, "%.2e",
                     fused ? column->fused_error : column->gradient_error);
        print_cell(text);
    }
    printf("\n");
}

static void print_counts(const struct table1 *table, const char *label,
                         int64_t (*count)(const sphg_stats *stats, int index), int index)
{
    print_label(label);
    for (int k = 0; k < TABLE1_COLUMNS; k++) {
        char text[TEXT_SIZE] = "-";
        if (table->columns[k].method != SPHG_PLAIN)
            text_grouped(count(&table->columns[k].stats, index), text);
        print_cell(text);
    }
    printf("\n");
}

static int64_t count_rank(const sphg_stats *stats, int rank)
{
    return stats->rank[rank];
}

static int64_t count_decomposed(const sphg_stats *stats, int unused)
{
    (void)unused;
    return stats->decomposed;
}

static void print_paper(const struct table1 *table, const char *label, int gradient)
{
    print_label(label);
    for (int k = 0; k < TABLE1_COLUMNS; k++) {
        char text[TEXT_SIZE] = "-";
        const struct column *column = &table->columns[k];
        const double time = gradient ? column->paper_gradient : column->paper_matrix;
        if (time > 0)
            snprintf(text, sizeof text, "%.2f", time);
        print_cell(text);
    }
    printf("\n");
}

static void print_lattice(const struct table1 *table)
{
    const struct table1_options *options = &table->options;
    const int32_t side = options->source.side;
    char count[TEXT_SIZE], wanted[TEXT_SIZE];
    printf("particles  %s in a lattice of %d x %d x %d",
           text_grouped(table->particles.count, count), side, side, side);
    if (table->particles.count != options->wanted_particles)
        printf(" (the cube nearest to %s)", text_grouped(options->wanted_particles, wanted));
    printf(", spacing 1/128\n           ");
    if (options->source.jitter > 0)
        printf("each coordinate moved by up to %g spacings, ", options->source.jitter);
    printf("%s order, volume %s\n", options->source.shuffled ? "shuffled" : "lattice",
           table->particles.volume_origin);
}

static const char *linear_field(const struct table1 *table)
{
    return table->particles.dimension == 3 ? "v = (-y, x, 2z)" : "v = (-y, x)";
}

static void print_input(const struct table1 *table)
{
    char count[TEXT_SIZE];
    const struct particles *particles = &table->particles;
    printf("particles  %s of %s%s%s\n", text_grouped(particles->count, count),
           table->options.source.input, particles->flat[0] ? ", " : "", particles->flat);
    if (particles->more)
        printf("           the first of several frames in the file\n");
    printf("           columns %s\n", particles->columns);
    printf("           %s order, volume %s, timed field: %s\n",
           table->options.source.shuffled ? "shuffled" : "file's", table->particles.volume_origin,
           particles->own_velocities ? "the file's velocities" : linear_field(table));
}

static void print_set_up(const struct table1 *table)
{
    const struct table1_options *options = &table->options;
    printf("Table 1 of Westhofen, Jeske, Bender 2023, doi:10.1145/3606933\n\n");
    if (options->source.input)
        print_input(table);
    else
        print_lattice(table);
    printf("scheme     %s, H = %g%s, threshold 0.01 (blend), %s%s\n", kernel_title(options->kernel),
           options->support, options->source.input ? "" : " spacings",
           precision_names[options->source.precision],
           options->source.precision == PRECISION_MIXED ? ": positions f64, the rest f32" : "");
    printf("machine    %s, %d processor%s; %d thread%s, %s\n", machine_cpu(), machine_cpus(),
           machine_cpus() > 1 ? "s" : "", options->threads, options->threads > 1 ? "s" : "",
           library_isa());
    printf("program    sphgrad %s, %s, %s\n", library_version(), machine_compiler(),
           machine_build());
}

static void print_search(const struct table1 *table)
{
    char pairs[TEXT_SIZE], median[TEXT_SIZE], first[TEXT_SIZE], range[2 * TEXT_SIZE];
    const double count = table->particles.count;
    printf("pairs      %s, %.2f a particle; %.1f bytes a particle held by the neighbours\n",
           text_grouped(table->neighbors.pairs, pairs), (double)table->neighbors.pairs / count,
           (double)table->neighbors.bytes / count);
    const double search = samples_wall(&table->search).median;
    text_time(search, median);
    text_time(table->first_search, first);
    format_range(&table->search, range);
    printf("search     T_ns %s ms (%s)", median, range);
    if (table->neighbors.pairs > 0)
        printf(", %.3f ns a pair", 1e6 * search / (double)table->neighbors.pairs);
    printf("; the first, with allocation, %s ms\n", first);
}

/* How much longer a particle takes here than with the probe. */
static double over_probe(const struct table1 *table, const struct samples *samples,
                         enum probe_work work)
{
    return samples_wall(samples).median / table->particles.count /
           (samples_wall(&table->probe[work]).median / table->probe_count);
}

static void print_probe(const struct table1 *table)
{
    char matrices[TEXT_SIZE], gradient[TEXT_SIZE], count[TEXT_SIZE];
    const struct column *kgc = &table->columns[1];
    text_time(samples_wall(&table->probe[PROBE_MATRICES]).median, matrices);
    text_time(samples_wall(&table->probe[PROBE_GRADIENT]).median, gradient);
    printf("yardstick  %s and %s ms for matrices and gradient of %s particles by `limit --probe`;\n"
           "           a particle's T_mat and T_grad of KGC take %.2f and %.2f of its\n",
           matrices, gradient, text_grouped(table->probe_count, count),
           over_probe(table, &kgc->matrix, PROBE_MATRICES),
           over_probe(table, &kgc->gradient, PROBE_GRADIENT));
}

static void print_header(const struct table1 *table)
{
    printf("\nmedian of %d repetition%s after a warm-up, methods in turn; search not included\n\n",
           table->options.repetitions, table->options.repetitions > 1 ? "s" : "");
    print_label("");
    for (int k = 0; k < TABLE1_COLUMNS; k++)
        print_cell(method_names[table->columns[k].method]);
    printf("\n");
}

static void print_times(const struct table1 *table)
{
    static const char *const labels[] = {"T_mat   [ms]",         "T_grad  [ms]",
                                         "fused   [ms]",         "T_mat  +weights [ms]",
                                         "T_grad +weights [ms]", "fused  +weights [ms]"};
    static const char *const per_pair[] = {"T_mat   [ns a pair]", "T_grad  [ns a pair]",
                                           "fused   [ns a pair]"};
    for (int which = 0; which < 6; which++) {
        print_medians(table, labels[which], which);
        print_ranges(table, which);
    }
    printf("\n");
    for (int which = 0; which < 3; which++)
        print_per_pair(table, per_pair[which], which);
}

static void print_ranks(const struct table1 *table)
{
    static const char *const labels[] = {"rank 0", "rank 1", "rank 2", "rank 3"};
    printf("\n");
    for (int rank = 0; rank <= table->particles.dimension; rank++)
        print_counts(table, labels[rank], count_rank, rank);
    print_counts(table, "to the eigensolver", count_decomposed, 0);
}

static int some_are_deficient(const struct table1 *table)
{
    for (int k = 0; k < TABLE1_COLUMNS; k++)
        if (table->columns[k].method != SPHG_PLAIN &&
            table->columns[k].stats.rank[table->particles.dimension] != table->particles.count)
            return 1;
    return 0;
}

static void print_footer(const struct table1 *table, int deficient)
{
    int64_t not_finite = 0;
    for (int k = 0; k < TABLE1_COLUMNS; k++)
        not_finite += table->columns[k].not_finite;
    printf("\nerror: max |J_i - J|_F / |J|_F on %s over all particles%s rank %d%s\n",
           linear_field(table), deficient ? " of" : ", all of", (int)table->particles.dimension,
           deficient ? " (SPH: over all)" : "");
    if (table->options.source.input && table->options.source.precision == PRECISION_MIXED)
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

/* Volumes are what a file gets wrong most easily, and what lambda takes as it is. */
static void print_suspect(const struct table1 *table)
{
    const int32_t dimension = table->particles.dimension;
    const double count = table->particles.count, ratio = table->volume_ratio;
    const double neighbors = (double)table->neighbors.pairs / count;
    const struct column *kgc = &table->columns[1];
    if (!table->options.source.input || (double)kgc->stats.rank[dimension] >= count / 10)
        return;
    printf("\nHardly any particle has full rank. First suspect: ");
    if (neighbors < dimension)
        printf("--support, which leaves %.2g neighbours a particle.\n", neighbors);
    else
        printf("the unit of the volumes (mass / density),\nwhich are %.2g times what the positions "
               "give (1 / sum W).\n",
               ratio);
}

void table1_print(const struct table1 *table)
{
    const int deficient = some_are_deficient(table);
    print_set_up(table);
    print_search(table);
    print_probe(table);
    print_header(table);
    print_times(table);
    printf("\n");
    print_errors(table, "error of T_grad", 0);
    print_errors(table, "error of fused", 1);
    if (deficient || table->options.source.input)
        print_ranks(table);
    print_suspect(table);
    printf("\n");
    print_paper(table, "paper, T_mat  [ms]", 0);
    print_paper(table, "paper, T_grad [ms]", 1);
    print_footer(table, deficient);
}
