"""Bases and branches as bytes: a basis read in other processes sweeps with the digits of the one it was written from;
curves come back as they were; damaged bytes, whatever is damaged in them, are refused."""
import csv
import multiprocessing
import pathlib
import random
import struct
import tempfile
import unittest
import warnings

import numpy
import plm

import models

FORMATS = pathlib.Path(__file__).resolve().parents[1] / "formats"
KEYS = ("frequency_hz", "arclength", "residual", "stable", "bifurcation", "n_switching")


def crc64(data):
    """CRC-64 of ECMA-182, reflected, bit by bit: shares nothing with the library's tables."""
    crc = 0xFFFFFFFFFFFFFFFF
    for byte in data:
        crc ^= byte
        for _ in range(8):
            crc = crc >> 1 ^ (0xC96C5795D7870F42 if crc & 1 else 0)
    return crc ^ 0xFFFFFFFFFFFFFFFF


def swept(basis, force_scale, **options):
    """Digits of a curve."""
    with warnings.catch_warnings():
        warnings.simplefilter("ignore")
        curve = plm.Hbm(basis, force_scale=force_scale, **options).sweep()
    return [curve[key] for key in KEYS] + [curve.amplitude(models.WATCHED)]


def read_and_sweep(job):
    """In a process of its own. Nothing can be factored there: a basis that was read has no matrices
    (test_the_structure_is_asked_again_when_the_model_is_attached)."""
    data, force_scale = job
    return swept(plm.Basis.from_bytes(data, plm.Context()), force_scale)


def quietly_resumed(basis, part):
    with warnings.catch_warnings():
        warnings.simplefilter("ignore")
        return plm.Hbm(basis).resume(part)


def same(one, other):
    return all(numpy.array_equal(a, b) for a, b in zip(one, other))


class Pieces(unittest.TestCase):
    def test_pieces_are_the_bytes(self):
        basis = models.pressed_chain()  # of more bytes than one piece has
        pieces, table = [], []
        basis.write_to(pieces.append)
        self.assertEqual(b"".join(pieces), basis.to_bytes())
        self.assertGreater(len(pieces), 1)
        self.assertLessEqual(max(map(len, pieces)), 65536)
        curve = plm.Hbm(models.basis(), n_harmonics=3).sweep()
        pieces.clear()
        curve.write_to(pieces.append)
        self.assertEqual(b"".join(pieces), curve.to_bytes())
        curve.write_csv_to(table.append, models.WATCHED)
        rows = list(csv.DictReader(b"".join(table).decode("ascii").splitlines()))
        numpy.testing.assert_array_equal([float(row["amplitude"]) for row in rows], curve.amplitude(models.WATCHED))

    def test_what_the_function_raises_comes_back_and_ends_the_writing(self):
        basis, calls = models.basis(), []

        def full(piece):
            calls.append(piece)
            raise OSError(28, "No space left on device")
        with self.assertRaises(OSError):
            basis.write_to(full)
        self.assertEqual(len(calls), 1)
        with self.assertRaisesRegex(TypeError, "a function of bytes"):
            basis.write_to("basis.plm")


