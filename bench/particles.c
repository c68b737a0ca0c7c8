#include "particles.h"
#include "csv.h"
#include "lattice.h"
#include "options.h"

#include <math.h>

const double lattice_spacing = 1.0 / 128;

static void create_tables(struct particles *particles, enum precision precision, int32_t count)
{
    particles->count = count;
    particles->positions = numbers_create(position_type(precision), count, 3);
    particles->velocities = numbers_create(field_type(precision), count, 3);
    particles->volumes = numbers_create(field_type(precision), count, 1);
}

void particles_linear_field(const struct particles *particles, struct numbers *field)
{
    for (int32_t i = 0; i < particles->count; i++) {
        numbers_set(field, i, 0, -numbers_get(&particles->positions, i, 1));
        numbers_set(field, i, 1, numbers_get(&particles->positions, i, 0));
        numbers_set(field, i, 2, 2 * numbers_get(&particles->positions, i, 2));
    }
}

static struct particles create_lattice(const struct particle_source *source)
{
    const struct lattice lattice = {.dimension = 3,
                                    .side = source->side,
                                    .spacing = lattice_spacing,
                                    .jitter = source->jitter,
                                    .shuffled = source->shuffled};
    struct particles particles = {.volume_origin = "spacing^3"};
    create_tables(&particles, source->precision, lattice_count(&lattice));
    lattice_fill(&lattice, &particles.positions);
    for (int32_t i = 0; i < particles.count; i++)
        numbers_set(&particles.volumes, i, 0, lattice_spacing * lattice_spacing * lattice_spacing);
    return particles;
}

/* What the program reads of a file; -1: not there. */
struct columns {
    int32_t position[3], velocity[3], density, volume;
};

static const char *const position_names[] = {"x", "y", "z", NULL};

static struct columns find_columns(const struct csv_table *table, const char *path)
{
    static const char *const velocity_names[] = {"vx", "vy", "vz"};
    struct columns columns = {.density = csv_column(table, "density"),
                              .volume = csv_column(table, "volume")};
    int32_t velocities = 0;
    for (int axis = 0; axis < 3; axis++) {
        columns.position[axis] = csv_column(table, position_names[axis]);
        columns.velocity[axis] = csv_column(table, velocity_names[axis]);
        velocities += columns.velocity[axis] >= 0;
    }
    if (velocities != 0 && velocities != 3)
        options_refuse("%s: vx, vy and vz belong together", path);
    return columns;
}

static double read_volume(const struct csv_table *table, const struct particle_source *source,
                          const struct columns *columns, int32_t row)
{
    const bool given = columns->volume >= 0;
    const double value = csv_value(table, row, given ? columns->volume : columns->density);
    if (given ? value < 0 : value <= 0)
        options_refuse("%s, line %lld: the %s is %g", source->input, (long long)table->lines[row],
                       given ? "volume" : "density", value);
    return given ? value : source->mass / value;
}

/* Refuses what the precision cannot hold. */
static void store(struct numbers *numbers, int32_t i, int32_t component, double value,
                  const char *path, const struct csv_table *table)
{
    numbers_set(numbers, i, component, value);
    if (!isfinite(numbers_get(numbers, i, component)))
        options_refuse("%s, line %lld: %g is beyond the precision", path,
                       (long long)table->lines[i], value);
}

static void read_volumes(struct particles *particles, const struct csv_table *table,
                         const struct particle_source *source, const struct columns *columns)
{
    const bool by_density = columns->volume < 0 && columns->density >= 0;
    if (by_density && source->mass <= 0)
        options_refuse("%s has densities: give the mass of a particle with --mass", source->input);
    if (!by_density && source->mass > 0)
        options_refuse("--mass: %s gives volumes, or no densities", source->input);
    if (!by_density && columns->volume < 0) {
        particles->volume_origin = "1 / sum W";
        numbers_destroy(&particles->volumes);
        return;
    }
    particles->volume_origin = by_density ? "mass / density" : "as given";
    for (int32_t i = 0; i < particles->count; i++)
        store(&particles->volumes, i, 0, read_volume(table, source, columns, i), source->input,
              table);
}

static void read_vectors(struct numbers *vectors, const struct csv_table *table,
                         const int32_t columns[3], const char *path)
{
    for (int32_t i = 0; i < vectors->count; i++)
        for (int32_t axis = 0; axis < 3; axis++)
            store(vectors, i, axis, csv_value(table, i, columns[axis]), path, table);
}

static struct particles read_particles(const struct particle_source *source)
{
    struct csv_table table;
    char message[512];
    if (!csv_read(source->input, position_names, &table, message, sizeof message))
        options_refuse("%s", message);
    const struct columns columns = find_columns(&table, source->input);
    struct particles particles = {.own_velocities = columns.velocity[0] >= 0};
    create_tables(&particles, source->precision, table.row_count);
    read_vectors(&particles.positions, &table, columns.position, source->input);
    if (particles.own_velocities)
        read_vectors(&particles.velocities, &table, columns.velocity, source->input);
    read_volumes(&particles, &table, source, &columns);
    csv_destroy(&table);
    if (source->shuffled) {
        shuffle_rows(&particles.positions);
        shuffle_rows(&particles.velocities);
        shuffle_rows(&particles.volumes);
    }
    return particles;
}

struct particles particles_create(const struct particle_source *source)
{
    struct particles particles = source->input ? read_particles(source) : create_lattice(source);
    if (!particles.own_velocities)
        particles_linear_field(&particles, &particles.velocities);
    return particles;
}

void particles_destroy(struct particles *particles)
{
    numbers_destroy(&particles->positions);
    numbers_destroy(&particles->velocities);
    numbers_destroy(&particles->volumes);
}
