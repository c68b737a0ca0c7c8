/* SPDX-License-Identifier: MIT */
#include "digits.h"
#include "internal.h"
#include <stdio.h>
#include <stdlib.h>
#include <string.h>

enum { DIGITS_LEAST = 6, DIGITS_MOST = 17 };

/* What a locale may put between the digits: one byte or several. */
static bool belongs_to_point(char c)
{
    return !strchr("0123456789+-einfa", c);
}

static void write_point(char *text)
{
    char *to = text;
    for (const char *from = text; *from; ++from)
        if (!belongs_to_point(*from))
            *to++ = *from;
        else if (to == text || to[-1] != '.')
            *to++ = '.';
    *to = '\0';
}

struct sphgi_digits sphgi_digits(double value)
{
    struct sphgi_digits made;
    for (int digits = DIGITS_LEAST; digits <= DIGITS_MOST; ++digits) {
        snprintf(made.text, sizeof made.text, "%.*g", digits, value);
        if (!(strtod(made.text, NULL) != value)) /* in the same locale; a NaN is a NaN */
            break;
    }
    write_point(made.text);
    return made;
}
