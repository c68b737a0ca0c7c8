#!/usr/bin/env python3
# SPDX-License-Identifier: MIT
"""python_processes.py LIBRARY: what multiprocessing does by fork(). Children give the gradients of the
parent, with its context and with new ones; so does one that was there before the parent worked."""
import ctypes as c
import multiprocessing
import os
import signal
import sys

SIDE = 20
COUNT = SIDE ** 3


class View(c.Structure):
    _fields_ = [("x", c.c_void_p), ("y", c.c_void_p), ("z", c.c_void_p),
                ("stride", c.c_ssize_t), ("type", c.c_int)]


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


class Sources(c.Structure):
    _fields_ = [("neighbors", c.c_void_p), ("volume", View), ("density", View),
                ("correction", View), ("same_volumes", c.c_int32)]


class Info(c.Structure):
    _fields_ = [("threads", c.c_int32), ("isa", c.c_int), ("openmp", c.c_int32),
                ("bytes", c.c_int64)]


library = c.CDLL(sys.argv[1])
library.sphg_jacobian.argtypes = [c.c_void_p, c.c_void_p, c.c_void_p, c.c_void_p, View, View]
library.sphg_context_destroy.argtypes = library.sphg_neighbors_destroy.argtypes = [c.c_void_p]


def view(array, stride):
    return View(c.addressof(array), None, None, stride, 1)


positions = (c.c_float * (3 * COUNT))()
for i in range(COUNT):
    positions[3 * i: 3 * i + 3] = [i % SIDE, i // SIDE % SIDE + 0.01 * (i % 7), i // SIDE ** 2]


def new_context():
    context = c.c_void_p()
    assert library.sphg_context_create(library.sphg_version(), None, c.byref(context)) == 0
    return context


def threads(context):
    info = Info()
    assert library.sphg_context_get_info(context, c.byref(info)) == 0
    return info.threads if info.openmp else 2


def gradients(context):
    """The gradients of the positions, as bytes."""
    neighbors, scheme = c.c_void_p(), Scheme(support_radius=2)
    result, volume = (c.c_float * (9 * COUNT))(), (c.c_float * 1)(1)
    geometry = Geometry(sources=view(positions, 12), source_count=COUNT, target_count=COUNT)
    assert library.sphg_neighbors_create(context, c.byref(neighbors)) == 0
    assert library.sphg_neighbors_search(context, neighbors, c.byref(scheme),
                                         c.byref(geometry)) == 0
    sources = Sources(neighbors=neighbors, volume=view(volume, 0))
    assert library.sphg_jacobian(context, c.byref(scheme), c.byref(sources), None,
                                 view(positions, 12), view(result, 36)) == 0
    library.sphg_neighbors_destroy(neighbors)
    return bytes(result)


def with_new_context(_=None):
    context = new_context()
    found = gradients(context), threads(context)
    library.sphg_context_destroy(context)
    return found


def in_child(work):
    """Whether work() was true in a child, which has a minute."""
    child = os.fork()
    if child == 0:
        signal.alarm(60)
        held = False
        try:
            held = work()
        finally:
            os._exit(0 if held else 1)
    return os.waitpid(child, 0)[1] == 0


def main():
    context = new_context()
    before = in_child(lambda: threads(context) == 2 and with_new_context()[1] == 2)
    expected = gradients(context)
    old = in_child(lambda: gradients(context) == expected)
    new = in_child(lambda: with_new_context()[0] == expected)
    with multiprocessing.get_context("fork").Pool(2) as pool:
        found = pool.map_async(with_new_context, range(4)).get(60)
    pool_works = all(one[0] == expected for one in found)
    here = gradients(context) == expected and threads(context) == 2
    held = {"a child from before": before, "old context": old, "new context": new,
            "multiprocessing": pool_works, "parent": here}
    for name, value in held.items():
        print(f"{name}: {'as the parent' if value else 'WRONG'}")
    return 0 if all(held.values()) else 1


sys.exit(main())
