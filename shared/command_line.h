/* SPDX-License-Identifier: MIT */
/* The command line of a program, described by a table of its options: argp reads it, with one line
 * on stderr and exit status 2 for what is refused. */
#ifndef SHARED_COMMAND_LINE_H
#define SHARED_COMMAND_LINE_H
#include <stdbool.h>
#include <stdint.h>

enum {
    EXIT_REFUSED = 2 /* bad options or a bad input file */
};

enum option_kind {
    OPTION_FLAG,     /* bool */
    OPTION_WHOLE,    /* int32_t in [least, most] */
    OPTION_SEED,     /* uint64_t in [0, most] */
    OPTION_REAL,     /* double in [least, most] */
    OPTION_POSITIVE, /* double, finite and above 0 */
    OPTION_CHOICE,   /* an enumeration or int: which of the words */
    OPTION_TEXT,     /* const char * */
    OPTION_FILE,     /* const char *: opened before hours of measuring, not after */
    OPTION_FOLDER    /* const char *: made where it is missing; NULL: none */
};

struct command_option {
    const char *name; /* NULL ends a table */
    int letter;       /* of the short form; 0: there is none */
    const char *argument, *help;
    enum option_kind kind;
    void *value; /* holds the default */
    double least, most;
    const char *const *words; /* NULL-terminated */
    bool *given;              /* or NULL */
};

/* The last columns of a row: of what kind, and where its value goes. */
#define AS_FLAG(value)               OPTION_FLAG, &(value), 0, 0, NULL, NULL
#define AS_WHOLE(value, least, most) OPTION_WHOLE, &(value), least, most, NULL, NULL
#define AS_REAL(value, least, most)  OPTION_REAL, &(value), least, most, NULL, NULL
#define AS_POSITIVE(value)           OPTION_POSITIVE, &(value), 0, 0, NULL, NULL
#define AS_CHOICE(value, words)      OPTION_CHOICE, &(value), 0, 0, words, NULL
#define AS_TEXT(value)               OPTION_TEXT, &(value), 0, 0, NULL, NULL
#define AS_SEED(value, most)         OPTION_SEED, &(value), 0, most, NULL, NULL
#define AS_FILE(value)               OPTION_FILE, &(value), 0, 0, NULL, NULL
#define AS_FOLDER(value)             OPTION_FOLDER, &(value), 0, 0, NULL, NULL

/* What messages begin with. */
void command_line_program(const char *name);

/* What --help says behind the options. */
void command_line_end_help(const char *text);

/* Reads argv[1..]; argv[0] is the name shown by --help. Options only: anything else is refused.
 * Ends the program on a bad option and after --help, of which -h is the short form. */
void command_line_read(const struct command_option *options, const char *about, int argc,
                       char **argv);

/* Prints the line and exits. */
__attribute__((format(printf, 1, 2), noreturn)) void command_line_refuse(const char *format, ...);
#endif
