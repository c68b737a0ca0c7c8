/* SPDX-License-Identifier: MIT */
#include "lattice.h"
#include "splitmix64.h"
#include <math.h>

double lattice_random(int64_t number)
{
    uint64_t state = (uint64_t)number * SPLITMIX64_STEP;
    return splitmix64_share(&state);
}

/* Uniform in [-1, 1]. Only 2^12 steps, so that jittered positions on a dyadic lattice, and linear
 * fields of them, stay exact in f32: what is measured is then the gradient, not rounding of A. */
static double next_displacement(uint64_t *state)
{
    const double steps = 4096;
    return (floor(splitmix64_share(state) * (2 * steps + 1)) - steps) / steps;
}

int32_t lattice_count(const struct lattice *lattice)
{
    const int32_t square = lattice->side * lattice->side;
    return lattice->dimension == 3 ? square * lattice->side : square;
}

void lattice_fill(const struct lattice *lattice, struct numbers *positions)
{
    const int32_t count = lattice_count(lattice);
    const double step = floor(lattice->jitter * 4096) / 4096; /* exact steps of the spacing */
    uint64_t state = 1;
    for (int32_t i = 0; i < count; ++i) {
        int32_t rest = i;
        for (int32_t axis = 0; axis < lattice->dimension; ++axis, rest /= lattice->side) {
            const double place = rest % lattice->side;
            const double moved = step > 0 ? round(4096 * step * next_displacement(&state)) : 0;
            const double offset = (place + moved / 4096) * lattice->spacing;
            numbers_set(positions, i, axis, lattice->origin + offset);
        }
    }
    if (lattice->shuffled)
        shuffle_rows(positions);
}

static void swap_rows(struct numbers *table, int32_t a, int32_t b)
{
    for (int32_t c = 0; c < table->width; ++c) {
        const double held = numbers_get(table, a, c);
        numbers_set(table, a, c, numbers_get(table, b, c));
        numbers_set(table, b, c, held);
    }
}

void shuffle_rows(struct numbers *table)
{
    uint64_t state = 2;
    for (int32_t i = table->count - 1; i > 0; --i)
        swap_rows(table, i, (int32_t)(splitmix64(&state) % (uint64_t)(i + 1)));
}
