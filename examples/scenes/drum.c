/* SPDX-License-Identifier: MIT */
#include "drum.h"
#include "bunny.h"
#include <math.h>
#include <stdlib.h>
#include <string.h>

static const double body_density = 900, soap_density = 1100, water_density = 1000;
static const double surface = -0.05; /* of the pool [m] */

/* ---- Drum ---- */

static void add_point(vector *points, int32_t *count, double x, double y, double z)
{
    double *point = points[(*count)++];
    point[0] = x;
    point[1] = y;
    point[2] = z;
}

static void add_mantle(double apart, vector *points, int32_t *count)
{
    const int32_t around = (int32_t)(6.283185307179586 * drum_radius / apart);
    const int32_t along = (int32_t)(drum_depth / apart) + 1;
    for (int32_t k = 0; k < around * along; ++k) {
        const double angle = 6.283185307179586 * (k % around) / around;
        const double z = drum_depth * ((double)(k / around) / (along - 1) - 0.5);
        add_point(points, count, drum_radius * cos(angle), drum_radius * sin(angle), z);
    }
}

static void add_ends(double apart, vector *points, int32_t *count)
{
    const int32_t half = (int32_t)(drum_radius / apart) + 1, side = 2 * half + 1;
    for (int32_t k = 0; k < side * side; ++k) {
        const double x = apart * (k % side - half), y = apart * (k / side - half);
        if (hypot(x, y) > drum_radius - 0.5 * apart)
            continue;
        add_point(points, count, x, y, -0.5 * drum_depth);
        add_point(points, count, x, y, 0.5 * drum_depth);
    }
}

struct wall drum_wall(const struct sph *sph, double spacing)
{
    const double apart = 0.6 * spacing;
    const int32_t per_length = (int32_t)(2 * drum_radius / apart) + 5;
    vector *points = array_new(8 * per_length * per_length, sizeof *points);
    int32_t count = 0;
    add_mantle(apart, points, &count);
    add_ends(apart, points, &count);
    return wall_new(sph, count, points);
}

void drum_turn(struct wall *wall, double angle, double omega)
{
    const double c = cos(angle), s = sin(angle);
    for (int32_t k = 0; k < wall->count; ++k) {
        double *x = wall->x[k], *v = wall->v[k];
        const double old = x[0];
        x[0] = c * old - s * x[1];
        x[1] = s * old + c * x[1];
        v[0] = -omega * x[1];
        v[1] = omega * x[0];
    }
}

bool drum_holds(const double *x)
{
    return hypot(x[0], x[1]) < drum_radius && fabs(x[2]) < 0.5 * drum_depth;
}

/* ---- Load ---- */

enum phase { NOTHING, BODY, SOAP, WATER };

static enum phase phase_at(const double *x, double spacing)
{
    const double margin = 0.9 * spacing; /* nearer to the wall a lattice would be compressed */
    if (hypot(x[0], x[1]) > drum_radius - margin || fabs(x[2]) > 0.5 * drum_depth - margin)
        return NOTHING;
    if (bunny_holds(x, spacing))
        return BODY;
    if (x[1] > surface)
        return NOTHING;
    return x[0] < -0.02 ? SOAP : WATER;
}

static void add_phase(struct load *load, enum phase phase, double spacing, double density,
                      uint64_t seed)
{
    struct random random = {seed};
    const int32_t half = (int32_t)(drum_radius / spacing) + 1, side = 2 * half + 1;
    for (int32_t k = 0; k < side * side * side; ++k) {
        vector x = {spacing * (k % side - half), spacing * (k / side % side - half),
                    spacing * (k / side / side - half)};
        if (phase_at(x, spacing) != phase)
            continue;
        for (int axis = 0; axis < 3; ++axis)
            x[axis] += spacing * random_between(&random, -2e-3, 2e-3);
        particles_set_rest_density(&load->all, load->all.count, density);
        memcpy(load->all.x[load->all.count++], x, sizeof x);
    }
}

