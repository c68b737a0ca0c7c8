/* SPDX-License-Identifier: MIT */
#include "rotation.h"
#include <stdlib.h>

struct rotations rotations_new(int32_t capacity)
{
    struct rotations made = {.left = array_new(capacity, sizeof *made.left),
                             .right = array_new(capacity, sizeof *made.right),
                             .sigma = array_new(capacity, sizeof *made.sigma)};
    return made;
}

void rotations_free(struct rotations *rotations)
{
    free(rotations->left);
    free(rotations->right);
    free(rotations->sigma);
}

static double determinant(const double *a)
{
    vector normal;
    cross(a + 3, a + 6, normal);
    return dot(a, normal);
}

/* U diag(1, 1, sign) V^T */
static void multiply(const double *u, double sign, const double *v, double *result)
{
    for (int a = 0; a < 3; ++a)
        for (int b = 0; b < 3; ++b)
            result[3 * a + b] = u[3 * a] * v[3 * b] + u[3 * a + 1] * v[3 * b + 1] +
                                sign * u[3 * a + 2] * v[3 * b + 2];
}

void rotations_find(const struct sph *sph, struct rotations *rotations, int32_t count,
                    tensor *matrices, tensor *found)
{
    sph_check(sph, sphg_svd(sph->context, count, tensors(matrices), tensors(rotations->left),
                            vectors(rotations->sigma), tensors(rotations->right)));
    for (int32_t i = 0; i < count; ++i) {
        const double *u = rotations->left[i], *v = rotations->right[i];
        const double sign = determinant(u) * determinant(v) < 0 ? -1 : 1;
        multiply(u, sign, v, found[i]);
        rotations->sigma[i][2] *= sign;
    }
}
