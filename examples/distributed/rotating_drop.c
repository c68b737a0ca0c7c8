/* SPDX-License-Identifier: MIT */
/* A rotating drop on many ranks. It turns and travels through boxes that are cut anew now and then,
 * and is compared with the same drop on one rank. Start it with mpirun. */
#define _POSIX_C_SOURCE 199309L /* nanosleep */
#include "report.h"
#include "stop.h"
#include <limits.h>
#include <stdio.h>
#include <stdlib.h>
#include <string.h>
#include <time.h>

static const char usage[] =
    "mpirun -n RANKS rotating_drop [LAYERS [STEPS [CUT_EVERY [slabs]]]]\n"
    "  LAYERS     particles along the radius (12)\n"
    "  STEPS      (200)\n"
    "  CUT_EVERY  steps before space is cut into new boxes (25)\n"
    "  slabs      cut into slabs, also where Zoltan's recursive bisection is there\n";

/* A whole number from 1 to most, or 0. */
static int number(const char *word, int most)
{
    char *end;
    const long value = strtol(word, &end, 10);
    return *word && !*end && value >= 1 && value <= most ? (int)value : 0;
}

static bool read_case(int count, char **words, struct drop_case *given)
{
    int *const numbers[3] = {&given->layers, &given->steps, &given->cut_every};
    static const int most[3] = {500, INT_MAX, INT_MAX};
    *given = (struct drop_case){.layers = 12, .steps = 200, .cut_every = 25, .cut = best_cut()};
    for (int k = 1; k < count; ++k) {
        if (k == 4 && strcmp(words[k], "slabs") == 0)
            given->cut = cut_into_slabs;
        else if (k > 3 || !(*numbers[k - 1] = number(words[k], most[k - 1])))
            return false;
    }
    return true;
}

static struct report run(MPI_Comm ranks, const struct drop_case *given)
{
    struct drop drop;
    drop_make(&drop, ranks, given);
    drop_run(&drop);
    const struct report report = report_of(&drop);
    drop_free(&drop);
    return report;
}

static int compare(const struct report *many, const struct drop_case *given)
{
    struct report one = run(MPI_COMM_SELF, given);
    printf("A drop of %d particles, %d steps; boxes by %s, cut anew every %d steps.\n\n",
           many->count, given->steps,
           given->cut == cut_into_slabs ? "slabs" : "recursive bisection (Zoltan)",
           given->cut_every);
    table_print(many, &one, 1. / given->layers);
    const bool good = table_judge(many, &one, 1. / given->layers);
    report_free(&one);
    return good ? EXIT_SUCCESS : EXIT_FAILURE;
}

/* MPI would wait at full speed, and take the core from the rank that still works. */
static void wait_calmly(int *status)
{
    MPI_Request request;
    int done = 0;
    MPI_Ibcast(status, 1, MPI_INT, 0, MPI_COMM_WORLD, &request);
    while (MPI_Test(&request, &done, MPI_STATUS_IGNORE), !done)
        nanosleep(&(struct timespec){.tv_nsec = 10000000}, NULL);
}

int main(int count, char **words)
{
    struct drop_case given;
    int rank, status = EXIT_SUCCESS;
    MPI_Init(&count, &words);
    MPI_Comm_rank(MPI_COMM_WORLD, &rank);
    if (!read_case(count, words, &given)) {
        if (rank == 0)
            fputs(usage, stderr);
        MPI_Finalize();
        return 2;
    }
    struct report many = run(MPI_COMM_WORLD, &given);
    if (rank == 0)
        status = compare(&many, &given);
    wait_calmly(&status);
    report_free(&many);
    MPI_Finalize();
    return status;
}
