# SPDX-License-Identifier: MIT
"""Results: exact where they must be, those of a reference in NumPy, and of one another."""
import dataclasses
import numpy as np
import sphgrad as sg
from support import PRECISIONS, Case, cloud, main, pair_gradients, waves

H = 2.2


class Results(Case):
    def test_linear_fields_are_exact(self):
        for dtype in PRECISIONS:
            for d in (2, 3):
                x = cloud(6, d, dtype)
                slope = np.arange(1.0, d * d + 1).reshape(d, d).astype(dtype)
                for method in ("kgc", "mls", "rkpm", "cmls", "crkpm"):
                    for kernel in ("cubic_spline", "wendland c4"):
                        n = sg.Neighbors(x, sg.Scheme(H, method, kernel))
                        found = sg.jacobian(n, np.ascontiguousarray(x @ slope.T), 1)
                        self.close(found, slope, 2000, 9)
                        self.assertEqual(found.dtype, dtype)

    def test_gradients_are_those_of_their_definition(self):
        scheme = sg.Scheme(H, threshold=1e-6)
        x = cloud()
        v, volume = waves(x), np.linspace(0.8, 1.2, len(x))
        g = pair_gradients(scheme, x, x, volume)
        n = sg.Neighbors(x, scheme)
        expected = np.einsum("ijb,ija->iab", g, v[None, :, :] - v[:, None, :])
        self.close(sg.jacobian(n, v, volume), expected, 1000)
        self.close(sg.gradient(n, v[:, 1], volume), expected[:, 1], 1000)
        self.close(sg.divergence(n, v, volume), np.trace(expected, axis1=1, axis2=2), 1000)
        direct = sg.gradient(n, v[:, 0], volume, form="direct")
        self.close(direct, np.einsum("ijb,j->ib", g, v[:, 0]), 1000, 2)

    def test_curl_and_divergence_are_those_of_the_jacobian(self):
        for d in (2, 3):
            x = cloud(6, d)
            v = waves(x)
            n = sg.Neighbors(x, H)
            j = sg.jacobian(n, v, 1)
            self.same(sg.gradient(n, v, 1), j)
            self.close(sg.divergence(n, v, 1), np.trace(j, axis1=1, axis2=2), 100)
            curl = sg.curl(n, v, 1)
            if d == 2:
                self.close(curl, j[:, 1, 0] - j[:, 0, 1], 100)
            else:
                self.close(curl, np.stack([j[:, 2, 1] - j[:, 1, 2], j[:, 0, 2] - j[:, 2, 0],
                                           j[:, 1, 0] - j[:, 0, 1]], 1), 100)

    def test_forces_are_the_negative_adjoint_of_gradients(self):
        random = np.random.default_rng(3)
        for d in (2, 3):
            x = cloud(6, d)
            v, volume = waves(x), np.linspace(0.9, 1.1, len(x))
            for method in ("kgc", "plain"):
                n = sg.Neighbors(x, sg.Scheme(H, method))
                j = sg.jacobian(n, v, volume)
                full = random.normal(size=(len(x), d, d))
                full += full.transpose(0, 2, 1)
                packed = np.ascontiguousarray(full[(slice(None),) + np.triu_indices(d)])
                scalar = random.normal(size=len(x))
                for stress in (full, packed):
                    f = sg.force(n, stress, volume)
                    self.close((f * v).sum(), -np.einsum("i,iab,iab", volume, full, j), 1e5)
                    self.close(f.sum(0), 0 * f.sum(0), 1e5)
                f = sg.force(n, scalar, volume)
                self.close((f * v).sum(), -np.einsum("i,i,iaa", volume, scalar, j), 1e5)

    def test_a_table_gives_the_same_as_computing_on_the_way(self):
        x = cloud()
        n = sg.Neighbors(x, H)
        table, rank = sg.correction_table(n, 1, rank=True)
        self.assertEqual(table.shape, (len(x), 6))
        self.assertEqual(set(rank), {3})
        self.close(sg.jacobian(sg.Sources(n, 1, correction=table), waves(x)),
                   sg.jacobian(n, waves(x), 1), 10)
        self.close(sg.jacobian(n, waves(x), 1, target_correction=table),
                   sg.jacobian(n, waves(x), 1), 10)
        self.same(sg.force(n, x[:, 0], 1, correction=table), sg.force(n, x[:, 0], 1))

    def test_other_things_in_one_request(self):
        x = cloud()
        v, n = waves(x), sg.Neighbors(x, sg.Scheme(H, "cmls"))
        found = sg.evaluate(n, [sg.Field(v, gradient=True, divergence=True, curl=True),
                                sg.Field(x[:, 0], "direct", value=True, square=True)],
                            volume=1, rank=True, lambda_min=True, correction=True, stats=True)
        self.same(found.fields[0].gradient, sg.jacobian(n, v, 1))
        self.close(found.fields[1].value, x[:, 0], 1000, 6)
        self.assertTrue((found.fields[1].square != 0).any())
        self.assertEqual(found.correction.shape, (len(x), 16))
        self.assertEqual(found.stats.rank, (0, 0, 0, len(x)))
        self.assertTrue((found.rank == 3).all() and (found.lambda_min > 0).all())

    def test_order_2_is_exact_on_quadratic_fields(self):
        x = cloud()
        n = sg.Neighbors(x, sg.Scheme(1.5 * H, order=2))
        values = np.stack([x[:, 0] ** 2, x[:, 1] * x[:, 2], 2 * x[:, 2]], axis=1)
        apart = np.zeros((len(x), 3, 8), x.dtype)[:, :, :6]  # no view can say where these are
        found = sg.evaluate(n, [sg.Field(values, gradient=True, hessian=apart, laplacian=True),
                                sg.Field(values[:, 0].copy(), hessian=True)],
                            volume=1, rank=True, stats=True, correction=True)
        full = found.rank == 9
        self.assertEqual(found.stats.quadratic, full.sum())
        self.assertGreater(full.sum(), 20)
        exact = np.zeros((3, 6))
        exact[0, 0], exact[1, 4] = 2, 1
        first = found.fields[0]
        self.assertLess(abs(first.hessian[full] - exact).max(), 1e-4)
        self.assertLess(abs(first.laplacian[full] - (2, 0, 0)).max(), 1e-4)
        self.assertLess(abs(first.gradient[full, 0, 0] - 2 * x[full, 0]).max(), 1e-4)
        self.same(found.fields[1].hessian, first.hessian[:, 0])
        self.assertEqual(found.correction.shape, (len(x), 45))
        again = sg.jacobian(n, values, 1, target_correction=found.correction)
        self.same(again, first.gradient)

    def test_curvature_is_borrowed_at_a_surface(self):
        x = cloud()
        n = sg.Neighbors(x, sg.Scheme(H, order=2))
        values = np.stack([x[:, 0] ** 2, x[:, 1] * x[:, 2], 2 * x[:, 2]], axis=1)
        exact = np.zeros((len(x), 3, 3))
        exact[:, 0, 0], exact[:, 2, 2] = 2 * x[:, 0], 2
        exact[:, 1, 1], exact[:, 1, 2] = x[:, 2], x[:, 1]
        first = sg.evaluate(n, sg.Field(values, gradient=True, curvature=True), volume=1, borrows=True)
        lent = first.fields[0].curvature
        self.assertEqual(lent.shape, (len(x), 19))
        open_ones = first.borrows.astype(bool)
        second = sg.evaluate(n, sg.Field(values, gradient=True, lenders=lent), volume=1,
                             subset=open_ones)
        alone = abs(first.fields[0].gradient - exact).max((1, 2))[open_ones]
        borrowed = abs(second.fields[0].gradient - exact).max((1, 2))[open_ones]
        self.assertLess(np.median(borrowed), .01 * np.median(alone) + 1e-4)
        self.same(sg.evaluate(n, sg.Field(values, gradient=True, lenders=[lent]), volume=1,
                              subset=open_ones).fields[0].gradient, second.fields[0].gradient)
        with self.assertRaises(ValueError):
            sg.evaluate(n, sg.Field(values, gradient=True, lenders=[lent, lent]), volume=1)

    def test_symmetric_form_conserves_momentum(self):
        x = cloud()
        found = sg.gradient(sg.Sources(sg.Neighbors(x, H), 1, np.full(len(x), 2.0),
                                       sg.correction_table(sg.Neighbors(x, H), 1)),
                            waves(x)[:, 0], form="symmetric")
        self.close(found.sum(0), np.zeros(3), 1e5)

    def test_heat_flows_from_warm_to_cold_and_none_is_lost(self):
        x = cloud()
        n = sg.Neighbors(x, H)
        sources = sg.Sources(n, 1, correction=sg.correction_table(n, 1))
        warm, k = waves(x)[:, 0].copy(), np.linspace(.5, 2, len(x)).astype(x.dtype)
        find = lambda field: sg.evaluate(sources, field).fields[0].laplacian
        flow = find(sg.Field(warm, "adjoint", laplacian=True, coefficient=k))
        self.assertLess(abs(flow.sum()), 1e-4 * abs(flow).sum())
        self.assertLess((warm * flow).sum(), 0)
        self.close(find(sg.Field(warm, "adjoint", laplacian=True, coefficient=[np.asarray(2, x.dtype)])),
                   2 * find(sg.Field(warm, "adjoint", laplacian=True)), 10)
        with self.assertRaises(ValueError):
            find(sg.Field(warm, "adjoint", laplacian=True, coefficient=[k, k]))
        apart = sg.Sources(sg.Neighbors(x, H, targets=x), 1, correction=sources.correction)
        found = sg.evaluate(apart, sg.Field(warm, "adjoint", laplacian=True, coefficient=k, at_targets=warm,
                                            coefficient_at_targets=k), target_volume=1)
        self.close(found.fields[0].laplacian, flow, 1000)

    def test_values_of_differences_and_means(self):
        x = cloud()
        n = sg.Neighbors(x, H)
        v, one, mass = waves(x), np.ones(len(x), x.dtype), np.linspace(.5, 2, len(x)).astype(x.dtype)
        find = lambda field: sg.evaluate(n, field, volume=1).fields[0]
        direct = find(sg.Field(v, "direct", value=True, value_volume=mass)).value
        weights = find(sg.Field(one, "direct", value=True, value_volume=mass)).value
        self.close(find(sg.Field(v, value=True, value_volume=[mass])).value, direct - v * weights[:, None], 1000)
        self.close(find(sg.Field(v, "direct", value=True, shepard=True, value_volume=mass)).value,
                   direct / weights[:, None], 100)
        turn = np.random.default_rng(3).normal(size=(len(x), 3, 3)).astype(x.dtype)
        found = find(sg.Field(v, gradient=True, tensor=turn, contraction=True))
        self.close(found.contraction, (found.gradient * turn).sum((1, 2)), 1000)

    def test_results_may_be_added(self):
        x = cloud()
        n = sg.Neighbors(x, H)
        once = sg.jacobian(n, waves(x), 1)
        sum_ = np.ones_like(once)
        sg.jacobian(n, waves(x), 1, out=sum_, accumulate=True)
        self.close(sum_, once + 1, 10, 4)
        self.close(sg.jacobian(n, waves(x), 1, accumulate=True), once, 2)


