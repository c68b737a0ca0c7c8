/* What can be wrong with an argument, by its kind: each kind spoils a valid call in as many ways as
 * it knows, and says what must become of it. */
#ifndef TESTS_SUPPORT_HOSTILE_H
#define TESTS_SUPPORT_HOSTILE_H
#include "victim.h"

typedef enum argument_kind {
    HOSTILE_FREE,      /* no value of it is wrong */
    HOSTILE_HANDLE,    /* a context: NULL */
    HOSTILE_POINTER,   /* that must be there */
    HOSTILE_BUILT,     /* neighbours that must have been built */
    HOSTILE_COUNT,     /* not negative */
    HOSTILE_ENUM,      /* from low to high */
    HOSTILE_DIMENSION, /* 2 or 3; 0 as well where low is 0 */
    HOSTILE_RADIUS,
    HOSTILE_THRESHOLD,
    HOSTILE_LENGTH, /* finite and not negative */
    HOSTILE_VIEW,
    HOSTILE_POSITIONS, /* the numbers behind a view */
    HOSTILE_VOLUMES,
    HOSTILE_RADII,
    HOSTILE_NUMBERS, /* any are legal */
    HOSTILE_OFFSETS,
    HOSTILE_INDICES,
    HOSTILE_RANGE,  /* of a subset: begin and end */
    HOSTILE_PICKED, /* of a subset: indices */
    HOSTILE_SPECIAL /* `special` knows */
} argument_kind;

enum hostile_flags {
    HOSTILE_REQUIRED = 1, /* an absent view is refused */
    HOSTILE_OUTPUT = 2,
    HOSTILE_VECTOR = 4,   /* its components may stand apart */
    HOSTILE_BYTES = 8,    /* of unsigned bytes, not of the case's precision */
    HOSTILE_LEADING = 16, /* its type decides what the others must be */
    HOSTILE_POSITIVE = 32 /* a count: 0 is refused */
};

enum {
    HOSTILE_REFUSED = 1000, /* any positive code */
    HOSTILE_SKIPPED = -1000 /* there is no such way for this argument */
};

typedef struct trial {
    char what[96];
    int expected;      /* a result; SPHG_OK: legal */
    const char *words; /* in the message; NULL: the last part of the argument's path */
    char value[40];    /* in the message as well */
    void *place;       /* input memory to restore, and what stood there */
    size_t bytes;
    unsigned char kept[8];
} trial;

typedef struct argument {
    const char *path; /* parameter, then members: "scheme.dimension" */
    argument_kind kind;
    size_t at; /* in the victim */
    unsigned flags;
    int low, high; /* of a count: low < 0: what 0 means depends on others */
    int (*special)(victim *own, int number, trial *made);
    const char *said; /* what messages call it; NULL: the last part of the path */
} argument;

typedef struct probe {
    void (*prepare)(victim *own); /* from the victim's request to this one, or NULL */
    sphg_result (*call)(victim *own);
    const argument *arguments;
    int count;
} probe;

/* Spoils argument a of the probe in its `number`-th way; 0: there are no more. */
int hostile_spoil(victim *own, const probe *tested, int a, int number, trial *made);
/* Puts input memory back. */
void hostile_restore(const trial *made);
/* Whether a context that trusts its host is meant to miss it. */
int hostile_is_about_numbers(argument_kind kind);

#endif
