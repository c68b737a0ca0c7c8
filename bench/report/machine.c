/* SPDX-License-Identifier: MIT */
#define _DEFAULT_SOURCE /* gethostname, tm_gmtoff, sysconf */
#include "machine.h"
#include <stdio.h>
#include <stdlib.h>
#include <string.h>
#include <time.h>
#include <unistd.h>
#ifdef _OPENMP
#include <omp.h>
#endif

/* The text after "key   : " on the first line of /proc/cpuinfo that starts with key. */
static int find_cpu_line(FILE *file, const char *key, char *text, size_t size)
{
    char line[256];
    while (fgets(line, sizeof line, file)) {
        const char *colon = strchr(line, ':');
        if (strncmp(line, key, strlen(key)) != 0 || !colon)
            continue;
        snprintf(text, size, "%s", colon + 1 + strspn(colon + 1, " \t"));
        text[strcspn(text, "\n")] = '\0';
        return 1;
    }
    return 0;
}

const char *machine_cpu(void)
{
    static char text[128];
    FILE *file = fopen("/proc/cpuinfo", "r");
    const int found = file && find_cpu_line(file, "model name", text, sizeof text);
    if (file)
        fclose(file);
    return found ? text : "unknown processor";
}

const char *machine_host(void)
{
    static char text[256];
    if (gethostname(text, sizeof text - 1) != 0)
        return "unknown";
    return text;
}

const char *machine_date(void)
{
    static char text[64];
    const time_t seconds = time(NULL);
    struct tm local;
    localtime_r(&seconds, &local);
    const size_t length = strftime(text, sizeof text, "%Y-%m-%dT%H:%M:%S%z", &local);
    if (length < 5 || length + 2 > sizeof text)
        return text;
    memmove(text + length - 1, text + length - 2, 3); /* +0000 becomes +00:00 */
    text[length - 2] = ':';
    return text;
}

const char *machine_compiler(void)
{
#if defined(__clang__)
    return __VERSION__;
#elif defined(__GNUC__)
    return "GCC " __VERSION__;
#else
    return "unknown";
#endif
}

const char *machine_build(void)
{
#ifdef NDEBUG
    return "release";
#else
    return "debug";
#endif
}

#ifdef _OPENMP
/* Not the affinity of this thread: with OMP_PROC_BIND that is one processor. */
int32_t machine_cpus(void)
{
    return omp_get_num_procs();
}

int32_t machine_threads(void)
{
    return omp_get_max_threads();
}
#else
int32_t machine_cpus(void)
{
    return (int32_t)sysconf(_SC_NPROCESSORS_ONLN);
}

int32_t machine_threads(void)
{
    return 1;
}
#endif