class Sets(Case):
    def test_two_source_sets_are_one(self):
        x = cloud()
        v, cut = waves(x), 80
        own, wall = np.ascontiguousarray(x[:cut]), np.ascontiguousarray(x[cut:])
        together = sg.Neighbors(x, H, own=cut)
        apart = [sg.Sources(sg.Neighbors(own, H), 1),
                 sg.Sources(sg.Neighbors(wall, H, targets=own), np.ones(len(wall)))]
        self.close(sg.jacobian(apart, [v[:cut], v[cut:]]), sg.jacobian(together, v, 1), 1000)
        self.assertEqual(sg.jacobian(together, v, 1).shape, (cut, 3, 3))

    def test_targets_of_other_neighbours(self):
        x = cloud()
        v, cut = waves(x), 80
        own, wall = np.ascontiguousarray(x[:cut]), np.ascontiguousarray(x[cut:])
        fluid = sg.Neighbors(own, H)
        handed = sg.Neighbors(wall, H, targets=own)
        beside = sg.Neighbors(wall, H, targets=fluid)
        self.assertEqual((beside.target_count, beside.part_of), (cut, False))
        self.assertLess(beside.info.bytes, handed.info.bytes)
        results = [sg.jacobian([sg.Sources(fluid, 1), sg.Sources(n, 1)], [v[:cut], v[cut:]])
                   for n in (handed, beside)]
        np.testing.assert_array_equal(*results)
        fluid.search(own + 0.01)
        with self.assertRaisesRegex(sg.Error, "built anew"):
            sg.gradient(beside, v[cut:, 0].copy(), 1, at_targets=v[:cut, 0].copy())
        beside.search(wall, targets=fluid)
        fluid.close()
        with self.assertRaisesRegex(ValueError, "closed"):
            sg.gradient(beside, v[cut:, 0].copy(), 1, at_targets=v[:cut, 0].copy())
        beside.search(wall, targets=own)
        self.assertTrue(np.isfinite(sg.jacobian([sg.Sources(beside, 1)], [v[cut:]], at_targets=v[:cut])).all())

    def test_walls_may_mirror(self):
        x = cloud()
        own, wall = np.ascontiguousarray(x[:80]), np.ascontiguousarray(x[80:])
        sets = [sg.Sources(sg.Neighbors(own, H), 1),
                sg.Sources(sg.Neighbors(wall, H, targets=own), 1)]
        p = waves(own)[:, 0].copy()
        found = sg.gradient(sets, [p, None], mirror=True)
        self.assertEqual(found.shape, (80, 3))
        with self.assertRaisesRegex(sg.Error, "absent"):
            sg.gradient(sets, [p, None])

    def test_places_that_are_no_particles(self):
        x = cloud()
        places = np.array([[2.5, 2.5, 2.5], [1.2, 3.1, 2.2]])
        n = sg.Neighbors(x, H, targets=places)
        self.close(sg.gradient(n, 3 * x[:, 1], 1, at_targets=3 * places[:, 1]),
                   np.array([0.0, 3.0, 0.0]), 1000, 3)
        self.assertFalse(n.part_of)

    def test_periodic_boxes_have_no_border(self):
        x = cloud()
        n = sg.Neighbors(x, H, period=6)
        wave = np.sin(2 * np.pi * x[:, 0] / 6)
        moved = np.mod(x + [1.7, 2.9, 0.3], 6)
        self.close(sg.gradient(sg.Neighbors(moved, H, period=[6, 6, 6]), wave, 1),
                   sg.gradient(n, wave, 1), 1e4)
        self.assertGreater(n.info.pairs, sg.Neighbors(x, H).info.pairs)

    def test_skins_hold(self):
        x = cloud()
        n = sg.Neighbors(x, H, skin=0.4)
        self.assertTrue(n.info.rebuilt)
        y = x + 0.05
        self.assertFalse(n.search(y).info.rebuilt)
        self.close(sg.jacobian(n, waves(y), 1), sg.jacobian(sg.Neighbors(y, H), waves(y), 1), 1000)
        self.assertTrue(n.search(y + 1 * np.linspace(0, 1, len(y))[:, None]).info.rebuilt)

    def test_single_fields_beside_double_positions(self):
        x = cloud() + 1e6
        n = sg.Neighbors(x, H, precision=np.float32)
        found = sg.jacobian(n, (x - 1e6).astype(np.float32), 1)
        self.assertEqual(found.dtype, np.float32)
        self.close(found, np.eye(3), 1000)

    def test_subsets_touch_nothing_else(self):
        x = cloud()
        n, v = sg.Neighbors(x, H), waves(x)
        whole = sg.jacobian(n, v, 1)
        mask = np.arange(len(x)) % 3 == 0
        for subset in (mask, np.flatnonzero(mask), np.flatnonzero(mask).astype(np.int32)[::-1]):
            out = np.full_like(whole, 7)
            sg.jacobian(n, v, 1, subset=subset, out=out)
            self.same(out[mask], whole[mask])
            self.assertTrue((out[~mask] == 7).all())
        for subset in (slice(5, 20), (5, 20)):
            found = sg.jacobian(n, v, 1, subset=subset)
            self.same(found[5:20], whole[5:20])
            self.assertFalse(found[:5].any() or found[20:].any())
        self.assertFalse(sg.jacobian(n, v, 1, subset=[]).any())

    def test_nothing_is_ordinary(self):
        x = np.empty((0, 3))
        n = sg.Neighbors(x, H)
        self.assertEqual(sg.jacobian(n, x, 1).shape, (0, 3, 3))
        self.assertEqual(sg.pairs(n).offsets.tolist(), [0])


