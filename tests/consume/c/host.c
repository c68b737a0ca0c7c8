/* SPDX-License-Identifier: MIT */
/* host PLUGIN REPETITIONS [resident FILE] [hides|shows NAME]...: loads a plugin, runs it and
 * unloads it while the threads that it left may still be at work, again and again, in all ways that
 * hosts do. Then: FILE is still loaded, the plugin hides or shows a name. */
#define _GNU_SOURCE /* RTLD_DEEPBIND */
#include <dlfcn.h>
#include <pthread.h>
#include <stdio.h>
#include <stdlib.h>
#include <string.h>
#include <sys/wait.h>
#include <time.h>
#include <unistd.h>
#ifndef RTLD_DEEPBIND
#define RTLD_DEEPBIND 0
#endif

/* A bit each; the plugin's own names are resolved first, it is seen by those loaded later, its
 * context stays, another thread unloads it, a child of fork() does all of it once more. */
enum { DEEP = 1, GLOBAL = 2, LEFT = 4, ELSEWHERE = 8, FORKED = 16 };

static int fails(const char *what)
{
    const char *reason = dlerror();
    fprintf(stderr, "host: %s: %s\n", what, reason ? reason : "failed");
    return 1;
}

/* NULL: done */
static void *unload(void *plugin)
{
    return dlclose(plugin) ? plugin : NULL;
}

static int unload_elsewhere(void *plugin)
{
    pthread_t thread;
    void *left = plugin;
    return pthread_create(&thread, NULL, unload, plugin) || pthread_join(thread, &left) || left;
}

static int run_and_unload(const char *file, int way);

static int repeat_in_child(const char *file, int way)
{
    int status = 1;
    const pid_t child = fork();
    if (child == 0) {
        alarm(60); /* one that hangs */
        _exit(run_and_unload(file, way));
    }
    return child < 0 || waitpid(child, &status, 0) != child || status;
}

static int run_and_unload(const char *file, int way)
{
    const int flags = RTLD_NOW | (way & DEEP ? RTLD_DEEPBIND : 0);
    void *plugin = dlopen(file, flags | (way & GLOBAL ? RTLD_GLOBAL : RTLD_LOCAL));
    void *const entry = plugin ? dlsym(plugin, "plugin_run") : NULL;
    int (*run)(int leave);
    if (!entry)
        return fails(file);
    memcpy(&run, &entry, sizeof run);
    if (run(way & LEFT))
        return fails("plugin_run");
    if (way & FORKED && repeat_in_child(file, way & ~FORKED))
        return fails("a child of fork");
    if (way & ELSEWHERE ? unload_elsewhere(plugin) : unload(plugin) != NULL)
        return fails("dlclose");
    nanosleep(&(struct timespec){.tv_nsec = 1000000}, NULL); /* threads left behind go on */
    return 0;
}

static int is_resident(const char *file)
{
    void *const loaded = dlopen(file, RTLD_NOW | RTLD_NOLOAD);
    return loaded ? dlclose(loaded), 1 : 0;
}

static int shows(const char *file, const char *name)
{
    void *const plugin = dlopen(file, RTLD_NOW | RTLD_LOCAL);
    const int found = plugin && dlsym(plugin, name);
    if (plugin)
        dlclose(plugin);
    return found;
}

int main(int count, char **words)
{
    const char *const file = count > 2 ? words[1] : "";
    for (int k = count > 2 ? atoi(words[2]) : 0; k > 0; --k)
        if (run_and_unload(file, (k - 1) % 32))
            return 1;
    int failed = count < 3;
    for (int k = 3; k + 1 < count; k += 2) {
        const int holds = !strcmp(words[k], "resident")
                              ? is_resident(words[k + 1])
                              : shows(file, words[k + 1]) == !strcmp(words[k], "shows");
        if (!holds)
            fprintf(stderr, "host: not so: %s %s\n", words[k], words[k + 1]);
        failed |= !holds;
    }
    if (!failed)
        puts("fine");
    return failed;
}
