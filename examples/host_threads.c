/* SPDX-License-Identifier: MIT */
/* Threads of the host, here two POSIX threads, instead of OpenMP's. Prints the error of a gradient,
 * and whether it has the same bits as on one thread. */
#include <sphgrad/sphgrad.h>
#include <math.h>
#include <pthread.h>
#include <stdio.h>
#include <string.h>

enum { SIDE = 10, COUNT = SIDE * SIDE * SIDE };

struct share { /* of a worker: the items [begin, end) */
    sphg_task *task;
    void *data;
    int32_t begin, end, worker;
};

static double x[COUNT][3], a[COUNT], gradient[2][COUNT][3];

static void *work(void *share)
{
    const struct share *mine = share;
    mine->task(mine->data, mine->begin, mine->end, mine->worker);
    return NULL;
}

/* The upper half of the items is worked on by a second thread. A host with a pool has more shares.
 */
static void parallel_for(sphg_task *task, void *data, int32_t count, int32_t grain, void *user)
{
    const int32_t middle = count / 2;
    struct share upper = {task, data, middle, count, 1};
    pthread_t thread;
    (void)user;
    if (count < 2 * grain || pthread_create(&thread, NULL, work, &upper) != 0) {
        task(data, 0, count, 0);
        return;
    }
    task(data, 0, middle, 0);
    pthread_join(thread, NULL);
}

int main(void)
{
    const double volume = 1;
    for (int i = 0; i < COUNT; ++i) { /* a lattice with spacing 1, and the field 2 x + 3 y - z */
        for (int k = 0, rest = i; k < 3; ++k, rest /= SIDE)
            x[i][k] = rest % SIDE;
        a[i] = 2 * x[i][0] + 3 * x[i][1] - x[i][2];
    }
    const sphg_config configs[2] = {{.threads = 1}, {.threads = 2, .parallel_for = parallel_for}};
    const sphg_view field = sphg_view_f64(a, sizeof a[0]);
    const sphg_scheme scheme = {.support_radius = 2};
    const sphg_geometry block = sphg_all(sphg_view_f64(x[0], sizeof x[0]), COUNT);
    int failed = 0;
    for (int k = 0; k < 2 && !failed; ++k) {
        sphg_context *context = NULL;
        sphg_neighbors *neighbors = NULL;
        failed = sphg_context_create(SPHG_VERSION, &configs[k], &context) ||
                 sphg_neighbors_create(context, &neighbors) ||
                 sphg_neighbors_search(context, neighbors, &scheme, &block);
        const sphg_sources sources = {.neighbors = neighbors, .volume = sphg_same_f64(&volume)};
        const sphg_view found = sphg_view_f64(gradient[k][0], sizeof gradient[k][0]);
        failed = failed || sphg_gradient(context, &scheme, &sources, NULL, field, found);
        sphg_neighbors_destroy(neighbors);
        sphg_context_destroy(context);
    }
    double error = 0;
    for (int i = 0; i < COUNT; ++i)
        error += fabs(gradient[1][i][1] - 3) / COUNT;
    const int same = memcmp(gradient[0], gradient[1], sizeof gradient[0]) == 0;
    printf("error %.1e, %s bits as on one thread\n", error, same ? "the same" : "other");
    return failed || !same || !(error < 1e-12);
}
