/* SPDX-License-Identifier: MIT */
#include "text.h"
#include <stdio.h>

const char *text_grouped(int64_t value, char text[TEXT_SIZE])
{
    char digits[TEXT_SIZE];
    const int length = snprintf(digits, sizeof digits, "%lld", (long long)value);
    int out = 0;
    for (int k = 0; k < length; ++k) {
        if (k > 0 && (length - k) % 3 == 0)
            text[out++] = ' ';
        text[out++] = digits[k];
    }
    text[out] = '\0';
    return text;
}

void text_time(double milliseconds, char text[TEXT_SIZE])
{
    const int decimals = milliseconds < 1 ? 3 : milliseconds < 100 ? 2 : milliseconds < 1000;
    snprintf(text, TEXT_SIZE, "%.*f", decimals, milliseconds);
}
