/* SPDX-License-Identifier: MIT */
#include "core/check.h"
#include "core/cpu.h"
#include "core/parallel.h"
#include <stdarg.h>
#include <stdio.h>
#include <string.h>

/* A failure before there is a context to keep the message. */
SPHGI_FORMAT(3, 4)
static sphg_result refuse(const sphg_config *config, sphg_result result, const char *format, ...)
{
    char message[SPHGI_MESSAGE_LENGTH];
    va_list arguments;
    va_start(arguments, format);
    vsnprintf(message, sizeof message, format, arguments);
    va_end(arguments);
    sphgi_report(config, result, message);
    return result;
}

static sphg_result check_config(int32_t version, const sphg_config *config)
{
    static const char f[] = "sphg_context_create";
    if (version <= 0 || version / 100 > SPHG_VERSION / 100)
        return refuse(config, SPHG_ERROR_VERSION, "%s: version is %d, this library serves 1 to %d",
                      f, (int)version, SPHG_VERSION / 100 * 100 + 99);
    if (!config->allocate != !config->release)
        return refuse(config, SPHG_ERROR_ARGUMENT, "%s: config.%s is NULL, config.%s is not", f,
                      config->allocate ? "release" : "allocate",
                      config->allocate ? "allocate" : "release");
    if (config->threads < 0 || (config->parallel_for && config->threads < 1))
        return refuse(config, SPHG_ERROR_ARGUMENT, "%s: config.threads is %d, must be at least %d",
                      f, (int)config->threads, config->parallel_for ? 1 : 0);
    if (config->isa < SPHG_ISA_BEST || config->isa > SPHG_ISA_NEON)
        return refuse(config, SPHG_ERROR_ARGUMENT, "%s: config.isa is %d, not an instruction set",
                      f, (int)config->isa);
    if (config->isa != SPHG_ISA_BEST && !sphgi_cpu_has(config->isa))
        return refuse(config, SPHG_ERROR_UNSUPPORTED, "%s: config.isa is %d, not on this machine",
                      f, (int)config->isa);
    return SPHG_OK;
}

sphg_result sphg_context_create(int32_t version, const sphg_config *config, sphg_context **context)
{
    const sphg_config defaults = {0};
    if (!config)
        config = &defaults;
    if (!context)
        return refuse(config, SPHG_ERROR_ARGUMENT, "sphg_context_create: context is NULL");
    *context = NULL;
    const sphg_result result = check_config(version, config);
    if (result)
        return result;
    const struct sphgi_allocator allocator = sphgi_allocator_of(config);
    sphg_context *made = sphgi_allocate(&allocator, sizeof *made);
    if (!made)
        return refuse(config, SPHG_ERROR_MEMORY,
                      "sphg_context_create: the allocator returned NULL");
    sphgi_context_open(made, config);
    made->threads = sphgi_thread_count(config);
    *context = made;
    return SPHG_OK;
}

enum { SCRATCH_BUFFERS = 14 };

static void list_scratch(sphg_context *context, struct sphgi_buffer **buffers)
{
    struct sphgi_buffer *all[SCRATCH_BUFFERS] = {
        &context->workers,       &context->packed,        &context->sums,
        &context->marks,         &context->waits,         &context->coefficients,
        &context->selection,     &context->sort,          &context->plan,
        &context->input,         &context->order_grid[0], &context->order_grid[1],
        &context->order_grid[2], &context->order_grid[3]};
    memcpy(buffers, all, sizeof all);
}

void sphg_context_destroy(sphg_context *context)
{
    if (!context)
        return;
    const struct sphgi_allocator allocator = context->allocator;
    struct sphgi_buffer *buffers[SCRATCH_BUFFERS];
    list_scratch(context, buffers);
    for (size_t k = 0; k < SCRATCH_BUFFERS; ++k)
        sphgi_free(&allocator, buffers[k]);
    sphgi_release(&allocator, context, sizeof *context);
}

sphg_result sphg_context_get_info(sphg_context *context, sphg_context_info *info)
{
    const struct sphgi_checker checker = {context, "sphg_context_get_info"};
    sphg_result result = sphgi_enter(context);
    if (result)
        return result;
    result = sphgi_check_pointer(checker, info, "info");
    if (!result) {
        struct sphgi_buffer *buffers[SCRATCH_BUFFERS];
        list_scratch(context, buffers);
        *info = (sphg_context_info){.threads = sphgi_threads_left(context),
                                    .isa = context->isa,
                                    .openmp = sphgi_has_openmp(),
                                    .bytes = (int64_t)sizeof *context};
        for (size_t k = 0; k < SCRATCH_BUFFERS; ++k)
            info->bytes += (int64_t)buffers[k]->size;
    }
    return sphgi_leave(context, result);
}

const char *sphg_last_message(const sphg_context *context)
{
    return context ? context->message : "there is no context";
}
