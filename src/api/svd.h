/* SPDX-License-Identifier: MIT */
/* Singular value decomposition of one 3 x 3 matrix. */
#ifndef SPHGI_SVD_H
#define SPHGI_SVD_H

/* a = u diag(sigma) v^T, row-major; sigma descending, >= 0; u and v orthogonal. NaN or Inf in a
 * gives NaN. */
void sphgi_svd(const double *a, double *u, double *sigma, double *v);

#endif
