/* SPDX-License-Identifier: MIT */
#include "scaling_cloud.h"
#include "lattice.h"
#include "particles/particles.h"
#include "settings.h"
#include <math.h>

/* R = Rz(0.7) Ry(0.3) Rx(0.5), in 2D Rz alone: no axis stays near an axis or a diagonal. */
static void rotate(struct numbers *positions, double middle)
{
    const double a = 0.5, b = 0.3, c = 0.7;
    for (int32_t i = 0; i < positions->count; ++i) {
        double x[3] = {0, 0, 0};
        for (int32_t axis = 0; axis < positions->width; ++axis)
            x[axis] = numbers_get(positions, i, axis) - middle;
        if (positions->width == 3) {
            const double y = cos(a) * x[1] - sin(a) * x[2], z = sin(a) * x[1] + cos(a) * x[2];
            const double turned = cos(b) * x[0] + sin(b) * z;
            x[1] = y, x[2] = cos(b) * z - sin(b) * x[0], x[0] = turned;
        }
        const double turned[3] = {cos(c) * x[0] - sin(c) * x[1], sin(c) * x[0] + cos(c) * x[1],
                                  x[2]};
        for (int32_t axis = 0; axis < positions->width; ++axis)
            numbers_set(positions, i, axis, middle + turned[axis]);
    }
}

/* The layers of the lattice, pulled apart by three support radii. */
static void part_layers(struct numbers *positions, int32_t side, double support)
{
    const int32_t layer_size = positions->width == 3 ? side * side : side;
    const int32_t axis = positions->width - 1;
    for (int32_t i = 0; i < positions->count; ++i) {
        const double more = (3 * support - 1) * lattice_spacing * (i / layer_size);
        numbers_set(positions, i, axis, numbers_get(positions, i, axis) + more);
    }
}

/* Everyone anywhere in a cell of his own, so wide that three others are in reach. */
static void scatter(struct numbers *positions, int32_t side, double support)
{
    const double pi = 3.14159265358979323846;
    const double radius = support * lattice_spacing;
    const double width = positions->width == 3 ? radius * cbrt(4 * pi / 9) : radius * sqrt(pi / 3);
    for (int32_t i = 0; i < positions->count; ++i) {
        int32_t rest = i;
        for (int32_t axis = 0; axis < positions->width; ++axis, rest /= side)
            numbers_set(positions, i, axis,
                        width * (rest % side + lattice_random(3 * (int64_t)i + axis)));
    }
}

static struct cloud create_lattice(const struct cloud_setting *setting)
{
    const struct lattice lattice = {
        .dimension = setting->dimension,
        .side = settings_side(setting->particles, setting->dimension),
        .origin = setting->shape == CLOUD_FAR ? 1e5 * setting->support * lattice_spacing : 0,
        .spacing = lattice_spacing,
        .jitter = setting->shape == CLOUD_LATTICE ? 0 : setting->jitter};
    struct cloud cloud = {.positions =
                              numbers_create(SPHG_F32, lattice_count(&lattice), setting->dimension),
                          .volumes = numbers_create(SPHG_F32, 1, 1),
                          .support_radius = setting->support * lattice_spacing};
    numbers_set(&cloud.volumes, 0, 0, pow(lattice_spacing, setting->dimension));
    lattice_fill(&lattice, &cloud.positions);
    if (setting->shape == CLOUD_ROTATED)
        rotate(&cloud.positions, 0.5 * (lattice.side - 1) * lattice_spacing);
    if (setting->shape == CLOUD_SHEETS)
        part_layers(&cloud.positions, lattice.side, setting->support);
    if (setting->shape == CLOUD_SPRAY)
        scatter(&cloud.positions, lattice.side, setting->support);
    if (setting->shuffled)
        shuffle_rows(&cloud.positions);
    return cloud;
}

/* ---- Graded ---------------------------------------------------------------------------------- */

/* The spacing at x, which grows ratio times over the length. */
static double spacing_at(const struct cloud_setting *setting, double x, double length)
{
    return lattice_spacing * pow(setting->ratio, x / length);
}

static int32_t side_of_layer(double spacing, double length)
{
    return (int32_t)fmax(1, round(length / spacing));
}

/* A cube of that length holds so many. */
static double graded_count(const struct cloud_setting *setting, double length)
{
    double count = 0, spacing;
    for (double x = 0; x < length; x += spacing) {
        spacing = spacing_at(setting, x, length);
        count += pow(side_of_layer(spacing, length), 2);
    }
    return count;
}

/* The length of the cube that holds about as many particles as wanted. */
static double graded_length(const struct cloud_setting *setting)
{
    double low = lattice_spacing, high = setting->ratio * lattice_spacing * setting->particles;
    for (int k = 0; k < 60; ++k) {
        const double middle = sqrt(low * high);
        if (graded_count(setting, middle) < setting->particles)
            low = middle;
        else
            high = middle;
    }
    return high;
}

static void add_layer(const struct cloud_setting *setting, double x, double length, int32_t *next,
                      struct cloud *cloud)
{
    const double spacing = spacing_at(setting, x, length);
    const int32_t side = side_of_layer(spacing, length);
    const double width = length / side;
    for (int32_t k = 0; k < side * side; ++k) {
        const int32_t i = (*next)++;
        const double place[3] = {x, width * (k % side), width * (k / side)};
        for (int32_t axis = 0; axis < 3; ++axis)
            numbers_set(&cloud->positions, i, axis,
                        place[axis] + setting->jitter * spacing *
                                          (2 * lattice_random(3 * (int64_t)i + axis) - 1));
        numbers_set(&cloud->radii, i, 0, setting->support * spacing);
        numbers_set(&cloud->volumes, i, 0, spacing * width * width);
    }
}

static struct cloud create_graded(const struct cloud_setting *setting)
{
    const double length = graded_length(setting);
    const int32_t count = (int32_t)graded_count(setting, length);
    struct cloud cloud = {.positions = numbers_create(SPHG_F32, count, 3),
                          .radii = numbers_create(SPHG_F32, count, 1),
                          .volumes = numbers_create(SPHG_F32, count, 1),
                          .support_radius = setting->support * lattice_spacing * setting->ratio};
    int32_t next = 0;
    for (double x = 0; x < length; x += spacing_at(setting, x, length))
        add_layer(setting, x, length, &next, &cloud);
    return cloud;
}

struct cloud cloud_create(const struct cloud_setting *setting)
{
    return setting->shape == CLOUD_GRADED ? create_graded(setting) : create_lattice(setting);
}
