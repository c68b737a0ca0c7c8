# SPDX-License-Identifier: MIT
"""Small matrices in batches: moments of your own, eigenvalues, singular values."""
import ctypes as c
import numpy as np
from . import _c
from ._c import Shape
from ._context import default_context
from ._evaluate import stats_of
from ._scheme import as_scheme
from ._views import Borrowed, count_of, precision_of


def _batch(array, name):
    array = np.asarray(array)
    if array.ndim < 2:
        raise ValueError(f"{name} has the shape {array.shape}, must have one item a row")
    return array, count_of(array, name), precision_of(array.dtype, name)


def invert_moments(moments, scheme, volume=None, *, correction=None, rank=False, lambda_min=False,
                   stats=False, context=None):
    """C = f(M) of moments (n, 6), in 2D (n, 3), that you summed yourself. Returns the table; with any
    of rank, lambda_min and stats a tuple of it and these. correction: the array to write to."""
    moments, count, dtype = _batch(moments, "moments")
    if moments.shape[1:] not in ((3,), (6,)):
        raise ValueError(f"moments has the shape {moments.shape}, must have (n, 3) or (n, 6)")
    dimension = 3 if moments.shape[1] == 6 else 2
    context = default_context() if context is None else context
    c_scheme, borrowed = as_scheme(scheme)._c_scheme(dimension), Borrowed()
    items = moments.shape[1:]
    table = np.empty((count,) + items, dtype) if correction is None else correction
    ranks = np.empty(count, np.uint8) if rank else None
    lambdas = np.empty(count, dtype) if lambda_min else None
    c_stats = _c.Stats()
    given = borrowed.input(moments, count, items, dtype, "moments", Shape.SYM_TENSOR, same=False)
    volumes = borrowed.input(volume, count, (), dtype, "volume")
    wanted = _c.Inversion(
        borrowed.output(table, count, items, dtype, "correction", Shape.SYM_TENSOR),
        borrowed.output(ranks, count, (), np.dtype(np.uint8), "rank"),
        borrowed.output(lambdas, count, (), dtype, "lambda_min"), c.pointer(c_stats))
    with context._calls() as pointer:
        context._check(_c.functions.sphg_invert_moments(pointer, c.byref(c_scheme), count, given,
                                                      volumes, c.byref(wanted)))
        borrowed.finish()
    extra = tuple(x for x in (ranks, lambdas, stats_of(c_stats) if stats else None)
                  if x is not None)
    return (table,) + extra if extra else table


def eigen(matrices, vectors=True, *, context=None):
    """Eigenvalues, descending, of symmetric matrices (n, 6), in 2D (n, 3); and unless vectors is False
    the matrices (n, d, d) whose columns are the eigenvectors."""
    matrices, count, dtype = _batch(matrices, "matrices")
    if matrices.shape[1:] not in ((3,), (6,)):
        raise ValueError(f"matrices has the shape {matrices.shape}, must have (n, 3) or (n, 6)")
    d = 3 if matrices.shape[1] == 6 else 2
    context, borrowed = default_context() if context is None else context, Borrowed()
    values = np.empty((count, d), dtype)
    columns = np.empty((count, d, d), dtype) if vectors else None
    with context._calls() as pointer:
        context._check(_c.functions.sphg_eigen(
            pointer, d, count,
            borrowed.input(matrices, count, matrices.shape[1:], dtype, "matrices",
                           Shape.SYM_TENSOR, same=False),
            borrowed.output(values, count, (d,), dtype, "values", Shape.VECTOR),
            borrowed.output(columns, count, (d, d), dtype, "vectors", Shape.TENSOR)))
    return (values, columns) if vectors else values


def svd(matrices, *, context=None):
    """U, sigma, V of matrices (n, 3, 3): A = U diag(sigma) V^T, sigma descending."""
    matrices, count, dtype = _batch(matrices, "matrices")
    if matrices.shape[1:] != (3, 3):
        raise ValueError(f"matrices has the shape {matrices.shape}, must have (n, 3, 3)")
    context, borrowed = default_context() if context is None else context, Borrowed()
    u, v = np.empty((count, 3, 3), dtype), np.empty((count, 3, 3), dtype)
    sigma = np.empty((count, 3), dtype)
    with context._calls() as pointer:
        context._check(_c.functions.sphg_svd(
            pointer, count,
            borrowed.input(matrices, count, (3, 3), dtype, "matrices", Shape.TENSOR, same=False),
            borrowed.output(u, count, (3, 3), dtype, "u", Shape.TENSOR),
            borrowed.output(sigma, count, (3,), dtype, "sigma", Shape.VECTOR),
            borrowed.output(v, count, (3, 3), dtype, "v", Shape.TENSOR)))
    return u, sigma, v
