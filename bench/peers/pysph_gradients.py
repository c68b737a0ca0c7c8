#!/usr/bin/env python3
# SPDX-License-Identifier: MIT
"""Gradients beside those of PySPH: plain SPH, its GradientCorrection beside KGC and its CRKSPH beside CRKPM, in f64 on
one thread, from positions to gradients. Both have the same kernel, so that they must agree to rounding.

    pysph_gradients.py [PARTICLES]     (100000)"""
import sys
import time
import numpy as np
import pysph
import sphgrad
from pysph.base.kernels import CubicSpline
from pysph.base.utils import get_particle_array
from pysph.sph.equation import Equation, Group
from pysph.sph.wc.crksph import CRKSPH, CRKSPHPreStep
from pysph.sph.wc.kernel_correction import GradientCorrection, GradientCorrectionPreStep
from pysph.tools.sph_evaluator import SPHEvaluator

ROUNDS = 5
ALWAYS = 1e9  # PySPH leaves out corrections that change a pair by more than its `tol`


class Gradient(Equation):
    """Of u, in the difference form, with the gradient of the kernel as the equations before have left it."""

    def initialize(self, d_idx, d_gradient):
        d_gradient[3 * d_idx] = 0.0
        d_gradient[3 * d_idx + 1] = 0.0
        d_gradient[3 * d_idx + 2] = 0.0

    def loop(self, d_idx, s_idx, d_gradient, d_u, s_u, s_m, s_rho, DWIJ):
        difference = s_m[s_idx] / s_rho[s_idx] * (s_u[s_idx] - d_u[d_idx])
        d_gradient[3 * d_idx] += difference * DWIJ[0]
        d_gradient[3 * d_idx + 1] += difference * DWIJ[1]
        d_gradient[3 * d_idx + 2] += difference * DWIJ[2]


def equations(first, correction):
    of = {"dest": "cloud", "sources": ["cloud"]}
    last = [Gradient(**of)]
    if first is None:
        return [Group(equations=last)]
    return [Group(equations=[first(dim=3, **of)]), Group(equations=[correction(dim=3, tol=ALWAYS, **of)] + last)]


# Name, PySPH's equations, our method.
PAIRS = (("plain SPH", None, None, "plain"),
         ("GradientCorrection", GradientCorrectionPreStep, GradientCorrection, "kgc"),
         ("CRKSPH", CRKSPHPreStep, CRKSPH, "crkpm"))


def cloud(side):
    """A cube of jittered particles, spacing 1, and a linear field."""
    axis = np.arange(float(side))
    lattice = np.stack(np.meshgrid(axis, axis, axis, indexing="ij"), -1).reshape(-1, 3)
    x = lattice + np.random.default_rng(1).uniform(-0.2, 0.2, lattice.shape)
    return x, x @ SLOPE


SLOPE = np.array([2.0, 3.0, -1.0])


def by_pysph(x, values, first, correction):
    """Gradients, and the milliseconds of each round."""
    particles = get_particle_array(name="cloud", x=x[:, 0], y=x[:, 1], z=x[:, 2], h=1.0, m=1.0, rho=1.0, u=values)
    for name, stride in (("gradient", 3), ("m_mat", 9), ("cwij", 1), ("ai", 1), ("gradai", 3), ("bi", 3), ("gradbi", 9)):
        particles.add_property(name, stride=stride)
    particles.add_property("V", data=1.0)  # the number of particles in a unit of volume
    evaluator = SPHEvaluator([particles], equations(first, correction), dim=3, kernel=CubicSpline(dim=3))
    times = []
    for _ in range(ROUNDS):
        start = time.perf_counter()
        evaluator.nnps.update()
        evaluator.evaluate()
        times.append(1e3 * (time.perf_counter() - start))
    return np.array(particles.gradient).reshape(-1, 3), times


def by_sphgrad(x, values, method):
    neighbors = sphgrad.Neighbors(x, sphgrad.Scheme(2.0, method), context=sphgrad.Context(threads=1))
    found = np.zeros_like(x)
    times = []
    for _ in range(ROUNDS):
        start = time.perf_counter()
        neighbors.search(x)
        sphgrad.gradient(neighbors, values, 1.0, out=found)
        times.append(1e3 * (time.perf_counter() - start))
    return found, times


def main():
    particles = float(sys.argv[1]) if len(sys.argv) > 1 else 1e5
    side = max(2, round(particles ** (1 / 3)))
    x, values = cloud(side)
    print(f"PySPH {pysph.__version__} beside sphgrad {sphgrad.__version__}, {len(x)} particles: milliseconds from positions"
          f" to gradients of a linear field, median (min-max) of {ROUNDS} rounds, one thread")
    for name, first, correction, method in PAIRS:
        theirs, their_times = by_pysph(x, values, first, correction)
        ours, our_times = by_sphgrad(x, values, method)
        size = np.linalg.norm(SLOPE)
        errors = [np.linalg.norm(found - SLOPE, axis=1).max() / size for found in (theirs, ours)]
        print(f"{name:18} {spread(their_times)}  {method:5} {spread(our_times)}  {ratio(their_times, our_times):6.2f} times"
              f" as long; largest error {errors[0]:.1e} and {errors[1]:.1e}, they differ by"
              f" {np.linalg.norm(theirs - ours, axis=1).max() / size:.1e}")


def spread(times):
    return f"{np.median(times):9.1f} ({min(times):.1f}-{max(times):.1f})"


def ratio(times, others):
    return np.median(times) / np.median(others)


if __name__ == "__main__":
    main()
