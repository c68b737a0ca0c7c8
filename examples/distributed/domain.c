/* SPDX-License-Identifier: MIT */
#include "domain.h"
#include "stop.h"
#include <limits.h>
#include <math.h>
#include <stdlib.h>
#include <string.h>

void domain_make(struct domain *domain, MPI_Comm ranks, const void *items, size_t size, int count)
{
    *domain = (struct domain){.ranks = ranks, .size = size, .own = count};
    MPI_Comm_rank(ranks, &domain->rank);
    MPI_Comm_size(ranks, &domain->rank_count);
    domain->items = resized(NULL, (size_t)count, size);
    if (count)
        memcpy(domain->items, items, (size_t)count * size);
    domain->boxes = resized(NULL, (size_t)domain->rank_count, sizeof *domain->boxes);
    for (int rank = 0; rank < domain->rank_count; ++rank) /* all space is the first one's */
        for (int a = 0; a < 3; ++a) {
            domain->boxes[rank].low[a] = rank ? INFINITY : -INFINITY;
            domain->boxes[rank].high[a] = INFINITY;
        }
}

void domain_free(struct domain *domain)
{
    plan_free(&domain->plan);
    plan_free(&domain->home);
    transfer_free(&domain->moving);
    free(domain->parcels.list);
    free(domain->spare);
    free(domain->near);
    free(domain->boxes);
    free(domain->items);
    free(domain->inner);
    free(domain->outer);
    *domain = (struct domain){0};
}

static const double *position(const struct domain *domain, int k)
{
    return (const double *)(const void *)(domain->items + (size_t)k * domain->size);
}

static void refuse_bad_places(const struct domain *domain)
{
    for (int k = 0; k < domain->own; ++k)
        for (int a = 0; a < 3; ++a)
            if (!isfinite(position(domain, k)[a]))
                stop("the position of a particle is not a finite number");
}

/* ---- Owners ---------------------------------------------------------------------------------- */

static void add_parcel(struct parcels *parcels, int32_t item, int rank)
{
    if (parcels->count == parcels->room) {
        parcels->room = parcels->room > INT_MAX / 2 ? INT_MAX : 2 * parcels->room + 64;
        parcels->list = resized(parcels->list, (size_t)parcels->room, sizeof *parcels->list);
    }
    parcels->list[parcels->count++] = (struct parcel){item, rank};
}

/* Most stay where they are. */
static int owner_of(const struct domain *domain, const double *x)
{
    if (box_holds(&domain->boxes[domain->rank], x))
        return domain->rank;
    for (int rank = 0; rank < domain->rank_count; ++rank)
        if (box_holds(&domain->boxes[rank], x))
            return rank;
    stop("the boxes do not fill space");
}

/* Everybody goes to its owner. */
static void send_home(struct domain *domain)
{
    domain->parcels.count = 0;
    for (int k = 0; k < domain->own; ++k) {
        const int owner = owner_of(domain, position(domain, k));
        domain->moved += owner != domain->rank;
        add_parcel(&domain->parcels, k, owner);
    }
    plan_make(&domain->home, domain->ranks, domain->parcels.list, domain->own);
    domain->spare = resized(domain->spare, (size_t)domain->home.received, domain->size);
    transfer_start(&domain->moving, &domain->home, domain->items, domain->spare, domain->size,
                   domain->size);
    transfer_finish(&domain->moving);
    char *before = domain->items;
    domain->items = domain->spare;
    domain->spare = before;
    domain->own = domain->home.received;
}

/* ---- Ghosts ---------------------------------------------------------------------------------- */

/* So that particles look at a few boxes only, however many ranks there are. */
static void find_near_boxes(struct domain *domain, double reach)
{
    const struct box *mine = &domain->boxes[domain->rank];
    domain->near = resized(domain->near, (size_t)domain->rank_count, sizeof *domain->near);
    domain->near_count = 0;
    for (int rank = 0; rank < domain->rank_count; ++rank)
        if (rank != domain->rank && boxes_are_near(mine, &domain->boxes[rank], reach))
            domain->near[domain->near_count++] = rank;
}

/* Who is sent to whom, and who to nobody. */
static void address(struct domain *domain, double reach)
{
    struct parcels *parcels = &domain->parcels;
    parcels->count = 0;
    domain->inner = resized(domain->inner, (size_t)domain->own, sizeof(int32_t));
    domain->outer = resized(domain->outer, (size_t)domain->own, sizeof(int32_t));
    domain->inner_count = domain->outer_count = 0;
    for (int k = 0; k < domain->own; ++k) {
        const int before = parcels->count;
        const double *x = position(domain, k);
        for (int n = 0; n < domain->near_count; ++n)
            if (box_is_near(&domain->boxes[domain->near[n]], x, reach))
                add_parcel(parcels, k, domain->near[n]);
        if (parcels->count > before)
            domain->outer[domain->outer_count++] = k;
        else
            domain->inner[domain->inner_count++] = k;
    }
}

static void bring_ghosts(struct domain *domain, double reach)
{
    find_near_boxes(domain, reach);
    address(domain, reach);
    plan_make(&domain->plan, domain->ranks, domain->parcels.list, domain->parcels.count);
    domain->ghosts = domain->plan.received;
    domain->items =
        resized(domain->items, (size_t)domain->own + (size_t)domain->ghosts, domain->size);
    domain_start(domain, &domain->moving, domain->items, domain->size, domain->size);
    transfer_finish(&domain->moving);
}

void domain_settle(struct domain *domain, double reach, cutter *cut)
{
    const struct places places = {position(domain, 0), domain->size, domain->own};
    refuse_bad_places(domain);
    if (cut && domain->rank_count > 1)
        cut(domain->ranks, &places, domain->boxes);
    send_home(domain);
    bring_ghosts(domain, reach);
}

void domain_start(const struct domain *domain, struct transfer *transfer, void *from, size_t size,
                  size_t stride)
{
    transfer_start(transfer, &domain->plan, from, (char *)from + (size_t)domain->own * stride, size,
                   stride);
}
