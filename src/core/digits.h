/* SPDX-License-Identifier: MIT */
/* Numbers in messages: with the fewest digits that read back as the same number, so that no message
 * shows a value that equals the limit it breaks. Nothing else prints a floating-point number. */
#ifndef SPHGI_DIGITS_H
#define SPHGI_DIGITS_H

struct sphgi_digits {
    char text[32];
};

/* With a decimal point whatever the host's locale has. Rounding to nearest and masked traps are
 * expected, as sphgi_enter() sets them. */
struct sphgi_digits sphgi_digits(double value);

#endif
