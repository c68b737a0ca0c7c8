# SPDX-License-Identifier: MIT
"""Requests: which results of which fields, in one sweep over the pairs."""
import ctypes as c
import dataclasses
import numpy as np
from . import _c
from ._context import choose
from ._neighbors import Neighbors
from ._scheme import as_scheme
from ._views import Borrowed, absent, as_array, item_shape


@dataclasses.dataclass
class Sources:
    """One source set: its neighbours, volumes V_j (an array, or a number for all), and for some forms
    densities and a table of corrections. same_volumes: the volumes are those of the sweep before, so
    that weights which the neighbours keep may be read."""
    neighbors: Neighbors
    volume: object = None
    density: object = None
    correction: object = None
    same_volumes: bool = False


@dataclasses.dataclass
class Field:
    """One field, and what is wanted of it.

    values is an array of A_j, or a list of one per source set, None where a set has none. Its shape is
    seen from the array: (n,) scalar, (n, d) vector, (n, d (d + 1) / 2) symmetric tensor, (n, d, d)
    tensor; `shape` names it where one item stands for all. at_targets: A_i, where the targets are not
    part of a source set. value, gradient, divergence, curl, square, hessian, laplacian, contraction:
    True, or the array to write to; a Hessian is (n, d (d + 1) / 2), of a vector (n, d, d (d + 1) / 2).
    form: "difference", "direct", "symmetric" or "adjoint".
    curvature: what targets lend, (n, 1 + d (d + 1) / 2), of a vector 1 + d times as many; lenders: such an
    array, or a list of one per source set, from an earlier call; None: nobody lends.
    coefficient: k_j of the Laplacian of the adjoint form, (n,) or one number, or a list of one per source
    set; coefficient_at_targets: k_i, where the targets are not part of a source set. shepard: the value is
    divided by the sum of its weights; value_volume: V_j of the value alone, as coefficient is given.
    contraction of a vector field with tensor, (n, d, d): sum of J[a, b] T[a, b]."""
    values: object
    form: _c.Form = _c.Form.DIFFERENCE
    value: object = None
    gradient: object = None
    divergence: object = None
    curl: object = None
    square: object = None
    at_targets: object = None
    accumulate: bool = False
    mirror: bool = False
    shape: object = None
    hessian: object = None
    laplacian: object = None
    curvature: object = None
    lenders: object = None
    coefficient: object = None
    coefficient_at_targets: object = None
    shepard: bool = False
    value_volume: object = None
    tensor: object = None
    contraction: object = None


@dataclasses.dataclass(frozen=True)
class Stats:
    """Sums over the targets whose corrections were computed."""
    rank: tuple
    certified: int
    decomposed: int
    empty: int
    lambda_min: float
    quadratic: int = 0


@dataclasses.dataclass
class FieldResult:
    value: object = None
    gradient: object = None
    divergence: object = None
    curl: object = None
    square: object = None
    hessian: object = None
    laplacian: object = None
    curvature: object = None
    contraction: object = None


@dataclasses.dataclass
class Evaluation:
    """What evaluate() found: a FieldResult per field, and what was wanted of the corrections."""
    fields: list
    correction: object = None
    rank: object = None
    lambda_min: object = None
    stats: object = None
    borrows: object = None


def stats_of(stats):
    return Stats(tuple(stats.rank), stats.certified, stats.decomposed, stats.empty,
                 stats.lambda_min, stats.quadratic)


def _sets(sources, volume=None):
    """A list of Sources, whatever was given."""
    if isinstance(sources, Neighbors):
        return [Sources(sources, volume)]
    if volume is not None:
        raise ValueError("the volume stands in Sources")
    sets = [sources] if isinstance(sources, Sources) else list(sources)
    if not sets:
        raise ValueError("there is no source set")
    if not all(isinstance(one, Sources) for one in sets):
        raise TypeError("sources must be Neighbors, Sources, or a list of Sources")
    return sets


_OUTPUT_SHAPES = {
    ("gradient", _c.Shape.SCALAR): _c.Shape.VECTOR,
    ("gradient", _c.Shape.VECTOR): _c.Shape.TENSOR,
    ("divergence", _c.Shape.VECTOR): _c.Shape.SCALAR,
    ("divergence", _c.Shape.SYM_TENSOR): _c.Shape.VECTOR,
    ("divergence", _c.Shape.TENSOR): _c.Shape.VECTOR,
    ("square", _c.Shape.SCALAR): _c.Shape.SCALAR,
    ("hessian", _c.Shape.SCALAR): _c.Shape.SYM_TENSOR,
    ("hessian", _c.Shape.VECTOR): _c.Shape.SYM_TENSOR,
    ("contraction", _c.Shape.VECTOR): _c.Shape.SCALAR,
}


