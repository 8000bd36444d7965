"""The command plm from a deck, with matrices by CalculiX: numbers against dense algebra on the same matrices, files against VTK."""
import contextlib
import io
import os
import pathlib
import re
import shutil
import subprocess
import sys
import tempfile
import unittest

import numpy
import plm
import plm.fe
import scipy.linalg
import scipy.optimize
from plm.command import main

import cracked_deck

try:
    import vtk
    from vtk.util.numpy_support import vtk_to_numpy
except ImportError:
    vtk = None
try:
    import matplotlib.image
except ImportError:
    matplotlib = None

FORCE, BETA, STIFFNESS_BY_AREA = 20.0, 2e-6, 2e6
N_HARMONICS, N_TIMES = 24, 512


class GapBalance:
    """Harmonic balance in the gaps alone, q = receptance (force - B' N), all in dense NumPy: a way that shares nothing with the
    library but the matrices."""

    def __init__(self, deck, tip):
        self.dofs = deck.matrices.dofs
        clamp = set(deck.node_sets["CLAMP"].tolist())
        free = numpy.array([node not in clamp for node in self.dofs[:, 0].tolist()])
        stiffness, mass = (matrix.toarray()[numpy.ix_(free, free)] for matrix in (deck.matrices.stiffness, deck.matrices.mass))
        self.square, self.modes = scipy.linalg.eigh(stiffness, mass)
        at = {tuple(dof): i for i, dof in enumerate(self.dofs[free].tolist())}
        area = cracked_deck.WIDTH * cracked_deck.HEIGHT / cracked_deck.NZ / 4  # what a face gives each corner
        rows, self.k = [], []
        for k in range(cracked_deck.NZ // 2 + 1, cracked_deck.NZ + 1):
            for j in range(cracked_deck.NY + 1):
                node = cracked_deck.label(cracked_deck.CRACK, j, k)
                row = numpy.zeros(len(stiffness))
                row[at[node, 1]], row[at[node + 1000, 1]] = 1, -1  # the left face moves towards the right one
                rows.append(row)
                self.k.append(STIFFNESS_BY_AREA * area * (1 if k == cracked_deck.NZ else 2))
        self.gaps, self.k = numpy.array(rows) @ self.modes, numpy.array(self.k)
        self.tip = self.modes[at[tip, 3]]
        angle = 2 * numpy.pi * numpy.outer(numpy.arange(N_TIMES) / N_TIMES, numpy.arange(1, N_HARMONICS + 1))
        self.waves = numpy.hstack([numpy.ones((N_TIMES, 1)), numpy.cos(angle), -numpy.sin(angle)])  # Re (a + i b) exp(i h omega t)
        self.means = numpy.r_[1, numpy.full(2 * N_HARMONICS, 2)][:, None] * self.waves.T / N_TIMES
        self.state = numpy.zeros((len(self.k), 2 * N_HARMONICS + 1))

    def linear(self, hz):
        """What forces of the pairs and the load do to the gaps and to the tip, harmonic by harmonic: complex."""
        omega = 2 * numpy.pi * hz * numpy.arange(N_HARMONICS + 1)
        receptance = 1 / (self.square * (1 + 1j * BETA * omega[:, None]) - omega[:, None]**2)
        between = numpy.einsum("im,hm,jm->hij", self.gaps, receptance, self.gaps)
        return between, (self.gaps * receptance[1]) @ self.tip * FORCE, receptance

    def solve(self, hz, stiffness):
        """Gaps at this frequency by Newton's method with the exact derivative of the sampled forces, damped."""
        n, size = self.state.shape
        between, free, _ = self.linear(hz)
        flexibility = numpy.zeros((n, size, n, size))  # of real and imaginary parts
        for h in range(N_HARMONICS + 1):
            real, imaginary = h, N_HARMONICS + h
            flexibility[:, real, :, real] = between[h].real
            if h:
                flexibility[:, imaginary, :, imaginary] = between[h].real
                flexibility[:, imaginary, :, real], flexibility[:, real, :, imaginary] = between[h].imag, -between[h].imag
        flexibility = flexibility.reshape((n * size, n * size))
        load = numpy.zeros((n, size))
        load[:, 1], load[:, N_HARMONICS + 1] = free.real, free.imag

        def residual(x):
            u = x @ self.waves.T
            force = (stiffness[:, None] * numpy.maximum(u, 0)) @ self.means.T
            return (x - load).ravel() + flexibility @ force.ravel(), u > 0
        x = self.state
        for _ in range(200):
            r, closed = residual(x)
            if numpy.abs(r).max() < 1e-10 * numpy.abs(x).max() + 1e-300:
                self.state = x
                return
            tangent = numpy.zeros((n, size, n, size))
            for i in range(n):
                tangent[i, :, i] = stiffness[i] * (self.means * closed[i]) @ self.waves
            step = numpy.linalg.solve(numpy.eye(n * size) + flexibility @ tangent.reshape((n * size, n * size)), r).reshape(x.shape)
            scale = next((s for s in 0.5**numpy.arange(12) if numpy.linalg.norm(residual(x - s * step)[0]) < numpy.linalg.norm(r)), 0.5)
            x = x - scale * step
        raise AssertionError(f"the reference does not converge at {hz} Hz")

    def amplitude(self, hz):
        self.solve(hz, self.k)
        between, _, receptance = self.linear(hz)
        force = (self.k[:, None] * numpy.maximum(self.state @ self.waves.T, 0)) @ self.means.T
        force = numpy.concatenate([force[:, :1] + 0j, force[:, 1:N_HARMONICS + 1] + 1j * force[:, N_HARMONICS + 1:]], axis=1)
        load = -force.T @ self.gaps
        load[1] += FORCE * self.tip
        q = (receptance * load) @ self.tip
        q = self.waves @ numpy.concatenate([q.real, q.imag[1:]])
        return (q.max() - q.min()) / 2

    def peak(self):
        for share in 10.0**numpy.arange(-4, 0.1, 0.5):
            self.solve(870, share * self.k)
        for hz in numpy.arange(868, 833, -2):
            self.amplitude(hz)
        best = scipy.optimize.minimize_scalar(lambda hz: -self.amplitude(hz), (832.0, 833.5, 835.0), options={"xtol": 1e-6})
        return best.x, -best.fun


@unittest.skipUnless(shutil.which("ccx"), "no ccx (calculix-ccx) to make matrices")
class Deck(unittest.TestCase):
    @classmethod
    def setUpClass(cls):
        folder = tempfile.TemporaryDirectory()
        cls.addClassCleanup(folder.cleanup)
        cls.folder = pathlib.Path(folder.name)
        cls.path = cls.folder / "beam.inp"
        cls.path.write_text(cracked_deck.text(FORCE))
        os.environ.setdefault("OMP_NUM_THREADS", "1")  # of ccx
        cls.deck = plm.fe.read_deck(cls.path)
        cls.deck.matrices_by_calculix(cls.folder)  # the files stay: the command takes them below
        tip, = cls.deck.node_sets["TIP"].tolist()
        cls.reference = GapBalance(cls.deck, tip)

    def run_plm(self, *arguments, status=0):
        out, err = io.StringIO(), io.StringIO()
        with contextlib.redirect_stdout(out), contextlib.redirect_stderr(err):
            self.assertEqual(main([str(one) for one in arguments]), status, out.getvalue() + err.getvalue())
        return out.getvalue(), err.getvalue()

    def test_modes(self):
        out, err = self.run_plm("modes", self.path, "--count", "6")
        found = [float(x) for x in re.findall(r"^ +\d  (\S+)$", out, re.M)]
        # dense eigenvalues of K, M are right to 1e-16 * (largest / lowest eigenvalue, 1e7) or so
        numpy.testing.assert_allclose(found, numpy.sqrt(self.reference.square[:6]) / (2 * numpy.pi), rtol=1e-8)
        self.assertEqual(err, "")

    def test_nothing_set(self):
        """From the deck alone to the peak, and what stands in the files for viewers."""
        out, err = self.run_plm("response", self.path, "--out", self.folder / "out", "--frames", "8")
        self.assertEqual(err, "")
        found = re.search(r"^  (\S+) at (\S+) Hz: ", out, re.M)
        hz, amplitude = self.reference.peak()
        numpy.testing.assert_allclose(float(found[2]), hz, rtol=1e-4)
        numpy.testing.assert_allclose(float(found[1]), amplitude, rtol=2e-3)  # 1e-3 asked for; 24 harmonics are 1e-3 from 60
        self.assertIn("4 of 4 pairs open and close", out)
        if vtk:
            self.check_files(amplitude)
        if vtk and matplotlib and (os.environ.get("DISPLAY") or shutil.which("xvfb-run")):
            picture = self.folder / "open.png"
            script = pathlib.Path(__file__).parents[2] / "examples" / "plot" / "plot_motion.py"
            subprocess.run([sys.executable, script, self.folder / "out" / "peak.pvd", picture], check=True, timeout=200)
            self.assertGreater(numpy.ptp(matplotlib.image.imread(picture)[..., :3]), 0.9)  # black lines on white

    def check_files(self, amplitude):
        place = {label: i for i, label in enumerate(self.deck.node_labels.tolist())}
        twins = [(place[label], place[label + 1000]) for label in self.deck.node_labels.tolist() if label + 1000 in place]
        self.assertEqual(len(twins), 4)
        opened = 0
        for k in range(8):
            reader = vtk.vtkXMLUnstructuredGridReader()
            reader.SetFileName(str(self.folder / "out" / f"peak_{k:03d}.vtu"))
            reader.Update()
            grid = reader.GetOutput()
            data = {name: vtk_to_numpy(grid.GetPointData().GetArray(name)) for name in
                    ("displacement", "penetration", "contact_force", "contact_status", "node")}
            self.assertEqual(data["node"].tolist(), self.deck.node_labels.tolist())
            self.assertEqual(grid.GetNumberOfCells(), sum(len(block[1]) for block in self.deck.elements))
            q, slaves = data["displacement"], [left for left, _ in twins]
            at_pairs = data["contact_status"] >= 0
            self.assertEqual(numpy.flatnonzero(at_pairs).tolist(), slaves)
            # the faces lie on each other: how far one has come into the other is the difference of their motions along x. They
            # are of 1e-2 at most, displacements of 5, and contact is told by 60 harmonics
            wanted = [q[left, 0] - q[right, 0] for left, right in twins]
            numpy.testing.assert_allclose(data["penetration"][slaves], wanted, rtol=0, atol=1e-4 * amplitude)
            self.assertFalse(data["contact_force"][~at_pairs].any())
            self.assertTrue((data["contact_force"] >= 0).all())
            opened += max(wanted) < -1e-3 * amplitude
            self.assertFalse(q[[place[label] for label in self.deck.node_sets["CLAMP"].tolist()]].any())
        self.assertTrue(0 < opened < 8)

    def test_matrices_that_are_there(self):
        """The same matrices handed over, and a force in place of the deck's: by the name of a set, twice as much."""
        once, _ = self.run_plm("response", self.path, "--matrices", self.folder / "matrices.sti")
        twice, _ = self.run_plm("response", self.path, "--matrices", self.folder / "matrices.sti", "--force", "tip", "z", 2 * FORCE)
        (one, hz), (two, hz_two) = (map(float, re.search(r"^  (\S+) at (\S+) Hz: ", out, re.M).groups()) for out in (once, twice))
        self.assertAlmostEqual(two / one, 2, 4)  # without gaps and pre-load contact is homogeneous
        self.assertEqual(hz, hz_two)

    def test_what_the_deck_does_not_hold(self):
        _, err = self.run_plm("response", self.path, "--force", "TOP", "z", "1", status=2)
        self.assertRegex(err, "force: 'TOP' is neither a node nor a set of nodes; there are the sets CLAMP, NALL, TIP")
        broken = self.folder / "broken.inp"
        broken.write_text(self.path.read_text().replace("*ELASTIC\n210000., 0.3", "*ELASTIC\nhard, 0.3"))
        _, err = self.run_plm("response", broken, status=2)
        self.assertRegex(err, r"broken.inp:\d+: ")
        _, err = self.run_plm("modes", self.path, "more.inp", status=2)
        self.assertRegex(err, "more.inp is no file")

    def test_what_is_not_read_is_listed(self):
        odd = self.folder / "odd.inp"
        odd.write_text(self.path.read_text().replace("*STEP\n", "*MAGIC WAND\n1, 2\n*STEP\n", 1))
        _, err = self.run_plm("response", odd, "--matrices", self.folder / "matrices.sti", "--out", self.folder / "odd", status=1)
        self.assertRegex(err, "warning: of the deck this was not taken: .*odd.inp:")
        self.assertRegex((self.folder / "odd" / "report.md").read_text(), r"## Not taken from the deck\n\n\* .*odd.inp:\d+: .*MAGIC")


if __name__ == "__main__":
    unittest.main()
