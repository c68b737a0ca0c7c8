# SPDX-License-Identifier: MIT
"""The C interface as it is: the library, its structs, enumerations and functions.

Members have the names and the order of sphgrad.h; a test compares every offset, value and
parameter with what a C compiler sees."""
import ctypes as c
import ctypes.util
import enum
import os

VERSION = (0, 1, 0)


class Result(enum.IntEnum):
    OK = 0
    ERROR_ARGUMENT = 1
    ERROR_VERSION = 2
    ERROR_TYPE = 3
    ERROR_SIZE = 4
    ERROR_STATE = 5
    ERROR_UNSUPPORTED = 6
    ERROR_CAPACITY = 7
    ERROR_NOT_FINITE = 8
    ERROR_BUSY = 9
    ERROR_LISTS = 10
    ERROR_MEMORY = -1
    ERROR_INDEX = -2
    ERROR_VOLUME = -3


class Type(enum.IntEnum):
    F32 = 1
    F64 = 2
    U8 = 3


class Shape(enum.IntEnum):
    """What one item of a field holds."""
    SCALAR = 1
    VECTOR = 2
    SYM_TENSOR = 3
    TENSOR = 4


class Layout(enum.IntEnum):
    """How the numbers of a matrix stand; NumPy's strides say it."""
    AS_SHAPE = 0
    COLUMN_MAJOR = 1
    FULL = 2


class Isa(enum.IntEnum):
    ISA_BEST = 0
    ISA_BASE = 1
    ISA_X86_V3 = 2
    ISA_X86_V4 = 3
    ISA_NEON = 4


class Method(enum.IntEnum):
    KGC = 0
    MLS = 1
    RKPM = 2
    CMLS = 3
    CRKPM = 4
    PLAIN = 5


class Kernel(enum.IntEnum):
    CUBIC_SPLINE = 0
    QUINTIC_SPLINE = 1
    WENDLAND_C2 = 2
    WENDLAND_C4 = 3
    WENDLAND_C6 = 4
    POLY6 = 5
    SPIKY = 6


class Policy(enum.IntEnum):
    BLEND = 0
    REPLACE = 1
    TRUNCATE = 2
    IDENTITY = 3


class Form(enum.IntEnum):
    DIFFERENCE = 0
    DIRECT = 1
    SYMMETRIC = 2
    ADJOINT = 3


class Fault(enum.IntEnum):
    FAULT_NONE = 0
    FAULT_LENGTH = 1
    FAULT_INDEX = 2
    FAULT_DOUBLED = 3
    FAULT_ONE_SIDED = 4
    FAULT_MISSING = 5


ENUMS = {"sphg_result": Result, "sphg_type": Type, "sphg_shape": Shape, "sphg_layout": Layout,
         "sphg_isa": Isa, "sphg_method": Method, "sphg_kernel": Kernel, "sphg_policy": Policy,
         "sphg_form": Form, "sphg_fault": Fault}


class View(c.Structure):
    _fields_ = [("x", c.c_void_p), ("y", c.c_void_p), ("z", c.c_void_p),
                ("stride", c.c_ssize_t), ("type", c.c_int), ("layout", c.c_int)]


class Config(c.Structure):
    _fields_ = [("threads", c.c_int32), ("isa", c.c_int), ("trusted", c.c_int32),
                ("allocate", c.c_void_p), ("release", c.c_void_p), ("log", c.c_void_p),
                ("parallel_for", c.c_void_p), ("user", c.c_void_p)]


class ContextInfo(c.Structure):
    _fields_ = [("threads", c.c_int32), ("isa", c.c_int), ("openmp", c.c_int32),
                ("bytes", c.c_int64)]


class Scheme(c.Structure):
    _fields_ = [("dimension", c.c_int32), ("method", c.c_int), ("kernel", c.c_int),
                ("policy", c.c_int), ("support_radius", c.c_double), ("threshold", c.c_double),
                ("order", c.c_int32)]


class Geometry(c.Structure):
    _fields_ = [("sources", View), ("targets", View), ("source_count", c.c_int32),
                ("target_count", c.c_int32), ("precision", c.c_int), ("list_free", c.c_int32),
                ("keep_weights", c.c_int32), ("skin", c.c_double), ("period", c.c_double * 3),
                ("source_support", View), ("target_support", View), ("mutual", c.c_int32),
                ("targets_of", c.c_void_p)]


