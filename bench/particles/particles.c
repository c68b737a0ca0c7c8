/* SPDX-License-Identifier: MIT */
#include "particles.h"
#include "tables/csv.h"
#include "lattice.h"
#include "command_line.h"
#include <math.h>

const double lattice_spacing = 1.0 / 128;

static struct particles create_lattice(const struct particle_source *source)
{
    const struct lattice lattice = {.dimension = source->dimension,
                                    .side = source->side,
                                    .spacing = lattice_spacing,
                                    .jitter = source->jitter,
                                    .shuffled = source->order == ORDER_SHUFFLED};
    const int32_t count = lattice_count(&lattice);
    struct particles particles = {
        .count = count,
        .dimension = source->dimension,
        .volume_origin = "spacing^3",
        .columns = "",
        .flat = "",
        .positions = numbers_create(position_type(source->precision), count, source->dimension),
        .volumes = numbers_create(field_type(source->precision), count, 1)};
    lattice_fill(&lattice, &particles.positions);
    for (int32_t i = 0; i < count; ++i)
        numbers_set(&particles.volumes, i, 0, pow(lattice_spacing, source->dimension));
    return particles;
}

/* Refuses what the precision cannot hold. */
static void store(struct numbers *numbers, int32_t i, int32_t component, double value,
                  const struct csv *csv)
{
    numbers_set(numbers, i, component, value);
    if (!isfinite(numbers_get(numbers, i, component)))
        command_line_refuse("%s, line %lld: %g is beyond the precision", csv->path,
                            (long long)csv->lines[i], value);
}

/* Where volumes come from: the file's, its densities with masses or --mass, or the positions. What
 * is not needed is not read. */
static const char *choose_volumes(const struct particle_source *source, struct csv *csv)
{
    const bool given = csv->columns[QUANTITY_VOLUME] >= 0;
    const bool densities = csv->columns[QUANTITY_DENSITY] >= 0;
    const bool masses = csv->columns[QUANTITY_MASS] >= 0 && source->mass <= 0;
    if (source->mass > 0 && (given || !densities))
        command_line_refuse("--mass: %s has %s", csv->path, given ? "volumes" : "no densities");
    const bool by_density = !given && densities && (masses || source->mass > 0);
    if (!by_density)
        csv->columns[QUANTITY_DENSITY] = -1;
    if (!by_density || !masses)
        csv->columns[QUANTITY_MASS] = -1;
    if (given)
        return "as given";
    if (by_density)
        return masses ? "mass / density" : "--mass / density";
    return densities ? "1 / sum W (densities want --mass)" : "1 / sum W";
}

static double volume_of(const struct particle_source *source, const struct csv *csv, int32_t row)
{
    const double *values = csv->values[row];
    const bool given = csv->columns[QUANTITY_VOLUME] >= 0;
    const double volume = values[QUANTITY_VOLUME], density = values[QUANTITY_DENSITY];
    const double mass = csv->columns[QUANTITY_MASS] >= 0 ? values[QUANTITY_MASS] : source->mass;
    if (given ? volume < 0 : density <= 0)
        command_line_refuse("%s, line %lld: the %s is %g", csv->path, (long long)csv->lines[row],
                            given ? "volume" : "density", given ? volume : density);
    if (!given && mass < 0)
        command_line_refuse("%s, line %lld: the mass is %g", csv->path, (long long)csv->lines[row],
                            mass);
    return given ? volume : mass / density;
}

static bool is_constant(const struct csv *csv, int axis)
{
    for (int32_t i = 1; i < csv->row_count; ++i)
        if (csv->values[i][QUANTITY_X + axis] != csv->values[0][QUANTITY_X + axis])
            return false;
    return true;
}

/* A file is in 2D if it has two coordinates, or one of three never changes: fills `axes` with those
 * that count. */
