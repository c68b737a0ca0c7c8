/* SPDX-License-Identifier: MIT */
#include "drop.h"
#include "stop.h"
#include <math.h>
#include <stdlib.h>
#include <string.h>

const double drop_spin = 1, drop_velocity[3] = {.25, .15, .05};

/* Towards the middle, at distance 1. Turning takes half of it off sideways and nothing along the
 * axis: the drop is at rest where it is flattened, x^2 + y^2 + 2 z^2 <= 1, and has pressure 1/2 in
 * the middle. */
static const double attraction = 2;

static void need(const struct drop *drop, sphg_result result)
{
    if (result != SPHG_OK)
        stop(sphg_last_message(drop->context));
}

void drop_middle(const struct drop *drop, double middle[3])
{
    for (int a = 0; a < 3; ++a)
        middle[a] = drop_velocity[a] * drop->time;
}

double drop_mass(const struct drop *drop)
{
    return (double)drop->volume; /* the density at rest is 1 */
}

/* ---- The beginning --------------------------------------------------------------------------- */

static struct particle particle_at(const double x[3], int name)
{
    const double depth = 1 - x[0] * x[0] - x[1] * x[1] - 2 * x[2] * x[2];
    struct particle made = {.x = {x[0], x[1], x[2]}, .pressure = (float)(depth / 2), .name = name};
    made.v[0] = (float)(drop_velocity[0] - drop_spin * x[1]);
    made.v[1] = (float)(drop_velocity[1] + drop_spin * x[0]);
    made.v[2] = (float)drop_velocity[2];
    return made;
}

int drop_fill(int layers, int first, int share, struct particle *room)
{
    int name = 0, filled = 0;
    for (int k = -layers; k <= layers; ++k)
        for (int j = -layers; j <= layers; ++j)
            for (int i = -layers; i <= layers; ++i) {
                if (i * i + j * j + 2 * k * k > layers * layers)
                    continue;
                if (name++ % share != first)
                    continue;
                const double x[3] = {(double)i / layers, (double)j / layers, (double)k / layers};
                if (room)
                    room[filled] = particle_at(x, name - 1);
                ++filled;
            }
    return filled;
}

int drop_count(int layers)
{
    return drop_fill(layers, 0, 1, NULL);
}

static void make_particles(struct drop *drop, MPI_Comm ranks)
{
    int rank, rank_count;
    MPI_Comm_rank(ranks, &rank);
    MPI_Comm_size(ranks, &rank_count);
    const int layers = drop->given.layers, count = drop_fill(layers, rank, rank_count, NULL);
    struct particle *particles = resized(NULL, (size_t)count, sizeof *particles);
    drop_fill(layers, rank, rank_count, particles);
    domain_make(&drop->domain, ranks, particles, sizeof *particles, count);
    free(particles);
}

void drop_make(struct drop *drop, MPI_Comm ranks, const struct drop_case *given)
{
    *drop = (struct drop){.given = *given, .spacing = 1. / given->layers, .speed_of_sound = 10};
    const double support = 2 * drop->spacing;
    const sphg_config config = {.threads = 1}; /* a rank for each core */
    drop->scheme = (sphg_scheme){.support_radius = support};
    drop->skin = .3 * support;
    drop->time_step = .25 * support / (double)drop->speed_of_sound;
    drop->volume = (float)pow(drop->spacing, 3);
    drop->viscosity = .02f * drop->speed_of_sound * (float)support;
    need(drop, sphg_context_create(SPHG_VERSION, &config, &drop->context));
    need(drop, sphg_neighbors_create(drop->context, &drop->neighbors));
    make_particles(drop, ranks);
}

void drop_free(struct drop *drop)
{
    sphg_neighbors_destroy(drop->neighbors);
    sphg_context_destroy(drop->context);
    domain_free(&drop->domain);
    transfer_free(&drop->transfer);
    free(drop->second);
    free(drop->jacobian);
    free(drop->force);
}

/* ---- Ghosts and neighbours ------------------------------------------------------------------- */

static struct particle *particles(const struct drop *drop)
{
    return (struct particle *)(void *)drop->domain.items;
}

static sphg_geometry geometry(const struct drop *drop)
{
    sphg_geometry made =
        sphg_own_and_ghosts(sphg_view_f64(particles(drop)->x, sizeof(struct particle)),
                            drop->domain.own, drop->domain.ghosts);
    made.precision = SPHG_F32; /* of fields */
    made.skin = drop->skin;
    return made;
}

static void search(const struct drop *drop)
{
    const sphg_geometry here = geometry(drop);
    need(drop, sphg_neighbors_search(drop->context, drop->neighbors, &drop->scheme, &here));
}

int64_t drop_pairs(const struct drop *drop)
{
    sphg_neighbors_info info = {0};
    need(drop, sphg_neighbors_get_info(drop->context, drop->neighbors, &info));
    return info.pairs;
}

/* Own particles have moved, ghosts stand where they were seen last: their owners ask about them. */
static bool anybody_would_rebuild(const struct drop *drop)
{
    const sphg_geometry here = geometry(drop);
    int32_t rebuild = 0;
    need(drop, sphg_neighbors_would_rebuild(drop->context, drop->neighbors, &drop->scheme, &here,
                                            &rebuild));
    MPI_Allreduce(MPI_IN_PLACE, &rebuild, 1, MPI_INT32_T, MPI_MAX, drop->domain.ranks);
    return rebuild != 0;
}

/* All skins are to begin where the ghosts were chosen. A search over nobody gives the old one up.
 */
static void forget_the_skin(const struct drop *drop)
{
    sphg_geometry nobody = geometry(drop);
    nobody.source_count = nobody.target_count = 0;
    need(drop, sphg_neighbors_search(drop->context, drop->neighbors, &drop->scheme, &nobody));
}

