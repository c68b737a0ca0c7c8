# SPDX-License-Identifier: MIT
"""The process around: fork, threads, the GIL."""
import multiprocessing
import os
import pickle
import signal
import sys
import threading
import time
import numpy as np
import sphgrad as sg
from sphgrad import _c
from support import Case, cloud, main, waves

H = 2.2
X = cloud(14, 3, np.float32)
V = waves(X)


def gradients(context=None):
    return sg.jacobian(sg.Neighbors(X, H, context=context), V, 1).tobytes()


def of_new_context(_=None):
    return gradients(sg.Context())


def in_child(work):
    """Whether work() was true in a child, which has half a minute."""
    child = os.fork()
    if child == 0:
        signal.alarm(30)
        held = False
        try:
            held = work()
        finally:
            os._exit(0 if held else 1)
    return os.waitpid(child, 0)[1] == 0


class Process(Case):
    def test_children_by_fork_work(self):
        kept = sg.Neighbors(X, H)
        expected = gradients()
        self.assertTrue(in_child(lambda: gradients() == expected))
        self.assertTrue(in_child(lambda: of_new_context() == expected))
        self.assertTrue(in_child(lambda: sg.jacobian(kept, V, 1).tobytes() == expected))
        with multiprocessing.get_context("fork").Pool(2) as pool:
            self.assertEqual(pool.map_async(of_new_context, range(4)).get(60), [expected] * 4)
        self.assertEqual(gradients(), expected)

    def test_a_lock_that_another_thread_held_does_not_stop_a_child(self):
        context = sg.Context(threads=1)
        expected, held, go_on = gradients(), threading.Event(), threading.Event()

        def hold():
            with context._calls():
                held.set()
                go_on.wait(30)

        thread = threading.Thread(target=hold)
        thread.start()
        held.wait(30)
        works = in_child(lambda: gradients(context) == expected)
        go_on.set()
        thread.join()
        self.assertTrue(works)

    def test_threads_may_share_a_context_or_not(self):
        expected = gradients()
        for contexts in ([sg.Context()] * 4, [sg.Context(threads=1) for _ in range(4)]):
            found = [None] * 4

            def work(k):
                found[k] = [gradients(contexts[k]) for _ in range(5)]

            threads = [threading.Thread(target=work, args=(k,)) for k in range(4)]
            for thread in threads:
                thread.start()
            for thread in threads:
                thread.join()
            self.assertEqual(found, [[expected] * 5] * 4)

    def test_calls_release_the_gil(self):
        n = sg.Neighbors(np.tile(X, (4, 1)) + np.repeat(np.arange(4, dtype="f4") * 40,
                                                       len(X))[:, None], H,
                         context=sg.Context(threads=1))
        v, out = np.tile(V, (4, 1)), np.empty((4 * len(X), 3, 3), np.float32)
        inside, real, interval = threading.Event(), _c.functions.sphg_evaluate, sys.getswitchinterval()
        calls = [0, 0]

        def watched(*arguments):
            inside.set()
            calls[0] += 1
            status = real(*arguments)
            inside.clear()
            return status

        def work():
            while calls[1] < 3 and calls[0] < 1000:
                sg.jacobian(n, v, 1, out=out)

        _c.functions.sphg_evaluate = watched
        sys.setswitchinterval(100) # who has the GIL keeps it until it lets go of it
        try:
            thread = threading.Thread(target=work)
            thread.start()
            while thread.is_alive() and calls[1] < 3:
                calls[1] += inside.is_set() # seen from here in the middle of a call
                time.sleep(0)
        finally:
            sys.setswitchinterval(interval)
            _c.functions.sphg_evaluate = real
            thread.join()
        self.assertEqual(calls[1], 3)

    def test_threads_are_those_asked_for(self):
        self.assertEqual(sg.Context(threads=1).info.threads, 1)
        self.assertEqual(gradients(sg.Context(threads=1)), gradients(sg.Context(threads=2)))
        self.assertEqual(sg.Context(isa="base").info.isa in (_c.Isa.ISA_BASE, _c.Isa.ISA_NEON), True)
        for threads in (-1, 2 ** 40):
            with self.assertRaises((ValueError, sg.Error)):
                sg.Context(threads=threads)

    def test_pickles_are_refused(self):
        for thing in (sg.default_context(), sg.Neighbors(X, H)):
            with self.assertRaisesRegex(TypeError, "process"):
                pickle.dumps(thing)
        self.assertEqual(pickle.loads(pickle.dumps(sg.Scheme(2, "mls"))), sg.Scheme(2, "mls"))
        try:
            sg.Neighbors(X, -1)
        except sg.Error as error:
            self.assertEqual(str(pickle.loads(pickle.dumps(error))), str(error))


main()
