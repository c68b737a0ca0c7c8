/* SPDX-License-Identifier: MIT */
#include "report.h"
#include "library.h"
#include "machine.h"
#include "numbers.h"
#include <cjson/cJSON.h>
#include <errno.h>
#include <stdio.h>
#include <stdlib.h>
#include <string.h>

struct report {
    cJSON *root, *context, *benchmarks;
    const struct settings *settings;
    int32_t families;
};

struct report *report_create(const struct settings *settings)
{
    struct report *report = allocate_to_the_end(1, sizeof *report);
    report->settings = settings;
    report->root = cJSON_CreateObject();
    report->context = cJSON_AddObjectToObject(report->root, "context");
    report->benchmarks = cJSON_AddArrayToObject(report->root, "benchmarks");
    report_text(report, "date", machine_date());
    report_text(report, "host_name", machine_host());
    report_text(report, "executable", "sphgrad-bench");
    report_number(report, "num_cpus", machine_cpus());
    report_text(report, "library_build_type", machine_build());
    report_text(report, "library_version", library_version());
    report_text(report, "cpu_model", machine_cpu());
    report_text(report, "isa", library_isa());
    report_text(report, "compiler", machine_compiler());
    report_number(report, "threads", settings->threads);
    return report;
}

void report_text(struct report *report, const char *name, const char *value)
{
    cJSON_AddStringToObject(report->context, name, value);
}

void report_number(struct report *report, const char *name, double value)
{
    cJSON_AddNumberToObject(report->context, name, value);
}

/* ---- On the terminal ------------------------------------------------------------------------ */

void report_lattice(struct report *report, int32_t count, double pairs)
{
    const struct settings *settings = report->settings;
    printf("particles  %s, lattice jittered by %g spacings, H = %g spacings, %.2f pairs a particle",
           text_grouped(count), settings->jitter, settings->support, pairs);
    report_lattice_numbers(report, count, pairs);
}

void report_lattice_numbers(struct report *report, int32_t count, double pairs)
{
    report_number(report, "particles", count);
    report_number(report, "support_spacings", report->settings->support);
    report_number(report, "jitter", report->settings->jitter);
    report_number(report, "pairs_per_particle", pairs);
}

void report_machine(const struct report *report)
{
    const int32_t threads = report->settings->threads;
    printf("machine    %s, %d processor%s; %d thread%s, %s\n", machine_cpu(), machine_cpus(),
           machine_cpus() > 1 ? "s" : "", threads, threads > 1 ? "s" : "", library_isa());
    printf("program    sphgrad %s, %s, %s, %s\n", library_version(), machine_compiler(),
           machine_build(), machine_date());
}

void report_if_busy(const struct report *report, const struct samples *samples)
{
    const int32_t threads = report->settings->threads;
    const int32_t processors = machine_cpus() < threads ? machine_cpus() : threads;
    const double had = samples_cpu(samples).median / (samples_wall(samples).median * processors);
    if (had < 0.8)
        printf("BUSY       others ran: the program had %.0f %% of its processors' time, and the "
               "times are too long\n",
               100 * had);
}

void report_table(struct report *report, const struct table *table)
{
    table_print(table);
    report_times(report, table);
}

/* ---- For programs --------------------------------------------------------------------------- */

/* A time of a row: what all its entries say. */
struct benchmark {
    struct report *report;
    const char *name;
    const struct cell *cells, *time; /* of the row */
    int32_t cell_count;
};

