/* SPDX-License-Identifier: MIT */
/* Calls in any order on objects in any state, with an allocator that fails now and then: a code
 * that the header names, every block given back at the end. */
#include "blocks.h"
#include "fuzz.h"

enum { MOST = 20, OBJECTS = 3 };

typedef struct world {
    int fail; /* the allocation from now on that fails; 0: none */
    long blocks;
    sphg_context *context;
    sphg_neighbors *objects[OBJECTS];
    float x[MOST * 3], volume[MOST], field[MOST], out[MOST * 45], more[MOST * 16];
    float radii[MOST], second[4][MOST * 7], lent[MOST * 7], tensor[MOST * 9];
    int32_t order[MOST], indices[MOST * MOST];
    int64_t offsets[MOST + 1];
    uint8_t rank[MOST];
    sphg_scheme scheme;
} world;

static void *allocate(size_t size, size_t alignment, void *user)
{
    world *own = user;
    if (own->fail > 0 && --own->fail == 0)
        return NULL;
    void *memory = block_take(size);
    FUZZ_REQUIRE(memory && alignment <= BLOCK_HEADER, "no memory");
    ++own->blocks;
    return memory;
}

static void release(void *memory, size_t size, void *user)
{
    world *own = user;
    FUZZ_REQUIRE(block_size(memory) == size, "released %zu bytes of %zu", size, block_size(memory));
    --own->blocks;
    block_give(memory);
}

/* A search goes as it was foretold, where memory lasts for both. */
static sphg_result search_as_foretold(world *own, sphg_neighbors *object,
                                      const sphg_geometry *geometry)
{
    sphg_neighbors_info info = {0};
    int32_t rebuild = -1;
    const sphg_result asked =
        sphg_neighbors_would_rebuild(own->context, object, &own->scheme, geometry, &rebuild);
    const sphg_result searched =
        sphg_neighbors_search(own->context, object, &own->scheme, geometry);
    if (asked == SPHG_ERROR_MEMORY || searched == SPHG_ERROR_MEMORY)
        return searched;
    FUZZ_REQUIRE(asked == searched, "foretold %d, found %d", (int)asked, (int)searched);
    if (searched == SPHG_OK && sphg_neighbors_get_info(own->context, object, &info) == SPHG_OK)
        FUZZ_REQUIRE(info.rebuilt == rebuild, "rebuilt %d, foretold %d", (int)info.rebuilt,
                     (int)rebuild);
    return searched;
}

static sphg_result search(world *own, fuzz_bytes *from, sphg_neighbors *object)
{
    const int count = fuzz_below(from, MOST + 1), flags = fuzz_byte(from);
    sphg_geometry geometry = {.sources = sphg_view_f32(own->x, own->scheme.dimension * 4),
                              .source_count = count,
                              .target_count = flags & 1 ? count : count / 2,
                              .list_free = (flags & 2) != 0,
                              .skin = flags & 4 ? .25 : 0,
                              .period = {flags & 8 ? 40 : 0},
                              .mutual = (flags & 64) != 0};
    const sphg_lists lists = {.offsets = own->offsets, .indices = own->indices};
    for (int k = 0; k < count * 3; ++k)
        own->x[k] = (float)fuzz_tame(from);
    if (flags & 32)
        geometry.source_support = sphg_view_f32(own->radii, 4);
    for (int i = 0; i < count && flags & 32; ++i)
        own->radii[i] = (float)ldexp(1 + fuzz_byte(from) % 16, -(fuzz_byte(from) % 24));
    if (!(flags & 16))
        return search_as_foretold(own, object, &geometry);
    for (int i = 0; i <= MOST; ++i)
        own->offsets[i] = (int64_t)i * count;
    for (int k = 0; k < MOST * MOST; ++k)
        own->indices[k] = count ? k % count : 0;
    return sphg_neighbors_use_lists(own->context, object, &own->scheme, &geometry, &lists);
}

/* Second derivatives, with lenders or without. */
static void ask_for_curvature(world *own, int wanted, const sphg_view *lenders, sphg_field *field,
                              sphg_request *request)
{
    field->gradient = sphg_view_f32(own->out, own->scheme.dimension * 4);
    field->hessian = wanted & 1 ? sphg_view_f32(own->second[0], 24) : sphg_absent();
    field->laplacian = wanted & 2 ? sphg_view_f32(own->second[1], 4) : sphg_absent();
    field->curvature = wanted & 4 ? sphg_view_f32(own->second[2], 28) : sphg_absent();
    field->lenders = wanted & 8 ? lenders : NULL;
    request->borrows = wanted & 16 ? sphg_view_u8(own->rank, 1) : sphg_absent();
}

