# SPDX-License-Identifier: MIT
"""Scheme: which derivative. Kernels and single pairs need no more than that."""
import ctypes as c
import dataclasses
import numpy as np
from . import _c
from ._context import choose


@dataclasses.dataclass(frozen=True)
class Scheme:
    """Support radius H, method, smoothing function, what becomes of directions that the cloud lacks.

    method: "kgc", "mls", "rkpm", "cmls", "crkpm" or "plain". kernel: "cubic_spline",
    "quintic_spline", "wendland_c2", "wendland_c4", "wendland_c6", "poly6" or "spiky". policy: "blend",
    "replace", "truncate" or "identity". threshold: 0 for 1e-2. dimension: 2 or 3; None: that of the
    positions. order: 2 for derivatives that are exact on quadratic fields ("kgc", "mls", "rkpm").
    dataclasses.replace() makes others of it."""
    support_radius: float
    method: _c.Method = _c.Method.KGC
    kernel: _c.Kernel = _c.Kernel.CUBIC_SPLINE
    policy: _c.Policy = _c.Policy.BLEND
    threshold: float = 0.0
    dimension: int = None
    order: int = 1

    def __post_init__(self):
        for name, kind in (("method", _c.Method), ("kernel", _c.Kernel), ("policy", _c.Policy)):
            object.__setattr__(self, name, choose(kind, getattr(self, name)))
        for name in ("support_radius", "threshold"):
            object.__setattr__(self, name, float(getattr(self, name)))
        if self.dimension not in (None, 2, 3):
            raise ValueError(f"dimension is {self.dimension!r}, must be 2 or 3")

    def _c_scheme(self, dimension=None):
        if dimension and self.dimension not in (None, dimension):
            raise ValueError(f"the scheme has {self.dimension} dimensions, the positions {dimension}")
        return _c.Scheme(dimension or self.dimension or 3, self.method, self.kernel, self.policy,
                         self.support_radius, self.threshold, self.order)

    def correction_width(self, dimension=None):
        """Numbers per particle of a correction table."""
        return _c.functions.sphg_correction_width(c.byref(self._c_scheme(dimension)))

    def kernel_value(self, r):
        """W(r) and W'(r)/r, of a distance or of an array of them."""
        scheme, w, slope = self._c_scheme(), c.c_double(), c.c_double()
        r = np.asarray(r, np.float64)
        both = np.empty((2,) + r.shape)
        flat = both.reshape(2, -1)
        for k, distance in enumerate(r.ravel()):
            _c.functions.sphg_kernel_value(c.byref(scheme), distance, c.byref(w), c.byref(slope))
            flat[0, k], flat[1, k] = w.value, slope.value
        return both[0][()], both[1][()]

    def kernel_constants(self):
        """sigma and the second moment mu2 of the smoothing function."""
        sigma, mu2 = c.c_double(), c.c_double()
        _c.functions.sphg_kernel_constants(c.byref(self._c_scheme()), c.byref(sigma), c.byref(mu2))
        return sigma.value, mu2.value

    def pair_gradient(self, x_ij, volume, correction=None):
        """G_ij of one pair. correction: the target's row of a table; None for "plain" alone."""
        x_ij = np.ascontiguousarray(x_ij, np.float64)
        if x_ij.shape not in ((2,), (3,)):
            raise ValueError(f"x_ij has the shape {x_ij.shape}, must have (2,) or (3,)")
        scheme = self._c_scheme(len(x_ij))
        width, gradient = _c.functions.sphg_correction_width(c.byref(scheme)), np.empty_like(x_ij)
        pointer = c.POINTER(c.c_double)
        if correction is None:
            if width:
                raise ValueError(f"the method {self.method.name} needs the target's correction")
            row = None
        else:
            table = np.ascontiguousarray(correction, np.float64)
            if table.shape != (width,):
                raise ValueError(f"correction has the shape {table.shape}, must have {(width,)}")
            row = table.ctypes.data_as(pointer)
        _c.functions.sphg_pair_gradient(c.byref(scheme), x_ij.ctypes.data_as(pointer), volume, row,
                                      gradient.ctypes.data_as(pointer))
        return gradient


def as_scheme(scheme):
    return scheme if isinstance(scheme, Scheme) else Scheme(scheme)
