/* SPDX-License-Identifier: MIT */
#include "text.h"
#include "library.h"
#include "machine.h"
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

void text_print_lattice(const struct settings *settings, int32_t count, double pairs)
{
    char text[TEXT_SIZE];
    printf("particles  %s, lattice jittered by %g spacings, H = %g spacings, %.2f pairs a particle",
           text_grouped(count, text), settings->jitter, settings->support, pairs);
}

void text_print_machine(int32_t threads)
{
    printf("machine    %s, %d processor%s; %d thread%s, %s\n", machine_cpu(), machine_cpus(),
           machine_cpus() > 1 ? "s" : "", threads, threads > 1 ? "s" : "", library_isa());
    printf("program    sphgrad %s, %s, %s, %s\n", library_version(), machine_compiler(),
           machine_build(), machine_date());
}

void text_print_if_busy(const struct samples *samples, int32_t threads)
{
    const int32_t processors = machine_cpus() < threads ? machine_cpus() : threads;
    const double had = samples_cpu(samples).median / (samples_wall(samples).median * processors);
    if (had < 0.8)
        printf(
            "BUSY       others ran: the program had %.0f %% of its processors' time, and the times "
            "are too long\n",
            100 * had);
}