class Lists(Case):
    def test_lists_give_the_same(self):
        x = cloud()
        n, v = sg.Neighbors(x, H), waves(x)
        p = sg.pairs(n)
        for offsets in (p.offsets, p.offsets.astype(np.int32)):
            m = sg.Neighbors(x, H, lists=sg.Lists(offsets, p.indices))
            self.close(sg.jacobian(m, v, 1), sg.jacobian(n, v, 1), 100)
            self.assertIsNone(m.check())
        flagged = (p.indices | (1 << 30)).astype(np.int32)
        m.use_lists(x, sg.Lists(p.offsets, flagged, (1 << 29) - 1))
        self.close(sg.jacobian(m, v, 1), sg.jacobian(n, v, 1), 100)

    def test_lists_that_lack_pairs_are_found(self):
        x = cloud()
        p = sg.pairs(sg.Neighbors(x, H))
        offsets = p.offsets.copy()
        offsets[1:] -= 1
        fault = sg.Neighbors(x, H, lists=sg.Lists(offsets, p.indices[1:])).check()
        self.assertEqual((fault.kind, fault.target, fault.source),
                         (sg.Fault.FAULT_ONE_SIDED, 0, p.indices[0]))

    def test_pairs_are_those_of_brute_force(self):
        x = cloud()
        p = sg.pairs(sg.Neighbors(x, H), 1, gradient=True)
        near = np.sqrt(((x[:, None] - x[None]) ** 2).sum(-1)) < H
        np.fill_diagonal(near, False)
        targets, sources = np.nonzero(near)
        self.same(p.indices, sources)
        self.same(np.diff(p.offsets), near.sum(1))
        self.close(p.gradient, pair_gradients(sg.Scheme(H), x, x, 1)[targets, sources], 1000)
        free = sg.pairs(sg.Neighbors(x, H), any_order=True)
        self.same(np.sort(free.indices[:p.offsets[1]]), p.indices[:p.offsets[1]])

    def test_pairs_of_some_targets(self):
        x = cloud()
        n = sg.Neighbors(x, H)
        whole = sg.pairs(n, 1, gradient=True)
        mask = np.arange(len(x)) % 4 == 1
        some = sg.pairs(n, 1, gradient=True, subset=mask)
        row = np.repeat(np.arange(len(x)), np.diff(whole.offsets))
        self.same(some.indices, whole.indices[mask[row]])
        self.same(some.gradient, whole.gradient[mask[row]])

    def test_pairs_are_matrices_of_scipy(self):
        try:
            from scipy.sparse import csr_matrix
        except ImportError:
            self.skipTest("this Python has no SciPy")
        x = cloud()
        n = sg.Neighbors(x, H)
        p, a = sg.pairs(n, 1, gradient=True), waves(x)[:, 0].copy()
        self.assertIsInstance(p.matrix(), csr_matrix)
        self.assertEqual(p.matrix().nnz, n.info.pairs)
        for k, matrix in enumerate(p.gradient_matrices()):
            self.close(matrix @ a - np.asarray(matrix.sum(1))[:, 0] * a, sg.gradient(n, a, 1)[:, k],
                       1000)
        m = sg.Neighbors(x, H, lists=p.matrix())
        self.close(sg.gradient(m, a, 1), sg.gradient(n, a, 1), 100)

    def test_a_question_is_answered_as_the_search_goes(self):
        x, radii = cloud(), np.full(216, H)
        n = sg.Neighbors(x, H, skin=0.2)
        for moved, rebuilt in ((0.09, False), (0.11, True)):
            self.assertEqual(n.would_rebuild(x + moved * np.eye(3)[0]), rebuilt)
        self.assertTrue(n.would_rebuild(x, own=100))
        graded = sg.Neighbors(x, H, skin=0.2, support=np.linspace(H, 2 * H, 216))
        self.assertFalse(graded.would_rebuild(x))
        self.assertTrue(graded.would_rebuild(x, support=2 * np.linspace(H, 2 * H, 216)))
        self.assertFalse(graded.would_rebuild(x))
        self.assertTrue(n.would_rebuild(x, support=radii))
        self.assertFalse(n.would_rebuild(x))

    def test_order_is_a_permutation(self):
        order = sg.Neighbors(cloud(), H).order()
        self.same(np.sort(order), np.arange(216))


