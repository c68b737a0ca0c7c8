# SPDX-License-Identifier: MIT
"""Arrays: what a view can express is used in place, everything else is copied or refused, and nothing
is ever written where it must not be."""
import ctypes
import gc
import numpy as np
import sphgrad as sg
from sphgrad import _c
from sphgrad._views import Borrowed
from support import PRECISIONS, Case, cloud, guarded, main, untouched, waves

H = 2.2


def layouts(values):
    """(name, array with the same numbers, whether a view expresses it)."""
    n, rest, dtype = len(values), values.shape[1:], values.dtype
    tensor = values.ndim == 3
    yield "C order", values.copy(), True
    yield "Fortran order", np.asfortranarray(values), not tensor
    yield "every second", np.repeat(values, 2, axis=0)[::2], True
    yield "backwards", values[::-1].copy()[::-1], True
    wide = np.zeros((n, 9) + rest[1:], dtype)
    wide[:, 2:2 + rest[0]] = values
    yield "columns of a wider array", wide[:, 2:2 + rest[0]], True
    wide[:, 7 - 2 * rest[0] + 1:8:2] = values[:, :]
    yield "every second column", wide[:, 7 - 2 * rest[0] + 1:8:2], True
    record = np.zeros(n, [("id", "i4"), ("pad", "f4"), ("v", dtype, rest)])
    record["v"] = values
    yield "a field of records", record["v"], True
    packed = np.zeros(n, [("id", "u1"), ("v", dtype, rest)])
    packed["v"] = values
    yield "a field of packed records", packed["v"], False
    size = (values[0].nbytes + 2 + 15) // 16 * 16
    odd = np.zeros(n, np.dtype({"names": ["v"], "formats": [(dtype, rest)], "offsets": [2],
                                "itemsize": size}))
    odd["v"] = values
    yield "a field at an odd place", odd["v"], False
    yield "last axis first", np.moveaxis(np.moveaxis(values, -1, 0).copy(), 0, -1), not tensor
    if tensor:
        yield "matrices by columns", values.swapaxes(1, 2).copy().swapaxes(1, 2), True
        full = np.zeros((n, 3, 3), dtype)
        full[:, :rest[0], :rest[1]] = values
        yield "part of 3 x 3", full[:, :rest[0], :rest[1]], True


