/* SPDX-License-Identifier: MIT */
#define _POSIX_C_SOURCE 200809L /* fork, chdir */
#include "gnuplot.h"
#include <errno.h>
#include <stdio.h>
#include <string.h>
#include <sys/wait.h>
#include <unistd.h>

enum {
    STATUS_NO_PROGRAM = 127 /* as in the shell */
};

static void become_gnuplot(const char *folder, const char *script)
{
    if (chdir(folder) == 0)
        execlp("gnuplot", "gnuplot", script, (char *)NULL);
    _exit(STATUS_NO_PROGRAM);
}

bool gnuplot_run(const char *folder, const char *script)
{
    int status = -1;
    fflush(NULL); /* or the child would print buffered text again */
    const pid_t child = fork();
    if (child == 0)
        become_gnuplot(folder, script);
    if (child < 0 || waitpid(child, &status, 0) < 0) {
        fprintf(stderr, "cannot start gnuplot: %s\n", strerror(errno));
        return false;
    }
    if (WIFEXITED(status) && WEXITSTATUS(status) == 0)
        return true;
    if (WIFEXITED(status) && WEXITSTATUS(status) == STATUS_NO_PROGRAM)
        fprintf(stderr, "no gnuplot here, so no pictures; the tables are written\n");
    else
        fprintf(stderr, "gnuplot failed on %s/%s\n", folder, script);
    return false;
}