/* Counters are the numbers of the row, and the median in the unit. */
static cJSON *add_entry(const struct benchmark *one, const char *name, const char *type,
                        double real, double cpu)
{
    const struct cell *time = one->time;
    cJSON *entry = cJSON_CreateObject();
    cJSON_AddItemToArray(one->report->benchmarks, entry);
    cJSON_AddStringToObject(entry, "name", name);
    cJSON_AddNumberToObject(entry, "family_index", one->report->families);
    cJSON_AddNumberToObject(entry, "per_family_instance_index", 0);
    cJSON_AddStringToObject(entry, "run_name", one->name);
    cJSON_AddStringToObject(entry, "run_type", type);
    cJSON_AddNumberToObject(entry, "threads", one->report->settings->threads);
    cJSON_AddNumberToObject(entry, "repetitions", time->samples->count);
    cJSON_AddNumberToObject(entry, "real_time", real);
    cJSON_AddNumberToObject(entry, "cpu_time", cpu);
    cJSON_AddStringToObject(entry, "time_unit", "ms");
    for (int32_t c = 0; c < one->cell_count; ++c)
        if (one->cells[c].key &&
            (one->cells[c].kind == CELL_NUMBER || one->cells[c].kind == CELL_COUNT))
            cJSON_AddNumberToObject(entry, one->cells[c].key, one->cells[c].number);
    if (time->unit)
        cJSON_AddNumberToObject(entry, time->unit, time->number * samples_median(time->samples));
    return entry;
}

static void add_benchmark(const struct benchmark *one)
{
    const struct samples *samples = one->time->samples;
    const struct spread wall = samples_wall(samples), cpu = samples_cpu(samples);
    const struct {
        const char *name;
        double wall, cpu;
    } aggregates[] = {{"mean", wall.mean, cpu.mean},
                      {"median", wall.median, cpu.median},
                      {"stddev", wall.deviation, cpu.deviation},
                      {"cv", wall.mean > 0 ? wall.deviation / wall.mean : 0,
                       cpu.mean > 0 ? cpu.deviation / cpu.mean : 0},
                      {"min", wall.min, cpu.min},
                      {"max", wall.max, cpu.max}};
    for (int32_t k = 0; k < samples->count; ++k) {
        cJSON *entry =
            add_entry(one, one->name, "iteration", samples->values[k].wall, samples->values[k].cpu);
        cJSON_AddNumberToObject(entry, "repetition_index", k);
        cJSON_AddNumberToObject(entry, "iterations", 1);
    }
    for (size_t k = 0; samples->count > 1 && k < sizeof aggregates / sizeof aggregates[0]; ++k) {
        const bool is_ratio = strcmp(aggregates[k].name, "cv") == 0;
        cJSON *entry = add_entry(one, table_text("%s_%s", one->name, aggregates[k].name),
                                 "aggregate", aggregates[k].wall, aggregates[k].cpu);
        cJSON_AddNumberToObject(entry, "iterations", samples->count);
        cJSON_AddStringToObject(entry, "aggregate_name", aggregates[k].name);
        cJSON_AddStringToObject(entry, "aggregate_unit", is_ratio ? "percentage" : "time");
    }
    ++one->report->families;
}

void report_times(struct report *report, const struct table *table)
{
    for (int32_t row = 0; row < table->row_count; ++row) {
        const struct cell *cells = table_row(table, row);
        const char *name = table->name;
        for (int32_t c = 0; c < table->column_count; ++c)
            if (cells[c].key && cells[c].kind == CELL_TEXT)
                name = table_text("%s/%s", name, cells[c].text);
        for (int32_t c = 0; c < table->column_count; ++c)
            if (cells[c].key && cells[c].kind == CELL_TIME)
                add_benchmark(&(struct benchmark){
                    .report = report,
                    .name = *cells[c].key ? table_text("%s/%s", name, cells[c].key) : name,
                    .cells = cells,
                    .time = &cells[c],
                    .cell_count = table->column_count});
    }
}

static bool write_text(const char *text, const char *path)
{
    FILE *file = fopen(path, "w");
    if (!file)
        return false;
    const bool written = fprintf(file, "%s\n", text) > 0;
    return fclose(file) == 0 && written;
}

void report_write(struct report *report)
{
    const char *path = report->settings->json;
    char *text = path ? cJSON_Print(report->root) : NULL;
    if (path && (!text || !write_text(text, path))) {
        fprintf(stderr, "sphgrad-bench: cannot write %s: %s\n", path, strerror(errno));
        exit(EXIT_FAILURE);
    }
    cJSON_free(text);
    cJSON_Delete(report->root);
}
