#define _POSIX_C_SOURCE 200809L /* fork, chdir */
#include "plot.h"

#include <errno.h>
#include <stdlib.h>
#include <string.h>
#include <sys/wait.h>
#include <unistd.h>

enum {
    STATUS_NO_PROGRAM = 127 /* as in the shell */
};

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
    for (; *parts; parts++)
        copy_part(file, *parts);
    plot_close(file, script);
    return plot_run(directory, script);
}

static void become_gnuplot(const char *directory, const char *script)
{
    if (chdir(directory) == 0)
        execlp("gnuplot", "gnuplot", script, (char *)NULL);
    _exit(STATUS_NO_PROGRAM);
}

bool plot_run(const char *directory, const char *script)
{
    int status = -1;
    fflush(NULL); /* or the child would print buffered text again */
    const pid_t child = fork();
    if (child == 0)
        become_gnuplot(directory, script);
    if (child < 0 || waitpid(child, &status, 0) < 0) {
        fprintf(stderr, "sphgrad-bench: cannot start gnuplot: %s\n", strerror(errno));
        return false;
    }
    if (WIFEXITED(status) && WEXITSTATUS(status) == 0)
        return true;
    if (WIFEXITED(status) && WEXITSTATUS(status) == STATUS_NO_PROGRAM)
        fprintf(stderr, "sphgrad-bench: no gnuplot here, so no pictures; the tables are written\n");
    else
        fprintf(stderr, "sphgrad-bench: gnuplot failed on %s/%s\n", directory, script);
    return false;
}