class Layouts(Case):
    def test_any_layout_gives_the_same_bits(self):
        for dtype in PRECISIONS:
            for d in (2, 3):
                x = cloud(6, d, dtype)
                v = waves(x)
                expected = sg.jacobian(sg.Neighbors(x, H), v, 1)
                for name, positions, _ in layouts(x):
                    with self.subTest(positions=name, dtype=dtype.__name__, d=d):
                        self.same(sg.jacobian(sg.Neighbors(positions, H), v, 1), expected)
                n = sg.Neighbors(x, H)
                for name, field, _ in layouts(v):
                    with self.subTest(field=name, dtype=dtype.__name__, d=d):
                        self.same(sg.jacobian(n, field, 1), expected)
                for name, out, _ in layouts(np.zeros_like(expected)):
                    with self.subTest(out=name, dtype=dtype.__name__, d=d):
                        self.assertIs(sg.jacobian(n, v, 1, out=out), out)
                        self.same(out, expected)
                volume = np.linspace(0.9, 1.1, len(x)).astype(dtype)
                self.same(sg.jacobian(n, v, volume[::-1].copy()[::-1]), sg.jacobian(n, v, volume))

    def test_tensors_of_any_layout_are_read_right(self):
        x = cloud()
        n = sg.Neighbors(x, H)
        s = np.random.default_rng(5).normal(size=(len(x), 3, 3))
        expected = sg.divergence(n, s, 1)
        for name, stress, _ in layouts(s):
            with self.subTest(name):
                self.same(sg.divergence(n, stress, 1), expected)

    def test_symmetric_matrices_may_be_whole(self):
        for d, packed in ((2, (0, 1, 3)), (3, (0, 1, 2, 4, 5, 8))):
            x = cloud(6, d)
            n, whole = sg.Neighbors(x, H), np.zeros((len(x), d, d))
            table = sg.correction_table(n, 1)
            for out in (whole, np.zeros((len(x), d, d)).swapaxes(1, 2)):
                self.assertIs(sg.correction_table(n, 1, out=out), out)
                self.same(out, np.ascontiguousarray(out).swapaxes(1, 2))
                self.same(out.reshape(len(x), d * d)[:, packed], table)
            stress = np.random.default_rng(6).normal(size=(len(x), d, d))
            stress += stress.swapaxes(1, 2)
            of_shape = {"shape": sg.Shape.SYM_TENSOR}
            expected = sg.evaluate(n, sg.Field(stress.reshape(len(x), d * d)[:, packed], divergence=True,
                                               **of_shape), volume=1, target_correction=table)
            found = sg.evaluate(n, sg.Field(stress, divergence=True, **of_shape), volume=1,
                                target_correction=whole)
            self.same(found.fields[0].divergence, expected.fields[0].divergence)
            with self.assertRaises(ValueError):
                sg.correction_table(n, 1, scheme=sg.Scheme(H, method=sg.Method.CMLS), out=whole)

    def test_what_a_view_expresses_is_not_copied(self):
        for shape, rest in ((_c.Shape.VECTOR, (3,)), (_c.Shape.TENSOR, (3, 3))):
            for name, array, in_place in layouts(np.ones((50,) + rest, np.float32)):
                with self.subTest(name, shape=shape.name):
                    for use in ("input", "output"):
                        view = getattr(Borrowed(), use)(array, 50, rest, np.dtype(np.float32), name,
                                                        shape)
                        self.assertEqual(view.x == array.ctypes.data, in_place)

    def test_one_item_stands_for_all(self):
        x = cloud()
        n, v = sg.Neighbors(x, H), waves(x)
        expected = sg.jacobian(n, v, np.ones(len(x)))
        for volume in (1, 1.0, np.float64(1), np.array(1.0), np.broadcast_to(1.0, len(x))):
            self.same(sg.jacobian(n, v, volume), expected)
        self.close(sg.jacobian(n, np.array([1.0, 2.0, 3.0]), 1),
                   np.zeros((len(x), 3, 3)), 1)
        self.close(sg.gradient(n, 5.0, 1), np.zeros((len(x), 3)), 1)

    def test_what_is_copied_back_keeps_what_was_not_selected(self):
        x = cloud()
        n, v = sg.Neighbors(x, H), waves(x)
        out = np.full((len(x), 3, 3), 7.0, order="F")
        sg.jacobian(n, v, 1, out=out, subset=slice(0, 10))
        self.assertTrue((out[10:] == 7).all())
        self.same(out[:10], sg.jacobian(n, v, 1)[:10])


