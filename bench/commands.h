/* SPDX-License-Identifier: MIT */
/* The commands of sphgrad-bench. A new one: a declaration here, a row in main.c, a file. */
#ifndef SPHGRAD_BENCH_COMMANDS_H
#define SPHGRAD_BENCH_COMMANDS_H

/* argv[0] names the command, options follow. Return the exit status. */
int command_table1(int argc, char **argv);
int command_fields(int argc, char **argv);
int command_limit(int argc, char **argv);
int command_forces(int argc, char **argv);
int command_lists(int argc, char **argv);
int command_skip(int argc, char **argv);
int command_frontier(int argc, char **argv);
int command_scaling(int argc, char **argv);
int command_stability(int argc, char **argv);
int command_solver(int argc, char **argv);
#endif
