# SPDX-License-Identifier: MIT
"""sphgrad: corrected first-order SPH derivatives (KGC, MLS, RKPM; linearised and classic) on NumPy.

    neighbors = sphgrad.Neighbors(positions, 2 * spacing)
    jacobian = sphgrad.jacobian(neighbors, velocities, volume)

docs/python.md is the manual."""
from ._c import (Fault, Form, Isa, Kernel, Method, Policy, Result, Shape, Type, VERSION)
from ._context import Context, ContextInfo, Error, default_context
from ._scheme import Scheme
from ._neighbors import ListFault, Lists, Neighbors, NeighborsInfo
from ._evaluate import Evaluation, Field, FieldResult, Sources, Stats, evaluate
from ._operators import correction_table, curl, divergence, force, gradient, jacobian
from ._pairs import Pairs, pairs
from ._matrices import eigen, invert_moments, svd

__version__ = ".".join(map(str, VERSION))
__all__ = [
    "Context", "ContextInfo", "Error", "Evaluation", "Fault", "Field", "FieldResult", "Form", "Isa",
    "Kernel", "ListFault", "Lists", "Method", "Neighbors", "NeighborsInfo", "Pairs", "Policy",
    "Result", "Scheme", "Shape", "Sources", "Stats", "Type", "VERSION", "correction_table", "curl",
    "default_context", "divergence", "eigen", "evaluate", "force", "gradient", "invert_moments",
    "jacobian", "pairs", "svd"]
