/* SPDX-License-Identifier: MIT */
#include "context.h"
#include "cpu.h"
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

void sphgi_context_open(sphg_context *context, const sphg_config *config)
{
    memset(context, 0, sizeof *context);
    context->config = *config;
    context->allocator = sphgi_allocator_of(config);
    context->isa = config->isa == SPHG_ISA_BEST ? sphgi_cpu_best() : config->isa;
    atomic_flag_clear(&context->busy);
    choose_passes(context);
    fill_pack_order(context->pack_order);
    fill_pack_bytes((const uint64_t *)context->pack_order, context->pack_bytes);
}

void sphgi_report(const sphg_config *config, sphg_result result, const char *message)
{
    if (config->log)
        config->log(result, message, config->user);
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
    sphgi_report(&context->config, result, context->message);
    return result;
}

sphg_result sphgi_fail_memory(sphg_context *context, const char *function)
{
    return sphgi_fail(context, SPHG_ERROR_MEMORY, "%s: the allocator returned NULL", function);
}