class Lists(c.Structure):
    _fields_ = [("offsets", c.c_void_p), ("indices", c.c_void_p), ("rows", c.c_void_p),
                ("lengths", c.c_void_p), ("row", c.c_void_p), ("user", c.c_void_p),
                ("index_mask", c.c_int32), ("copy", c.c_int32)]


class NeighborsInfo(c.Structure):
    _fields_ = [("pairs", c.c_int64), ("bytes", c.c_int64), ("target_count", c.c_int32),
                ("source_count", c.c_int32), ("rebuilt", c.c_int32), ("skin_left", c.c_double)]


class ListFault(c.Structure):
    _fields_ = [("kind", c.c_int), ("target", c.c_int32), ("source", c.c_int32),
                ("faulty", c.c_int32), ("distance", c.c_double)]


class Sources(c.Structure):
    _fields_ = [("neighbors", c.c_void_p), ("volume", View), ("density", View),
                ("correction", View), ("same_volumes", c.c_int32)]


class Subset(c.Structure):
    _fields_ = [("begin", c.c_int32), ("end", c.c_int32), ("indices", c.c_void_p),
                ("mask", c.c_void_p)]


class Field(c.Structure):
    _fields_ = [("shape", c.c_int), ("form", c.c_int), ("accumulate", c.c_int32),
                ("at_sources", c.POINTER(View)), ("at_targets", View), ("value", View),
                ("gradient", View), ("divergence", View), ("curl", View), ("square", View),
                ("mirror", c.c_int32), ("hessian", View), ("laplacian", View),
                ("curvature", View), ("lenders", c.POINTER(View)),
                ("coefficient", c.POINTER(View)), ("coefficient_at_targets", View),
                ("shepard", c.c_int32), ("value_volume", c.POINTER(View)), ("tensor", View),
                ("contraction", View)]


class Stats(c.Structure):
    _fields_ = [("rank", c.c_int64 * 4), ("certified", c.c_int64), ("decomposed", c.c_int64),
                ("empty", c.c_int64), ("lambda_min", c.c_double), ("quadratic", c.c_int64)]


class Request(c.Structure):
    _fields_ = [("sources", c.POINTER(Sources)), ("fields", c.POINTER(Field)),
                ("set_count", c.c_int32), ("field_count", c.c_int32),
                ("subset", c.POINTER(Subset)), ("target_volume", View), ("target_density", View),
                ("target_correction", View), ("correction", View), ("rank", View),
                ("lambda_min", View), ("stats", c.POINTER(Stats)), ("borrows", View)]


class Pairs(c.Structure):
    _fields_ = [("offsets", c.c_void_p), ("indices", c.c_void_p), ("gradient", View),
                ("capacity", c.c_int64), ("count", c.c_int64), ("any_order", c.c_int32),
                ("block", c.c_int32), ("lengths", c.c_void_p)]


class Inversion(c.Structure):
    _fields_ = [("correction", View), ("rank", View), ("lambda_min", View),
                ("stats", c.POINTER(Stats))]


STRUCTS = {"sphg_view": View, "sphg_config": Config, "sphg_context_info": ContextInfo,
           "sphg_scheme": Scheme, "sphg_geometry": Geometry, "sphg_lists": Lists,
           "sphg_neighbors_info": NeighborsInfo, "sphg_list_fault": ListFault,
           "sphg_sources": Sources, "sphg_subset": Subset, "sphg_field": Field,
           "sphg_stats": Stats, "sphg_request": Request, "sphg_pairs": Pairs,
           "sphg_inversion": Inversion}

_context = _neighbors = c.c_void_p
_double_p, _scheme_p = c.POINTER(c.c_double), c.POINTER(Scheme)
_short = [_context, _scheme_p, c.POINTER(Sources), c.POINTER(Subset), View, View]

