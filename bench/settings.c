#include "settings.h"
#include "library.h"
#include "particles/names.h"
#include "options.h"

#include <math.h>

enum {
    KEY_PARTICLES = 512,
    KEY_THREADS,
    KEY_REPETITIONS,
    KEY_SUPPORT,
    KEY_JITTER,
    KEY_JSON,
    KEY_ISA
};

static const struct argp_option cloud_options[] = {
    {"particles", KEY_PARTICLES, "N", 0, "in the nearest cube or square", 0},
    {"support", KEY_SUPPORT, "H", 0, "support radius in spacings", 0},
    {"jitter", KEY_JITTER, "SHARE", 0, "move each coordinate by up to this share of the spacing",
     0},
    {"isa", KEY_ISA, "NAME", 0, "baseline, x86-64-v3, x86-64-v4 or neon (the best)", 0},
    {0}};

static const struct argp_option run_options[] = {
    {"threads", KEY_THREADS, "N", 0, "(OMP_NUM_THREADS, or one per processor)", 0},
    {"repetitions", KEY_REPETITIONS, "N", 0, "rounds through everything, after a warm-up", 0},
    {"json", KEY_JSON, "FILE", 0, "write all repetitions in Google Benchmark's format", 0},
    {0}};

void settings_choose_isa(const char *name)
{
    if (!library_choose_isa((sphg_isa)option_choice("isa", name, isa_names)))
        options_refuse("--isa: %s does not run here", name);
}

static error_t parse_run_option(int key, char *text, struct argp_state *state)
{
    struct settings *settings = state->input;
    switch (key) {
    case KEY_THREADS:
        settings->threads = option_integer("threads", text, 1, 1024);
        return 0;
    case KEY_REPETITIONS:
        settings->repetitions = option_integer("repetitions", text, 1, 10000);
        return 0;
    case KEY_JSON:
        settings->json = text;
        option_writable("json", text);
        return 0;
    default:
        return ARGP_ERR_UNKNOWN;
    }
}

const struct argp settings_run_argp = {.options = run_options, .parser = parse_run_option};

static error_t parse_cloud_option(int key, char *text, struct argp_state *state)
{
    struct settings *settings = state->input;
    switch (key) {
    case ARGP_KEY_INIT:
        state->child_inputs[0] = settings;
        return 0;
    case KEY_PARTICLES:
        settings->particles = option_integer("particles", text, 1, 1000000000);
        return 0;
    case KEY_SUPPORT:
        settings->support = option_real("support", text, 1.25, 8);
        return 0;
    case KEY_JITTER:
        settings->jitter = option_real("jitter", text, 0, 1);
        return 0;
    case KEY_ISA:
        settings_choose_isa(text);
        return 0;
    default:
        return ARGP_ERR_UNKNOWN;
    }
}

static const struct argp_child run_child[] = {{&settings_run_argp, 0, NULL, 0}, {NULL, 0, NULL, 0}};
const struct argp settings_argp = {
    .options = cloud_options, .parser = parse_cloud_option, .children = run_child};

int32_t settings_side(int32_t particles, int32_t dimension)
{
    const int32_t side = (int32_t)lround(pow((double)particles, 1.0 / dimension));
    return side > 1 ? side : 1;
}