class Bases(unittest.TestCase):
    def test_four_processes_sweep_four_levels_with_the_digits_of_one(self):
        basis = models.basis()
        data, levels = basis.to_bytes(), [0.5, 1.0, 1.5, 2.0]
        with multiprocessing.get_context("spawn").Pool(2) as pool:
            found = pool.map(read_and_sweep, [(data, level) for level in levels])
        for level, one in zip(levels, found):
            self.assertTrue(same(one, swept(basis, level)), level)

    def test_every_kind_comes_back(self):
        model = models.model().build()
        sampler = plm.Sampler(model, system="open", mode=1).run()
        for options in ({}, {"kind": "craig_bampton"}, {"kind": "full"}, {"kind": "bilinear"}, {"kind": "snapshots"},
                        {"n_pairs_carried": 1}, {"n_harmonics": 3, "selection": "bands"}):
            with warnings.catch_warnings():
                warnings.simplefilter("ignore")
                basis = plm.Basis(model, sampler, **options).build()
            data = basis.to_bytes()
            again = plm.Basis.from_bytes(data, plm.Context())
            self.assertEqual(again.to_bytes(), data, options)
            for key in ("kind", "size", "static_size", "window_low_hz", "preload_residual", "space_description",
                        "sample_frequency_hz", "pairs_carried"):
                self.assertTrue(numpy.array_equal(again[key], basis[key]), (options, key))
            self.assertTrue(numpy.array_equal(again.vectors(), basis.vectors()), options)
            self.assertTrue(same(swept(again, 1), swept(basis, 1)), options)

    def test_pre_load_moving_walls_and_a_moving_base(self):
        model = models.model()
        model.set_preload(-20 * models.force())
        model.set_gap_motion([1e-4, 2e-4j])
        sampler = plm.Sampler(model.build(), system="rest", mode=1, n_harmonics=1).run()
        basis = plm.Basis(model, sampler, n_harmonics=1, load_vectors=False).build()
        self.assertGreater(basis.static_size, basis.size)  # P_0 is another one
        again = plm.Basis.from_bytes(basis.to_bytes(), plm.Context())
        for options in ({}, {"motion": "harmonics", "n_harmonics": 5}):
            self.assertTrue(same(swept(again, 1, **options), swept(basis, 1, **options)), options)
        shaken = models.model(absolute_outputs=1)
        shaken.fix_dofs([0])
        shaken.set_base_motion(numpy.eye(models.DOFS)[0] * 1e-3)
        shaken.set_excitation(None)
        shaken.add_outputs(numpy.eye(models.DOFS)[[models.WATCHED]])
        basis = plm.Basis(shaken.build(), plm.Sampler(shaken, system="open", mode=1).run()).build()
        again = plm.Basis.from_bytes(basis.to_bytes(), plm.Context())
        one, other = (plm.Hbm(b, n_harmonics=3, stability="off").sweep() for b in (basis, again))
        self.assertTrue(numpy.array_equal(one.amplitude(models.DOFS), other.amplitude(models.DOFS)))
        self.assertFalse(numpy.array_equal(one.amplitude(models.DOFS), one.amplitude(models.WATCHED)))

    def test_the_structure_is_asked_again_when_the_model_is_attached(self):
        basis = models.basis()
        curve = plm.Hbm(basis, n_harmonics=5, stability="off").sweep()
        again = plm.Basis.from_bytes(basis.to_bytes(), basis.context)
        read = plm.Branch.from_bytes(again, curve.to_bytes())
        with self.assertRaisesRegex(plm.PlmError, "attach the model"):
            read.full_residual(3)
        other = models.model()
        other.fix_dofs([20])
        with self.assertRaisesRegex(plm.PlmError, "another one than the basis was made of"):
            again.attach(other.build())
        twin = models.model().build()  # built anew, as another process would
        again.attach(twin)
        read = plm.Branch.from_bytes(again, curve.to_bytes())
        # by vectors that are formed there and recovered here: to rounding of a residual of 1e-9 of the forces
        self.assertAlmostEqual(read.full_residual(3), curve.full_residual(3), delta=1e-9)
        self.assertEqual(plm.Hbm(again, n_harmonics=5, stability="off").sweep().status, plm.OK)
        error = plm.Hbm(again, n_harmonics=5).estimate_error(read, 3, models.WATCHED)
        truth = plm.Hbm(basis, n_harmonics=5).estimate_error(curve, 3, models.WATCHED)
        self.assertAlmostEqual(error.amplitude.basis, truth.amplitude.basis, delta=1e-12)

    def test_isolated_branches_are_found_on_what_was_read(self):
        basis = models.carrier()
        again = plm.Basis.from_bytes(basis.to_bytes(), plm.Context())
        found = []
        for b in (basis, again):
            with warnings.catch_warnings():
                warnings.simplefilter("ignore")
                hbm = plm.Hbm(b, force_scale=0.006)
                found.append([one.branch.frequency_hz for one in hbm.find_isolated(hbm.sweep(), 0.02)])
        self.assertGreater(len(found[0]), 0)
        self.assertTrue(len(found[0]) == len(found[1]) and same(*found))


