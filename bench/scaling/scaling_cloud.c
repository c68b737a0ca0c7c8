#include "scaling_cloud.h"
#include "particles/lattice.h"
#include "particles/particles.h"
#include "settings.h"

#include <math.h>

/* R = Rz(0.7) Ry(0.3) Rx(0.5), in 2D Rz alone: no axis stays near an axis or a diagonal. */
static void rotate(struct numbers *positions, double middle)
{
    const double a = 0.5, b = 0.3, c = 0.7;
    for (int32_t i = 0; i < positions->count; i++) {
        double x[3] = {0, 0, 0};
        for (int32_t axis = 0; axis < positions->width; axis++)
            x[axis] = numbers_get(positions, i, axis) - middle;
        if (positions->width == 3) {
            const double y = cos(a) * x[1] - sin(a) * x[2], z = sin(a) * x[1] + cos(a) * x[2];
            const double turned = cos(b) * x[0] + sin(b) * z;
            x[1] = y, x[2] = cos(b) * z - sin(b) * x[0], x[0] = turned;
        }
        const double turned[3] = {cos(c) * x[0] - sin(c) * x[1], sin(c) * x[0] + cos(c) * x[1],
                                  x[2]};
        for (int32_t axis = 0; axis < positions->width; axis++)
            numbers_set(positions, i, axis, middle + turned[axis]);
    }
}

/* The layers of the lattice, pulled apart by three support radii. */
static void part_layers(struct numbers *positions, int32_t side, double support)
{
    const int32_t layer_size = positions->width == 3 ? side * side : side;
    const int32_t axis = positions->width - 1;
    for (int32_t i = 0; i < positions->count; i++) {
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
    for (int32_t i = 0; i < positions->count; i++) {
        int32_t rest = i;
        for (int32_t axis = 0; axis < positions->width; axis++, rest /= side)
            numbers_set(positions, i, axis,
                        width * (rest % side + lattice_random(3 * (int64_t)i + axis)));
    }
}

struct numbers cloud_positions(const struct cloud_setting *setting)
{
    const struct lattice lattice = {
        .dimension = setting->dimension,
        .side = settings_side(setting->particles, setting->dimension),
        .origin = setting->shape == CLOUD_FAR ? 1e5 * setting->support * lattice_spacing : 0,
        .spacing = lattice_spacing,
        .jitter = setting->shape == CLOUD_LATTICE ? 0 : setting->jitter};
    struct numbers positions =
        numbers_create(SPHG_F32, lattice_count(&lattice), setting->dimension);
    lattice_fill(&lattice, &positions);
    if (setting->shape == CLOUD_ROTATED)
        rotate(&positions, 0.5 * (lattice.side - 1) * lattice_spacing);
    if (setting->shape == CLOUD_SHEETS)
        part_layers(&positions, lattice.side, setting->support);
    if (setting->shape == CLOUD_SPRAY)
        scatter(&positions, lattice.side, setting->support);
    if (setting->shuffled)
        shuffle_rows(&positions);
    return positions;
}