class Small(Case):
    def test_eigen_svd_and_inverse_are_those_of_numpy(self):
        a = np.random.default_rng(2).normal(size=(50, 3, 3))
        u, sigma, v = sg.svd(a)
        self.close(np.einsum("iab,ib,icb->iac", u, sigma, v), a, 100, 4)
        self.close(sigma, np.linalg.svd(a, compute_uv=False), 100, 4)
        for d in (2, 3):
            s = np.einsum("iba,ibc->iac", a, a)[:, :d, :d] + np.eye(d)
            packed = np.ascontiguousarray(s[(slice(None),) + np.triu_indices(d)])
            values, vectors = sg.eigen(packed)
            self.close(values, np.linalg.eigvalsh(s)[:, ::-1], 100, 40)
            self.close(np.einsum("iab,ib,icb->iac", vectors, values, vectors), s, 100, 40)
            self.same(sg.eigen(packed, vectors=False), values)
            table, rank, least, stats = sg.invert_moments(packed, sg.Scheme(H), 1, rank=True,
                                                          lambda_min=True, stats=True)
            self.close(table, np.linalg.inv(s)[(slice(None),) + np.triu_indices(d)], 1000)
            self.assertEqual((set(rank), stats.rank[d]), ({d}, 50))

    def test_kernels_and_single_pairs(self):
        scheme = sg.Scheme(2, "plain")
        w, slope = scheme.kernel_value(np.linspace(0, 2, 9))
        self.assertEqual((w[-1], slope[-1]), (0, 0))
        self.assertTrue((w[:-1] > 0).all())
        sigma, mu2 = scheme.kernel_constants()
        self.close(np.float64(sigma), 8 / np.pi, 10, 3)
        self.assertGreater(mu2, 0)
        value, slope = scheme.kernel_value(0.5)
        self.close(scheme.pair_gradient([0.5, 0, 0], 2), [2 * 0.5 * slope, 0, 0], 10)
        with self.assertRaises(ValueError):
            sg.Scheme(2).pair_gradient([0.5, 0, 0], 2)
        row = np.array([1.0, 0, 0, 1, 0, 1])
        self.same(sg.Scheme(2).pair_gradient([0.5, 0, 0], 2, row),
                  scheme.pair_gradient([0.5, 0, 0], 2))
        self.assertEqual([sg.Scheme(1, m, dimension=2).correction_width()
                          for m in ("kgc", "crkpm", "plain")], [3, 9, 0])
        self.assertEqual(dataclasses.replace(scheme, method="mls").method, sg.Method.MLS)


main()
