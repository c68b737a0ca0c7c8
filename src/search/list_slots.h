/* SPDX-License-Identifier: MIT */
/* Slots in which lists wait that a finder has found, until those of a group are together. */
#ifndef SPHGI_LIST_SLOTS_H
#define SPHGI_LIST_SLOTS_H
#include "finder.h"

enum {
    SPHGI_CROWDED = -1, /* the length of a list that was not collected */
    SPHGI_SLOT = 512 /* candidates of a list in a slot that is not wide. Slots stand close together:
                        the few lines that lists take of each must stay in the L1 cache */
};

static inline size_t sphgi_slot_room(int32_t candidates)
{
    return (size_t)candidates + SPHGI_FIND_SLACK;
}

/* Of all slots, where a target has up to `room` candidates. */
static inline size_t sphgi_slot_bytes(int32_t room)
{
    return SPHGI_LISTS_MOST *
           (sphgi_slot_room(SPHGI_SLOT) + (room > SPHGI_SLOT ? sphgi_slot_room(room) : 0)) *
           sizeof(uint32_t);
}

static inline int32_t sphgi_slot_number(int32_t target)
{
    return target & (SPHGI_LISTS_MOST - 1);
}

/* Slots for the next targets, that share so many candidates. */
static inline void sphgi_open_slots(struct sphgi_finder *f, int32_t count, int32_t candidates,
                                    uint32_t **lists)
{
    const bool wide = candidates > SPHGI_SLOT;
    for (int32_t k = 0; k < count; ++k) {
        const int32_t s = sphgi_slot_number(f->next + k);
        f->length[s] = SPHGI_CROWDED;
        f->list[s] = lists[k] = wide ? f->wide_slots + (size_t)s * sphgi_slot_room(f->room)
                                     : f->slots + (size_t)s * sphgi_slot_room(SPHGI_SLOT);
    }
}

/* Where any list fits, for one that does not wait. */
static inline uint32_t *sphgi_wide_slot(const struct sphgi_finder *f)
{
    return f->room > SPHGI_SLOT ? f->wide_slots : f->slots;
}

static inline void sphgi_close_slots(struct sphgi_finder *f, int32_t count, const int32_t *lengths)
{
    for (int32_t k = 0; k < count; ++k)
        f->length[sphgi_slot_number(f->next + k)] = lengths[k];
}

#endif