class Branches(unittest.TestCase):
    def test_points_are_the_same(self):
        for basis, options in ((models.basis(), {}), (models.basis(), {"n_harmonics": 5}),
                               (models.between_stops(), {"motion": "harmonics"})):
            with warnings.catch_warnings():
                warnings.simplefilter("ignore")
                curve = plm.Hbm(basis, **options).sweep()
            data = curve.to_bytes()
            read = plm.Branch.from_bytes(plm.Basis.from_bytes(basis.to_bytes(), plm.Context()), data)
            self.assertEqual(read.to_bytes(), data)
            for key in KEYS:
                self.assertTrue(numpy.array_equal(read[key], curve[key]), key)
            self.assertTrue(numpy.array_equal(read.coefficients(3), curve.coefficients(3)))
            # extrema of exact motions are found anew, to rounding of a flow over a period
            self.assertLess(abs(read.amplitude(0) / curve.amplitude(0) - 1).max(), 1e-12)

    def test_a_table_has_all_digits_and_replaces_as_a_whole(self):
        basis = models.basis()
        curve = plm.Hbm(basis, n_harmonics=3, stability="off").sweep()
        with tempfile.TemporaryDirectory() as folder:
            path = pathlib.Path(folder) / "curve.csv"
            path.write_text("what was there before")
            curve.write_csv(path, models.WATCHED)
            with open(path, newline="", encoding="ascii") as file:
                rows = list(csv.DictReader(file))
            self.assertEqual([p.name for p in path.parent.iterdir()], ["curve.csv"])
        self.assertEqual([float(row["frequency_hz"]) for row in rows], list(curve.frequency_hz))
        self.assertEqual([float(row["amplitude"]) for row in rows], list(curve.amplitude(models.WATCHED)))
        self.assertEqual([int(row["stable"]) for row in rows], list(curve.stable))


class Damaged(unittest.TestCase):
    """With the right checksum, so that what stands behind it is asked."""

    def refuse_or_work(self, data, read):
        try:
            return read(data)
        except plm.PlmError as error:
            self.assertIn(error.status, (plm.ERR_ARGUMENT, plm.ERR_MEMORY, plm.ERR_CONVERGENCE), error)
        return None

    def damaged(self, data, random_numbers):
        body = bytearray(data[:-8])
        at = random_numbers.randrange(32, len(body) - 8)
        kind = random_numbers.randrange(4)
        if kind == 0:
            body[at] ^= 1 << random_numbers.randrange(8)
        elif kind == 1:  # a size, most of all
            at -= at % 8
            body[at:at + 8] = struct.pack("<q", random_numbers.choice([-1, 0, 1, 2**31, 2**62, -2**63, 7]))
        elif kind == 2:
            at -= at % 8
            body[at:at + 8] = struct.pack("<d", random_numbers.choice([float("nan"), float("inf"), 1e308, -1.0, 0.0]))
        else:  # cut, with the length made right
            del body[at:at + 8 * random_numbers.randrange(1, 9)]
        body[24:32] = struct.pack("<q", len(body) + 8)
        return bytes(body) + struct.pack("<Q", crc64(body))

    def test_the_checksum_is_that_of_the_format(self):
        data = models.between_stops().to_bytes()
        self.assertEqual(struct.unpack("<Q", data[-8:])[0], crc64(data[:-8]))

    def test_damaged_bytes_are_refused_or_read(self):
        basis = models.between_stops()
        with warnings.catch_warnings():
            warnings.simplefilter("ignore")
            curve = plm.Hbm(basis, max_points=4).sweep()
        random_numbers, context = random.Random(48), plm.Context()
        refused = 0
        for data, read in ((basis.to_bytes(), lambda d: plm.Basis.from_bytes(d, context)),
                           (curve.to_bytes(), lambda d: plm.Branch.from_bytes(basis, d))):
            for _ in range(150):
                refused += self.refuse_or_work(self.damaged(data, random_numbers), read) is None
        self.assertGreater(refused, 100)

    def test_files_of_every_version_are_read(self):
        for folder in sorted(FORMATS.glob("version_*")):
            basis = plm.Basis.from_bytes((folder / "basis.plm").read_bytes(), plm.Context())
            branch = plm.Branch.from_bytes(basis, (folder / "branch.plm").read_bytes())
            wanted = numpy.loadtxt(folder / "curve.csv", delimiter=",", skiprows=1, usecols=(0, 1))
            self.assertTrue(numpy.array_equal(branch.frequency_hz, wanted[:, 0]))
            # found anew by a flow: to rounding, on another machine as well
            self.assertLess(abs(branch.amplitude(0) / wanted[:, 1] - 1).max(), 1e-10)
            self.assertEqual(basis.kind, "full")
            part = plm.Branch.from_bytes(basis, (folder / "unfinished.plm").read_bytes())
            whole = quietly_resumed(basis, part)
            self.assertLess(abs(whole.frequency_hz / wanted[:, 0] - 1).max(), 1e-8)


if __name__ == "__main__":
    unittest.main()
