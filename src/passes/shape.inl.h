/* Weights of the pairs of a piece: from x_ij and V_j to what is summed. */

SPHGI_TEMPLATE real *array_of(void *arrays, enum sphgi_array array)
{
    return (real *)arrays + array * SPHGI_PIECE;
}

SPHGI_TEMPLATE vec radius(vec x, vec y, vec z, bool three)
{
    vec square = x * x + y * y;
    if (three)
        square += z * z;
    return vsqrt(square);
}

/* s_ij x_ij (theory.md, section 2), s_ij divided by m_ref; MLS still lacks its V_i. */
SPHGI_TEMPLATE void vectors_as(const struct sphgi_shape *shape, real *a, int32_t count,
                               sphg_kernel kernel, sphg_method method, bool three)
{
    const vec scale = splat(R(method == SPHG_KGC ? shape->w_scale : -shape->w_scale));
    for (int32_t k = 0; k < count; k += LANES, a += LANES) {
        const vec x = load(a + SPHGI_X * SPHGI_PIECE), y = load(a + SPHGI_Y * SPHGI_PIECE);
        const vec z = three ? load(a + SPHGI_Z * SPHGI_PIECE) : splat(R(0));
        const vec v = load(a + SPHGI_V * SPHGI_PIECE);
        const vec q = radius(x, y, z, three);
        const vec shape_value = method == SPHG_KGC ? kernel_d(kernel, q) : kernel_w(kernel, q);
        vec s = scale * shape_value;
        if (method != SPHG_MLS)
            s *= v;
        store(a + SPHGI_GX * SPHGI_PIECE, s * x);
        store(a + SPHGI_GY * SPHGI_PIECE, s * y);
        if (three)
            store(a + SPHGI_GZ * SPHGI_PIECE, s * z);
    }
}

/* S: w_j, D: w_j'/r, both without V_j. */
SPHGI_TEMPLATE void weights_as(const struct sphgi_shape *shape, real *a, int32_t count,
                               sphg_kernel kernel, bool three)
{
    const vec scale = splat(R(shape->value_scale));
    for (int32_t k = 0; k < count; k += LANES, a += LANES) {
        const vec z = three ? load(a + SPHGI_Z * SPHGI_PIECE) : splat(R(0));
        const vec q =
            radius(load(a + SPHGI_X * SPHGI_PIECE), load(a + SPHGI_Y * SPHGI_PIECE), z, three);
        store(a + SPHGI_S * SPHGI_PIECE, scale * kernel_w(kernel, q));
        store(a + SPHGI_D * SPHGI_PIECE, scale * kernel_d(kernel, q));
    }
}

/* One instance per kernel, and inside it per method and dimension. */
#define SPHGI_INSTANCE(name, prefix, sigma2, sigma3, mu2_2, mu2_3)                                 \
    static void prefix##_vectors(const struct sphgi_shape *shape, void *arrays, int32_t count)     \
    {                                                                                              \
        vectors_of(shape, arrays, count, SPHG_##name);                                             \
    }                                                                                              \
    static void prefix##_weights(const struct sphgi_shape *shape, void *arrays, int32_t count)     \
    {                                                                                              \
        if (shape->dimension == 3)                                                                 \
            weights_as(shape, arrays, count, SPHG_##name, true);                                   \
        else                                                                                       \
            weights_as(shape, arrays, count, SPHG_##name, false);                                  \
    }

SPHGI_TEMPLATE void vectors_of(const struct sphgi_shape *shape, real *arrays, int32_t count,
                               sphg_kernel kernel)
{
    const bool three = shape->dimension == 3;
    if (shape->method == SPHG_MLS && three)
        vectors_as(shape, arrays, count, kernel, SPHG_MLS, true);
    else if (shape->method == SPHG_MLS)
        vectors_as(shape, arrays, count, kernel, SPHG_MLS, false);
    else if (shape->method == SPHG_RKPM && three)
        vectors_as(shape, arrays, count, kernel, SPHG_RKPM, true);
    else if (shape->method == SPHG_RKPM)
        vectors_as(shape, arrays, count, kernel, SPHG_RKPM, false);
    else if (three)
        vectors_as(shape, arrays, count, kernel, SPHG_KGC, true);
    else
        vectors_as(shape, arrays, count, kernel, SPHG_KGC, false);
}

SPHGI_KERNELS(SPHGI_INSTANCE)
#undef SPHGI_INSTANCE

typedef void shape_function(const struct sphgi_shape *shape, void *arrays, int32_t count);

static void shape_vectors(const struct sphgi_shape *shape, void *arrays, int32_t count)
{
    static shape_function *const instance[] = {
#define SPHGI_ENTRY(name, prefix, sigma2, sigma3, mu2_2, mu2_3) [SPHG_##name] = prefix##_vectors,
        SPHGI_KERNELS(SPHGI_ENTRY)
#undef SPHGI_ENTRY
    };
    instance[shape->kernel](shape, arrays, count);
}

static void shape_weights(const struct sphgi_shape *shape, void *arrays, int32_t count)
{
    static shape_function *const instance[] = {
#define SPHGI_ENTRY(name, prefix, sigma2, sigma3, mu2_2, mu2_3) [SPHG_##name] = prefix##_weights,
        SPHGI_KERNELS(SPHGI_ENTRY)
#undef SPHGI_ENTRY
    };
    instance[shape->kernel](shape, arrays, count);
}

/* PHI = V_j W; needs shape_weights. */
static void shape_values(void *arrays, int32_t count)
{
    for (int32_t k = 0; k < count; k += LANES)
        store(array_of(arrays, SPHGI_PHI) + k,
              load(array_of(arrays, SPHGI_V) + k) * load(array_of(arrays, SPHGI_S) + k));
}