class Refusals(Case):
    def setUp(self):
        self.x = cloud(6, 3, np.float32)
        self.n, self.v = sg.Neighbors(self.x, H), waves(self.x)

    def refuse(self, kind, words, call, *arguments, **options):
        with self.assertRaisesRegex(kind, words):
            call(*arguments, **options)

    def test_results_stay_within_their_arrays(self):
        for dtype in PRECISIONS:
            for d in (2, 3):
                x = cloud(6, d, dtype)
                n, v, count = sg.Neighbors(x, H), waves(x), len(x)
                for call, rest in ((sg.jacobian, (d, d)), (sg.divergence, ()),
                                   (sg.curl, (3,) if d == 3 else ())):
                    out, memory = guarded((count,) + rest, dtype)
                    call(n, v, 1, out=out)
                    self.assertTrue(untouched(memory) and not (out == 12345).any())
                rank, memory = guarded((count,), np.uint16)
                rank = rank.view(np.uint8)[:count]
                sg.evaluate(n, volume=1, rank=rank)
                self.assertTrue(untouched(memory))

    def test_lengths_are_checked(self):
        v, n = self.v, self.n
        for wrong in (v[:-1], v[:5], v[:0], np.vstack([v, v]), v[:, :2], v[:, 0].copy(), v[None]):
            self.refuse(ValueError, "shape", sg.jacobian, n, wrong, 1)
        for wrong in (np.empty((5, 3, 3), "f4"), np.empty((len(v), 9), "f4"),
                      np.empty((len(v), 2, 2), "f4"), np.empty((len(v) + 1, 3, 3), "f4")):
            wrong[...] = 3
            self.refuse(ValueError, "shape", sg.jacobian, n, v, 1, out=wrong)
            self.assertTrue((wrong == 3).all())
        ones = np.ones(len(v), "f4")
        self.refuse(ValueError, "volume", sg.jacobian, n, v, ones[:-1])
        self.refuse(ValueError, "target_volume", sg.jacobian, n, v, 1, target_volume=ones[1:])
        self.refuse(ValueError, "correction", sg.jacobian,
                    sg.Sources(n, 1, correction=np.ones((len(v), 5), "f4")), v)
        self.refuse(ValueError, "target_correction", sg.jacobian, n, v, 1,
                    target_correction=np.ones((len(v), 16), "f4"))
        self.refuse(ValueError, "rank", sg.evaluate, n, volume=1, rank=np.empty(5, np.uint8))
        self.refuse(ValueError, "lambda_min", sg.evaluate, n, volume=1,
                    lambda_min=np.empty(5, "f4"))
        self.refuse(ValueError, "positions", sg.Neighbors, np.zeros((5, 4)), H)
        self.refuse(ValueError, "positions", sg.Neighbors, np.zeros(5), H)
        self.refuse(ValueError, "targets", sg.Neighbors, self.x, H, targets=self.x[:, :2])
        self.refuse(ValueError, "own", sg.Neighbors, self.x, H, own=len(v) + 1)
        self.refuse(ValueError, "own", sg.Neighbors, self.x, H, own=-1)

    def test_lengths_follow_the_last_build(self):
        n = sg.Neighbors(self.x, H)
        n.search(np.vstack([self.x, self.x + 0.1]))
        self.refuse(ValueError, "shape", sg.jacobian, n, self.v, 1)
        with self.assertRaises(sg.Error):
            n.search(np.full((3, 3), np.nan, "f4"))
        self.assertEqual(n.target_count, 2 * len(self.x))
        self.assertEqual(sg.jacobian(n, np.vstack([self.v, self.v]), 1).shape[0], 2 * len(self.x))

    def test_types_are_checked(self):
        v, n = self.v, self.n
        for wrong in (v.astype("f8"), v.astype("i4"), v.astype(">f4"), v.astype("c8"), v.astype(object),
                      np.ma.masked_array(v, v > 0)):
            self.refuse(TypeError, "values", sg.jacobian, n, wrong, 1)
        self.refuse(TypeError, "volume", sg.jacobian, n, v, np.ones(len(v)))
        self.refuse(TypeError, "volume", sg.jacobian, n, v, "1")
        for wrong in (self.x.astype("i4"), self.x.astype("f2"), self.x.astype(">f4"),
                      self.x.astype("c8"), np.ma.masked_array(self.x)):
            self.refuse(TypeError, "positions", sg.Neighbors, wrong, H)
        self.refuse(TypeError, "targets", sg.Neighbors, self.x, H, targets=self.x.astype("f8"))
        self.refuse(TypeError, "gradient", sg.jacobian, n, v, 1, out=np.empty((len(v), 3, 3)))
        self.refuse(TypeError, "gradient", sg.jacobian, n, v, 1, out=[0.0] * len(v))
        self.refuse(TypeError, "rank", sg.evaluate, n, volume=1, rank=np.empty(len(v), np.int8))

    def test_outputs_must_be_writable(self):
        out = np.zeros((len(self.x), 3, 3), "f4")
        out.flags.writeable = False
        self.refuse(ValueError, "read-only", sg.jacobian, self.n, self.v, 1, out=out)
        same = np.lib.stride_tricks.as_strided(np.zeros(9, "f4"), out.shape, (0, 12, 4))
        self.refuse(ValueError, "one place", sg.jacobian, self.n, self.v, 1, out=same)
        self.assertFalse(out.any() or same.any())
        read = self.v.copy()
        read.flags.writeable = False
        self.same(sg.jacobian(self.n, read, 1), sg.jacobian(self.n, self.v, 1))

    def test_outputs_must_not_overlap(self):
        memory = np.zeros((len(self.x), 4), "f4")
        memory[:, 0] = self.x[:, 0]
        before = memory.copy()
        self.refuse(sg.Error, "overlap", sg.gradient, self.n, memory[:, 0], 1, out=memory[:, :3])
        self.same(memory, before)
        self.same(sg.gradient(self.n, memory[:, 0], 1, out=memory[:, 1:]),
                  sg.gradient(self.n, before[:, 0], 1))

    def test_subsets_are_checked(self):
        count = len(self.x)
        for wrong in ([count], [-1], np.array([2 ** 40]), np.ones(count - 1, bool),
                      np.ones((count, 1), bool), (0, count + 1), (-1, 3), (5, 2), slice(0, 9, 2)):
            self.refuse((ValueError, TypeError), "", sg.jacobian, self.n, self.v, 1, subset=wrong)
        self.refuse(TypeError, "whole", sg.jacobian, self.n, self.v, 1, subset=np.array([1.5]))

    def test_numbers_that_are_none(self):
        x, v = self.x.copy(), self.v.copy()
        x[7, 1] = np.nan
        with self.assertRaises(sg.Error) as caught:
            sg.Neighbors(x, H)
        self.assertEqual(caught.exception.status, sg.Result.ERROR_NOT_FINITE)
        self.assertIn("7", caught.exception.message)
        for volume in (-1.0, np.inf, np.where(np.arange(len(v)) == 9, np.nan, 1).astype("f4")):
            with self.assertRaises(sg.Error) as caught:
                sg.jacobian(self.n, v, volume)
            self.assertEqual(caught.exception.status, sg.Result.ERROR_VOLUME)
        v[0] = np.nan
        found = sg.jacobian(self.n, v, 1)
        self.assertTrue(np.isnan(found[0]).any())
        self.assertTrue(np.isfinite(found[-1]).all())

    def test_messages_are_those_of_the_library(self):
        for options, word in (({"scheme": -1.0}, "support_radius"), ({"scheme": H, "skin": -1},
                              "skin"), ({"scheme": H, "period": 1.0}, "period"),
                              ({"scheme": sg.Scheme(H, threshold=2)}, "threshold")):
            with self.assertRaises(sg.Error) as caught:
                sg.Neighbors(self.x, **options)
            self.assertEqual(caught.exception.status, sg.Result.ERROR_ARGUMENT)
            self.assertIn(word, caught.exception.message)
            self.assertIn("ERROR_ARGUMENT", str(caught.exception))
        self.refuse(ValueError, "method", sg.Scheme, H, "sph")
        self.refuse(ValueError, "Isa|isa", sg.Context, 1, "avx")
        self.refuse(sg.Error, "support_radius", sg.jacobian, self.n, self.v, 1, scheme=2 * H)

    def test_fields_that_make_no_sense(self):
        x, n = self.x, self.n
        self.refuse(ValueError, "not defined", sg.divergence, n, x[:, 0], 1)
        self.refuse(ValueError, "not defined", sg.curl, n, x[:, 0], 1)
        self.refuse(ValueError, "not defined", sg.gradient, n, np.zeros((len(x), 3, 3), "f4"), 1)
        self.refuse(ValueError, "source set", sg.jacobian, n, [self.v, self.v], 1)
        self.refuse(TypeError, "sources", sg.jacobian, ["n"], self.v)
        self.refuse(ValueError, "no source set", sg.jacobian, [], self.v)
        self.refuse(ValueError, "shape", sg.gradient, n, None, 1)
        other = sg.Neighbors(x[:50].copy(), H)
        self.refuse(ValueError, "differ", sg.jacobian, [sg.Sources(n, 1), sg.Sources(other, 1)],
                    [self.v, self.v[:50]])

    def test_small_matrices_are_checked(self):
        self.refuse(ValueError, "shape", sg.svd, np.zeros((5, 2, 2)))
        self.refuse(ValueError, "shape", sg.eigen, np.zeros((5, 4)))
        self.refuse(TypeError, "int", sg.eigen, np.zeros((5, 6), int))
        self.refuse(ValueError, "correction", sg.invert_moments, np.zeros((5, 6)), H, 1,
                    correction=np.zeros((4, 6)))


