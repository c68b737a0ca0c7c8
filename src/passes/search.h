/* SPDX-License-Identifier: MIT */
/* What a search hands to its passes. */
#ifndef SPHGI_PASSES_SEARCH_H
#define SPHGI_PASSES_SEARCH_H
#include "internal.h"

/* How the cells of an open raster are numbered. Passes cut those from - SPHGI_CUT_MOST up to, and
 * without, SPHGI_CUT_MOST. */
#define SPHGI_CUT_MOST (1 << 29)
enum { SPHGI_QUARTERS = 4 }; /* of a cell of an octave, along its bar */
/* Of a place in a cell, in widths of it. Far out cells are no wholes of the place. */
static inline int32_t sphgi_quarter_of(double inside)
{
    return inside <= 0 ? 0 : inside < 1 ? (int32_t)(inside * SPHGI_QUARTERS) : SPHGI_QUARTERS - 1;
}
struct sphgi_cutting {
    int32_t along;          /* the axis of the bars, whose block comes first */
    double inverse[3];      /* 1 / cell width; 0: an axis that is not used */
    int32_t shift[3];       /* a block is 2^shift cells long */
    int32_t local_shift[3]; /* where the axis stands in the number of a cell in its block */
    int32_t octaves;        /* of radii, the largest of which is top; 0: all are the same */
    double top;
};

/* Periodic axes, as distances have them: in the type of the positions. */
struct sphgi_periods {
    double length[3]; /* 0: open */
    double limit[3];  /* coordinates beyond it are taken into the box; open: infinite */
};

/* Runs of rows that hold the candidates of a cell; the first one holds the cell itself, from row
 * `own` on. Runs may be empty. */
enum {
    SPHGI_RUNS_MOST = 128,
    SPHGI_SCANNED = 4 /* vectors of a run that are noted at a time: most runs are no longer */
};
struct sphgi_runs {
    int32_t count, candidates, own;
    int32_t begin[SPHGI_RUNS_MOST], length[SPHGI_RUNS_MOST];
    int32_t staged[SPHGI_RUNS_MOST]; /* where each begins among the coordinates that are staged */
};

/* Candidates of targets with radii of their own, packed into the scratch of the search. */
struct sphgi_packed {
    int32_t most; /* of the runs they come from */
    int32_t count;
    int32_t self; /* of these, the first target, if all are sources that follow one another; -1:
                     they are none, or a period parts them */
};

/* A search among sources. */
struct sphgi_find {
    const void *rows; /* x y z of the sources; SPHGI_LANES_MOST - 1 rows past each run are read */
    double reach;
    bool radii;            /* particles have their own, in the 4th numbers of rows */
    double stretch;        /* what these are multiplied with */
    bool mutual;           /* the larger one of a pair counts */
    const int32_t *selves; /* row of each target, if they are sources in another order; or NULL */
    double slack;          /* rounding of differences between images far apart [L] */
    double period[3];
    bool periodic;
    uint32_t dummy;                  /* id that lists are padded with */
    void *scratch;                   /* for the candidates, see find.c */
    void *staged;                    /* coordinates of runs: all x, all y and all z */
    int32_t staged_room;             /* numbers between x and y, and between y and z */
    void *scan;                      /* for the vectors that a run is scanned in */
    const uint64_t *pack_order;      /* [256]: the positions of the set bits, a byte each */
    const uint8_t (*pack_bytes)[16]; /* [256]: the same for items of two bytes */
};

#endif
