#include "options.h"

#include <errno.h>
#include <math.h>
#include <stdarg.h>
#include <stdio.h>
#include <stdlib.h>
#include <string.h>
#include <sys/stat.h>

void options_refuse(const char *format, ...)
{
    va_list arguments;
    va_start(arguments, format);
    fputs("sphgrad-bench: ", stderr);
    vfprintf(stderr, format, arguments);
    fputc('\n', stderr);
    va_end(arguments);
    exit(EXIT_REFUSED);
}

static char end_of_help[128];

void options_end_help(const char *text)
{
    snprintf(end_of_help, sizeof end_of_help, "\v%s", text);
}

/* The outer parser: hands the input on and takes what is no option. Without an error stream argp
 * adds no second line to getopt's message. */
static error_t parse_outer(int key, char *text, struct argp_state *state)
{
    switch (key) {
    case ARGP_KEY_INIT:
        state->child_inputs[0] = state->input;
        state->err_stream = NULL;
        return 0;
    case ARGP_KEY_ARG:
        options_refuse("unexpected argument '%s'", text);
    default:
        return ARGP_ERR_UNKNOWN;
    }
}

void options_parse(const struct argp *argp, int argc, char **argv, void *input)
{
    static char help[] = "--help";
    for (int k = 1; k < argc; k++)
        if (strcmp(argv[k], "-h") == 0)
            argv[k] = help;
    const struct argp_child children[] = {{argp, 0, NULL, 0}, {NULL, 0, NULL, 0}};
    const struct argp outer = {.parser = parse_outer, .doc = end_of_help, .children = children};
    if (argp_parse(&outer, argc, argv, ARGP_IN_ORDER, NULL, input))
        exit(EXIT_REFUSED);
}

int32_t option_integer(const char *name, const char *text, int32_t least, int32_t most)
{
    char *end;
    errno = 0;
    const long long value = strtoll(text, &end, 10);
    if (end == text || *end != '\0')
        options_refuse("--%s: '%s' is not a whole number", name, text);
    if (errno == ERANGE || value < least || value > most)
        options_refuse("--%s: %s is not in [%d, %d]", name, text, least, most);
    return (int32_t)value;
}

static double read_real(const char *name, const char *text)
{
    char *end;
    const double value = strtod(text, &end);
    if (end == text || *end != '\0' || !isfinite(value))
        options_refuse("--%s: '%s' is not a finite number", name, text);
    return value;
}

double option_real(const char *name, const char *text, double least, double most)
{
    const double value = read_real(name, text);
    if (value < least || value > most)
        options_refuse("--%s: %s is not in [%g, %g]", name, text, least, most);
    return value;
}

double option_positive(const char *name, const char *text)
{
    const double value = read_real(name, text);
    if (value <= 0)
        options_refuse("--%s: %s is not positive", name, text);
    return value;
}

/* "a, b, c" */
static void join(const char *const choices[], char *list, size_t size)
{
    size_t length = 0;
    list[0] = '\0';
    for (int k = 0; choices[k] && length < size; k++)
        length += (size_t)snprintf(list + length, size - length, "%s%s", k ? ", " : "", choices[k]);
}

int option_choice(const char *name, const char *text, const char *const choices[])
{
    char list[256];
    for (int k = 0; choices[k]; k++)
        if (strcmp(text, choices[k]) == 0)
            return k;
    join(choices, list, sizeof list);
    options_refuse("--%s: '%s' is none of %s", name, text, list);
}

void option_writable(const char *name, const char *path)
{
    FILE *file = fopen(path, "a");
    if (!file)
        options_refuse("--%s: cannot write %s: %s", name, path, strerror(errno));
    fclose(file);
}

void option_folder(const char *name, const char *path)
{
    struct stat status;
    if (mkdir(path, 0777) == 0)
        return;
    if (errno != EEXIST)
        options_refuse("--%s: cannot make %s: %s", name, path, strerror(errno));
    if (stat(path, &status) != 0 || !S_ISDIR(status.st_mode))
        options_refuse("--%s: %s is not a folder", name, path);
}
