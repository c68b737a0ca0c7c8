/* SPDX-License-Identifier: MIT */
/* How the files that check arguments say no. */
#ifndef SPHGI_REFUSE_H
#define SPHGI_REFUSE_H

/* In a function that has a `checker` (check.h). */
#define REFUSE(result, ...) return sphgi_fail(checker.context, result, __VA_ARGS__)

#endif
