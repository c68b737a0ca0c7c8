# SPDX-License-Identifier: MIT
"""Pairs as CSR, with their gradients: for loops and matrices of your own."""
import ctypes as c
import dataclasses
import numpy as np
from . import _c
from ._evaluate import Call
from ._views import TYPES, absent


@dataclasses.dataclass
class Pairs:
    """Row k holds the k-th selected target's sources indices[offsets[k]:offsets[k + 1]], ascending
    unless any_order; gradient has G_ij of each, an array (pairs, d), or is None."""
    offsets: np.ndarray
    indices: np.ndarray
    gradient: object
    source_count: int

    def matrix(self, data=None):
        """A SciPy CSR matrix, rows by sources. data: a number per pair; None: 1 each."""
        from scipy.sparse import csr_matrix
        if data is None:
            data = np.ones(len(self.indices))
        data = np.asarray(data)
        if data.shape != self.indices.shape:
            raise ValueError(f"data has the shape {data.shape}, must have {self.indices.shape}")
        shape = (len(self.offsets) - 1, self.source_count)
        return csr_matrix((data, self.indices, self.offsets), shape=shape)

    def gradient_matrices(self):
        """A SciPy CSR matrix for each direction: matrix k times A is sum_j A_j (G_ij)_k."""
        if self.gradient is None:
            raise ValueError("the pairs were found without gradient=True")
        return [self.matrix(self.gradient[:, k]) for k in range(self.gradient.shape[1])]


def pairs(sources, volume=None, *, gradient=False, scheme=None, subset=None,
          target_correction=None, any_order=False):
    """The selected targets' pairs with r < H, with G_ij if `gradient`. One source set."""
    call = Call(sources, volume, scheme, subset)
    if len(call.sets) != 1:
        raise ValueError("pairs are those of one source set")
    with call.context._calls() as context:
        call.begin()
        table = call.target(target_correction, (call.width,), "target_correction",
                            call.table_shape)
        offsets = np.zeros(call.selected + 1, np.int64)
        wanted = _c.Pairs(offsets=offsets.ctypes.data, gradient=absent(), any_order=bool(any_order))
        subset = None if call.subset is None else c.byref(call.subset)

        def find():
            call.context._check(_c.functions.sphg_pair_gradients(
                context, c.byref(call.c_scheme), call.c_sources, subset, table, c.byref(wanted)))

        find()
        indices = np.empty(wanted.count, np.int32)
        found = np.empty((wanted.count, call.dimension), call.dtype) if gradient else None
        wanted.capacity = wanted.count
        wanted.indices = indices.ctypes.data
        if gradient:
            wanted.gradient = _c.View(found.ctypes.data, None, None, found.strides[0],
                                      TYPES[call.dtype])
        find()
    return Pairs(offsets, indices, found, call.sets[0].neighbors.source_count)
