#include "report_json.h"
#include "library.h"
#include "machine.h"
#include "particles/numbers.h"

#include <cjson/cJSON.h>
#include <errno.h>
#include <stdio.h>
#include <stdlib.h>
#include <string.h>

struct report {
    cJSON *root, *context, *benchmarks;
    int32_t threads, families;
};

struct report *report_create(const char *executable, int32_t threads)
{
    struct report *report = allocate_or_exit(1, sizeof *report);
    report->threads = threads;
    report->root = cJSON_CreateObject();
    report->context = cJSON_AddObjectToObject(report->root, "context");
    report->benchmarks = cJSON_AddArrayToObject(report->root, "benchmarks");
    report_text(report, "date", machine_date());
    report_text(report, "host_name", machine_host());
    report_text(report, "executable", executable);
    report_number(report, "num_cpus", machine_cpus());
    report_text(report, "library_build_type", machine_build());
    report_text(report, "library_version", library_version());
    report_text(report, "cpu_model", machine_cpu());
    report_text(report, "isa", library_isa());
    report_text(report, "compiler", machine_compiler());
    report_number(report, "threads", threads);
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
    cJSON_AddNumberToObject(entry, "threads", report->threads);
    return entry;
}

static void add_measured(cJSON *entry, double real, double cpu, const char *unit,
                         const struct counter *counters)
{
    cJSON_AddNumberToObject(entry, "real_time", real);
    cJSON_AddNumberToObject(entry, "cpu_time", cpu);
    cJSON_AddStringToObject(entry, "time_unit", unit);
    for (; counters->name; counters++)
        cJSON_AddNumberToObject(entry, counters->name, counters->value);
}

static void add_repetition(struct report *report, const char *name, const struct samples *samples,
                           int32_t index, const struct counter *counters)
{
    cJSON *entry = add_entry(report, name, name, "iteration");
    cJSON_AddNumberToObject(entry, "repetitions", samples->count);
    cJSON_AddNumberToObject(entry, "repetition_index", index);
    cJSON_AddNumberToObject(entry, "iterations", 1);
    add_measured(entry, samples->values[index].wall, samples->values[index].cpu, "ms", counters);
}

static void add_aggregate(struct report *report, const char *name, const struct samples *samples,
                          const struct counter *aggregate, double cpu,
                          const struct counter *counters)
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

void report_benchmark(struct report *report, const char *name, const struct samples *samples,
                      const struct counter *counters)
{
    if (samples->count == 0)
        return;
    for (int32_t index = 0; index < samples->count; index++)
        add_repetition(report, name, samples, index, counters);
    const struct spread wall = samples_wall(samples), cpu = samples_cpu(samples);
    const struct counter aggregates[] = {
        {"mean", wall.mean},        {"median", wall.median},
        {"stddev", wall.deviation}, {"cv", wall.mean > 0 ? wall.deviation / wall.mean : 0},
        {"min", wall.min},          {"max", wall.max}};
    const double cpus[] = {cpu.mean,      cpu.median,
                           cpu.deviation, cpu.mean > 0 ? cpu.deviation / cpu.mean : 0,
                           cpu.min,       cpu.max};
    for (size_t k = 0; k < sizeof cpus / sizeof cpus[0]; k++)
        add_aggregate(report, name, samples, &aggregates[k], cpus[k], counters);
    report->families++;
}

void report_once(struct report *report, const char *name, struct moment time,
                 const struct counter *counters)
{
    cJSON *entry = add_entry(report, name, name, "iteration");
    cJSON_AddNumberToObject(entry, "repetitions", 1);
    cJSON_AddNumberToObject(entry, "repetition_index", 0);
    cJSON_AddNumberToObject(entry, "iterations", 1);
    add_measured(entry, time.wall, time.cpu, "ms", counters);
    report->families++;
}

static int write_text(const char *text, const char *path)
{
    FILE *file = fopen(path, "w");
    if (!file)
        return 0;
    const int written = fprintf(file, "%s\n", text) > 0;
    return fclose(file) == 0 && written;
}

void report_write(struct report *report, const char *path)
{
    char *text = cJSON_Print(report->root);
    if (!text || !write_text(text, path)) {
        fprintf(stderr, "sphgrad-bench: cannot write %s: %s\n", path, strerror(errno));
        exit(EXIT_FAILURE);
    }
    cJSON_free(text);
    cJSON_Delete(report->root);
    free(report);
}
