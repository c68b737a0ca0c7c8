/* SPDX-License-Identifier: MIT */
#include "sampling.h"
#include <math.h>
#include <stdbool.h>
#include <stdlib.h>

enum {
    DARTS_PER_CELL = 30, /* afterwards hardly any free place is left */
    LAST_MISSES = 5000   /* in a row: the sphere is full */
};

/* A grid of cells with room for one point each. */
struct board {
    int32_t columns, rows;
    double cell;
    int32_t *held; /* 1 + number of the point, 0: free */
};

static bool is_near(const double *a, const double *b, double distance)
{
    const vector apart = {a[0] - b[0], a[1] - b[1], a[2] - b[2]};
    return dot(apart, apart) < distance * distance;
}

static bool is_free(const struct board *board, int32_t column, int32_t row, vector *points,
                    const double *dart, double distance)
{
    for (int32_t c = column - 2; c <= column + 2; ++c)
        for (int32_t r = row - 2; r <= row + 2; ++r) {
            if (c < 0 || r < 0 || c >= board->columns || r >= board->rows)
                continue;
            const int32_t held = board->held[(ptrdiff_t)r * board->columns + c];
            if (held && is_near(points[held - 1], dart, distance))
                return false;
        }
    return true;
}

int32_t sample_rectangle(struct random *random, const double low[2], const double high[2],
                         double distance, vector **points)
{
    struct board board = {.cell = distance / sqrt(2)};
    int32_t count = 0;
    board.columns = (int32_t)((high[0] - low[0]) / board.cell) + 1;
    board.rows = (int32_t)((high[1] - low[1]) / board.cell) + 1;
    const int32_t cells = board.columns * board.rows;
    board.held = array_new(cells, sizeof *board.held);
    *points = array_new(cells, sizeof **points);
    for (int64_t dart = 0; dart < (int64_t)cells * DARTS_PER_CELL; ++dart) {
        const vector x = {random_between(random, low[0], high[0]),
                          random_between(random, low[1], high[1]), 0};
        const int32_t column = (int32_t)((x[0] - low[0]) / board.cell);
        const int32_t row = (int32_t)((x[1] - low[1]) / board.cell);
        if (!is_free(&board, column, row, *points, x, distance))
            continue;
        add_scaled((*points)[count++], 1, x);
        board.held[(ptrdiff_t)row * board.columns + column] = count;
    }
    free(board.held);
    return count;
}

int32_t sample_sphere(struct random *random, double radius, double distance, vector **points)
{
    /* discs of half the distance do not overlap: at most 16 R^2 / distance^2 of them */
    const int32_t most = (int32_t)(16 * radius * radius / (distance * distance)) + 1;
    int32_t count = 0;
    *points = array_new(most, sizeof **points);
    for (int misses = 0; misses < LAST_MISSES && count < most; ++misses) {
        const double height = random_between(random, -1, 1);
        const double angle = random_between(random, 0, 6.283185307179586);
        const double across = radius * sqrt(1 - height * height);
        const vector x = {across * cos(angle), across * sin(angle), radius * height};
        bool free_place = true;
        for (int32_t k = 0; k < count && free_place; ++k)
            free_place = !is_near((*points)[k], x, distance);
        if (!free_place)
            continue;
        add_scaled((*points)[count++], 1, x);
        misses = 0;
    }
    return count;
}
