# SPDX-License-Identifier: MIT
"""What the tests of the Python package share: clouds, and a reference in plain NumPy."""
import os
import sys
import unittest

try:
    import numpy as np
except ImportError:
    print("skipped: this Python has no NumPy")
    sys.exit(77)

import sphgrad as sg

PRECISIONS = (np.float32, np.float64)


def cloud(side=6, dimension=3, dtype=np.float64, seed=1):
    """A shaken lattice of unit spacing."""
    axes = np.meshgrid(*[np.arange(side)] * dimension, indexing="ij")
    lattice = np.stack(axes, -1).reshape(-1, dimension).astype(np.float64)
    shaken = lattice + np.random.default_rng(seed).uniform(-0.2, 0.2, lattice.shape)
    return np.ascontiguousarray(shaken.astype(dtype))


def waves(x):
    """A smooth field of vectors."""
    return np.ascontiguousarray(np.sin(x + 0.3 * np.roll(x, 1, axis=1)).astype(x.dtype))


def pair_gradients(scheme, targets, sources, volume):
    """G[i, j, :] of KGC by its definition, all pairs, no threshold."""
    apart = targets[:, None, :] - sources[None, :, :]
    distance = np.sqrt((apart ** 2).sum(-1))
    _, slope = scheme.kernel_value(distance)
    weight = np.where((distance > 0) & (distance < scheme.support_radius), volume * slope, 0)
    moments = -np.einsum("ij,ija,ijb->iab", weight, apart, apart)
    return np.einsum("iab,ij,ijb->ija", np.linalg.inv(moments), weight, apart)


def guarded(shape, dtype):
    """An array for results amid numbers that nobody may touch, and those numbers."""
    size = int(np.prod(shape))
    memory = np.full(size + 128, 12345, dtype)
    return memory[64:64 + size].reshape(shape), memory


def untouched(memory):
    return bool((memory[:64] == 12345).all() and (memory[-64:] == 12345).all())


class Case(unittest.TestCase):
    def close(self, found, expected, roundings, scale=1.0):
        """Within so many roundings of the type, relative to `scale`."""
        found = np.asarray(found)
        error = float(np.abs(found - expected).max()) if found.size else 0.0
        limit = roundings * float(np.finfo(found.dtype).eps) * scale
        self.assertLessEqual(error, limit)

    def same(self, found, expected):
        np.testing.assert_array_equal(found, expected)


def main():
    unittest.main(verbosity=1 if os.environ.get("CI") else 2)
