#include "context.h"
#include "check.h"
#include "cpu.h"
#include "parallel.h"
#include <stdarg.h>
#include <stdio.h>
#include <string.h>

static void choose_passes(sphg_context *context)
{
    context->passes_f32 = &sphgi_passes_f32_base;
    context->passes_f64 = &sphgi_passes_f64_base;
#ifdef SPHG_HAVE_V3
    if (context->isa == SPHG_ISA_X86_V3) {
        context->passes_f32 = &sphgi_passes_f32_v3;
        context->passes_f64 = &sphgi_passes_f64_v3;
    }
#endif
#ifdef SPHG_HAVE_V4
    if (context->isa == SPHG_ISA_X86_V4) {
        context->passes_f32 = &sphgi_passes_f32_v4;
        context->passes_f64 = &sphgi_passes_f64_v4;
    }
#endif
}

static void fill_pack_order(uint64_t *order)
{
    for (uint32_t bits = 0; bits < 256; ++bits) {
        order[bits] = 0;
        for (uint32_t bit = 0, place = 0; bit < 8; ++bit)
            if (bits >> bit & 1)
                order[bits] |= (uint64_t)bit << (8 * place++);
    }
}

/* b -> 2 b, 2 b + 1 */
static void fill_pack_bytes(const uint64_t *order, uint8_t (*bytes)[16])
{
    for (uint32_t bits = 0; bits < 256; ++bits)
        for (uint32_t k = 0; k < 16; ++k)
            bytes[bits][k] = (uint8_t)(2 * (order[bits] >> (8 * (k / 2)) & 7) + k % 2);
}

static void report(const sphg_config *config, sphg_result result, const char *message)
{
    if (config->log)
        config->log(result, message, config->user);
}

/* A failure before there is a context to keep the message. */
__attribute__((format(printf, 3, 4))) static sphg_result
refuse(const sphg_config *config, sphg_result result, const char *format, ...)
{
    char message[SPHGI_MESSAGE_LENGTH];
    va_list arguments;
    va_start(arguments, format);
    vsnprintf(message, sizeof message, format, arguments);
    va_end(arguments);
    report(config, result, message);
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
    memset(made, 0, sizeof *made);
    made->config = *config;
    made->allocator = allocator;
    made->threads = sphgi_thread_count(config);
    made->isa = config->isa == SPHG_ISA_BEST ? sphgi_cpu_best() : config->isa;
    atomic_flag_clear(&made->busy);
    choose_passes(made);
    fill_pack_order(made->pack_order);
    fill_pack_bytes((const uint64_t *)made->pack_order, made->pack_bytes);
    *context = made;
    return SPHG_OK;
}

enum { SCRATCH_BUFFERS = 12 };

static void list_scratch(sphg_context *context, struct sphgi_buffer **buffers)
{
    struct sphgi_buffer *all[SCRATCH_BUFFERS] = {
        &context->workers,       &context->packed,        &context->sums,
        &context->coefficients,  &context->selection,     &context->sort,
        &context->plan,          &context->input,         &context->order_grid[0],
        &context->order_grid[1], &context->order_grid[2], &context->order_grid[3]};
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

const struct sphgi_passes *sphgi_passes_of(const sphg_context *context, sphg_type type)
{
    return type == SPHG_F64 ? context->passes_f64 : context->passes_f32;
}

sphg_result sphgi_enter(sphg_context *context)
{
    if (!context)
        return SPHG_ERROR_ARGUMENT;
    if (atomic_flag_test_and_set_explicit(&context->busy, memory_order_acquire))
        return SPHG_ERROR_BUSY; /* the message belongs to the call that is under way */
    context->message[0] = '\0';
    context->host_floats = sphgi_floats_enter();
    return SPHG_OK;
}

sphg_result sphgi_leave(sphg_context *context, sphg_result result)
{
    sphgi_floats_leave(context->host_floats);
    atomic_flag_clear_explicit(&context->busy, memory_order_release);
    return result;
}

sphg_result sphgi_fail(sphg_context *context, sphg_result result, const char *format, ...)
{
    va_list arguments;
    va_start(arguments, format);
    vsnprintf(context->message, sizeof context->message, format, arguments);
    va_end(arguments);
    report(&context->config, result, context->message);
    return result;
}

sphg_result sphgi_fail_memory(sphg_context *context, const char *function)
{
    return sphgi_fail(context, SPHG_ERROR_MEMORY, "%s: the allocator returned NULL", function);
}