class Call:
    """One call on neighbours: checks, views, arrays that must live until it is over."""

    def __init__(self, sources, volume, scheme, subset):
        self.sets = _sets(sources, volume)
        first = self.sets[0].neighbors
        if not isinstance(first, Neighbors):
            raise TypeError("neighbors must be Neighbors")
        self.context, self.scheme = first.context, scheme
        self.subset_given = subset
        self.borrowed = Borrowed()
        self.subset = None

    def begin(self):
        """Inside the context's lock: from here on counts stay what they are."""
        first = self.sets[0].neighbors
        self.count, self.dtype, self.dimension = (first.target_count, first.dtype, first.dimension)
        for one in self.sets:
            n = one.neighbors
            n._pointer  # raises if it is closed
            if (n.target_count, n.dtype, n.dimension) != (self.count, self.dtype, self.dimension):
                raise ValueError("the source sets differ in targets, precision or dimension")
        scheme = first.scheme if self.scheme is None else as_scheme(self.scheme)
        self.c_scheme = scheme._c_scheme(self.dimension)
        self.width = _c.functions.sphg_correction_width(c.byref(self.c_scheme))
        linear = self.c_scheme.method <= _c.Method.RKPM and self.c_scheme.order != 2
        self.table_shape = _c.Shape.SYM_TENSOR if linear else None
        if self.subset_given is not None:
            self.subset = self._subset(self.subset_given)
        self.c_sources = (_c.Sources * len(self.sets))(*(self._source(s) for s in self.sets))

    def _source(self, one):
        n, take = one.neighbors, self.borrowed.input
        return _c.Sources(
            n._pointer, take(one.volume, n.source_count, (), self.dtype, "volume"),
            take(one.density, n.source_count, (), self.dtype, "density"),
            take(one.correction, n.source_count, (self.width,), self.dtype, "correction",
                 self.table_shape),
            bool(one.same_volumes))

    def _subset(self, given):
        """slice or (begin, end): a range; bool: a mask; whole numbers: indices."""
        if isinstance(given, slice):
            if given.step not in (None, 1):
                raise ValueError("a subset is a slice without a step")
            begin, end, _ = given.indices(self.count)
            return _c.Subset(begin, max(begin, end))
        if isinstance(given, tuple) and len(given) == 2:
            begin, end = given
            if not 0 <= begin <= end <= self.count:
                raise ValueError(f"subset is {given}, must lie within the {self.count} targets")
            return _c.Subset(begin, end)
        given = np.asarray(given)
        if given.dtype == np.bool_:
            mask, _ = self.borrowed.numbers(given.view(np.uint8) if given.ndim else given, np.uint8,
                                            "subset", self.count)
            return _c.Subset(0, self.count, None, mask)
        indices, array = self.borrowed.numbers(given, np.int32, "subset")
        if len(array) and not 0 <= array.min() <= array.max() < self.count:
            raise ValueError(f"subset names targets that are not among the {self.count}")
        return _c.Subset(0, len(array), indices if len(array) else None)

    @property
    def selected(self):
        """Rows of the pairs of the selected targets."""
        s = self.subset
        if s is None:
            return self.count
        if s.mask:
            return int(np.count_nonzero(np.asarray(self.subset_given)))
        return s.end - s.begin

    def target(self, value, items, name, shape=None):
        return self.borrowed.input(value, self.count, items, self.dtype, name, shape)

    def new(self, items, dtype=None):
        """Who is not selected keeps zeros."""
        make = np.empty if self.subset is None else np.zeros
        return make((self.count,) + items, self.dtype if dtype is None else dtype)

    def output(self, wanted, items, name, shape=None, dtype=None, zeros=False):
        """The array and its view, of True, an array, or None."""
        if wanted is None or wanted is False:
            return None, absent()
        dtype = self.dtype if dtype is None else dtype
        if wanted is True:
            wanted = np.zeros((self.count,) + items, dtype) if zeros else self.new(items, dtype)
        return wanted, self.borrowed.output(wanted, self.count, items, np.dtype(dtype), name, shape)

    def stats(self, wanted):
        return _c.Stats() if wanted else None


def _shape_of(array, count, dimension, name):
    for shape in _c.Shape:
        if array.shape == (count,) + item_shape(shape, dimension):
            return shape
    if array.ndim == 0:
        return _c.Shape.SCALAR
    raise ValueError(f"{name} has the shape {array.shape}: it is neither {count} numbers, vectors, "
                     f"symmetric tensors nor tensors in {dimension}D (`shape` says which for one "
                     f"item that stands for all)")


def _field_shape(call, field, values):
    if field.shape is not None:
        return choose(_c.Shape, field.shape)
    for one, value in zip(call.sets, values):
        if value is not None:
            return _shape_of(as_array(value, call.dtype, "values"), one.neighbors.source_count,
                             call.dimension, "values")
    if field.at_targets is not None:
        return _shape_of(as_array(field.at_targets, call.dtype, "at_targets"), call.count,
                         call.dimension, "at_targets")
    raise ValueError("a field without values needs its shape")


def _of_sets(call, field, name, items):
    """The views of a member that has one per source set; None: it is not given."""
    given = getattr(field, name)
    if given is None:
        return None
    each = list(given) if isinstance(given, (list, tuple)) else [given]
    if len(each) != len(call.sets):
        raise ValueError(f"a field has {name} for {len(each)} source sets of {len(call.sets)}")
    views = (_c.View * len(each))(*(
        call.borrowed.input(one, of.neighbors.source_count, items, call.dtype, name)
        for one, of in zip(each, call.sets)))
    call.borrowed.keep(views)
    return c.cast(views, c.POINTER(_c.View))


