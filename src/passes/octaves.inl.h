/* SPDX-License-Identifier: MIT */
/* Rows with radii of their own into the cells of their octaves (search/octaves.h). */

/* 2^k, k the whole number of times that a radius goes into the largest by halves, at most `most`:
 * bits of positive numbers rise as these do. */
SPHGI_TEMPLATE int32_t octave_of(int64_t top, double radius, int32_t most)
{
    int64_t bits;
    __builtin_memcpy(&bits, &radius, sizeof bits);
    const int64_t octave = (top - bits) >> 52;
    return octave < most ? (int32_t)octave : most;
}

SPHGI_TEMPLATE double two_to_the(int32_t exponent)
{
    const int64_t bits = (int64_t)(1023 + exponent) << 52;
    double power;
    __builtin_memcpy(&power, &bits, sizeof power);
    return power;
}

/* Block and octave, and quarter of one of its cells of each row; as `cut` does it, in cells that
 * are as many times smaller. */
static bool cut_octaves(const struct sphgi_cutting *cutting, const void *rows, int32_t count,
                        int32_t (*block)[4], uint8_t *local)
{
    const struct cutter c = cutter_of(cutting);
    int64_t top;
    __builtin_memcpy(&top, &cutting->top, sizeof top);
    four_bits far = {0};
    for (int32_t k = 0; k < count; ++k) {
        const four_reals row = *(const four_reals *)((const real *)rows + SPHGI_ROW * k);
        const int32_t octave = octave_of(top, (double)row[3], cutting->octaves - 1);
        const four_doubles t =
            __builtin_convertvector(row, four_doubles) * c.scale * two_to_the(octave);
        const four_doubles raised = t - 0.5 + c.magic, whole = raised - c.magic;
        const four_bits bits = (four_bits)raised;
        far |= bits - c.nearest;
        const four_ints cell = __builtin_convertvector((four_longs)bits, four_ints);
        const four_ints parts = (cell & c.inside) << c.local_shift;
        four_ints at = cell >> c.shift;
        const int32_t first = at[0];
        at[3] = octave;
        at[0] = at[cutting->along];
        at[cutting->along] = first;
        *(four_ints *)block[k] = at;
        local[k] = (uint8_t)((parts[0] | parts[1] | parts[2]) * SPHGI_QUARTERS +
                             sphgi_quarter_of(t[cutting->along] - whole[cutting->along]));
    }
    return are_near(&far);
}
