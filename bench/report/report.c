/* SPDX-License-Identifier: MIT */
#include "report.h"
#include "library.h"
#include "machine.h"
#include "numbers.h"
#include "text.h"
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

/* A number of a benchmark. */
struct counter {
    const char *name;
    double value;
};

struct counters {
    int count;
    struct counter list[TABLE_COLUMNS_MOST + 1]; /* and the time in its unit */
};

struct report *report_create(const struct settings *settings)
{
    struct report *report = allocate_or_exit(1, sizeof *report);
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

void report_lattice(struct report *report, int32_t count, double pairs)
{
    const struct settings *settings = report->settings;
    char text[TEXT_SIZE];
    printf("particles  %s, lattice jittered by %g spacings, H = %g spacings, %.2f pairs a particle",
           text_grouped(count, text), settings->jitter, settings->support, pairs);
    report_lattice_numbers(report, count, pairs);
}

void report_lattice_numbers(struct report *report, int32_t count, double pairs)
{
    const struct settings *settings = report->settings;
    report_number(report, "particles", count);
    report_number(report, "support_spacings", settings->support);
    report_number(report, "jitter", settings->jitter);
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
        printf(
            "BUSY       others ran: the program had %.0f %% of its processors' time, and the times "
            "are too long\n",
            100 * had);
}

static cJSON *add_entry(struct report *report, const char *name, const char *run_name,
                        const char *run_type)
{
    cJSON *entry = cJSON_CreateObject();
    cJSON_AddItemToArray(report->benchmarks, entry);
    cJSON_AddStringToObject(entry, "name", name);
    cJSON_AddNumberToObject(entry, "family_index", report->families);
    cJSON_AddNumberToObject(entry, "per_family_instance_index", 0);
    cJSON_AddStringToObject(entry, "run_name", run_name);
    cJSON_AddStringToObject(entry, "run_type", run_type);
    cJSON_AddNumberToObject(entry, "threads", report->settings->threads);
    return entry;
}

static void add_measured(cJSON *entry, double real, double cpu, const char *unit,
                         const struct counters *counters)
{
    cJSON_AddNumberToObject(entry, "real_time", real);
    cJSON_AddNumberToObject(entry, "cpu_time", cpu);
    cJSON_AddStringToObject(entry, "time_unit", unit);
    for (int k = 0; k < counters->count; ++k)
        cJSON_AddNumberToObject(entry, counters->list[k].name, counters->list[k].value);
}

static void add_repetition(struct report *report, const char *name, const struct samples *samples,
                           int32_t index, const struct counters *counters)
{
    cJSON *entry = add_entry(report, name, name, "iteration");
    cJSON_AddNumberToObject(entry, "repetitions", samples->count);
    cJSON_AddNumberToObject(entry, "repetition_index", index);
    cJSON_AddNumberToObject(entry, "iterations", 1);
    add_measured(entry, samples->values[index].wall, samples->values[index].cpu, "ms", counters);
}

static void add_aggregate(struct report *report, const char *name, const struct samples *samples,
                          const struct counter *aggregate, double cpu,
                          const struct counters *counters)
{
    char full_name[256];
    const int is_ratio = strcmp(aggregate->name, "cv") == 0;
    snprintf(full_name, sizeof full_name, "%s_%s", name, aggregate->name);
    cJSON *entry = add_entry(report, full_name, name, "aggregate");
    cJSON_AddNumberToObject(entry, "repetitions", samples->count);
    cJSON_AddNumberToObject(entry, "iterations", samples->count);
    cJSON_AddStringToObject(entry, "aggregate_name", aggregate->name);
    cJSON_AddStringToObject(entry, "aggregate_unit", is_ratio ? "percentage" : "time");
    add_measured(entry, aggregate->value, cpu, "ms", counters);
}

static void add_benchmark(struct report *report, const char *name, const struct samples *samples,
                          const struct counters *counters)
{
    for (int32_t index = 0; index < samples->count; ++index)
        add_repetition(report, name, samples, index, counters);
    if (samples->count == 1) {
        ++report->families;
        return;
    }
    const struct spread wall = samples_wall(samples), cpu = samples_cpu(samples);
    const struct counter aggregates[] = {
        {"mean", wall.mean},        {"median", wall.median},
        {"stddev", wall.deviation}, {"cv", wall.mean > 0 ? wall.deviation / wall.mean : 0},
        {"min", wall.min},          {"max", wall.max}};
    const double cpus[] = {cpu.mean,      cpu.median,
                           cpu.deviation, cpu.mean > 0 ? cpu.deviation / cpu.mean : 0,
                           cpu.min,       cpu.max};
    for (size_t k = 0; k < sizeof cpus / sizeof cpus[0]; ++k)
        add_aggregate(report, name, samples, &aggregates[k], cpus[k], counters);
    ++report->families;
}

static void add_counter(struct counters *counters, const char *name, double value)
{
    counters->list[counters->count++] = (struct counter){name, value};
}

/* What the times of a row have in common: the start of their names, and counters. */
static void describe_row(const struct table *table, int32_t row, char *name, size_t size,
                         struct counters *counters)
{
    const struct column *columns = table_columns(table);
    const struct cell *cells = table_row(table, row);
    size_t length = (size_t)snprintf(name, size, "%s", table_name(table));
    for (int c = 0; columns[c].head || columns[c].key; ++c) {
        if (!columns[c].key)
            continue;
        if (cells[c].kind == CELL_TEXT && length < size)
            length += (size_t)snprintf(name + length, size - length, "/%s", cells[c].text);
        if (cells[c].kind == CELL_NUMBER || cells[c].kind == CELL_COUNT)
            add_counter(counters, columns[c].key, cells[c].number);
    }
}

void report_times(struct report *report, const struct table *table)
{
    const struct column *columns = table_columns(table);
    for (int32_t row = 0; row < table_rows(table); ++row) {
        const struct cell *cells = table_row(table, row);
        char first[192], name[224];
        struct counters common = {0};
        describe_row(table, row, first, sizeof first, &common);
        for (int c = 0; columns[c].head || columns[c].key; ++c) {
            if (cells[c].kind != CELL_TIME || !columns[c].key)
                continue;
            struct counters counters = common;
            if (columns[c].unit)
                add_counter(&counters, columns[c].unit,
                            cells[c].number * samples_median(cells[c].samples));
            snprintf(name, sizeof name, "%s%s%s", first, *columns[c].key ? "/" : "",
                     columns[c].key);
            add_benchmark(report, name, cells[c].samples, &counters);
        }
    }
}

void report_table(struct report *report, const struct table *table)
{
    table_print(table);
    report_times(report, table);
}

static int write_text(const char *text, const char *path)
{
    FILE *file = fopen(path, "w");
    if (!file)
        return 0;
    const int written = fprintf(file, "%s\n", text) > 0;
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
    free(report);
}