def _field(call, field):
    """The C field, and what it writes."""
    several = isinstance(field.values, (list, tuple))
    values = list(field.values) if several else [field.values]
    if len(values) != len(call.sets):
        raise ValueError(f"a field has values for {len(values)} source sets of {len(call.sets)}")
    shape = _field_shape(call, field, values)
    items = item_shape(shape, call.dimension)
    views = (_c.View * len(values))(*(
        call.borrowed.input(value, one.neighbors.source_count, items, call.dtype, "values", shape)
        for one, value in zip(call.sets, values)))
    call.borrowed.keep(views)
    result = _c.Field(shape=shape, form=choose(_c.Form, field.form),
                      accumulate=bool(field.accumulate), mirror=bool(field.mirror),
                      at_sources=c.cast(views, c.POINTER(_c.View)))
    result.at_targets = call.borrowed.input(field.at_targets, call.count, items, call.dtype,
                                            "at_targets", shape)
    found = FieldResult()
    for name in ("value", "gradient", "divergence", "curl", "square", "hessian", "laplacian",
                 "contraction"):
        wanted = getattr(field, name)
        if wanted is None or wanted is False:
            setattr(result, name, absent())
            continue
        if name in ("value", "laplacian"):
            out = shape
        elif name == "curl" and shape == _c.Shape.VECTOR:
            out = _c.Shape.VECTOR if call.dimension == 3 else _c.Shape.SCALAR
        else:
            out = _OUTPUT_SHAPES.get((name, shape))
        if out is None:
            raise ValueError(f"{name} of a {shape.name.lower()} is not defined")
        items = item_shape(out, call.dimension)
        if name == "hessian" and shape == _c.Shape.VECTOR:  # one of each component
            items, out = (call.dimension,) + items, None
        array, view = call.output(wanted, items, name, out, zeros=field.accumulate)
        setattr(result, name, view)
        setattr(found, name, array)
    numbers = 1 + int(np.prod(item_shape(shape, call.dimension), dtype=int)) * \
        item_shape(_c.Shape.SYM_TENSOR, call.dimension)[0]
    found.curvature, result.curvature = call.output(field.curvature, (numbers,), "curvature")
    for name, of_each in (("lenders", (numbers,)), ("coefficient", ()), ("value_volume", ())):
        views = _of_sets(call, field, name, of_each)
        if views is not None:
            setattr(result, name, views)
    result.coefficient_at_targets = call.target(field.coefficient_at_targets, (),
                                                "coefficient_at_targets")
    result.shepard = bool(field.shepard)
    result.tensor = call.target(field.tensor, (call.dimension, call.dimension), "tensor",
                                _c.Shape.TENSOR)
    return result, found


def evaluate(sources, fields=(), *, volume=None, scheme=None, subset=None, target_volume=None,
             target_density=None, target_correction=None, correction=None, rank=None,
             lambda_min=None, stats=False, borrows=None):
    """All that is named, in one sweep over the pairs.

    sources: Neighbors (and `volume`), Sources, or a list of them whose sums add up. fields: Field, or a
    list. subset: a slice, (begin, end), a mask of bool, or indices; others are not touched. correction,
    rank, lambda_min, borrows: True, or the array to write to; borrows.astype(bool) is the subset of a
    call with lenders."""
    call = Call(sources, volume, scheme, subset)
    fields = [fields] if isinstance(fields, Field) else list(fields)
    with call.context._calls() as context:
        call.begin()
        made = [_field(call, field) for field in fields]
        c_fields = (_c.Field * len(made))(*(field for field, _ in made))
        request = _c.Request(sources=call.c_sources, fields=c_fields if made else None,
                             set_count=len(call.sets), field_count=len(made))
        if call.subset is not None:
            request.subset = c.pointer(call.subset)
        request.target_volume = call.target(target_volume, (), "target_volume")
        request.target_density = call.target(target_density, (), "target_density")
        request.target_correction = call.target(target_correction, (call.width,),
                                                "target_correction", call.table_shape)
        correction, request.correction = call.output(correction, (call.width,), "correction",
                                                     call.table_shape)
        rank, request.rank = call.output(rank, (), "rank", dtype=np.uint8)
        lambda_min, request.lambda_min = call.output(lambda_min, (), "lambda_min")
        borrows, request.borrows = call.output(borrows, (), "borrows", dtype=np.uint8)
        c_stats = call.stats(stats)
        if c_stats is not None:
            request.stats = c.pointer(c_stats)
        call.context._check(_c.functions.sphg_evaluate(context, c.byref(call.c_scheme),
                                                     c.byref(request)))
        call.borrowed.finish()
    return Evaluation([found for _, found in made], correction, rank, lambda_min,
                      None if c_stats is None else stats_of(c_stats), borrows)
