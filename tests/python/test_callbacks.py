"""Log, progress, cancel, Ctrl-C and other signals, the end of the interpreter, the user's own solver."""
import gc
import os
import pathlib
import signal
import subprocess
import sys
import threading
import types
import unittest

import numpy
import plm
import scipy.sparse.linalg

import models


class OfTheUser(Exception):
    pass


class Callbacks(unittest.TestCase):
    def setUp(self):
        self.context = plm.Context()
        self.basis = models.basis(self.context)

    def sweep(self, progress=None, **options):
        return plm.Hbm(self.basis, **options).sweep(progress=progress)

    def test_progress_is_told(self):
        calls = []
        self.sweep(lambda stage, fraction: calls.append((stage, fraction)))
        self.assertTrue(all(isinstance(stage, str) and 0 <= fraction <= 1 for stage, fraction in calls))
        self.assertIn("sweep", [stage for stage, _ in calls])

    def test_progress_never_runs_backwards(self):
        """Within a call, whatever its stages tell of themselves; and where one stage is the call, it goes to the end."""
        def heard(call, *arguments, **more):
            told = []
            call(*arguments, progress=lambda stage, fraction: told.append(fraction), **more)
            self.assertEqual(told, sorted(told), call.__name__)
            self.assertTrue(told and 0 <= told[0] and told[-1] <= 1, call.__name__)
            return told
        model = models.model(context=self.context)
        heard(model.build)
        heard(model.solve_rest)
        sampler = plm.Sampler(model)
        heard(sampler.run)
        basis = plm.Basis(model, sampler)
        heard(basis.build)
        hbm = plm.Hbm(basis, n_harmonics=5)
        self.assertGreater(max(heard(hbm.sweep)), 0.9)
        curve = hbm.sweep()
        heard(hbm.find_peak, curve, models.WATCHED)
        heard(hbm.estimate_error, hbm.find_peak(curve, models.WATCHED).branch, 0, models.WATCHED)
        heard(hbm.refine_basis, models.WATCHED, 1e-2)
        of_all = heard(model.compute_response, models.WATCHED)
        self.assertGreater(len(set(of_all)), 20)
        self.assertLess(max(of_all), 1)  # something is left, as long as there is more to do
        self.assertGreater(max(heard(plm.Transient(basis, frequency_hz=10, periods=50).run)), 0.9)
        study = plm.Study(model, repeats=1)
        study.set_output(models.WATCHED)
        study.add_response("one", hbm)
        study.add_response("other", plm.Hbm(basis, n_harmonics=3))
        self.assertEqual(len(set(heard(study.run))), 3)  # the reference and two methods

    def test_true_cancels(self):
        curve = self.sweep(lambda stage, fraction: stage == "sweep" and fraction > 0.3)
        self.assertEqual(curve.status, plm.CANCELLED)
        self.assertEqual(curve.end_reason, plm.REASON_CANCELLED)
        self.assertIn("cancel", curve.status_text.lower())
        self.assertLess(len(curve), len(self.sweep()))
        with self.assertRaises(plm.PlmCancelled):
            plm.Sampler(self.basis.model).run(progress=lambda *_: True)

    def test_exceptions_come_back(self):
        def fail(stage, fraction):
            calls.append(stage)
            if len(calls) == when:
                raise OfTheUser(when)
        for when in (1, 2, 6):
            calls = []
            with self.assertRaisesRegex(OfTheUser, str(when)):
                self.sweep(fail)
            self.assertEqual(len(calls), when)  # it stopped at once
        self.assertEqual(self.sweep().status, plm.OK)  # still usable

    def test_context_progress(self):
        calls = []
        self.context.progress = lambda *x: calls.append(x)
        self.sweep(progress=False)
        self.assertFalse(calls)
        self.sweep()
        self.assertTrue(calls and self.context.progress)

    def test_calls_from_inside_are_refused(self):
        def call_in(_stage, _fraction):
            self.basis.set("n_harmonics", 3)
        with self.assertRaises(plm.PlmError) as caught:
            self.sweep(call_in)
        self.assertEqual((caught.exception.status, caught.exception.function), (plm.ERR_STATE, "plm_basis_set_int"))

    def test_another_thread(self):
        """A context that another thread uses is not called too early or too late."""
        def use():
            try:
                self.basis.set("n_harmonics", 3)
            except plm.PlmError as error:
                refused.append(error)

        def call_beside(_stage, _fraction):
            thread = threading.Thread(target=use)
            thread.start()
            thread.join()
        refused = []
        self.sweep(call_beside)
        self.assertEqual({error.status for error in refused}, {plm.ERR_BUSY})
        self.assertRegex(str(refused[0]), "^plm_basis_set_int: another thread is inside a call of this context; give each "
                                          "thread a context of its own")

    def test_ctrl_c(self):
        def interrupt(stage, fraction):
            if stage == "sweep" and fraction > 0.3:
                signal.raise_signal(signal.SIGINT)
        with self.assertRaises(KeyboardInterrupt) as caught:
            self.sweep(interrupt)
        self.assertGreater(len(caught.exception.branch), 0)
        with self.assertRaises(KeyboardInterrupt):
            plm.Sampler(self.basis.model).run(progress=lambda *_: signal.raise_signal(signal.SIGINT))
        self.assertIs(signal.getsignal(signal.SIGINT), signal.default_int_handler)
        self.assertEqual(self.sweep().status, plm.OK)

    def test_what_handlers_of_signals_raise(self):
        """A time limit as scripts and pytest-timeout set it. Its signal comes while the library computes, so that Python runs the
        handler when it enters a callback, before any `try` of that."""
        def limit(_number, _frame):
            raise kind("limit")
        before = signal.signal(signal.SIGALRM, limit)
        hook = sys.unraisablehook
        hbm = plm.Hbm(self.basis, n_harmonics=31, max_step=1e-3)  # seconds, if nothing ends it
        try:
            kind = OfTheUser
            for _ in range(3):
                signal.setitimer(signal.ITIMER_REAL, 0.3)
                with self.assertRaisesRegex(OfTheUser, "limit"):
                    hbm.sweep()
            for kind in (OfTheUser, KeyboardInterrupt):
                armed = []

                def arm(stage, fraction):  # once there is a point
                    if stage == "sweep" and fraction > 0 and not armed:
                        armed.append(signal.setitimer(signal.ITIMER_REAL, 0.1))
                with self.assertRaisesRegex(kind, "limit") as caught:
                    hbm.sweep(progress=arm)
            self.assertGreater(len(caught.exception.branch), 0)
            self.assertIs(signal.getsignal(signal.SIGALRM), limit)
            self.assertIs(sys.unraisablehook, hook)
        finally:
            signal.setitimer(signal.ITIMER_REAL, 0)
            signal.signal(signal.SIGALRM, before)
        self.assertEqual(self.sweep().status, plm.OK)

    def test_what_is_not_ours_goes_where_it_went(self):
        class Waste:
            def __del__(self):
                raise OfTheUser("waste")
        seen, before = [], sys.unraisablehook
        sys.unraisablehook = lambda unraisable: seen.append(str(unraisable.exc_value))
        try:
            self.assertEqual(self.sweep(lambda *_: bool(Waste()) and False).status, plm.OK)
        finally:
            sys.unraisablehook = before
        self.assertEqual(set(seen), {"waste"})

    def run_to_its_end(self, end):
        """A program whose daemon thread is inside a call, and what its main thread does then: (exit code, what it printed)."""
        program = """
import os, sys, threading
import models, plm
model = models.model(context=plm.Context()).build()
inside, held = threading.Event(), threading.Event()
def told(stage, fraction):
    inside.set()
    hold()
def compute():
    while True:
        model.compute_response(models.WATCHED, accuracy=1e-6, progress=told)
def hold():
    pass
threading.Thread(target=compute, daemon=True).start()
inside.wait()
""" + end
        alone = {**os.environ, "OPENBLAS_NUM_THREADS": "1"}  # a fork beside its threads is more than OpenBLAS bears
        done = subprocess.run([sys.executable, "-c", program], cwd=pathlib.Path(__file__).parent, capture_output=True, text=True,
                              timeout=200, check=False, env=alone)
        return done.returncode, done.stdout + done.stderr

    def test_the_interpreter_ends_inside_a_call(self):
        """Python ends daemon threads that want to run, and with one inside a callback the whole process would end."""
        self.assertEqual(self.run_to_its_end("print('bye')"), (0, "bye\n"))
        # nobody waits for ever for a function of the user
        self.assertEqual(self.run_to_its_end("plm._calls.PATIENCE = 0.2\nhold = held.wait\nprint('bye')"), (0, "bye\n"))
        # nor a child process for a thread that it has not got
        self.assertEqual(self.run_to_its_end("child = os.fork()\nif not child: sys.exit(3)\n"
                                             "print(os.waitstatus_to_exitcode(os.waitpid(child, 0)[1]))"), (0, "3\n"))

    def test_log(self):
        lines = []
        self.context.log = lambda level, text: lines.append((level, text))
        models.basis(self.context)
        self.sweep()
        self.assertTrue(all(level in (0, 1, 2) and text for level, text in lines))
        self.assertTrue(lines)

        def fail(level, text):
            raise OfTheUser("log")
        self.context.log = fail
        with self.assertRaises(OfTheUser):
            models.basis(self.context)
        self.context.log = True
        with self.assertLogs("plm", level="DEBUG"):
            models.basis(self.context)
        self.context.log = None

    def test_bar(self):
        self.sweep(progress=True)  # tqdm or a plain line
        shown = []

        class Bar:
            n = 0

            def __init__(self, **_options):
                shown.append("made")

            def set_description(self, text, refresh):
                shown.append(text)

            def refresh(self):
                shown.append(self.n)

            def close(self):
                shown.append("closed")
        fakes = {"tqdm": types.ModuleType("tqdm"), "tqdm.auto": types.ModuleType("tqdm.auto")}
        fakes["tqdm.auto"].tqdm = Bar
        before = {name: sys.modules.get(name) for name in fakes}
        sys.modules.update(fakes)
        try:
            self.sweep(progress=True)
        finally:
            for name, module in before.items():
                if module is None:
                    del sys.modules[name]
                else:
                    sys.modules[name] = module
        self.assertEqual((shown[0], shown[-1]), ("made", "closed"))
        self.assertIn("sweep", shown)

    def test_garbage_collected_inside_a_callback(self):
        waste = [models.model(context=self.context)]

        def collect(_stage, _fraction):
            waste.clear()
        self.sweep(collect)
        self.assertEqual(len(self.context._orphans), 1)
        self.sweep()
        self.assertEqual(len(self.context._orphans), 0)

    def test_own_solver(self):
        wanted, calls = self.basis.model.modes(2), []

        def factor(matrix, positive_definite):
            calls.append((matrix.shape, positive_definite))
            self.assertEqual(abs(matrix - matrix.T).max(), 0)
            return scipy.sparse.linalg.splu(matrix).solve
        self.context.set_solver(factor)
        numpy.testing.assert_allclose(models.model(context=self.context).build().modes(2), wanted, rtol=1e-9)
        self.assertTrue(calls and calls[0][0] == (models.DOFS, models.DOFS))

        def fail(matrix, positive_definite):
            raise OfTheUser("factor")
        self.context.set_solver(fail)
        with self.assertRaises(OfTheUser):
            models.model(context=self.context).build()
        self.context.set_solver(None)
        models.model(context=self.context).build()
        gc.collect()
        self.assertFalse(self.context._host.factors)  # all released with their models

    def test_inertia_of_the_own_solver(self):
        wanted, counts = self.basis.model.modes(2), []

        def factor(matrix, positive_definite):
            lu = scipy.sparse.linalg.splu(matrix)

            def solve(right_hand_sides):
                return lu.solve(right_hand_sides)
            solve.matrix = matrix
            return solve

        def inertia(solve):
            counts.append(int((numpy.linalg.eigvalsh(solve.matrix.toarray()) < 0).sum()))
            return counts[-1]
        self.context.set_solver(factor, inertia)
        numpy.testing.assert_allclose(plm.Sampler(models.model(context=self.context).build()).run().model.modes(2), wanted,
                                      rtol=1e-9)
        self.assertTrue(counts and min(counts) >= 0)
        self.context.set_solver(factor, lambda solve: -5)
        with self.assertRaises(plm.PlmError):
            plm.Sampler(models.model(context=self.context).build()).run()
        self.context.set_solver(None)

    def test_a_superelement_and_the_way_back(self):
        t = numpy.array([[0.5], [1.0]])
        raised = []

        def recover(q):
            if raised:
                raise raised[0]
            return t @ q
        self.context.set_threads(2)
        self.context.set_effort(20)
        m = plm.Model(numpy.array([[1.25]]), numpy.array([[5000.0]]), reduction_error=1e-4, context=self.context)
        m.add_gap_rows(numpy.array([[1.0]]), 5000.0, 1e-5)
        m.set_rayleigh_damping(0, 5e-4)
        m.set_excitation([1.0])
        with self.assertRaisesRegex(plm.PlmError, "recovery"):
            m.recover([1.0])
        m.set_recovery(recover, 2)
        m.build()
        numpy.testing.assert_array_equal(m.recover([2.0]), [1.0, 2.0])
        numpy.testing.assert_array_equal(m.recover([[1.0, 2.0, 3.0]]), [[0.5, 1.0, 1.5], [1.0, 2.0, 3.0]])
        with self.assertRaisesRegex(ValueError, "n_dof"):
            m.recover([1.0, 2.0])
        response = m.compute_response(0, accuracy=1e-2)
        self.assertGreaterEqual(response.error, 1e-4)
        numpy.testing.assert_allclose(m.recover_amplitude(response.curve, 0), 0.5 * response.curve.amplitude(0), rtol=1e-12)
        raised.append(OfTheUser("recover"))
        with self.assertRaisesRegex(OfTheUser, "recover"):
            m.recover([1.0])

    def test_a_context_goes_with_its_last_user(self):
        import weakref
        context = plm.Context()
        model = models.model(context=context)
        watch = weakref.ref(context)
        del context
        self.assertIsNotNone(watch())
        del model
        self.assertIsNone(watch())  # without the help of the garbage collector


if __name__ == "__main__":
    unittest.main()
