/* SPDX-License-Identifier: MIT */
/* The commands of sphgrad-bench. A new one: a name here, a row in main.c, a folder. */
#ifndef SPHGRAD_BENCH_COMMANDS_H
#define SPHGRAD_BENCH_COMMANDS_H

/* argv[0] names the command, options follow. Returns the exit status. */
typedef int command_function(int argc, char **argv);
command_function command_table1, command_fields, command_limit, command_forces, command_lists,
    command_skip, command_frontier, command_scaling, command_stability, command_solver;
#endif