# name: (result, parameters)
FUNCTIONS = {
    "sphg_result_string": (c.c_char_p, [c.c_int]),
    "sphg_version": (c.c_int32, []),
    "sphg_context_create": (c.c_int, [c.c_int32, c.POINTER(Config), c.POINTER(_context)]),
    "sphg_context_destroy": (None, [_context]),
    "sphg_context_get_info": (c.c_int, [_context, c.POINTER(ContextInfo)]),
    "sphg_last_message": (c.c_char_p, [_context]),
    "sphg_correction_width": (c.c_int32, [_scheme_p]),
    "sphg_kernel_value": (None, [_scheme_p, c.c_double, _double_p, _double_p]),
    "sphg_kernel_constants": (None, [_scheme_p, _double_p, _double_p]),
    "sphg_neighbors_create": (c.c_int, [_context, c.POINTER(_neighbors)]),
    "sphg_neighbors_destroy": (None, [_neighbors]),
    "sphg_neighbors_search": (c.c_int, [_context, _neighbors, _scheme_p, c.POINTER(Geometry)]),
    "sphg_neighbors_would_rebuild": (c.c_int, [_context, _neighbors, _scheme_p, c.POINTER(Geometry),
                                               c.c_void_p]),
    "sphg_neighbors_use_lists": (c.c_int, [_context, _neighbors, _scheme_p, c.POINTER(Geometry),
                                           c.POINTER(Lists)]),
    "sphg_neighbors_get_info": (c.c_int, [_context, _neighbors, c.POINTER(NeighborsInfo)]),
    "sphg_neighbors_check": (c.c_int, [_context, _scheme_p, _neighbors, c.POINTER(ListFault)]),
    "sphg_neighbors_get_order": (c.c_int, [_context, _neighbors, c.c_void_p]),
    "sphg_evaluate": (c.c_int, [_context, _scheme_p, c.POINTER(Request)]),
    "sphg_correction": (c.c_int, _short),
    "sphg_gradient": (c.c_int, _short),
    "sphg_jacobian": (c.c_int, _short),
    "sphg_divergence": (c.c_int, _short),
    "sphg_curl": (c.c_int, _short),
    "sphg_force": (c.c_int, _short[:4] + [c.c_int, View, View]),
    "sphg_pair_gradients": (c.c_int, _short[:5] + [c.POINTER(Pairs)]),
    "sphg_pair_gradient": (None, [_scheme_p, _double_p, c.c_double, _double_p, _double_p]),
    "sphg_invert_moments": (c.c_int, [_context, _scheme_p, c.c_int32, View, View,
                                      c.POINTER(Inversion)]),
    "sphg_eigen": (c.c_int, [_context, c.c_int32, c.c_int32, View, View, View]),
    "sphg_svd": (c.c_int, [_context, c.c_int32, View, View, View, View]),
}

# What Python does without, and why.
NOT_CALLED = dict.fromkeys(
    ["sphg_correction", "sphg_gradient", "sphg_jacobian", "sphg_divergence", "sphg_curl",
     "sphg_force"],
    "the same results come from sphg_evaluate, which takes several source sets as well")
NOT_SET = {
    "sphg_config.allocate": "memory is the library's own: a Python function would need the GIL",
    "sphg_config.release": "as allocate",
    "sphg_config.log": "every failure raises an exception with the same message",
    "sphg_config.parallel_for": "workers would wait for the GIL in every piece of work",
    "sphg_config.user": "for functions of the host alone",
    "sphg_lists.rows": "lists come as CSR, which NumPy and SciPy make of anything",
    "sphg_lists.lengths": "as rows",
    "sphg_lists.row": "a Python function in each of a million rows would take minutes",
    "sphg_lists.user": "handed to row alone",
    "sphg_pairs.block": "vectors of a host's own loops: NumPy has its own, over all pairs at once",
    "sphg_pairs.lengths": "differences of offsets, without a block",
}


def _places():
    """Where the library may be: named by the user, beside this package, where it was installed."""
    named = os.environ.get("SPHGRAD_LIBRARY")
    if named:
        yield named
        return
    here = os.path.dirname(os.path.abspath(__file__))
    try:
        from ._place import LIBRARY
        yield os.path.normpath(os.path.join(here, LIBRARY))
    except ImportError: # used from the sources
        pass
    found = ctypes.util.find_library("sphgrad")
    if found:
        yield found


def _load():
    tried = []
    for place in _places():
        try:
            library = c.CDLL(place)
            break
        except OSError as error:
            tried.append(str(error))
    else:
        raise ImportError("sphgrad: the shared library is not found; the environment variable "
                          "SPHGRAD_LIBRARY may name it. " + "; ".join(tried))
    for name, (result, parameters) in FUNCTIONS.items():
        try:
            function = getattr(library, name)
        except AttributeError:
            raise ImportError(f"sphgrad: {place} has no {name}: it is not of version "
                              f"{VERSION[0]}.{VERSION[1]}") from None
        function.restype, function.argtypes = result, parameters
    version = library.sphg_version()
    if version // 100 != VERSION[0] * 100 + VERSION[1]:
        raise ImportError(f"sphgrad: {place} has version {version // 10000}."
                          f"{version // 100 % 100}, this package needs {VERSION[0]}.{VERSION[1]}")
    return library


functions = _load()
