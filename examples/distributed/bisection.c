/* SPDX-License-Identifier: MIT */
/* The cuts of Zoltan's recursive coordinate bisection. Zoltan also says which particles have to
 * move; here the boxes decide that, as they decide who is a ghost. */
#include "boxes.h"
#include "stop.h"
#include <float.h>
#include <math.h>
#include <stdlib.h>
#include <zoltan.h>

/* ---- What Zoltan asks ------------------------------------------------------------------------ */

static int dimension(void *data, int *error)
{
    (void)data;
    *error = ZOLTAN_OK;
    return 3;
}

static int count_particles(void *data, int *error)
{
    *error = ZOLTAN_OK;
    return ((const struct places *)data)->count;
}

/* Cuts need no names that hold everywhere: the number within the rank will do for both. */
static void name_particles(void *data, int global_size, int local_size, ZOLTAN_ID_PTR global,
                           ZOLTAN_ID_PTR local, int weights, float *weight, int *error)
{
    (void)weights;
    (void)weight;
    const int count = ((const struct places *)data)->count;
    for (int k = 0; k < count; ++k)
        global[k * global_size] = local[k * local_size] = (ZOLTAN_ID_TYPE)k;
    *error = ZOLTAN_OK;
}

static void tell_places(void *data, int global_size, int local_size, int count,
                        ZOLTAN_ID_PTR global, ZOLTAN_ID_PTR local, int axes, double *x, int *error)
{
    (void)global_size;
    (void)global;
    for (int k = 0; k < count; ++k)
        for (int a = 0; a < axes; ++a)
            x[k * axes + a] = place_of(data, (int)local[k * local_size])[a];
    *error = ZOLTAN_OK;
}

/* ---- What it answers ------------------------------------------------------------------------- */

static void need(int result)
{
    if (result != ZOLTAN_OK && result != ZOLTAN_WARN)
        stop("Zoltan could not cut the particles");
}

static struct Zoltan_Struct *asked(MPI_Comm ranks, const struct places *places)
{
    float version;
    need(Zoltan_Initialize(0, NULL, &version));
    struct Zoltan_Struct *zoltan = Zoltan_Create(ranks);
    if (!zoltan)
        stop("Zoltan could not be set up");
    need(Zoltan_Set_Param(zoltan, "DEBUG_LEVEL", "0"));
    need(Zoltan_Set_Param(zoltan, "LB_METHOD", "RCB"));
    need(Zoltan_Set_Param(zoltan, "KEEP_CUTS", "1"));
    need(Zoltan_Set_Param(zoltan, "RETURN_LISTS", "NONE"));
    void *data = (void *)places;
    need(Zoltan_Set_Num_Geom_Fn(zoltan, dimension, data));
    need(Zoltan_Set_Num_Obj_Fn(zoltan, count_particles, data));
    need(Zoltan_Set_Obj_List_Fn(zoltan, name_particles, data));
    need(Zoltan_Set_Geom_Multi_Fn(zoltan, tell_places, data));
    return zoltan;
}

static void cut(struct Zoltan_Struct *zoltan)
{
    int changes, global_size, local_size, imports, exports;
    ZOLTAN_ID_PTR in_global = NULL, in_local = NULL, out_global = NULL, out_local = NULL;
    int *in_ranks = NULL, *in_parts = NULL, *out_ranks = NULL, *out_parts = NULL;
    need(Zoltan_LB_Partition(zoltan, &changes, &global_size, &local_size, &imports, &in_global,
                             &in_local, &in_ranks, &in_parts, &exports, &out_global, &out_local,
                             &out_ranks, &out_parts));
    need(Zoltan_LB_Free_Part(&in_global, &in_local, &in_ranks, &in_parts));
    need(Zoltan_LB_Free_Part(&out_global, &out_local, &out_ranks, &out_parts));
}

/* Zoltan's outer boxes end at the largest double. */
static double open_end(double face)
{
    return face <= -DBL_MAX ? -INFINITY : face >= DBL_MAX ? INFINITY : face;
}

void cut_by_bisection(MPI_Comm ranks, const struct places *places, struct box *boxes)
{
    int rank_count;
    MPI_Comm_size(ranks, &rank_count);
    struct Zoltan_Struct *zoltan = asked(ranks, places);
    cut(zoltan);
    for (int rank = 0; rank < rank_count; ++rank) {
        struct box *b = &boxes[rank];
        int axes;
        need(Zoltan_RCB_Box(zoltan, rank, &axes, &b->low[0], &b->low[1], &b->low[2], &b->high[0],
                            &b->high[1], &b->high[2]));
        for (int a = 0; a < 3; ++a) {
            b->low[a] = open_end(b->low[a]);
            b->high[a] = open_end(b->high[a]);
        }
    }
    Zoltan_Destroy(&zoltan);
}
