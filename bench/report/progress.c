/* SPDX-License-Identifier: MIT */
#define _POSIX_C_SOURCE 200809L /* isatty */
#include "progress.h"
#include <stdarg.h>
#include <stdio.h>
#include <unistd.h>

static const char erase_line[] = "\r\033[K";

void progress_show(const char *format, ...)
{
    if (!isatty(STDERR_FILENO))
        return;
    va_list arguments;
    va_start(arguments, format);
    fputs(erase_line, stderr);
    vfprintf(stderr, format, arguments);
    fflush(stderr);
    va_end(arguments);
}

void progress_clear(void)
{
    if (isatty(STDERR_FILENO))
        fputs(erase_line, stderr);
}
