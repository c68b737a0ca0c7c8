/* SPDX-License-Identifier: MIT */
#include "command_line.h"
#include <argp.h>
#include <errno.h>
#include <math.h>
#include <stdarg.h>
#include <stdio.h>
#include <stdlib.h>
#include <string.h>
#include <sys/stat.h>

enum { OPTIONS_MOST = 32, FIRST_KEY = 256 };

static const char *program = "";
static const char *end_of_help = "";

void command_line_program(const char *name)
{
    program = name;
}

void command_line_end_help(const char *text)
{
    end_of_help = text;
}

void command_line_refuse(const char *format, ...)
{
    va_list arguments;
    va_start(arguments, format);
    fprintf(stderr, "%s: ", program);
    vfprintf(stderr, format, arguments);
    fputc('\n', stderr);
    va_end(arguments);
    exit(EXIT_REFUSED);
}

/* ---- Values --------------------------------------------------------------------------------- */

static int64_t read_whole(const struct command_option *option, const char *text)
{
    char *end;
    errno = 0;
    const long long value = strtoll(text, &end, 10);
    if (end == text || *end != '\0')
        command_line_refuse("--%s: '%s' is not a whole number", option->name, text);
    if (errno == ERANGE || (double)value < option->least || (double)value > option->most)
        command_line_refuse("--%s: %s is not in [%.0f, %.0f]", option->name, text, option->least,
                            option->most);
    return value;
}

static double read_real(const struct command_option *option, const char *text)
{
    char *end;
    const double value = strtod(text, &end);
    if (end == text || *end != '\0' || !isfinite(value))
        command_line_refuse("--%s: '%s' is not a finite number", option->name, text);
    if (option->kind == OPTION_POSITIVE && value <= 0)
        command_line_refuse("--%s: %s is not positive", option->name, text);
    if (option->kind == OPTION_REAL && (value < option->least || value > option->most))
        command_line_refuse("--%s: %s is not in [%g, %g]", option->name, text, option->least,
                            option->most);
    return value;
}

static int read_choice(const struct command_option *option, const char *text)
{
    char list[256] = "";
    size_t length = 0;
    for (int k = 0; option->words[k]; ++k) {
        if (strcmp(text, option->words[k]) == 0)
            return k;
        if (length < sizeof list)
            length += (size_t)snprintf(list + length, sizeof list - length, "%s%s", k ? ", " : "",
                                       option->words[k]);
    }
    command_line_refuse("--%s: '%s' is none of %s", option->name, text, list);
}

static void read_value(const struct command_option *option, const char *text)
{
    int choice;
    switch (option->kind) {
    case OPTION_FLAG:
        *(bool *)option->value = true;
        break;
    case OPTION_WHOLE:
        *(int32_t *)option->value = (int32_t)read_whole(option, text);
        break;
    case OPTION_SEED:
        *(uint64_t *)option->value = (uint64_t)read_whole(option, text);
        break;
    case OPTION_REAL:
    case OPTION_POSITIVE:
        *(double *)option->value = read_real(option, text);
        break;
    case OPTION_CHOICE: /* enumerations are as large as int */
        choice = read_choice(option, text);
        memcpy(option->value, &choice, sizeof choice);
        break;
    default:
        *(const char **)option->value = text;
    }
    if (option->given)
        *option->given = true;
}

static void make_folder(const struct command_option *option, const char *path)
{
    struct stat status;
    if (mkdir(path, 0777) == 0)
        return;
    if (errno != EEXIST)
        command_line_refuse("--%s: cannot make %s: %s", option->name, path, strerror(errno));
    if (stat(path, &status) != 0 || !S_ISDIR(status.st_mode))
        command_line_refuse("--%s: %s is not a folder", option->name, path);
}

static void open_file(const struct command_option *option, const char *path)
{
    FILE *file = fopen(path, "a");
    if (!file)
        command_line_refuse("--%s: cannot write %s: %s", option->name, path, strerror(errno));
    fclose(file);
}

/* Once all options are known to be good. */
static void prepare_files(const struct command_option *options)
{
    for (; options->name; ++options) {
        if (options->kind != OPTION_FILE && options->kind != OPTION_FOLDER)
            continue;
        const char *path = *(const char **)options->value;
        if (path && options->kind == OPTION_FILE)
            open_file(options, path);
        else if (path)
            make_folder(options, path);
    }
}

/* ---- argp ----------------------------------------------------------------------------------- */

static int key_of(const struct command_option *options, int index)
{
    return options[index].letter ? options[index].letter : FIRST_KEY + index;
}

/* Without an error stream argp adds no second line to getopt's message. */
static error_t take(int key, char *text, struct argp_state *state)
{
    const struct command_option *options = state->input;
    if (key == ARGP_KEY_INIT)
        state->err_stream = NULL;
    if (key == ARGP_KEY_ARG)
        command_line_refuse("unexpected argument '%s'", text);
    for (int k = 0; options[k].name; ++k)
        if (key == key_of(options, k)) {
            read_value(&options[k], text);
            return 0;
        }
    return ARGP_ERR_UNKNOWN;
}

void command_line_read(const struct command_option *options, const char *about, int argc,
                       char **argv)
{
    static char help[] = "--help";
    struct argp_option described[OPTIONS_MOST + 1] = {{0}};
    char doc[1024];
    for (int k = 0; options[k].name && k < OPTIONS_MOST; ++k)
        described[k] = (struct argp_option){
            options[k].name, key_of(options, k), options[k].argument, 0, options[k].help, 0};
    snprintf(doc, sizeof doc, "%s\v%s", about, end_of_help);
    for (int k = 1; k < argc; ++k)
        if (strcmp(argv[k], "-h") == 0)
            argv[k] = help;
    const struct argp argp = {.options = described, .parser = take, .doc = doc};
    /* argp hands over its own copy of the pointer */
    if (argp_parse(&argp, argc, argv, ARGP_IN_ORDER, NULL, (void *)(uintptr_t)options))
        exit(EXIT_REFUSED);
    prepare_files(options);
}
