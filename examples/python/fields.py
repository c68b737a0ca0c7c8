#!/usr/bin/env python3
# SPDX-License-Identifier: MIT
"""Errors of a gradient by plain SPH and by three corrections.
The field is trigonometric, on a shaken square of particles that is cut off at its border. Errors are printed, and drawn
if Matplotlib is there.

    python3 fields.py [PICTURE]     (fields_python.png)"""
import sys
import numpy as np
import sphgrad

SIDE = 60
SPACING = 1 / SIDE


def positions():
    """Particles in the unit square, off their lattice by up to a tenth of the spacing."""
    middle = (np.arange(SIDE) + 0.5) * SPACING
    lattice = np.stack(np.meshgrid(middle, middle), -1).reshape(-1, 2)
    return lattice + np.random.default_rng(1).uniform(-0.1, 0.1, lattice.shape) * SPACING


def field(x):
    """A(x, y) = sin(2 pi x) cos(2 pi y), and its gradient."""
    a, b = 2 * np.pi * x[:, 0], 2 * np.pi * x[:, 1]
    gradient = 2 * np.pi * np.stack([np.cos(a) * np.cos(b), -np.sin(a) * np.sin(b)], 1)
    return np.sin(a) * np.cos(b), gradient


def errors(x, values, exact):
    """Method: length of the error at every particle, relative to the largest gradient."""
    neighbors = sphgrad.Neighbors(x, 2 * SPACING)
    found = {}
    for method in ("plain", "kgc", "mls", "rkpm"):
        gradient = sphgrad.gradient(neighbors, values, SPACING ** 2,
                                    scheme=sphgrad.Scheme(2 * SPACING, method))
        found[method] = np.linalg.norm(gradient - exact, axis=1) / np.abs(exact).max()
    return found


def draw(x, values, found, picture):
    import matplotlib
    matplotlib.use("Agg")
    from matplotlib import pyplot
    figure, axes = pyplot.subplots(1, 5, figsize=(14, 3.4), layout="constrained")
    size = (200 / SIDE) ** 2

    def panel(axis, numbers, title, **colours):
        axis.set_title(title)
        axis.set_aspect("equal")
        axis.set_axis_off()
        return axis.scatter(x[:, 0], x[:, 1], size, numbers, linewidths=0, **colours)

    dots = panel(axes[0], values, "field", cmap="coolwarm")
    figure.colorbar(dots, ax=axes[0], location="bottom", shrink=0.8)
    for axis, (method, error) in zip(axes[1:], found.items()):
        dots = panel(axis, np.log10(np.maximum(error, 1e-4)), "error, " + method, cmap="viridis",
                     vmin=-4, vmax=0)
    figure.colorbar(dots, ax=axes[1:], location="bottom", shrink=0.4, label="log10 of the error")
    figure.savefig(picture, dpi=120)


def main():
    picture = sys.argv[1] if len(sys.argv) > 1 else "fields_python.png"
    x = positions()
    values, exact = field(x)
    found = errors(x, values, exact)
    for method, error in found.items():
        print(f"{method:6} largest error {error.max():.3f}, mean {error.mean():.4f}")
    try:
        draw(x, values, found, picture)
        print(f"drawn: {picture}")
    except ImportError:
        print("not drawn: this Python has no Matplotlib (Debian, Ubuntu: python3-matplotlib)")


if __name__ == "__main__":
    main()
