#include "options.h"

#include <argp.h>
#include <errno.h>
#include <stdlib.h>
#include <string.h>
#include <sys/stat.h>

const char *const method_names[METHOD_COUNT] = {"sph", "kgc", "mls", "rkpm"};

static const struct argp_option described[] = {
    {"method", 'm', "NAME", 0, "kgc, mls or rkpm beside sph, or sph alone (default: kgc)", 0},
    {"alone", 'a', NULL, 0, "this method without sph beside it, and no picture", 0},
    {"size", 's', "NAME", 0, "quick or full (default: quick)", 0},
    {"seed", 'r', "N", 0, "of the random numbers (default: 1)", 0},
    {"threads", 't', "N", 0,
     "methods in turn on so many threads (default: quick sizes run methods side by side, each on "
     "one; full sizes on all, or on one while particles are few)",
     0},
    {"output", 'o', "DIR", 0, "write pictures, tables and particles there", 0},
    {"check", 'c', NULL, 0, "compare with the gates of this scene; status 1 if one fails", 0},
    {"brief", 'b', NULL, 0,
     "measure the beginning and do not simulate; --check then takes the gates on that", 0},
    {0}};

static int one_of(struct argp_state *state, const char *text, const char *const names[], int count)
{
    for (int k = 0; k < count; k++)
        if (strcmp(text, names[k]) == 0)
            return k;
    argp_failure(state, 2, 0, "'%s' is none of the choices; --help lists them", text);
    return 0;
}

static int64_t whole_number(struct argp_state *state, const char *text, int64_t most)
{
    char *end;
    errno = 0;
    const long long value = strtoll(text, &end, 10);
    if (end == text || *end || errno || value < 0 || value > most)
        argp_failure(state, 2, 0, "'%s' is not a whole number from 0 to %lld", text,
                     (long long)most);
    return value;
}

static const char *directory(struct argp_state *state, const char *path)
{
    struct stat status;
    if (mkdir(path, 0777) != 0 && errno != EEXIST)
        argp_failure(state, 2, errno, "%s", path);
    if (stat(path, &status) != 0 || !S_ISDIR(status.st_mode))
        argp_failure(state, 2, 0, "%s is no directory", path);
    return path;
}

static error_t take(int key, char *text, struct argp_state *state)
{
    static const char *const sizes[] = {"quick", "full"};
    struct options *options = state->input;
    switch (key) {
    case 'm':
        options->method = (enum method)one_of(state, text, method_names, METHOD_COUNT);
        options->method_given = true;
        return 0;
    case 's':
        options->full = one_of(state, text, sizes, 2) == 1;
        return 0;
    case 'r':
        options->seed = (uint64_t)whole_number(state, text, INT64_MAX);
        return 0;
    case 't':
        options->threads = (int32_t)whole_number(state, text, 4096);
        return 0;
    case 'o':
        options->output = directory(state, text);
        return 0;
    case 'c':
        options->check = true;
        return 0;
    case 'b':
        options->brief = true;
        return 0;
    case 'a':
        options->alone = true;
        return 0;
    case ARGP_KEY_END:
        if (options->check && options->alone)
            argp_error(state, "gates compare with sph: --check cannot go with --alone");
        if (options->brief && options->output)
            argp_error(state, "--brief has nothing to write to --output");
        return 0;
    default:
        return ARGP_ERR_UNKNOWN;
    }
}

struct options options_read(const char *scene, const char *about, int argc, char **argv)
{
    struct options options = {.scene = scene, .seed = 1, .method = KGC};
    const struct argp argp = {.options = described, .parser = take, .doc = about};
    static char help[] = "--help";
    for (int k = 1; k < argc; k++)
        if (strcmp(argv[k], "-h") == 0)
            argv[k] = help;
    argp_err_exit_status = 2;
    argp_parse(&argp, argc, argv, 0, NULL, &options);
    return options;
}
