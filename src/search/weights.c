/* SPDX-License-Identifier: MIT */
#include "weights.h"

struct sphgi_weights_book {
    atomic_bool taken;
    atomic_bool other_volumes; /* a sweep that did not take the memory had others */
    uint32_t number;           /* of the factors that were last asked for */
    struct sphgi_weights_of of;
    uint32_t marks[]; /* per group */
};

/* Sweeps see neighbours as const: who is near whom stays. The book lies in memory of its own. */
static struct sphgi_weights_book *book_of(const sphg_neighbors *n)
{
    return n->weight_book.data;
}

/* Where pairs are tested one by one, a factor alone does not tell which of them count. */
static bool are_kept(const sphg_neighbors *n)
{
    return n->keeps_weights && n->dummy_is_far && !n->periodic && n->skin == 0 &&
           n->position_type == n->type;
}

bool sphgi_weights_reserve(sphg_neighbors *n)
{
    if (!are_kept(n)) {
        sphgi_free(&n->allocator, &n->weights);
        sphgi_free(&n->allocator, &n->weight_book);
        return true;
    }
    const size_t marks = (size_t)sphgi_group_count(n->target_count) * sizeof(uint32_t);
    const size_t size = sizeof(struct sphgi_weights_book) + marks;
    if (!sphgi_reserve(&n->allocator, &n->weights, (size_t)n->found.room,
                       sphgi_size_of_type(n->type)) ||
        !sphgi_reserve(&n->allocator, &n->weight_book, size, 1))
        return false;
    memset(n->weight_book.data, 0, size);
    return true;
}

static bool are_the_same(const struct sphgi_weights_of *a, const struct sphgi_weights_of *b)
{
    return a->kernel == b->kernel && a->method == b->method && a->radius == b->radius &&
           a->volume == b->volume;
}

void sphgi_weights_pass(const sphg_neighbors *n, bool same_volumes)
{
    if (n->keeps_weights && book_of(n) && !same_volumes)
        atomic_store(&book_of(n)->other_volumes, true);
}

struct sphgi_kept_weights sphgi_weights_take(const sphg_neighbors *n,
                                             const struct sphgi_weights_of *of, bool same_volumes)
{
    struct sphgi_weights_book *book = book_of(n);
    if (!n->keeps_weights || !book)
        return (struct sphgi_kept_weights){.number = 0};
    if (atomic_exchange(&book->taken, true)) {
        sphgi_weights_pass(n, same_volumes);
        return (struct sphgi_kept_weights){.number = 0};
    }
    const bool others = atomic_exchange(&book->other_volumes, false);
    const bool same = (same_volumes && !others) || of->volume >= 0;
    if (!book->number || !same || !are_the_same(&book->of, of)) {
        book->of = *of;
        ++book->number;
        if (!book->number) { /* after 2^32 - 1 changes */
            memset(book->marks, 0, (size_t)sphgi_group_count(n->target_count) * sizeof(uint32_t));
            book->number = 1;
        }
    }
    return (struct sphgi_kept_weights){n->weights.data, book->marks, book->number};
}

void sphgi_weights_give_back(const sphg_neighbors *n, const struct sphgi_kept_weights *weights,
                             bool good)
{
    if (!weights->number)
        return;
    if (!good)
        book_of(n)->of.radius = -1; /* the same as no other */
    atomic_store(&book_of(n)->taken, false);
}
