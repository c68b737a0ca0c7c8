/* Reading the command line: argp, with one line on stderr and exit status 2 for what is refused. */
#ifndef SPHGRAD_BENCH_OPTIONS_H
#define SPHGRAD_BENCH_OPTIONS_H
#include <argp.h>
#include <stdint.h>

enum {
    EXIT_REFUSED = 2 /* bad options or a bad input file */
};

/* Reads argv[1..] with argp's options; argv[0] is the name shown in messages. The commands take
 * options only: anything else is refused. */
void options_parse(const struct argp *argp, int argc, char **argv, void *input);

/* What --help says behind the options. */
void options_end_help(const char *text);

/* Prints the line and exits. */
__attribute__((format(printf, 1, 2), noreturn)) void options_refuse(const char *format, ...);

/* Values, refused with the option's name where they are not in range. */
int32_t option_integer(const char *name, const char *text, int32_t least, int32_t most);
double option_real(const char *name, const char *text, double least, double most);
double option_positive(const char *name, const char *text);
/* Opened before hours of measuring, not after. */
void option_writable(const char *name, const char *path);
void option_folder(const char *name, const char *path); /* made where it is missing */
int option_choice(const char *name, const char *text, const char *const choices[]);
#endif
