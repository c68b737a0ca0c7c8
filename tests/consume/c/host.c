/* host PLUGIN REPETITIONS [resident FILE] [hides|shows NAME]...: loads a plugin, runs it and
 * unloads it while the threads that it left may still be at work, again and again. Then: FILE is
 * still loaded, the plugin hides or shows a name. */
#define _POSIX_C_SOURCE 200809L /* nanosleep */
#include <dlfcn.h>
#include <stdio.h>
#include <stdlib.h>
#include <string.h>
#include <time.h>

static int fails(const char *what)
{
    const char *reason = dlerror();
    fprintf(stderr, "host: %s: %s\n", what, reason ? reason : "failed");
    return 1;
}

static int run_and_unload(const char *file)
{
    void *plugin = dlopen(file, RTLD_NOW | RTLD_LOCAL);
    void *const entry = plugin ? dlsym(plugin, "plugin_run") : NULL;
    int (*run)(void);
    if (!entry)
        return fails(file);
    memcpy(&run, &entry, sizeof run);
    if (run())
        return fails("plugin_run");
    if (dlclose(plugin))
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
    for (int k = count > 2 ? atoi(words[2]) : 0; k > 0; k--)
        if (run_and_unload(file))
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
