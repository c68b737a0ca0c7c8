/* SPDX-License-Identifier: MIT */
/* bench_report FILE [NAME COUNTER LEAST MOST | ratio PART WHOLE MOST]...: the report parses, names
 * its machine, and holds nothing but finite numbers; every benchmark whose name contains NAME has
 * the COUNTER, in [LEAST, MOST], and there is at least one; the least processor time of PART is at
 * most MOST times that of WHOLE. */
#include <cjson/cJSON.h>
#include <math.h>
#include <stdio.h>
#include <stdlib.h>
#include <string.h>

static int failures;

static void complain(const char *what, const char *which)
{
    fprintf(stderr, "%s: %s\n", which, what);
    ++failures;
}

static char *read_file(const char *path)
{
    FILE *file = fopen(path, "r");
    if (!file || fseek(file, 0, SEEK_END) != 0)
        return NULL;
    const long size = ftell(file);
    char *text = malloc((size_t)size + 1);
    rewind(file);
    if (text)
        text[fread(text, 1, (size_t)size, file)] = '\0';
    fclose(file);
    return text;
}

static const char *name_of(const cJSON *benchmark)
{
    const char *name = cJSON_GetStringValue(cJSON_GetObjectItem(benchmark, "name"));
    return name ? name : "without a name";
}

/* cJSON writes null where a number is not finite. */
static void check_benchmark(const cJSON *benchmark)
{
    const cJSON *item;
    cJSON_ArrayForEach(item, benchmark) if (!cJSON_IsString(item) &&
                                            !(cJSON_IsNumber(item) && isfinite(item->valuedouble)))
        complain("neither text nor finite number", item->string);
    const cJSON *time = cJSON_GetObjectItem(benchmark, "real_time");
    if (!cJSON_IsNumber(time) || time->valuedouble < 0)
        complain("no time", name_of(benchmark));
}

static void check_context(const cJSON *root)
{
    static const char *const names[] = {"cpu_model", "host_name", "isa", "date", "compiler"};
    for (size_t k = 0; k < sizeof names / sizeof names[0]; ++k)
        if (!cJSON_IsString(cJSON_GetObjectItem(cJSON_GetObjectItem(root, "context"), names[k])))
            complain("not in the context", names[k]);
}

static void check_counter(const cJSON *benchmarks, char *const wanted[4])
{
    const double least = strtod(wanted[2], NULL), most = strtod(wanted[3], NULL);
    const cJSON *benchmark;
    int seen = 0;
    cJSON_ArrayForEach(benchmark, benchmarks)
    {
        if (!strstr(name_of(benchmark), wanted[0]))
            continue;
        const cJSON *counter = cJSON_GetObjectItem(benchmark, wanted[1]);
        ++seen;
        if (!cJSON_IsNumber(counter))
            complain(wanted[1], name_of(benchmark));
        else if (!(counter->valuedouble >= least && counter->valuedouble <= most)) {
            fprintf(stderr, "%s: %s is %g, not in [%g, %g]\n", name_of(benchmark), wanted[1],
                    counter->valuedouble, least, most);
            ++failures;
        }
    }
    if (seen == 0)
        complain("no such benchmark", wanted[0]);
}

/* The fastest of many repetitions: what a busy machine disturbs least. */
static double least_time(const cJSON *benchmarks, const char *run_name)
{
    const cJSON *benchmark;
    cJSON_ArrayForEach(benchmark, benchmarks)
    {
        const char *run = cJSON_GetStringValue(cJSON_GetObjectItem(benchmark, "run_name"));
        const char *kind = cJSON_GetStringValue(cJSON_GetObjectItem(benchmark, "aggregate_name"));
        if (run && kind && strcmp(run, run_name) == 0 && strcmp(kind, "min") == 0)
            return cJSON_GetNumberValue(cJSON_GetObjectItem(benchmark, "cpu_time"));
    }
    complain("no such benchmark", run_name);
    return NAN;
}

static void check_ratio(const cJSON *benchmarks, char *const wanted[4])
{
    const double part = least_time(benchmarks, wanted[1]),
                 whole = least_time(benchmarks, wanted[2]), most = strtod(wanted[3], NULL);
    printf("%-45s %.3f of %s, at most %s\n", wanted[1], part / whole, wanted[2], wanted[3]);
    if (!(part <= most * whole))
        complain("takes too large a share", wanted[1]);
}

int main(int argc, char **argv)
{
    char *text = argc > 1 ? read_file(argv[1]) : NULL;
    cJSON *root = text ? cJSON_Parse(text) : NULL;
    const cJSON *benchmarks = cJSON_GetObjectItem(root, "benchmarks"), *benchmark;
    if (cJSON_GetArraySize(benchmarks) == 0)
        complain("no report", argc > 1 ? argv[1] : "no file");
    check_context(root);
    cJSON_ArrayForEach(benchmark, benchmarks) check_benchmark(benchmark);
    for (int k = 2; k + 4 <= argc; k += 4)
        if (strcmp(argv[k], "ratio") == 0)
            check_ratio(benchmarks, argv + k);
        else
            check_counter(benchmarks, argv + k);
    cJSON_Delete(root);
    free(text);
    return failures > 0;
}
