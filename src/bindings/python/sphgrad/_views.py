# SPDX-License-Identifier: MIT
"""NumPy arrays as views of the C interface.

Every array is checked here: type, length, layout, and for outputs that it may be written. What a
view can express is used where it lies; of the rest inputs are copied, and outputs are copied back."""
import numpy as np
from ._c import Layout, Shape, Type, View

TYPES = {np.dtype(np.float32): Type.F32, np.dtype(np.float64): Type.F64,
         np.dtype(np.uint8): Type.U8}
COUNT_MAX = 2 ** 31 - 1


def precision_of(dtype, name):
    """The dtype that fields have: float32 or float64, in this machine's byte order."""
    dtype = np.dtype(dtype)
    if dtype not in (np.dtype(np.float32), np.dtype(np.float64)):
        raise TypeError(f"{name} is {dtype}, must be float32 or float64")
    return dtype


def item_shape(shape, dimension):
    """What stands behind the first axis of an array of such items."""
    return {Shape.SCALAR: (), Shape.VECTOR: (dimension,),
            Shape.SYM_TENSOR: (dimension * (dimension + 1) // 2,),
            Shape.TENSOR: (dimension, dimension)}[shape]


def as_array(value, dtype, name):
    """Arrays must have the type already; numbers and lists of numbers are given it."""
    if isinstance(value, np.ma.MaskedArray):
        raise TypeError(f"{name} is a masked array, whose mask would be ignored: take .filled()")
    if isinstance(value, np.ndarray) and value.ndim:
        if value.dtype != dtype:
            raise TypeError(f"{name} is {value.dtype}, must be {dtype} as the neighbours are")
        return value
    array = np.asarray(value)
    if array.dtype.kind not in "iuf":
        raise TypeError(f"{name} is {array.dtype}, must be numbers of type {dtype}")
    return array.astype(dtype)


def _is_transposed(array):
    """Whether matrices stand column by column."""
    size = array.itemsize
    return array.ndim == 3 and array.shape[1] > 1 and array.strides[1:] == (size, array.shape[1] * size)


def _is_whole(array, items, shape):
    """Whether symmetric tensors or corrections stand as whole matrices."""
    side = array.shape[-1] if array.ndim else 0
    return shape == Shape.SYM_TENSOR and array.ndim == len(items) + 2 and \
        array.shape[-2:] == (side, side) and items == (side * (side + 1) // 2,)


def _expressible(array, shape):
    """Whether a view can say where the numbers are: aligned, and rows of numbers contiguous."""
    size = array.itemsize
    if not array.flags.aligned or any(s % size for s in array.strides):
        return False
    inner, axes = array.strides[1:], array.shape[1:]
    if shape == Shape.VECTOR or (shape == Shape.TENSOR and _is_transposed(array)):
        return True
    if shape == Shape.SYM_TENSOR and len(axes) == 2:
        return inner == (axes[1] * size, size) or _is_transposed(array)
    if shape is None and len(axes) == 2 and inner[0] != axes[1] * size:
        return False  # Hessians of a vector
    return not inner or axes[-1] == 1 or inner[-1] == size


def _describe(array, shape, same=False):
    """The view of an array that is expressible."""
    start, size = array.ctypes.data, array.itemsize
    view = View(start, None, None, 0 if same else array.strides[0], TYPES[array.dtype])
    if shape == Shape.SYM_TENSOR and array.ndim == 3:
        view.layout = Layout.FULL
    elif shape == Shape.TENSOR and _is_transposed(array):
        view.layout = Layout.COLUMN_MAJOR
    elif shape in (Shape.VECTOR, Shape.TENSOR) and array.ndim > 1:
        apart, behind = array.strides[1], size * (array.shape[1] if shape == Shape.TENSOR else 1)
        if apart != behind:
            view.y = start + apart
            if array.shape[1] == 3:
                view.z = start + 2 * apart
    return view


def count_of(array, name):
    if len(array) > COUNT_MAX:
        raise ValueError(f"{name} has {len(array)} items, more than {COUNT_MAX}")
    return len(array)


class Borrowed:
    """The arrays of one call: kept alive until it is over, results copied back if it succeeded."""

    def __init__(self):
        self._kept, self._back = [], []

    def input(self, value, count, items, dtype, name, shape=None, same=True):
        """A view of `count` items, each of the shape `items`; with `same` one item may be for all."""
        if value is None:
            return View(type=Type.F32)
        array = as_array(value, dtype, name)
        if _is_whole(array, items, shape):
            items = array.shape[1:]
        one = same and array.shape == items and array.ndim == len(items)
        if one:
            array = array.reshape((1,) + items)
        elif array.shape != (count,) + items:
            also = f" or {items}" if same else ""
            raise ValueError(f"{name} has the shape {array.shape}, must have {(count,) + items}{also}")
        if not _expressible(array, shape):
            array = np.ascontiguousarray(array)
            if not array.flags.aligned:
                array = array.copy()
        self._kept.append(array)
        return _describe(array, shape, one)

    def output(self, array, count, items, dtype, name, shape=None):
        """A view of an array that is there already."""
        if array is None:
            return View(type=Type.F32)
        if not isinstance(array, np.ndarray):
            raise TypeError(f"{name} is {type(array).__name__}, must be a NumPy array: it is written")
        if isinstance(array, np.ma.MaskedArray):
            raise TypeError(f"{name} is a masked array, whose mask would be ignored")
        if array.dtype != dtype:
            raise TypeError(f"{name} is {array.dtype}, must be {dtype}")
        if _is_whole(array, items, shape):
            items = array.shape[1:]
        if array.shape != (count,) + items:
            raise ValueError(f"{name} has the shape {array.shape}, must have {(count,) + items}")
        if not array.flags.writeable:
            raise ValueError(f"{name} is read-only, but results are written to it")
        if count > 1 and any(s == 0 and n > 1 for s, n in zip(array.strides, array.shape)):
            raise ValueError(f"{name} has several items in one place, but results are written to it")
        written = array
        if not _expressible(array, shape):
            written = np.array(array, order="C")
            self._back.append((array, written))
        self._kept.append(written)
        return _describe(written, shape)

    def numbers(self, value, dtype, name, count=None):
        """The address of whole numbers (or bytes) as one contiguous array of dtype, and the array."""
        array = np.asarray(value)
        if isinstance(value, np.ma.MaskedArray) or array.ndim != 1 or \
                (array.dtype.kind not in "iub" and array.size):
            raise TypeError(f"{name} is {array.dtype} of {array.ndim} axes, "
                            f"must be a row of whole numbers")
        if count is not None and len(array) != count:
            raise ValueError(f"{name} has {len(array)} items, must have {count}")
        limits = np.iinfo(dtype)
        if array.dtype != dtype and array.size and array.dtype != np.bool_ and \
                (array.max() > limits.max or array.min() < limits.min):
            raise ValueError(f"{name} does not fit {np.dtype(dtype)}")
        array = np.require(array, dtype, ["C", "ALIGNED"])
        self._kept.append(array)
        return array.ctypes.data, array

    def keep(self, *things):
        self._kept.extend(things)

    def finish(self):
        for array, written in self._back:
            array[...] = written


def absent():
    return View(type=Type.F32)
