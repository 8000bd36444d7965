"""Curves that were stopped go on with the points that they would have had: cancelled at any moment, ended by max_points or for
want of effort, in the process or from bytes, in another one."""
import multiprocessing
import os
import pathlib
import random
import tempfile
import unittest
import warnings

import numpy
import plm

import models

KEYS = ("frequency_hz", "arclength", "residual", "stable", "bifurcation", "n_switching", "point_harmonics")

# each way of following a curve: exact motions, harmonics chosen by point with stability, a fixed number, gaps as unknowns,
# time samples, through branch points
CASES = {
    "exact": (models.basis, {}),
    "exact, finer": (models.basis, {"max_step": 0.03, "force_scale": 2.0}),
    "harmonics by point": (models.basis, {"motion": "harmonics"}),
    "seven harmonics": (models.basis, {"n_harmonics": 7, "stability": "floquet"}),
    "gaps": (models.basis, {"n_harmonics": 5, "unknowns": "gaps", "direction": "up"}),
    "samples": (models.basis, {"n_harmonics": 5, "aft": "sampled"}),
    "branch points": (models.between_stops, {"max_step": 0.05}),
    "branch points by harmonics": (models.between_stops, {"motion": "harmonics"}),
}


def quietly(call, *arguments, **options):
    with warnings.catch_warnings():
        warnings.simplefilter("ignore")
        return call(*arguments, **options)


def digits(curve):
    """What a curve is made of. (What a point leaves out, "harmonic_error", is off by rounding from run to run.)"""
    dof = min(models.WATCHED, curve.n_dof - 1)
    return [curve[key] for key in KEYS] + [curve.coefficients(i, dof) for i in range(len(curve))]


def same(one, other):
    a, b = digits(one), digits(other)
    return len(a) == len(b) and all(numpy.array_equal(x, y, equal_nan=True) for x, y in zip(a, b))


def cancelled(basis, options, after):
    """The curve as far as it had come at the after-th call of a progress callback; None: it had no point yet."""
    calls = 0

    def progress(_stage, _fraction):
        nonlocal calls
        calls += 1
        if calls >= after:
            raise KeyboardInterrupt
    try:
        quietly(plm.Hbm(basis, **options).sweep, progress=progress)
    except KeyboardInterrupt as stop:
        return getattr(stop, "branch", None)
    except plm.PlmError:
        return None
    return None


def counted(basis, options):
    """The whole curve, and how often its progress callback was called."""
    calls = []
    return quietly(plm.Hbm(basis, **options).sweep, progress=lambda stage, fraction: calls.append(stage)), len(calls)


def resume_elsewhere(job):
    """In a process of its own, from bytes alone; the bytes of the whole curve."""
    basis, branch, options = job
    basis = plm.Basis.from_bytes(basis, plm.Context())
    curve = quietly(plm.Hbm(basis, **options).resume, plm.Branch.from_bytes(basis, branch))
    return curve.to_bytes()