static void ask_for_values(world *own, int wanted, const sphg_view *volumes, sphg_field *field)
{
    field->form = wanted & 1 ? SPHG_DIRECT : SPHG_DIFFERENCE;
    field->shepard = wanted & 1;
    field->value = sphg_view_f32(own->second[3], 4);
    field->value_volume = wanted & 2 ? volumes : NULL;
}

/* What order 2, diffusion and other sums add to a field; now and then what its form has not. */
static sphg_result ask_for_more(world *own, fuzz_bytes *from, sphg_sources *sources,
                                const sphg_subset *chosen)
{
    const int d = own->scheme.dimension, kind = fuzz_byte(from), wanted = fuzz_byte(from);
    const sphg_view scalars = sphg_view_f32(own->field, 4), volumes = sphg_view_f32(own->volume, 4),
                    vectors = sphg_view_f32(own->x, 4 * d), lenders = sphg_view_f32(own->lent, 28);
    sphg_field field = {.shape = SPHG_SCALAR, .at_sources = &scalars};
    sphg_request request = {
        .sources = sources, .fields = &field, .set_count = 1, .field_count = 1, .subset = chosen};
    sphg_stats stats;
    if (kind % 4 == 0) {
        ask_for_curvature(own, wanted, &lenders, &field, &request);
        request.stats = wanted & 32 ? &stats : NULL;
    } else if (kind % 4 == 1) {
        field.form = SPHG_ADJOINT;
        field.laplacian = sphg_view_f32(own->second[1], 4);
        field.coefficient = wanted & 1 ? &volumes : NULL;
        field.coefficient_at_targets = wanted & 2 ? volumes : sphg_absent();
        sources->correction = sphg_view_f32(own->out, 180);
    } else if (kind % 4 == 2) {
        ask_for_values(own, wanted, &volumes, &field);
    } else {
        field.shape = SPHG_VECTOR;
        field.at_sources = &vectors;
        field.tensor = sphg_view_f32(own->tensor, 4 * d * d);
        field.contraction = sphg_view_f32(own->more, 4);
    }
    if (kind > 240)
        field.form = (sphg_form)(kind / 4 % 4);
    const sphg_result result = sphg_evaluate(own->context, &own->scheme, &request);
    for (int k = 0; k < MOST * 7 && result == SPHG_OK && wanted & 4; ++k)
        own->lent[k] = own->second[2][k];
    return result;
}

static sphg_result operate(world *own, fuzz_bytes *from, const sphg_neighbors *object)
{
    const int d = own->scheme.dimension, drawn = fuzz_byte(from);
    const int kind = drawn % 6;
    sphg_sources sources = {.neighbors = object, .volume = sphg_view_f32(own->volume, 4)};
    const sphg_view field = sphg_view_f32(own->field, 4), out = sphg_view_f32(own->out, d * 4);
    const sphg_subset subset = {0, fuzz_below(from, MOST + 1), NULL, NULL};
    const sphg_subset *chosen = fuzz_byte(from) % 2 ? &subset : NULL;
    sphg_view table = sphg_view_f32(own->out, 180);
    table.layout = (sphg_layout)(subset.end % 3); /* refused where it has no meaning */
    if (kind == 0)
        return sphg_gradient(own->context, &own->scheme, &sources, chosen, field, out);
    if (kind == 1)
        return sphg_correction(own->context, &own->scheme, &sources, chosen, table,
                               sphg_view_u8(own->rank, 1));
    if (drawn >= 192)
        return ask_for_more(own, from, &sources, chosen);
    if (kind == 2)
        return sphg_force(own->context, &own->scheme, &sources, chosen, SPHG_SCALAR, field, out);
    sphg_pairs pairs = {.offsets = own->offsets, .capacity = fuzz_byte(from)};
    if (kind == 3)
        return sphg_pair_gradients(own->context, &own->scheme, &sources, chosen, sphg_absent(),
                                   &pairs);
    sphg_sources both[2] = {sources, sources};
    both[1].neighbors = own->objects[fuzz_byte(from) % OBJECTS];
    const sphg_view fields[2] = {field, kind == 4 ? field : sphg_absent()};
    const sphg_field one = {.shape = SPHG_SCALAR, .at_sources = fields, .gradient = out};
    const sphg_request request = {.sources = both,
                                  .fields = &one,
                                  .set_count = 2,
                                  .field_count = 1,
                                  .subset = chosen,
                                  .rank = sphg_view_u8(own->rank, 1)};
    return sphg_evaluate(own->context, &own->scheme, &request);
}

