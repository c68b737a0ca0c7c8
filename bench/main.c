/* SPDX-License-Identifier: MIT */
/* sphgrad-bench: finds the command and hands over. */
#include "commands.h"
#include "command_line.h"
#include "library.h"
#include <stdio.h>
#include <stdlib.h>
#include <string.h>

struct command {
    const char *name, *summary;
    const char *meaning; /* what its tables say, in the last line of what it prints */
    command_function *run;
};

/* The first is the default. Durations are those of two cores. */
static const struct command commands[] = {
    {"table1", "time the corrections and gradients of a million particles (default, 15 s)",
     "the shorter, the sooner a step ends; a gradient is exact where its error is one of rounding",
     command_table1},
    {"fields", "error of plain and corrected derivatives on a square: tables, CSV, pictures (2 s)",
     "a field is exact where its error is one of rounding, and converges where the order is "
     "positive",
     command_fields},
    {"limit", "how near the library comes to the arithmetic limit of this machine (15 s)",
     "at 100 % the library would do nothing but the arithmetic that its formulas ask for",
     command_limit},
    {"forces", "time the operators that a solver iterates: forces and divergences (15 s)",
     "an iteration costs what its operators take; forces add up to nothing where their error is "
     "one of rounding",
     command_forces},
    {"lists", "time a pair of sums over a host's own lists, and of pairs written out (5 s)",
     "a host with lists of its own saves the build and pays what its rows take more than kept "
     "lists",
     command_lists},
    {"skip", "what it saves not to compute what a scene does not need (half a minute)",
     "what is left out is time saved; the same bits: what is still computed does not notice",
     command_skip},
    {"frontier",
     "run time against error of every way to a gradient: tables, CSV, picture (half a minute)",
     "who wants a smaller error than a way on the frontier gives has to pay for the next one",
     command_frontier},
    {"scaling",
     "time a particle over sizes, threads, neighbours, orders and clouds (a minute or two)",
     "where a column stays level, the time of a particle does not depend on what its group changes",
     command_scaling},
    {"stability",
     "sweeps into degenerate, distant and uneven particles: tables, CSV, pictures (a minute)",
     "every promise holds where ratios stay below their limits and the last three columns are 0",
     command_stability},
    {"solver", "time a matrix of the batches: moment inversion, eigenvalues, SVD (a minute or two)",
     "nothing can be faster than the copy, which moves the same numbers and computes nothing",
     command_solver},
};
enum { COMMANDS = sizeof commands / sizeof commands[0] };

static int print_overview(void)
{
    printf("Usage: sphgrad-bench [COMMAND] [OPTIONS]\n\n");
    for (int k = 0; k < COMMANDS; ++k)
        printf("  %-10s %s\n", commands[k].name, commands[k].summary);
    printf("\nsphgrad-bench COMMAND --help lists the options of a command.\n");
    return EXIT_SUCCESS;
}

static int run(const struct command *command, int argc, char **argv)
{
    char name[64]; /* in front of messages about options */
    snprintf(name, sizeof name, "sphgrad-bench %s", command->name);
    argv[0] = name;
    command_line_end_help(command->summary);
    const int status = command->run(argc, argv);
    printf("\nmeaning    %s\n", command->meaning);
    return status;
}

int main(int argc, char **argv)
{
    const char *first = argc > 1 ? argv[1] : "";
    command_line_program("sphgrad-bench");
    if (strcmp(first, "--help") == 0 || strcmp(first, "-?") == 0 || strcmp(first, "-h") == 0)
        return print_overview();
    if (strcmp(first, "--version") == 0 || strcmp(first, "-V") == 0)
        return printf("sphgrad-bench %s\n", library_version()) < 0;
    if (argc < 2 || first[0] == '-')
        return run(&commands[0], argc, argv);
    for (int k = 0; k < COMMANDS; ++k)
        if (strcmp(first, commands[k].name) == 0)
            return run(&commands[k], argc - 1, argv + 1);
    command_line_refuse("there is no command '%s' (sphgrad-bench --help lists them)", first);
}