class Resumed(unittest.TestCase):
    def test_cancelled_anywhere(self):
        chance = random.Random(48)
        for name, (make, options) in CASES.items():
            basis = make()
            (whole, n), resumed = counted(basis, options), 0
            for _ in range(12):
                after = chance.randint(n // 4, n)  # before and after the curve there is none to go on with
                part = cancelled(basis, options, after)
                if part is None:
                    continue
                self.assertEqual(part.status, plm.CANCELLED, name)
                again = quietly(plm.Hbm(basis, **options).resume, plm.Branch.from_bytes(basis, part.to_bytes()))
                self.assertTrue(same(again, whole), (name, after, n, len(part), len(again), len(whole)))
                resumed += 1
                if resumed == 2:
                    break
            self.assertGreater(resumed, 0, name)

    def test_more_points_than_were_allowed(self):
        for name in ("exact", "harmonics by point", "seven harmonics"):
            make, options = CASES[name]
            basis = make()
            whole = quietly(plm.Hbm(basis, **options).sweep)
            part = quietly(plm.Hbm(basis, **options, max_points=13).sweep)
            self.assertEqual(part.end_reason, plm.REASON_POINT_LIMIT)
            part = quietly(plm.Hbm(basis, **options, max_points=27).resume, part)
            self.assertEqual(len(part), 27)
            self.assertTrue(same(quietly(plm.Hbm(basis, **options).resume, part), whole), name)

    def test_in_another_process(self):
        basis = models.basis()
        for options in ({}, {"motion": "harmonics"}):
            whole = quietly(plm.Hbm(basis, **options).sweep)
            part = quietly(plm.Hbm(basis, **options, max_points=17).sweep)
            with multiprocessing.get_context("spawn").Pool(1) as pool:
                data = pool.apply(resume_elsewhere, ((basis.to_bytes(), part.to_bytes(), options),))
            self.assertTrue(same(plm.Branch.from_bytes(basis, data), whole), options)

    def test_static_directions_of_their_own(self):
        """Exact motions then have P_0 in the place of P: its loads, damping and all come back from bytes with their digits."""
        basis = models.pressed_chain()
        self.assertGreater(basis.static_size, basis.size)
        read = plm.Basis.from_bytes(basis.to_bytes(), plm.Context())
        again = plm.Basis.from_bytes(read.to_bytes(), basis.context).attach(basis.model)
        for options in ({}, {"n_harmonics": 3}):
            whole = quietly(plm.Hbm(basis, **options, max_points=12).sweep)
            part = quietly(plm.Hbm(basis, **options, max_points=6).sweep).to_bytes()
            for other in (read, again):
                resumed = quietly(plm.Hbm(other, **options, max_points=12).resume, plm.Branch.from_bytes(other, part))
                self.assertTrue(same(resumed, whole), options)

    def test_what_it_cost_is_counted_as_if_it_had_never_stopped(self):
        basis = models.basis()
        for options in ({}, {"n_harmonics": 7}):
            whole = quietly(plm.Hbm(basis, **options).sweep)
            part = quietly(plm.Hbm(basis, **options, max_points=15).sweep)
            again = quietly(plm.Hbm(basis, **options).resume, part)
            for key in ("factorizations", "failed_steps", "newton_iterations"):
                self.assertEqual(again[key], whole[key], (options, key))


class Saved(unittest.TestCase):
    def setUp(self):
        folder = tempfile.TemporaryDirectory()
        self.addCleanup(folder.cleanup)
        self.path = pathlib.Path(folder.name) / "curve.plm"

    def test_a_file_on_the_way_and_at_the_end(self):
        basis = models.basis()
        whole = quietly(plm.Hbm(basis).sweep)
        hbm, seen = plm.Hbm(basis), {}

        def look(_stage, _fraction):  # every version of the file is whole
            if self.path.exists():
                branch = plm.Branch.from_bytes(basis_beside, self.path.read_bytes())
                seen[len(branch)] = branch
        basis_beside = plm.Basis.from_bytes(basis.to_bytes(), plm.Context())
        hbm.save_every(7, self.path)
        quietly(hbm.sweep, progress=look)
        self.assertGreater(len(seen), 3)
        for n, branch in seen.items():
            self.assertEqual(branch.end_reason, plm.REASON_UNFINISHED)
            self.assertIn("resume", branch.end_text)
            self.assertTrue(numpy.array_equal(branch.frequency_hz, whole.frequency_hz[:n]))
            self.assertTrue(same(quietly(plm.Hbm(basis_beside).resume, branch), whole), n)
        end = plm.Branch.from_bytes(basis, self.path.read_bytes())
        self.assertTrue(same(end, whole) and end.end_reason == whole.end_reason)
        self.assertEqual([one.name for one in self.path.parent.iterdir()], ["curve.plm"])

    def test_on_compressed_models(self):
        """Many coordinates, an accuracy that the first model misses: stopped on that or on the next one, whose making is done again."""
        basis = models.stopped_chain()
        options = {"accuracy": 1e-4}
        said, versions, hbm = [], [], plm.Hbm(basis, **options)
        basis.context.log = lambda _level, text: said.append(text)

        def look(_stage, _fraction):
            data = self.path.read_bytes() if self.path.exists() else b""
            if data and data not in versions[-1:]:
                versions.append(data)
        hbm.save_every(9, self.path)
        whole = quietly(hbm.sweep, progress=look)
        basis.context.log = None
        self.assertTrue(any(text.startswith("compressed to") for text in said), said)
        hbm.save_every(0)
        n = [len(plm.Branch.from_bytes(basis, data)) for data in versions]
        second = next(i for i in range(1, len(n)) if n[i] < n[i - 1])  # where the next model's curve begins
        part = cancelled(basis, options, counted(basis, options)[1] * 3 // 4)
        self.assertEqual(part.status, plm.CANCELLED)
        parts = [versions[second // 2], versions[-2], part.to_bytes()]
        with multiprocessing.get_context("spawn").Pool(1) as pool:  # from bytes alone
            elsewhere = pool.apply(resume_elsewhere, ((basis.to_bytes(), parts[0], options),))
        ends = [plm.Branch.from_bytes(basis, elsewhere)]
        ends += [quietly(hbm.resume, plm.Branch.from_bytes(basis, data)) for data in parts[1:]]
        for i, end in enumerate(ends):
            self.assertTrue(same(end, whole), (i, n, len(part), len(end), len(whole)))
            self.assertEqual((end.status, end.end_reason), (whole.status, whole.end_reason), i)

    def test_no_longer(self):
        hbm = plm.Hbm(models.basis(), n_harmonics=3)
        hbm.save_every(5, self.path)
        hbm.save_every(0)
        quietly(hbm.sweep)
        self.assertFalse(self.path.exists())

    def test_a_folder_that_went_away_costs_no_curve(self):
        folder = self.path.parent / "gone"
        folder.mkdir()
        basis = models.basis()
        hbm = plm.Hbm(basis)
        hbm.save_every(5, folder / "curve.plm")
        os.rmdir(folder)
        with warnings.catch_warnings(record=True) as issued:
            warnings.simplefilter("always")
            curve = hbm.sweep()
        self.assertIn("was not saved", " ".join(str(one.message) for one in issued))
        self.assertTrue(same(curve, quietly(plm.Hbm(basis).sweep)))


class Refused(unittest.TestCase):
    def test_in_words(self):
        basis = models.basis()
        hbm = plm.Hbm(basis, n_harmonics=3)
        whole, part = quietly(hbm.sweep), quietly(plm.Hbm(basis, n_harmonics=3, max_points=12).sweep)
        with self.assertRaisesRegex(plm.PlmError, "nothing to go on with"):
            hbm.resume(whole)
        with self.assertRaisesRegex(plm.PlmError, "n_harmonics = 3; those of this hbm are: n_harmonics = 5"):
            plm.Hbm(basis, n_harmonics=5).resume(part)
        with self.assertRaisesRegex(plm.PlmError, "12 points, all that .max_points. allows"):
            plm.Hbm(basis, n_harmonics=3, max_points=12).resume(part)
        with self.assertRaisesRegex(plm.PlmError, "another basis"):
            plm.Hbm(models.basis(basis.context), n_harmonics=3).resume(part)
        levels = quietly(plm.Hbm(basis, n_harmonics=3, max_points=12).sweep_levels, [1.0])
        with self.assertRaisesRegex(plm.PlmError, "only a curve that was swept at one level"):
            hbm.resume(levels[0])
        with self.assertRaisesRegex(plm.PlmError, "cannot be written"):
            hbm.save_every(5, "no/such/folder/curve.plm")
        with self.assertRaisesRegex(plm.PlmError, "path"):
            hbm.save_every(5)


if __name__ == "__main__":
    unittest.main()