static void choose_axes(struct particles *particles, const struct csv *csv, int axes[3])
{
    int missing = 0, flat = 0, last = -1;
    for (int axis = 0; axis < 3; ++axis) {
        const bool absent = csv->columns[QUANTITY_X + axis] < 0;
        missing += absent;
        if (absent || is_constant(csv, axis)) {
            ++flat;
            last = axis;
        }
    }
    particles->dimension = missing || flat == 1 ? 2 : 3;
    if (missing)
        particles->flat = text_of("2D: the file has no %c", "xyz"[last]);
    else if (flat == 1)
        particles->flat =
            text_of("2D: all %c are %g", "xyz"[last], csv -> values[0][QUANTITY_X + last]);
    int count = 0;
    for (int axis = 0; axis < 3; ++axis)
        if (particles->dimension == 3 || axis != last)
            axes[count++] = axis;
}

static const char *names_of_columns(const struct csv *csv)
{
    const char *names = "";
    for (int quantity = 0; quantity < QUANTITIES; ++quantity) {
        char name[32];
        if (csv->columns[quantity] >= 0)
            names = text_of("%s%s%s", names, *names ? ", " : "",
                            csv_name(csv, (enum quantity)quantity, name, sizeof name));
    }
    return names;
}

static struct numbers read_vectors(const struct csv *csv, sphg_type type, int32_t dimension,
                                   enum quantity first, const int axes[3])
{
    struct numbers vectors = numbers_create(type, csv->row_count, dimension);
    for (int32_t i = 0; i < vectors.count; ++i)
        for (int32_t k = 0; k < dimension; ++k)
            store(&vectors, i, k, csv->values[i][(int)first + axes[k]], csv);
    return vectors;
}

static struct numbers read_volumes(const struct particle_source *source, const struct csv *csv)
{
    struct numbers volumes = numbers_create(field_type(source->precision), csv->row_count, 1);
    for (int32_t i = 0; i < volumes.count; ++i)
        store(&volumes, i, 0, volume_of(source, csv, i), csv);
    return volumes;
}

static struct particles read_particles(const struct particle_source *source)
{
    struct csv csv;
    if (!csv_open(&csv, source->input))
        command_line_refuse("%s", csv.message);
    struct particles particles = {.volume_origin = choose_volumes(source, &csv), .flat = ""};
    particles.columns = names_of_columns(&csv);
    if (!csv_read(&csv))
        command_line_refuse("%s", csv.message);
    int axes[3] = {0, 1, 2};
    choose_axes(&particles, &csv, axes);
    particles.count = csv.row_count;
    particles.more = csv.more;
    particles.positions =
        read_vectors(&csv, position_type(source->precision), particles.dimension, QUANTITY_X, axes);
    if (csv.columns[QUANTITY_VX + axes[0]] >= 0)
        particles.velocities = read_vectors(&csv, field_type(source->precision),
                                            particles.dimension, QUANTITY_VX, axes);
    if (csv.columns[QUANTITY_VOLUME] >= 0 || csv.columns[QUANTITY_DENSITY] >= 0)
        particles.volumes = read_volumes(source, &csv);
    csv_destroy(&csv);
    if (source->order == ORDER_SHUFFLED) {
        shuffle_rows(&particles.positions);
        shuffle_rows(&particles.velocities);
        shuffle_rows(&particles.volumes);
    }
    return particles;
}

struct particles particles_create(const struct particle_source *source)
{
    return source->input ? read_particles(source) : create_lattice(source);
}

struct scene scene_of_lattice(sphg_context *context, const struct settings *settings,
                              int32_t dimension)
{
    const struct particle_source source = {.dimension = dimension,
                                           .side = settings_side(settings->particles, dimension),
                                           .jitter = settings->jitter,
                                           .precision = settings->precision};
    const sphg_scheme scheme = {.dimension = dimension,
                                .support_radius = settings->support * lattice_spacing};
    const struct particles particles = particles_create(&source);
    return scene_open(context, &scheme, particles.positions, particles.volumes);
}
