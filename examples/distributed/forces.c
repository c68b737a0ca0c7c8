/* SPDX-License-Identifier: MIT */
/* Forces of particles that are spread over many ranks, beside those found on one: for each method
 * the adjoint form of a stress and the symmetric form of a pressure, in double precision. The word
 * `forget` leaves out the exchange of corrections, and shows what the library cannot see. Start it
 * with mpirun. */
#include "cloud.h"
#include "gather.h"
#include "stop.h"
#include <sphgrad/sphgrad.h>
#include <stdio.h>
#include <stdlib.h>
#include <string.h>

static const char usage[] =
    "mpirun -n RANKS forces [SIDE] [slabs] [forget]\n"
    "  SIDE    particles along an edge of the cube (9)\n"
    "  slabs   cut into slabs, also where Zoltan's recursive bisection is there\n"
    "  forget  do not bring the corrections of ghosts\n";

struct wanted {
    int side;
    bool forget;
    cutter *cut;
};

static const struct {
    sphg_method method;
    const char *name;
} methods[] = {{SPHG_KGC, "KGC"}, {SPHG_MLS, "MLS"}, {SPHG_RKPM, "RKPM"}};
enum { METHODS = sizeof methods / sizeof *methods };

/* ---- Forces ---------------------------------------------------------------------------------- */

struct work {
    struct domain domain;
    sphg_context *context;
    sphg_neighbors *neighbors;
    sphg_scheme scheme;
    sphg_sources sources;
    struct cloud_particle *particles;
    double (*correction)[6]; /* own and ghosts */
    struct cloud_forces *forces;
};

static void need(const struct work *work, sphg_result result)
{
    if (result != SPHG_OK)
        stop(sphg_last_message(work->context));
}

static sphg_view of_particles(const double *first)
{
    return sphg_view_f64(first, sizeof(struct cloud_particle));
}

static void begin(struct work *work, MPI_Comm ranks, const struct wanted *wanted)
{
    struct domain *domain = &work->domain;
    const sphg_config config = {.threads = 1};
    *work = (struct work){.scheme = {.support_radius = 2.2}};
    cloud_make(domain, ranks, wanted->side);
    domain_settle(domain, work->scheme.support_radius, wanted->cut);
    const size_t own = (size_t)domain->own, all = own + (size_t)domain->ghosts;
    work->particles = (struct cloud_particle *)(void *)domain->items;
    work->correction = resized(NULL, all, sizeof *work->correction);
    work->forces = resized(NULL, own, sizeof *work->forces);
    need(work, sphg_context_create(SPHG_VERSION, &config, &work->context));
    need(work, sphg_neighbors_create(work->context, &work->neighbors));
    const sphg_geometry geometry =
        sphg_own_and_ghosts(of_particles(work->particles->x), domain->own, domain->ghosts);
    need(work, sphg_neighbors_search(work->context, work->neighbors, &work->scheme, &geometry));
    work->sources =
        (sphg_sources){.neighbors = work->neighbors,
                       .volume = of_particles(&work->particles->volume),
                       .density = of_particles(&work->particles->density),
                       .correction = sphg_view_f64(work->correction[0], sizeof *work->correction)};
}

static void end(struct work *work)
{
    sphg_neighbors_destroy(work->neighbors);
    sphg_context_destroy(work->context);
    domain_free(&work->domain);
    free(work->correction);
    free(work->forces);
}

/* Corrections of the own particles are computed, those of ghosts come from their owners. */
static void correct(struct work *work, bool forget)
{
    struct transfer transfer = {0};
    const size_t size = sizeof *work->correction;
    memset(work->correction, 0, (size_t)(work->domain.own + work->domain.ghosts) * size);
    need(work, sphg_correction(work->context, &work->scheme, &work->sources, NULL,
                               work->sources.correction, sphg_absent()));
    if (forget)
        return;
    domain_start(&work->domain, &transfer, work->correction, size, size);
    transfer_finish(&transfer);
    transfer_free(&transfer);
}

static void press(struct work *work)
{
    const sphg_view pressure = of_particles(&work->particles->pressure);
    const sphg_field field = {
        .shape = SPHG_SCALAR,
        .form = SPHG_SYMMETRIC,
        .at_sources = &pressure,
        .gradient = sphg_view_f64(work->forces->of[CLOUD_SYMMETRIC], sizeof *work->forces)};
    const sphg_request request = {
        .sources = &work->sources, .fields = &field, .set_count = 1, .field_count = 1};
    need(work, sphg_evaluate(work->context, &work->scheme, &request));
    need(work, sphg_force(work->context, &work->scheme, &work->sources, NULL, SPHG_SYM_TENSOR,
                          of_particles(work->particles->stress),
                          sphg_view_f64(work->forces->of[CLOUD_ADJOINT], sizeof *work->forces)));
}