static void settle(struct drop *drop, bool cut)
{
    const double begin = MPI_Wtime();
    struct domain *domain = &drop->domain;
    domain_settle(domain, drop->scheme.support_radius + drop->skin, cut ? drop->given.cut : NULL);
    const size_t own = (size_t)domain->own, all = own + (size_t)domain->ghosts;
    drop->second = resized(drop->second, all, sizeof *drop->second);
    drop->jacobian = resized(drop->jacobian, own, sizeof *drop->jacobian);
    drop->force = resized(drop->force, own, sizeof *drop->force);
    forget_the_skin(drop);
    ++drop->settled;
    drop->settling += MPI_Wtime() - begin;
}

static void start(struct drop *drop, void *from, size_t size, size_t stride)
{
    domain_start(&drop->domain, &drop->transfer, from, size, stride);
}

static void finish(struct drop *drop)
{
    const double begin = MPI_Wtime();
    transfer_finish(&drop->transfer);
    drop->waiting += MPI_Wtime() - begin;
}

/* Where everybody is now, and who is near whom. */
static void bring_positions(struct drop *drop, int step)
{
    const bool cut = step % drop->given.cut_every == 0;
    if (cut || anybody_would_rebuild(drop)) {
        settle(drop, cut);
        if (step == 0) /* from where they were made */
            drop->domain.moved = 0;
        return;
    }
    start(drop, particles(drop)->x, sizeof particles(drop)->x, sizeof(struct particle));
    finish(drop);
}

/* ---- A step ---------------------------------------------------------------------------------- */

static sphg_view of_second(const float *first)
{
    return sphg_view_f32(first, sizeof(struct second_message));
}

static sphg_sources sources(const struct drop *drop)
{
    return (sphg_sources){.neighbors = drop->neighbors,
                          .volume = sphg_same_f32(&drop->volume),
                          .correction = of_second(drop->second->correction)};
}

/* Corrections and velocity gradients of some of the own particles. */
static void differentiate(const struct drop *drop, const int32_t *targets, int count)
{
    sphg_sources set = sources(drop);
    const sphg_view velocities = sphg_view_f32(particles(drop)->v, sizeof(struct particle));
    const sphg_field field = {.shape = SPHG_VECTOR,
                              .at_sources = &velocities,
                              .gradient =
                                  sphg_view_f32(drop->jacobian[0][0], sizeof *drop->jacobian)};
    const sphg_subset subset = sphg_listed(targets, count);
    const sphg_request request = {.sources = &set,
                                  .fields = &field,
                                  .set_count = 1,
                                  .field_count = 1,
                                  .subset = &subset,
                                  .correction = set.correction};
    set.correction = sphg_absent();
    need(drop, sphg_evaluate(drop->context, &drop->scheme, &request));
}

static void press(const struct drop *drop, const int32_t *targets, int count)
{
    const sphg_sources set = sources(drop);
    const sphg_subset subset = sphg_listed(targets, count);
    need(drop, sphg_force(drop->context, &drop->scheme, &set, &subset, SPHG_SYM_TENSOR,
                          of_second(drop->second->stress),
                          sphg_view_f32(drop->force[0], sizeof *drop->force)));
}

/* Pressure rises where the fluid is compressed; stress is that and friction. */
static void stress(const struct drop *drop)
{
    static const int row[6] = {0, 0, 0, 1, 1, 2}, column[6] = {0, 1, 2, 1, 2, 2};
    const float stiffness = drop->speed_of_sound * drop->speed_of_sound;
    for (int i = 0; i < drop->domain.own; ++i) {
        float(*j)[3] = drop->jacobian[i];
        struct particle *p = &particles(drop)[i];
        p->pressure -= (float)drop->time_step * stiffness * (j[0][0] + j[1][1] + j[2][2]);
        for (int k = 0; k < 6; ++k) {
            const int a = row[k], b = column[k];
            drop->second[i].stress[k] =
                drop->viscosity * (j[a][b] + j[b][a]) - (a == b ? p->pressure : 0);
        }
    }
}

static void move(struct drop *drop)
{
    double middle[3];
    drop_middle(drop, middle);
    for (int i = 0; i < drop->domain.own; ++i) {
        struct particle *p = &particles(drop)[i];
        for (int a = 0; a < 3; ++a) {
            const double pull = attraction * (middle[a] - p->x[a]);
            const double push = (double)drop->force[i][a] / drop_mass(drop);
            p->v[a] += (float)(drop->time_step * (pull + push));
            p->x[a] += drop->time_step * (double)p->v[a];
        }
    }
    drop->time += drop->time_step;
}

/* Inner particles have no ghosts among their neighbours: they are computed while ghosts are under
 * way. */
static void advance(struct drop *drop, int step)
{
    const struct domain *domain = &drop->domain;
    bring_positions(drop, step);
    start(drop, particles(drop)->v, sizeof particles(drop)->v, sizeof(struct particle));
    search(drop);
    differentiate(drop, domain->inner, domain->inner_count);
    finish(drop);
    differentiate(drop, domain->outer, domain->outer_count);
    stress(drop);
    start(drop, drop->second, sizeof *drop->second, sizeof *drop->second);
    press(drop, domain->inner, domain->inner_count);
    finish(drop);
    press(drop, domain->outer, domain->outer_count);
    move(drop);
}

void drop_run(struct drop *drop)
{
    MPI_Barrier(drop->domain.ranks);
    const double begin = MPI_Wtime();
    for (int step = 0; step < drop->given.steps; ++step)
        advance(drop, step);
    MPI_Barrier(drop->domain.ranks);
    drop->seconds = MPI_Wtime() - begin;
}
