# SPDX-License-Identifier: MIT
"""Neighbors: who sums over whom, and where everyone stood."""
import ctypes as c
import dataclasses
import weakref
import numpy as np
from . import _c
from ._context import Error, default_context
from ._scheme import as_scheme
from ._views import Borrowed, COUNT_MAX, absent, precision_of


@dataclasses.dataclass(frozen=True)
class NeighborsInfo:
    pairs: int
    bytes: int
    target_count: int
    source_count: int
    rebuilt: bool
    skin_left: float


@dataclasses.dataclass(frozen=True)
class ListFault:
    kind: _c.Fault
    target: int
    source: int
    faulty: int
    distance: float


@dataclasses.dataclass
class Lists:
    """Your own lists as CSR: the sources around target i are indices[offsets[i]:offsets[i + 1]]. Each
    pair stands there from both ends; i itself is skipped. index_mask: bits of an index that count.
    copy: the library keeps a copy, in the form of its own lists, instead of borrowing the arrays."""
    offsets: object
    indices: object
    index_mask: int = 0
    copy: bool = False


def _positions(value, name):
    if not isinstance(value, np.ndarray):
        value = np.asarray(value, np.float64)
    if value.ndim != 2 or value.shape[1] not in (2, 3):
        raise ValueError(f"{name} have the shape {value.shape}, must have (n, 2) or (n, 3)")
    if len(value) > COUNT_MAX:
        raise ValueError(f"{name} are {len(value)}, more than {COUNT_MAX}")
    precision_of(value.dtype, name)
    return value