/* By name, on rank 0. */
static struct cloud_forces *forces_of(struct work *work, sphg_method method,
                                      const struct wanted *wanted)
{
    const int own = work->domain.own, all = wanted->side * wanted->side * wanted->side;
    work->scheme.method = method;
    correct(work, wanted->forget);
    press(work);
    for (int k = 0; k < own; ++k)
        work->forces[k].name = work->particles[k].name;
    return gather_by_name(work->domain.ranks, work->forces, sizeof *work->forces, own, all);
}

/* ---- Verdict --------------------------------------------------------------------------------- */

static bool is_small(double error)
{
    return error <= 1e-12;
}

/* Fewer particles have no exact gradient: they are compared, and nothing is known of their work. */
static bool has_exact_gradients(int side)
{
    return side >= 4;
}

static bool judge(const char *name, const struct cloud_forces *many, const struct cloud_forces *one,
                  int side)
{
    const double adjoint = cloud_difference(many, one, side, CLOUD_ADJOINT);
    const double symmetric = cloud_difference(many, one, side, CLOUD_SYMMETRIC);
    printf("%-6s %10.1e %10.1e", name, adjoint, symmetric);
    bool good = is_small(adjoint) && is_small(symmetric);
    if (has_exact_gradients(side)) {
        const struct cloud_errors a = cloud_judge(many, side, CLOUD_ADJOINT);
        const struct cloud_errors s = cloud_judge(many, side, CLOUD_SYMMETRIC);
        printf("   %10.1e %10.1e   %10.1e %10.1e", a.momentum, s.momentum, a.work, s.work);
        good &=
            is_small(a.momentum) && is_small(s.momentum) && is_small(a.work) && is_small(s.work);
    }
    printf("%s\n", good ? "" : "   WRONG");
    return good;
}

static void print_head(const struct work *work, const struct wanted *wanted)
{
    const int all = wanted->side * wanted->side * wanted->side;
    const int rank_count = work->domain.rank_count;
    printf("%d particle%s on %d rank%s, %s; forces in the adjoint and the symmetric form%s\n\n",
           all, all > 1 ? "s" : "", rank_count, rank_count > 1 ? "s" : "",
           wanted->cut == cut_into_slabs ? "slabs" : "recursive bisection",
           wanted->forget ? ", corrections of ghosts forgotten" : "");
    printf("%-6s %21s", "", "beside one rank");
    if (has_exact_gradients(wanted->side))
        printf("   %21s   %21s", "momentum lost", "work beside the exact");
    putchar('\n');
}

/* On all ranks, and on rank 0 alone. Returns the status of the program. */
static int compare(int rank, const struct wanted *wanted)
{
    struct work many, one;
    bool good = true;
    begin(&many, MPI_COMM_WORLD, wanted);
    if (rank == 0) {
        begin(&one, MPI_COMM_SELF, wanted);
        print_head(&many, wanted);
    }
    for (int k = 0; k < METHODS; ++k) {
        struct cloud_forces *found = forces_of(&many, methods[k].method, wanted);
        if (rank == 0) {
            struct cloud_forces *expected = forces_of(&one, methods[k].method, wanted);
            good &= judge(methods[k].name, found, expected, wanted->side);
            free(expected);
        }
        free(found);
    }
    if (rank == 0)
        end(&one);
    end(&many);
    return good ? EXIT_SUCCESS : EXIT_FAILURE;
}

static bool read_words(int count, char **words, struct wanted *wanted)
{
    *wanted = (struct wanted){.side = 9, .cut = best_cut()};
    for (int k = 1; k < count; ++k) {
        char *end_of_number;
        const long side = strtol(words[k], &end_of_number, 10);
        if (strcmp(words[k], "slabs") == 0)
            wanted->cut = cut_into_slabs;
        else if (strcmp(words[k], "forget") == 0)
            wanted->forget = true;
        else if (*words[k] && !*end_of_number && side >= 1 && side <= 1000)
            wanted->side = (int)side;
        else
            return false;
    }
    return true;
}

int main(int count, char **words)
{
    struct wanted wanted;
    int rank, status = 2;
    MPI_Init(&count, &words);
    MPI_Comm_rank(MPI_COMM_WORLD, &rank);
    if (read_words(count, words, &wanted))
        status = compare(rank, &wanted);
    else if (rank == 0)
        fputs(usage, stderr);
    MPI_Bcast(&status, 1, MPI_INT, 0, MPI_COMM_WORLD);
    MPI_Finalize();
    return status;
}
