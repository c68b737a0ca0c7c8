/* SPDX-License-Identifier: MIT */
#define _POSIX_C_SOURCE 200809L /* popen, dup2, setenv */
#include "report.h"
#include "library.h"
#include <signal.h>
#include <stdarg.h>
#include <stdio.h>
#include <stdlib.h>
#include <string.h>
#include <unistd.h>

/* What no text has: before a line for report.py and in place of what is not there; and between. */
#define MARK  "\036"
#define COMMA "\037"

static FILE *reader;     /* report.py */
static int own_output;   /* what standard output was */
static bool has_columns; /* the table has a row */

void report_tell(const char *word, ...)
{
    va_list arguments;
    printf(MARK "%s", word);
    va_start(arguments, word);
    for (const char *text; (text = va_arg(arguments, const char *)) != NULL;)
        printf(COMMA "%s", text);
    va_end(arguments);
    putchar('\n');
    has_columns = has_columns && strcmp(word, "table") != 0;
}

static const char *name_of_compiler(void)
{
#if defined(__clang__)
    return __VERSION__;
#else
    return "GCC " __VERSION__;
#endif
}

static const char *name_of_build(void)
{
#ifdef NDEBUG
    return "release";
#else
    return "debug";
#endif
}

void report_open(const char *command, const struct settings *settings)
{
    setenv("SPHG_BENCH_REPORT", BENCH_FOLDER "/report/report.py", 1);
    signal(SIGPIPE, SIG_IGN); /* where report.py ends early, that is seen in report_close */
    fflush(stdout);
    own_output = dup(STDOUT_FILENO);
    reader = popen("exec python3 -B -X utf8 \"$SPHG_BENCH_REPORT\"", "w");
    if (own_output < 0 || !reader || dup2(fileno(reader), STDOUT_FILENO) < 0) {
        perror("sphgrad-bench: python3");
        exit(EXIT_FAILURE);
    }
    REPORT("open", command, settings->json ? settings->json : "");
    report_number("num_cpus", settings_processors());
    REPORT("text", "library_build_type", name_of_build());
    REPORT("text", "library_version", library_version());
    REPORT("text", "isa", library_isa());
    REPORT("text", "compiler", name_of_compiler());
    report_number("threads", settings->threads);
}

int report_close(void)
{
    REPORT("close");
    fflush(stdout);
    dup2(own_output, STDOUT_FILENO);
    return pclose(reader) == 0 ? EXIT_SUCCESS : EXIT_FAILURE;
}

void report_number(const char *name, double value)
{
    REPORT("number", name, text_of("%.17g", value));
}

void report_lattice(const struct settings *settings, int32_t count, double pairs)
{
    report_number("particles", count);
    report_number("support_spacings", settings->support);
    report_number("jitter", settings->jitter);
    report_number("pairs_per_particle", pairs);
}

void report_begin(const char *command, const struct settings *settings, int32_t count, double pairs,
                  const char *more)
{
    report_open(command, settings);
    report_lattice(settings, count, pairs);
    printf("particles  %s, lattice jittered by %g spacings, H = %g spacings, %.2f pairs a "
           "particle; %s\n",
           text_grouped(count), settings->jitter, settings->support, pairs, more);
    REPORT("machine");
}

void report_if_busy(const struct settings *settings, const struct samples *samples)
{
    const int32_t threads = settings->threads;
    const int32_t all = settings_processors(), processors = all < threads ? all : threads;
    const double had = samples_cpu(samples).median / (samples_wall(samples).median * processors);
    if (had < 0.8)
        printf("BUSY       others ran: the program had %.0f %% of its processors' time, and the "
               "times are too long\n",
               100 * had);
}

/* ---- Rows ----------------------------------------------------------------------------------- */

static void tell_column(const struct cell *cell)
{
    const char *const names[] = {cell->head, cell->key, cell->format, cell->unit};
    printf(MARK "column");
    for (int k = 0; k < 4; ++k)
        printf(COMMA "%s", names[k] ? names[k] : MARK);
    putchar('\n');
}

static void tell_cell(const struct cell *cell)
{
    printf(COMMA "%c", "-tncs"[cell->kind]);
    if (cell->kind == CELL_TEXT)
        printf("%s", cell->text);
    else if (cell->kind != CELL_NONE)
        printf("%.17g", cell->number);
    for (int32_t k = 0; cell->kind == CELL_TIME && k < cell->samples->count; ++k)
        printf(" %.17g %.17g", cell->samples->values[k].wall, cell->samples->values[k].cpu);
}

void table_add(const struct cell *cells, size_t count)
{
    for (size_t c = 0; c < count && !has_columns; ++c)
        tell_column(&cells[c]);
    has_columns = true;
    printf(MARK "row");
    for (size_t c = 0; c < count; ++c)
        tell_cell(&cells[c]);
    putchar('\n');
}

/* ---- Texts ---------------------------------------------------------------------------------- */

const char *text_of(const char *format, ...)
{
    va_list arguments;
    va_start(arguments, format);
    const size_t size = (size_t)vsnprintf(NULL, 0, format, arguments) + 1;
    va_end(arguments);
    char *text = allocate_to_the_end(1, size);
    va_start(arguments, format);
    vsnprintf(text, size, format, arguments);
    va_end(arguments);
    return text;
}

const char *text_grouped(int64_t value)
{
    return value < 1000 ? text_of("%d", (int)value)
                        : text_of("%s %03d", text_grouped(value / 1000), (int)(value % 1000));
}

const char *text_time(double milliseconds)
{
    const int decimals = milliseconds < 1 ? 3 : milliseconds < 100 ? 2 : milliseconds < 1000;
    return text_of("%.*f", decimals, milliseconds);
}