class Neighbors:
    """Finds the pairs of `positions`, shape (n, 2) or (n, 3), float32 or float64, and keeps a copy
    of the positions. `scheme` is a Scheme or the support radius.

    own       the first so many particles are targets, the others ghosts; None: all
    targets   other places to sum at, apart from the sources; or Neighbors whose targets they are, which
              must be searched before, and not again while these are in use
    period    per axis, 0 for an open one; or one number for all
    skin      find pairs up to H + skin and keep them until a particle has moved skin / 2
    support   a radius per particle, of the positions' type, or one number; the scheme's is not read
    target_support   the same of `targets`
    mutual    neighbours are those with r < max(H_i, H_j), not r < H_i
    precision of fields and results; None: that of the positions. float32 beside float64 positions
    list_free keep no pairs: less memory; less time where one call uses them, more where several do
    keep_weights   keep what a kernel gives each pair for the next sweeps (see Sources.same_volumes)
    lists     Lists of yours, or a SciPy CSR matrix, instead of a search. Borrowed: what is used
              where it lies must stay unchanged until the next build

    search() takes the next step's positions; what is not given stays as it was."""

    def __init__(self, positions, scheme, *, own=None, targets=None, period=None, skin=0.0,
                 precision=None, list_free=False, keep_weights=False, lists=None, support=None,
                 target_support=None, mutual=False, context=None):
        self._destroy = None
        self.context = context if context is not None else default_context()
        self._scheme = as_scheme(scheme)
        self._options = dict(period=period, skin=skin, precision=precision, list_free=list_free,
                             keep_weights=keep_weights, support=support,
                             target_support=target_support, mutual=mutual)
        pointer = c.c_void_p()
        with self.context._calls() as handle:
            self.context._check(_c.functions.sphg_neighbors_create(handle, c.byref(pointer)))
            self._pointer_value = pointer
            # The context's handle stands among the arguments so that it lives until this is done.
            self._destroy = weakref.finalize(self, _destroy_neighbors, pointer, self.context._handle)
            self.context._neighbors.add(self)
        self.dtype, self.dimension = None, None
        self.target_count = self.source_count = 0
        self.part_of = None  # whether the targets are the first of the sources
        self._borrowed = None
        self._targets_of = None  # lives as long as its targets are in use
        try:
            self._build(positions, own, targets, lists)
        except BaseException:
            self.close()
            raise

    @property
    def scheme(self):
        """Of the last build."""
        return self._scheme

    @property
    def _pointer(self):
        if self._destroy is None or not self._destroy.alive:
            raise ValueError("the neighbours are closed")
        if self._targets_of is not None:
            self._targets_of._pointer  # raises if these are closed
        return self._pointer_value

    def search(self, positions, *, own=None, targets=None, scheme=None, support=None,
               target_support=None):
        """Finds the pairs of these positions, or nothing if the skin still holds. Returns self."""
        if support is not None:
            self._options["support"] = support
        if target_support is not None:
            self._options["target_support"] = target_support
        self._build(positions, own, targets, None, scheme)
        return self

    def would_rebuild(self, positions, *, own=None, targets=None, scheme=None, support=None,
                      target_support=None):
        """Whether that search would find pairs anew, or the skin still holds. Nothing is built."""
        positions = _positions(positions, "positions")
        scheme = self._scheme if scheme is None else as_scheme(scheme)
        given = {"support": support, "target_support": target_support}
        kept, borrowed, rebuild = self._options, Borrowed(), c.c_int32()
        self._options = {**kept, **{name: x for name, x in given.items() if x is not None}}
        try:
            geometry = self._question(positions, own, targets, borrowed)[0]
        finally:
            self._options = kept
        c_scheme = scheme._c_scheme(positions.shape[1])
        with self.context._calls() as context:
            self.context._check(_c.functions.sphg_neighbors_would_rebuild(
                context, self._pointer, c.byref(c_scheme), c.byref(geometry), c.byref(rebuild)))
        return bool(rebuild.value)

    def use_lists(self, positions, lists, *, own=None, targets=None, scheme=None):
        """Takes your lists for these positions. Returns self."""
        self._build(positions, own, targets, lists, scheme)
        return self

    def _geometry(self, positions, own, targets, borrowed):
        dimension = positions.shape[1]
        geometry = _c.Geometry(source_count=len(positions), skin=self._options["skin"],
                               list_free=bool(self._options["list_free"]),
                               keep_weights=bool(self._options["keep_weights"]))
        geometry.sources = borrowed.input(positions, len(positions), (dimension,), positions.dtype,
                                          "positions", _c.Shape.VECTOR, same=False)
        geometry.targets = absent()
        if targets is not None and own is not None:
            raise ValueError("own and targets exclude each other")
        if isinstance(targets, Neighbors):
            geometry.targets_of = targets._pointer
            geometry.target_count = targets.target_count
        elif targets is not None:
            targets = _positions(targets, "targets")
            geometry.targets = borrowed.input(targets, len(targets), (dimension,), positions.dtype,
                                              "targets", _c.Shape.VECTOR, same=False)
            geometry.target_count = len(targets)
        else:
            count = len(positions) if own is None else own
            if not 0 <= count <= len(positions):
                raise ValueError(f"own is {own}, must be from 0 to {len(positions)}, all positions")
            geometry.target_count = count
        geometry.mutual = bool(self._options["mutual"])
        for name, many in (("support", len(positions)), ("target_support", geometry.target_count)):
            view = borrowed.input(self._options[name], many, (), positions.dtype, name)
            setattr(geometry, "source_support" if name == "support" else name, view)
        period = self._options["period"]
        if period is not None:
            period = np.broadcast_to(np.asarray(period, np.float64), (dimension,))
            geometry.period[:dimension] = list(period)
        return geometry

    def _lists(self, lists, geometry, borrowed):
        if not isinstance(lists, Lists):
            lists = Lists(lists.indptr, lists.indices)
        if any(self._options[name] for name in ("skin", "list_free", "keep_weights")) or \
                self._options["support"] is not None:
            raise ValueError("skin, list_free, keep_weights and support are for a search, not for lists")
        offsets, array = borrowed.numbers(lists.offsets, np.int64, "offsets",
                                          geometry.target_count + 1)
        if array[0] != 0 or (len(array) > 1 and bool((array[1:] < array[:-1]).any())):
            raise ValueError("offsets must begin with 0 and never fall")
        indices, found = borrowed.numbers(lists.indices, np.int32, "indices")
        if len(found) < array[-1]:
            raise ValueError(f"indices has {len(found)} items, offsets name {array[-1]}")
        return _c.Lists(offsets=offsets, indices=indices if len(found) else None,
                        index_mask=lists.index_mask, copy=bool(lists.copy))

    def _question(self, positions, own, targets, borrowed):
        """The geometry in C, and the precision of fields."""
        geometry = self._geometry(positions, own, targets, borrowed)
        dtype = positions.dtype
        if self._options["precision"] is not None:
            dtype = precision_of(self._options["precision"], "precision")
        geometry.precision = {"f4": _c.Type.F32, "f8": _c.Type.F64}[dtype.str[1:]]
        return geometry, dtype

    def _build(self, positions, own, targets, lists, scheme=None):
        positions = _positions(positions, "positions")
        scheme = self._scheme if scheme is None else as_scheme(scheme)
        borrowed = Borrowed()
        geometry, dtype = self._question(positions, own, targets, borrowed)
        c_scheme = scheme._c_scheme(positions.shape[1])
        c_lists = None if lists is None else self._lists(lists, geometry, borrowed)
        with self.context._calls() as context:
            self._targets_of = None  # a build needs those of the last one no more
            pointer = self._pointer
            if c_lists is None:
                status = _c.functions.sphg_neighbors_search(context, pointer, c.byref(c_scheme),
                                                          c.byref(geometry))
            else:
                status = _c.functions.sphg_neighbors_use_lists(
                    context, pointer, c.byref(c_scheme), c.byref(geometry), c.byref(c_lists))
            self.context._check(status)
            self._scheme, self.dtype, self.dimension = scheme, dtype, positions.shape[1]
            self.target_count, self.source_count = geometry.target_count, geometry.source_count
            self.part_of = targets is None
            self._targets_of = targets if isinstance(targets, Neighbors) else None
            self._borrowed = borrowed if c_lists is not None and not c_lists.copy else None

    @property
    def info(self):
        """Pairs, bytes, counts, whether the last search found anew, and what is left of the skin."""
        info = _c.NeighborsInfo()
        with self.context._calls() as context:
            self.context._check(_c.functions.sphg_neighbors_get_info(context, self._pointer,
                                                                   c.byref(info)))
        return NeighborsInfo(info.pairs, info.bytes, info.target_count, info.source_count,
                             bool(info.rebuilt), info.skin_left)

    def check(self):
        """None if every pair with r < H is there, once and from both ends; else the first ListFault."""
        fault, scheme = _c.ListFault(), self._scheme._c_scheme(self.dimension)
        with self.context._calls() as context:
            status = _c.functions.sphg_neighbors_check(context, c.byref(scheme), self._pointer,
                                                     c.byref(fault))
            if status not in (_c.Result.ERROR_LISTS, _c.Result.ERROR_INDEX):
                self.context._check(status)
        if status == _c.Result.OK:
            return None
        return ListFault(_c.Fault(fault.kind), fault.target, fault.source, fault.faulty,
                         fault.distance)

    def order(self):
        """Sources along the library's path through space: sort particles by it now and then."""
        with self.context._calls() as context:
            order = np.empty(self.source_count, np.int32)
            self.context._check(_c.functions.sphg_neighbors_get_order(context, self._pointer,
                                                                    order.ctypes.data))
        return order

    def close(self):
        """Gives the memory back now."""
        if self._destroy is not None:
            with self.context._lock:
                self._destroy()
                self._borrowed = None

    def __enter__(self):
        return self

    def __exit__(self, *error):
        self.close()

    def __reduce__(self):
        raise TypeError("neighbours cannot be pickled: build them in each process")


def _destroy_neighbors(pointer, context_handle):
    del context_handle
    _c.functions.sphg_neighbors_destroy(pointer)
