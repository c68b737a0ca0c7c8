# SPDX-License-Identifier: MIT
"""Context: who works. Errors of the library become exceptions here."""
import contextlib
import ctypes as c
import dataclasses
import os
import threading
import weakref
from . import _c


class Error(Exception):
    """The library refused a call or could not finish it. `status` is a Result; positive: nothing was
    written; negative: the outputs of this call are undefined. `message` is what it objected to."""

    def __init__(self, status, message):
        self.status = _c.Result(status)
        self.message = message
        super().__init__(status, message)

    def __str__(self):
        return f"{self.message or _c.functions.sphg_result_string(self.status).decode()}" \
               f" ({self.status.name})"


def choose(kind, value):
    """A member of an enumeration from itself, its number or its name in any case."""
    if isinstance(value, str):
        name = value.upper().replace(" ", "_").replace("-", "_")
        prefix = {"Isa": "ISA_", "Fault": "FAULT_"}.get(kind.__name__, "")
        for key in (name, prefix + name):
            if key in kind.__members__:
                return kind[key]
        known = ", ".join(k.lower()[len(prefix):] for k in kind.__members__)
        raise ValueError(f"no {kind.__name__.lower()} is called {value!r}; there are {known}")
    return kind(value)


@dataclasses.dataclass(frozen=True)
class ContextInfo:
    threads: int
    isa: _c.Isa
    openmp: bool
    bytes: int


class _Handle:
    """Owns the C context. Neighbours hold it too, so that it outlives them."""

    def __init__(self, config):
        pointer = c.c_void_p()
        version = _c.VERSION[0] * 10000 + _c.VERSION[1] * 100 + _c.VERSION[2]
        status = _c.functions.sphg_context_create(version, c.byref(config), c.byref(pointer))
        if status:
            raise Error(status, f"Context: threads={config.threads}, "
                                f"isa={_c.Isa(config.isa).name}: "
                                f"{_c.functions.sphg_result_string(status).decode()}")
        self.pointer = pointer
        self.destroy = weakref.finalize(self, _c.functions.sphg_context_destroy, pointer)


class Context:
    """Threads, instruction set and memory of the calls that use it.

    threads: 0 for as many as OpenMP has, 1 for the calling thread alone. isa: "best", "base",
    "x86_v3", "x86_v4" or "neon". trusted: do not look for bad numbers in positions, volumes and lists.

    Threads of Python may share a context: their calls wait for one another. Contexts of their own
    work at the same time, since calls release the GIL. After fork() old and new contexts work in the
    child, on its calling thread if the parent had used several."""

    def __init__(self, threads=0, isa="best", trusted=False):
        config = _c.Config(threads=threads, isa=choose(_c.Isa, isa), trusted=bool(trusted))
        if config.threads != threads:
            raise ValueError(f"threads is {threads}")
        self._handle = _Handle(config)
        self._neighbors = weakref.WeakSet()
        self._lock = threading.RLock()
        _all_contexts.add(self)

    @property
    def _pointer(self):
        if self._handle is None:
            raise ValueError("the context is closed")
        return self._handle.pointer

    @contextlib.contextmanager
    def _calls(self):
        """One call at a time, its checks included."""
        with self._lock:
            yield self._pointer

    def _check(self, status):
        if status:
            raise Error(status, _c.functions.sphg_last_message(self._pointer).decode())

    @property
    def info(self):
        """What calls use: threads, isa, openmp, and the bytes held beside neighbours."""
        info = _c.ContextInfo()
        with self._calls() as pointer:
            self._check(_c.functions.sphg_context_get_info(pointer, c.byref(info)))
        return ContextInfo(info.threads, _c.Isa(info.isa), bool(info.openmp), info.bytes)

    def close(self):
        """Gives the memory back now, that of its neighbours included."""
        with self._lock:
            for neighbors in list(self._neighbors):
                neighbors.close()
            if self._handle is not None:
                self._handle.destroy()
                self._handle = None

    def __enter__(self):
        return self

    def __exit__(self, *error):
        self.close()

    def __reduce__(self):
        raise TypeError("a context cannot be pickled: make one in each process")


_all_contexts = weakref.WeakSet()
_default = None
_default_lock = threading.Lock()


def default_context():
    """The context of those who name none: all threads, the best instruction set."""
    global _default
    with _default_lock:
        if _default is None or _default._handle is None:
            _default = Context()
        return _default


def _after_fork_in_child():
    """Locks that other threads of the parent held would never be released here."""
    global _default_lock
    _default_lock = threading.Lock()
    for context in list(_all_contexts):
        context._lock = threading.RLock()


if hasattr(os, "register_at_fork"):
    os.register_at_fork(after_in_child=_after_fork_in_child)
