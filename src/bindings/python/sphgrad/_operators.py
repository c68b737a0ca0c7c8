# SPDX-License-Identifier: MIT
"""The usual operators: requests of one field."""
import numpy as np
from . import _c
from ._evaluate import Field, Sources, _sets, evaluate
from ._scheme import as_scheme


def _one(name, sources, values, volume, out, options):
    field_options = {key: options.pop(key) for key in
                     ("form", "at_targets", "accumulate", "mirror", "shape") if key in options}
    field = Field(values, **{name: True if out is None else out}, **field_options)
    return getattr(evaluate(sources, field, volume=volume, **options).fields[0], name)


def gradient(sources, values, volume=None, *, out=None, **options):
    """The gradient of a scalar field, an array (n, d); of a vector field that is the Jacobian.

    sources: Neighbors and `volume`, Sources, or a list of these (and of values). Options are those of
    Field (form, at_targets, mirror, ...) and of evaluate() (scheme, subset, target_correction, ...)."""
    return _one("gradient", sources, values, volume, out, options)


def jacobian(sources, values, volume=None, *, out=None, **options):
    """J[i, a, b] = d v_a / d x_b of a vector field, an array (n, d, d). Options as at gradient()."""
    options.setdefault("shape", _c.Shape.VECTOR)
    return _one("gradient", sources, values, volume, out, options)


def divergence(sources, values, volume=None, *, out=None, **options):
    """Of a vector field (n,); of a tensor, symmetric or not, (n, d). Options as at gradient()."""
    return _one("divergence", sources, values, volume, out, options)


def curl(sources, values, volume=None, *, out=None, **options):
    """Of a vector field: (n, 3), in 2D (n,). Options as at gradient()."""
    return _one("curl", sources, values, volume, out, options)


def force(sources, stress, volume=None, *, correction=None, out=None, **options):
    """The adjoint form, f_i = sum V_i S_i G_ij - V_j S_j G_ji, an array (n, d). stress: (n,) for S
    times the unit matrix, or a symmetric or full tensor. correction: the table of all sources, with one
    source set; None: computed here for sources that are all targets."""
    sets = _sets(sources, volume)
    if correction is not None or (len(sets) == 1 and sets[0].correction is None):
        if len(sets) != 1:
            raise ValueError("with several source sets corrections stand in Sources")
        one = sets[0]
        if correction is None:
            correction = _own_correction(one, options.get("scheme"))
        sets = [Sources(one.neighbors, one.volume, one.density, correction)]
    shape = options.get("shape")
    first = next((s for s in (stress if isinstance(stress, (list, tuple)) else [stress])
                  if s is not None), None)
    scalar = shape in (_c.Shape.SCALAR, "scalar") or (shape is None and np.ndim(first) <= 1)
    options["form"] = _c.Form.ADJOINT
    return _one("gradient" if scalar else "divergence", sets, stress, None, out, options)


def _own_correction(one, scheme):
    """The table that `force` needs, or None where the method has none."""
    n = one.neighbors
    width = (n.scheme if scheme is None else as_scheme(scheme)).correction_width(n.dimension)
    if width == 0:
        return None
    if not n.part_of or n.target_count != n.source_count:
        raise ValueError("the sources are not all targets: force needs the correction of each")
    return correction_table(n, one.volume, scheme=scheme)


def correction_table(sources, volume=None, *, out=None, rank=None, **options):
    """C_i, an array (n, width): what the operators compute on the way, kept for several uses. With
    rank=True, or an array of uint8, the pair (table, rank)."""
    found = evaluate(sources, volume=volume, correction=True if out is None else out, rank=rank,
                     **options)
    return found.correction if rank is None or rank is False else (found.correction, found.rank)

