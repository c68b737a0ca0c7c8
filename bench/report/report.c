/* SPDX-License-Identifier: MIT */
#define _POSIX_C_SOURCE 200809L /* popen, setenv */
#include "report.h"
#include "library.h"
#include <signal.h>
#include <stdio.h>
#include <stdlib.h>
#include <sys/wait.h>

/* report.py reads lines of words, between which stands what no word has. */
#define COMMA "\037"
static FILE *reader;
enum {
    BROKEN_PROMISES = 3
}; /* what report.py ends with where all is shown, but not as it should be */

#if defined(__clang__)
static const char compiler[] = __VERSION__;
#else
static const char compiler[] = "GCC " __VERSION__;
#endif
#ifdef NDEBUG
static const char build[] = "release";
#else
static const char build[] = "debug";
#endif

void report_open(const char *command, const struct settings *settings)
{
    setenv("SPHG_BENCH_REPORT", BENCH_FOLDER "/report/report.py", 1);
    signal(SIGPIPE, SIG_IGN); /* where report.py ends early, that is seen in report_close */
    fflush(stdout);
    reader = popen("exec python3 -B -X utf8 \"$SPHG_BENCH_REPORT\"", "w");
    if (!reader) {
        perror("sphgrad-bench: python3");
        exit(EXIT_FAILURE);
    }
    fprintf(reader, "open" COMMA "%s\n", command);
    report_number("num_cpus", settings_processors());
    report_text("library_build_type", build);
    report_text("library_version", library_version());
    report_text("isa", library_isa());
    report_text("compiler", compiler);
    report_number("threads", settings->threads);
    report_text(".json", settings->json ? settings->json : "");
    report_text(".output", settings->output ? settings->output : "");
    report_text(".kernel", kernel_names[settings->kernel]);
    report_text(".precision", precision_names[settings->precision]);
    report_number(".particles", settings->particles);
    report_number(".repetitions", settings->repetitions);
    report_number(".support", settings->support);
    report_number(".jitter", settings->jitter);
}

int report_close(void)
{
    fprintf(reader, "close\n");
    const int status = pclose(reader);
    if (status != 0 && !(WIFEXITED(status) && WEXITSTATUS(status) == BROKEN_PROMISES))
        exit(EXIT_FAILURE); /* it has said why */
    return status == 0 ? EXIT_SUCCESS : EXIT_FAILURE;
}

void report_text(const char *name, const char *value)
{
    fprintf(reader, "text" COMMA "%s" COMMA "%s\n", name, value);
}

void report_number(const char *name, double value)
{
    fprintf(reader, "number" COMMA "%s" COMMA "%.17g\n", name, value);
}

void report_lattice(const struct settings *settings, int32_t count, double pairs_per_particle)
{
    report_number("particles", count);
    report_number("support_spacings", settings->support);
    report_number("jitter", settings->jitter);
    report_number("pairs_per_particle", pairs_per_particle);
}

void table_begin(const char *name)
{
    fprintf(reader, "table" COMMA "%s\n", name);
}

void table_add(const struct cell *cells, size_t count)
{
    fprintf(reader, "row");
    for (const struct cell *cell = cells; cell < cells + count; ++cell) {
        fprintf(reader, COMMA "%s" COMMA "%c", cell->name, "-tncs"[cell->kind]);
        if (cell->kind == CELL_TEXT)
            fprintf(reader, "%s", cell->text);
        else if (cell->kind != CELL_NONE)
            fprintf(reader, "%.17g", cell->number);
        if (cell->kind == CELL_TIME)
            fprintf(reader, " %s", cell->unit ? cell->unit : "ms");
        for (int32_t k = 0; cell->kind == CELL_TIME && k < cell->samples->count; ++k)
            fprintf(reader, " %.17g %.17g", cell->samples->values[k].wall,
                    cell->samples->values[k].cpu);
    }
    fprintf(reader, "\n");
}
