/* SPDX-License-Identifier: MIT */
/* What can be wrong with an argument, by its kind: each kind spoils a valid call in as many ways as
 * it knows, and says what must become of it. */
#ifndef TESTS_SUPPORT_BAD_ARGUMENTS_H
#define TESTS_SUPPORT_BAD_ARGUMENTS_H
#include "valid_call.h"

typedef enum argument_kind {
    ARGUMENT_FREE,      /* no value of it is wrong */
    ARGUMENT_HANDLE,    /* a context: NULL */
    ARGUMENT_POINTER,   /* that must be there */
    ARGUMENT_BUILT,     /* neighbours that must have been built */
    ARGUMENT_COUNT,     /* not negative */
    ARGUMENT_ENUM,      /* from low to high */
    ARGUMENT_DIMENSION, /* 2 or 3; 0 as well where low is 0 */
    ARGUMENT_RADIUS,
    ARGUMENT_THRESHOLD,
    ARGUMENT_LENGTH, /* finite and not negative */
    ARGUMENT_VIEW,
    ARGUMENT_POSITIONS, /* the numbers behind a view */
    ARGUMENT_VOLUMES,
    ARGUMENT_RADII,
    ARGUMENT_NUMBERS, /* any are legal */
    ARGUMENT_OFFSETS,
    ARGUMENT_INDICES,
    ARGUMENT_RANGE,  /* of a subset: begin and end */
    ARGUMENT_PICKED, /* of a subset: indices */
    ARGUMENT_SPECIAL /* `special` knows */
} argument_kind;

enum argument_flags {
    ARGUMENT_REQUIRED = 1, /* an absent view is refused */
    ARGUMENT_OUTPUT = 2,
    ARGUMENT_VECTOR = 4,   /* its components may stand apart */
    ARGUMENT_BYTES = 8,    /* of unsigned bytes, not of the case's precision */
    ARGUMENT_LEADING = 16, /* its type decides what the others must be */
    ARGUMENT_POSITIVE = 32 /* a count: 0 is refused */
};

enum {
    ARGUMENT_REFUSED = 1000, /* any positive code */
    ARGUMENT_SKIPPED = -1000 /* there is no such way for this argument */
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
    size_t at; /* in the valid call */
    unsigned flags;
    int low, high; /* of a count: low < 0: what 0 means depends on others */
    int (*special)(valid_call *own, int number, trial *made);
    const char *said; /* what messages call it; NULL: the last part of the path */
} argument;

typedef struct probe {
    void (*prepare)(valid_call *own); /* from the valid call's request to this one, or NULL */
    sphg_result (*call)(valid_call *own);
    const argument *arguments;
    int count;
} probe;

/* Spoils argument a of the probe in its `number`-th way; 0: there are no more. */
int argument_spoil(valid_call *own, const probe *tested, int a, int number, trial *made);
/* Puts input memory back. */
void argument_restore(const trial *made);
/* Whether a context that trusts its host is meant to miss it. */
int argument_is_about_numbers(argument_kind kind);

#endif
