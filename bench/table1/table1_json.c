/* Table 1 for machines. */
#include "report/report_json.h"
#include "table1.h"

#include <stdio.h>

static void describe(struct report *report, const struct table1 *table)
{
    const struct table1_options *options = &table->options;
    const double count = table->particles.count;
    report_text(report, "particles_from",
                options->source.input ? options->source.input : "lattice");
    report_number(report, "particles", count);
    report_number(report, "dimension", table->particles.dimension);
    report_number(report, "pairs", (double)table->neighbors.pairs);
    report_number(report, "pairs_per_particle", (double)table->neighbors.pairs / count);
    report_number(report, "bytes_per_particle", (double)table->neighbors.bytes / count);
    report_text(report, "kernel", kernel_names[options->kernel]);
    report_text(report, "precision", precision_names[options->source.precision]);
    report_text(report, "order", options->source.shuffled ? "shuffled" : "lattice");
    report_number(report, "support_radius", table->support_radius);
    if (!options->source.input) {
        report_number(report, "support_spacings", options->support);
        report_number(report, "jitter", options->source.jitter);
    }
    report_number(report, "search_first_ms", table->first_search);
}

static void report_part(struct report *report, const struct column *column, const char *part,
                        const struct samples *samples, const double *error)
{
    char name[64];
    snprintf(name, sizeof name, "table1/%s/%s", method_names[column->method], part);
    const struct counter counters[] = {{error ? "error_max" : NULL, error ? *error : 0}, {NULL, 0}};
    report_benchmark(report, name, samples, counters);
}

void table1_write_json(const struct table1 *table, const char *path, const char *executable)
{
    struct report *report = report_create(executable, table->options.threads);
    describe(report, table);
    const struct counter none = {NULL, 0};
    report_benchmark(report, "table1/search", &table->search, &none);
    const struct counter probe_size[] = {{"particles", table->probe_count}, {NULL, 0}};
    report_benchmark(report, "probe/matrices", &table->probe[PROBE_MATRICES], probe_size);
    report_benchmark(report, "probe/gradient", &table->probe[PROBE_GRADIENT], probe_size);
    for (int k = 0; k < TABLE1_COLUMNS; k++) {
        const struct column *column = &table->columns[k];
        report_part(report, column, "matrix", &column->matrix, NULL);
        report_part(report, column, "gradient", &column->gradient, &column->gradient_error);
        report_part(report, column, "fused", &column->fused, &column->fused_error);
        report_part(report, column, "matrix+weights", &column->matrix_kept, NULL);
        report_part(report, column, "gradient+weights", &column->gradient_kept,
                    &column->kept_error);
        report_part(report, column, "fused+weights", &column->fused_kept, NULL);
    }
    report_write(report, path);
}