class Lists(Case):
    def setUp(self):
        self.x = cloud()
        self.v = waves(self.x)
        self.p = sg.pairs(sg.Neighbors(self.x, H))
        self.expected = sg.jacobian(sg.Neighbors(self.x, H), self.v, 1)

    def test_lists_are_checked(self):
        x, o, i = self.x, self.p.offsets, self.p.indices
        for offsets, indices in ((o[:-1], i), (o, i[:-1]), (o, i[:0]), (o + 1, i), (o[::-1], i),
                                 (np.append(o, o[-1]), i)):
            with self.assertRaises(ValueError):
                sg.Neighbors(x, H, lists=sg.Lists(offsets, indices))
        for indices in (i.astype(float), i.astype(np.int64) + 2 ** 40, i.reshape(-1, 2)[:, :1]):
            with self.assertRaises((TypeError, ValueError)):
                sg.Neighbors(x, H, lists=sg.Lists(o, indices))
        with self.assertRaises(ValueError):
            sg.Neighbors(x, H, skin=0.1, lists=sg.Lists(o, i))
        wrong = i.copy()
        wrong[100] = len(x)
        with self.assertRaises(sg.Error) as caught:
            sg.jacobian(sg.Neighbors(x, H, lists=sg.Lists(o, wrong)), self.v, 1)
        self.assertEqual(caught.exception.status, sg.Result.ERROR_INDEX)

    def test_borrowed_arrays_live_as_long_as_needed(self):
        n = sg.Neighbors(self.x, H, lists=sg.Lists(self.p.offsets.copy(), self.p.indices.copy()))
        gc.collect()
        litter = [np.full(len(self.p.indices), -1, np.int32) for _ in range(20)]
        litter += [np.full(len(self.p.offsets), -1, np.int64) for _ in range(20)]
        self.close(sg.jacobian(n, self.v, 1), self.expected, 100)
        with self.assertRaises(sg.Error): # the old lists hold after a refusal
            n.use_lists(np.full_like(self.x, np.nan), sg.Lists(self.p.offsets * 1, self.p.indices * 1))
        gc.collect()
        litter += [np.full(len(self.p.indices), -1, np.int32) for _ in range(20)]
        self.close(sg.jacobian(n, self.v, 1), self.expected, 100)

    def test_contexts_outlive_their_neighbours(self):
        gc.collect()
        real = {name: getattr(_c.functions, name)
                for name in ("sphg_context_destroy", "sphg_neighbors_destroy")}
        order = []

        def watch(name):
            def destroy(pointer):
                order.append(name)
                real[name](pointer)
            setattr(_c.functions, name, destroy)

        try:
            for name in real:
                watch(name)
            context = sg.Context(threads=1)
            n = sg.Neighbors(self.x, H, context=context)
            cycle = [context, n]
            cycle.append(cycle)
            context.cycle = cycle
            del context, n, cycle
            gc.collect()
        finally:
            for name in real:
                setattr(_c.functions, name, real[name])
        self.assertEqual(order, ["sphg_neighbors_destroy", "sphg_context_destroy"])
        n = sg.Neighbors(self.x, H, context=sg.Context(threads=1))
        gc.collect()
        self.same(sg.jacobian(n, self.v, 1), self.expected)
        with sg.Context(threads=1) as context:
            n = sg.Neighbors(self.x, H, context=context)
        for call in (lambda: n.info, lambda: sg.jacobian(n, self.v, 1), lambda: context.info,
                     lambda: n.search(self.x)):
            with self.assertRaisesRegex(ValueError, "closed"):
                call()
        n.close()
        context.close()

    def test_temporaries_live_through_the_call(self):
        n = sg.Neighbors(self.x * 1.0, H)
        self.same(sg.jacobian(n, self.v * 1.0, np.ones(len(self.x)) * 1.0), self.expected)
        self.assertEqual(ctypes.sizeof(_c.View), 40 if ctypes.sizeof(ctypes.c_void_p) == 8 else 20)


main()
