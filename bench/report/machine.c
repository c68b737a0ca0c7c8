/* SPDX-License-Identifier: MIT */
#define _DEFAULT_SOURCE /* gethostname, tm_gmtoff, sysconf */
#include "machine.h"
#include <stdio.h>
#include <time.h>
#include <unistd.h>
#ifdef _OPENMP
#include <omp.h>
#endif

const char *machine_cpu(void)
{
    static char text[128];
    char line[256];
    FILE *file = fopen("/proc/cpuinfo", "r");
    while (file && !*text && fgets(line, sizeof line, file))
        sscanf(line, "model name : %127[^\n]", text);
    if (file)
        fclose(file);
    return *text ? text : "unknown processor";
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
    char clock[32], zone[8]; /* +0000, to become +00:00 */
    const time_t seconds = time(NULL);
    struct tm local;
    localtime_r(&seconds, &local);
    strftime(clock, sizeof clock, "%Y-%m-%dT%H:%M:%S", &local);
    strftime(zone, sizeof zone, "%z", &local);
    snprintf(text, sizeof text, "%s%.3s:%s", clock, zone, zone + 3);
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