/* Kept lists are right. Those of the host are shared by all objects, so that any fault may be. */
static sphg_result check(world *own, const sphg_neighbors *object)
{
    sphg_list_fault fault = {.kind = SPHG_FAULT_NONE};
    const sphg_result result = sphg_neighbors_check(own->context, &own->scheme, object, &fault);
    const int named = result == SPHG_ERROR_LISTS || result == SPHG_ERROR_INDEX;
    FUZZ_REQUIRE((fault.kind != SPHG_FAULT_NONE) == named, "fault %d: %s", (int)fault.kind,
                 sphg_last_message(own->context));
    return result == SPHG_ERROR_LISTS ? SPHG_OK : result;
}

static sphg_result question(world *own, fuzz_bytes *from, const sphg_neighbors *object)
{
    sphg_neighbors_info info;
    sphg_context_info context_info;
    const sphg_view tensors = sphg_view_f32(own->out, 36);
    switch (fuzz_byte(from) % 6) {
    case 0:
        return sphg_neighbors_get_info(own->context, object, &info);
    case 1:
        return sphg_neighbors_get_order(own->context, object, own->order);
    case 2:
        return sphg_eigen(own->context, 3, MOST, tensors, sphg_view_f32(own->more, 12),
                          sphg_absent());
    case 3:
        return sphg_svd(own->context, MOST, tensors, sphg_absent(), sphg_view_f32(own->more, 12),
                        sphg_absent());
    case 4:
        return sphg_context_get_info(own->context, &context_info);
    default:
        return check(own, object);
    }
}

static sphg_result step(world *own, fuzz_bytes *from)
{
    sphg_neighbors **object = &own->objects[fuzz_byte(from) % OBJECTS];
    int method;
    switch (fuzz_byte(from) % 8) {
    case 0:
        sphg_neighbors_destroy(*object);
        *object = NULL;
        return SPHG_OK;
    case 1:
        if (*object)
            return SPHG_OK;
        return sphg_neighbors_create(own->context, object);
    case 2:
        own->scheme.dimension = 2 + fuzz_byte(from) % 2;
        method = fuzz_byte(from);
        own->scheme.method = (sphg_method)(method % 6);
        own->scheme.order = method / 6 % 3;
        own->scheme.support_radius = (1 + fuzz_byte(from)) / 16.;
        return SPHG_OK;
    case 3:
    case 4:
        return search(own, from, *object);
    case 5:
        return question(own, from, *object);
    default:
        return operate(own, from, *object);
    }
}

int LLVMFuzzerTestOneInput(const uint8_t *data, size_t size)
{
    static world own;
    fuzz_bytes from = {data, size};
    memset(&own, 0, sizeof own);
    const sphg_config config = {.threads = 1,
                                .isa = fuzz_isa(size),
                                .allocate = allocate,
                                .release = release,
                                .user = &own};
    own.scheme = (sphg_scheme){.dimension = 3, .support_radius = 1};
    own.fail = fuzz_byte(&from) % 4;
    if (sphg_context_create(SPHG_VERSION, &config, &own.context) == SPHG_OK)
        for (int k = 0; k < 16 && from.left; ++k) {
            const int armed = fuzz_byte(&from);
            own.fail = armed > 128 ? armed % 24 : 0;
            for (int i = 0; i < MOST; ++i)
                own.volume[i] = 1;
            const sphg_result result = step(&own, &from);
            /* ERROR_INDEX: all objects share the lists, which the last build wrote */
            FUZZ_REQUIRE(result >= SPHG_ERROR_INDEX && result <= SPHG_ERROR_CAPACITY, "%d: %s",
                         (int)result, sphg_last_message(own.context));
            FUZZ_REQUIRE(result != SPHG_ERROR_MEMORY || armed > 128, "memory failed by itself");
        }
    for (int k = 0; k < OBJECTS; ++k)
        sphg_neighbors_destroy(own.objects[k]);
    sphg_context_destroy(own.context);
    FUZZ_REQUIRE(own.blocks == 0, "%ld blocks leaked", own.blocks);
    return 0;
}
