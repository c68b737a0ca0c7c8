/* SPDX-License-Identifier: MIT */
#include "plot.h"
#include "gnuplot.h"
#include "table.h"
#include <errno.h>
#include <stdlib.h>
#include <string.h>

FILE *plot_file(const char *directory, const char *name)
{
    char path[4096];
    const int length = snprintf(path, sizeof path, "%s/%s", directory, name);
    FILE *file = length < (int)sizeof path ? fopen(path, "w") : NULL;
    if (!file) {
        fprintf(stderr, "sphgrad-bench: cannot write %s/%s: %s\n", directory, name,
                strerror(errno));
        exit(EXIT_FAILURE);
    }
    return file;
}

void plot_close(FILE *file, const char *name)
{
    const bool failed = ferror(file) != 0;
    if (fclose(file) == 0 && !failed)
        return;
    fprintf(stderr, "sphgrad-bench: cannot write %s: %s\n", name, strerror(errno));
    exit(EXIT_FAILURE);
}

static void copy_part(FILE *to, const char *name)
{
    char path[4096], line[1024];
    snprintf(path, sizeof path, "%s/%s", BENCH_FOLDER, name);
    FILE *from = fopen(path, "r");
    if (!from) {
        fprintf(stderr, "sphgrad-bench: cannot read %s: %s\n", path, strerror(errno));
        exit(EXIT_FAILURE);
    }
    while (fgets(line, sizeof line, from))
        fputs(line, to);
    fclose(from);
}

bool plot_draw(const char *directory, const char *script, const char *assignments,
               const char *const parts[])
{
    FILE *file = plot_file(directory, script);
    fputs(assignments, file);
    for (; *parts; ++parts)
        copy_part(file, *parts);
    plot_close(file, script);
    return gnuplot_run(directory, script);
}

void plot_written(const char *directory, const char *path, const char *tables,
                  const char *assignments)
{
    const char *name = strrchr(path, '/') + 1;
    const char *const parts[] = {table_text("%s.gp", path), NULL};
    const bool drawn = plot_draw(directory, table_text("%s.gp", name), assignments, parts);
    printf("\nwritten to %s: %s, %s.gp%s\n", directory, tables, name,
           drawn ? table_text(", %s.png", name) : "");
}