struct load load_new(double spacing, uint64_t seed)
{
    struct load load = {0};
    const double volume = 3.141592653589793 * drum_radius * drum_radius * drum_depth;
    load.capacity = (int32_t)(volume / (spacing * spacing * spacing));
    load.all = particles_new(load.capacity, spacing * spacing * spacing);
    load.all.count = 0;
    add_phase(&load, BODY, spacing, body_density, seed);
    load.body = load.all.count;
    add_phase(&load, SOAP, spacing, soap_density, seed + 1);
    load.soap = load.all.count;
    add_phase(&load, WATER, spacing, water_density, seed + 2);
    return load;
}

void load_free(struct load *load)
{
    particles_free(&load->all);
}

static void reorder(int32_t count, const int32_t *from, void *values, size_t size)
{
    char *room = array_new(count, size);
    memcpy(room, values, (size_t)count * size);
    for (int32_t k = 0; k < count; ++k)
        memcpy((char *)values + (size_t)k * size, room + (size_t)from[k] * size, size);
    free(room);
}

/* What else particles have is the same in a phase, or found anew in each step. */
void load_sort(const struct sph *sph, struct load *load, const sphg_neighbors *neighbors,
               bool with_body)
{
    const int32_t count = load->all.count;
    int32_t *order = array_new(count, sizeof *order), *from = array_new(count, sizeof *from);
    int32_t filled[3] = {0, load->body, load->soap};
    sph_check(sph, sphg_neighbors_get_order(sph->context, neighbors, order));
    for (int32_t k = 0; k < count; ++k) {
        const int32_t i = order[k], phase = (i >= load->body) + (i >= load->soap);
        from[filled[phase]++] = i;
    }
    for (int32_t i = 0; !with_body && i < load->body; ++i)
        from[i] = i;
    reorder(count, from, load->all.x, sizeof *load->all.x);
    reorder(count, from, load->all.v, sizeof *load->all.v);
    reorder(count, from, load->all.change, sizeof *load->all.change);
    reorder(count, from, load->all.potential, sizeof *load->all.potential);
    free(order);
    free(from);
}

static bool is_room(const struct particles *all, const double *x, double spacing)
{
    for (int32_t i = 0; i < all->count; ++i) {
        vector off = {0};
        add_scaled(off, 1, all->x[i]);
        add_scaled(off, -1, x);
        if (dot(off, off) < spacing * spacing)
            return false;
    }
    return true;
}

/* A new particle at the end of the phase: of the water, or of the soap, whose next neighbour in
 * memory then goes to the end. */
static void add_particle(struct load *load, const double *x, double speed, double density)
{
    struct particles *all = &load->all;
    int32_t place = all->count++;
    if (density == soap_density) {
        const int32_t from = load->soap++;
        memcpy(all->x[place], all->x[from], sizeof all->x[place]);
        memcpy(all->v[place], all->v[from], sizeof all->v[place]);
        memcpy(all->change[place], all->change[from], sizeof all->change[place]);
        all->potential[place] = all->potential[from];
        particles_set_rest_density(all, place, water_density);
        place = from;
    }
    const vector down = {0, -speed, 0};
    memcpy(all->x[place], x, sizeof all->x[place]);
    memcpy(all->v[place], down, sizeof down);
    memset(all->change[place], 0, sizeof all->change[place]);
    all->potential[place] = 0;
    particles_set_rest_density(all, place, density);
}

static void pour(struct load *load, double x, double spacing, double speed, double density)
{
    const int32_t side = (int32_t)fmin(4, 0.15 / spacing) + 1;
    for (int32_t k = 0; k < side * side && load->all.count < load->capacity; ++k) {
        const vector at = {x + spacing * (k % side - 0.5 * (side - 1)), 0.3,
                           spacing * (k / side - 0.5 * (side - 1))};
        if (is_room(&load->all, at, 0.99 * spacing))
            add_particle(load, at, speed, density);
    }
}

void load_pour(struct load *load, double spacing, double speed)
{
    pour(load, -0.12, spacing, speed, soap_density);
    pour(load, 0.12, spacing, speed, water_density);
}
