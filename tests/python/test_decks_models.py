"""What deck.model() makes of a deck whose matrices are handed over: supports, loads, gaps, base motion, damping, refusals."""
import os
import shutil
import tempfile
import unittest
import warnings

import numpy
import plm
import scipy.sparse

from plm.fe import FileError, Matrices, read_deck

# two unit cubes of four nodes each that look at each other: node i and i + 4 at z = 0 and z = GAP, as faces of shells
GAP = 0.25
NODES = "*NODE\n" + "".join(f"{i + 4 * k}, {x}, {y}, {z}\n" for k, z in ((0, 0.0), (1, GAP))
                            for i, (x, y) in enumerate(((0, 0), (1, 0), (1, 1), (0, 1)), 1))
SHEETS = ("*ELEMENT, TYPE=M3D4, ELSET=LOW\n1, 1,2,3,4\n*ELEMENT, TYPE=M3D4, ELSET=HIGH\n2, 5,6,7,8\n"
          "*SURFACE, NAME=MASTER\nLOW, SPOS\n*SURFACE, NAME=SLAVE\nHIGH, SNEG\n")
STIFFNESS, MASS = 500.0, 2.0


def matrices(directions=(1, 2, 3), nodes=range(1, 9)):
    """Each node a mass on three springs to the ground."""
    dofs = [(n, d) for n in nodes for d in directions]
    eye = scipy.sparse.identity(len(dofs), format="csr")
    return Matrices(STIFFNESS * eye, MASS * eye, dofs=dofs)


class Models(unittest.TestCase):
    def setUp(self):
        self.folder = tempfile.mkdtemp()
        self.addCleanup(shutil.rmtree, self.folder)

    def deck(self, text, given=None):
        path = os.path.join(self.folder, "deck.inp")
        with open(path, "w", encoding="ascii") as file:
            file.write(NODES + SHEETS + text)
        return read_deck(path, given or matrices())

    def model(self, text, **options):
        self.made = self.deck(text)
        with warnings.catch_warnings():
            warnings.simplefilter("error", plm.PlmWarning)
            return self.made.model(**options)

    CONTACT = ("*SURFACE INTERACTION, NAME=I\n*SURFACE BEHAVIOR, PRESSURE-OVERCLOSURE=LINEAR\n4000.\n"
               "*CONTACT PAIR, INTERACTION=I{}\nSLAVE, MASTER\n")

    def test_rows(self):
        deck = self.deck("")
        self.assertEqual((deck.dof(3, 2), deck.dof(3, 4), deck.dof(99, 1), deck.n_dof), (7, None, None, 24))
        self.assertEqual(deck.faces("slave").tolist(), [[4, 7, 6, 5]])  # seen from below
        self.assertEqual(deck.faces(deck.surfaces["MASTER"]).tolist(), [[0, 1, 2, 3]])

    def test_gaps(self):
        """From the mesh; ADJUST=; CLEARANCE, also an interference; stiffness by area, a quarter of the square each."""
        for more, clearance, gap in (("", "", GAP), (", ADJUST=0.3", "", 0.0), (", ADJUST=0.2", "", GAP),
                                     ("", "*CLEARANCE, SLAVE=SLAVE, MASTER=MASTER, VALUE=0.01\n", 0.01),
                                     ("", "*CLEARANCE, SLAVE=SLAVE, MASTER=MASTER, VALUE=-0.02\n", -0.02),
                                     (", TYPE=SURFACE TO SURFACE", "*CLEARANCE, SLAVE=SLAVE, MASTER=MASTER, VALUE=0.01\n", 0.01)):
            model = self.model(self.CONTACT.format(more) + clearance)
            numpy.testing.assert_allclose(model.initial_gap, gap, rtol=0, atol=1e-12)
            self.assertEqual(model.n_pairs, 4)
            numpy.testing.assert_allclose(model.contact_stiffness.sum(), 4000, rtol=1e-12)
        numpy.testing.assert_allclose(self.model(self.CONTACT.format(""), contact_stiffness=8.0).contact_stiffness, 2, rtol=1e-12)
        numpy.testing.assert_allclose(self.model(self.CONTACT.format(""), closed=0.3).initial_gap, 0)
        with self.assertRaisesRegex(FileError, "deck.inp:22: .*partner"):
            self.model(self.CONTACT.format(""), search=0.1)

    def test_load_on_an_arm(self):
        """A node of no element that follows another: its force is one and a moment there. By hand, each direction a spring of its own."""
        arm, force = numpy.array([0.5, -0.25, 2.0]), numpy.array([3.0, 2.0, 0.0])
        for tie in ("*MPC\nBEAM, 300, 5\n", "*RIGID BODY, NSET=ARM, REF NODE=5\n", "*COUPLING, CONSTRAINT NAME=C, REF NODE=5, SURFACE=ARM\n*KINEMATIC\n"):
            at = numpy.array([0, 0, GAP]) + arm
            text = ("*NODE, NSET=ARM\n300, {}, {}, {}\n".format(*at) + tie + self.CONTACT.format("")
                    + "*STEP\n*STATIC\n*CLOAD\n300, 1, 3.\n300, 2, 2.\n*END STEP\n")
            deck = self.deck(text, matrices(range(1, 7)))
            q = deck.model(force=[(5, 1, 1.0)], contact_stiffness=1e-9).solve_rest().rest_displacement
            turn = numpy.cross(arm, force) / STIFFNESS
            numpy.testing.assert_allclose(q[[deck.dof(5, d) for d in range(1, 7)]], [*force / STIFFNESS, *turn], rtol=1e-10, atol=1e-15)
            numpy.testing.assert_allclose(q[[deck.dof(300, d) for d in range(1, 7)]], [*force / STIFFNESS + numpy.cross(turn, arm), *turn],
                                          rtol=1e-10, atol=1e-15)

    def test_rest_of_two_masses(self):
        """A force that closes the gap: k x = f - N, N = k_n (2 x - gap) for either side, by hand."""
        step = ("*STEP\n*STATIC\n*CLOAD\n" + "".join(f"{n}, 3, {400 if n < 5 else -400}.\n" for n in range(1, 9)) + "*END STEP\n")
        model = self.model(self.CONTACT.format("") + step, force=[(5, 3, 1.0)]).solve_rest()
        kn = 1000.0
        x = (400 + kn * GAP) / (STIFFNESS + 2 * kn)
        numpy.testing.assert_allclose(model.rest_displacement[[self.made.dof(n, 3) for n in range(1, 9)]], [x] * 4 + [-x] * 4, rtol=1e-10)
        numpy.testing.assert_allclose(model.rest_force, kn * (2 * x - GAP), rtol=1e-10)
        self.assertEqual(self.model(self.CONTACT.format("") + step, preload=False).solve_rest().rest_n_closed, 0)

    def curve(self, model, low, high):
        """Of the linear structure: no contact closes."""
        with warnings.catch_warnings():
            warnings.filterwarnings("ignore", "plm_hbm_sweep: no contact pair opens or closes", plm.PlmWarning)
            basis = plm.Basis(model, kind="full", frequency_min_hz=low, frequency_max_hz=high).build()
            return plm.Hbm(basis, n_harmonics=1).sweep()

    def test_harmonic_forces(self):
        """From the step of the deck, real and imaginary parts, or from force=; static loads stay out of it."""
        step = ("*STEP\n*STATIC\n*CLOAD\n1, 1, 9.\n*END STEP\n*STEP\n*STEADY STATE DYNAMICS\n1., 2.\n*CLOAD{}\n1, 1, 3.\n"
                "*CLOAD, {}\n1, 1, 4.\n*END STEP\n")
        cases = [(step.format("", "LOAD CASE=2"), {}), (step.format(", REAL", "IMAGINARY"), {})]
        cases += [("", dict(force=force)) for force in ([(1, 1, 5.0)], {(1, 1): 5.0}, [(1, 1, 3.0), (1, 1, 4j)], 5 * numpy.eye(24)[0])]
        for text, options in cases:
            model = self.model(self.CONTACT.format("") + text, **options)
            model.set_rayleigh_damping(0, 1e-3)
            curve = self.curve(model, 1.9, 2.1)
            w = 2 * numpy.pi * curve.frequency_hz
            numpy.testing.assert_allclose(curve.amplitude(self.made.dof(1, 1)),
                                          5 / abs(STIFFNESS - w * w * MASS + 1j * w * 1e-3 * STIFFNESS), rtol=1e-6)

    def test_moving_supports(self):
        """A spring of 200 between nodes 1 and 2; node 1 is shaken. By algebra, relative to how node 2 follows at rest."""
        for more, factor in (("", lambda w: 1), (", TYPE=VELOCITY", lambda w: 1 / w), (", TYPE=ACCELERATION", lambda w: 1 / w**2)):
            deck = self.deck(f"*STEP\n*STEADY STATE DYNAMICS\n1., 2.\n*BOUNDARY{more}\n1, 1, 1, 0.5\n*END STEP\n" + self.CONTACT.format(""))
            k = deck.matrices.stiffness.tolil()
            k[0, 3] = k[3, 0] = -200.0
            deck.set_matrices(Matrices(k.tocsr(), deck.matrices.mass, dofs=deck.matrices.dofs))
            self.assertEqual(deck.unread, [])
            model = deck.model()
            model.set_structural_damping(0.02)
            curve = self.curve(model, 1.9, 2.1)
            w = 2 * numpy.pi * curve.frequency_hz
            absolute = 200 * (1 + 0.02j) / (STIFFNESS * (1 + 0.02j) - w * w * MASS)
            numpy.testing.assert_allclose(curve.amplitude(deck.dof(2, 1)), 0.5 * factor(w) * abs(absolute - 200 / STIFFNESS), rtol=1e-6)

    def test_supports(self):
        """OP=NEW ends those of steps before, not those of the model; what the matrices do not have is held already."""
        model = self.model("*BOUNDARY\n1, 1, 3\n2, XSYMM\n3, PINNED\n*STEP\n*FREQUENCY\n4\n*BOUNDARY\n4, 1\n*END STEP\n"
                           "*STEP\n*FREQUENCY\n4\n*BOUNDARY, OP=NEW\n5, 2, 3\n*END STEP\n")
        self.assertEqual(model.n_free, 24 - 3 - 1 - 3 - 2)
        deck = self.deck("*BOUNDARY\n1, ENCASTRE\n*EQUATION\n2\n2, 1, 1., 1, 1, -3.\n", matrices(nodes=range(2, 9)))
        self.assertEqual(deck.model().n_free, 20)  # an equation with what is held holds the other

    def test_damping(self):
        for text, want in (("*MATERIAL, NAME=M\n*DENSITY\n1.\n*DAMPING, ALPHA=0.3, BETA=1.e-3\n", "rayleigh"),
                           ("*STEP\n*STEADY STATE DYNAMICS\n1.,2.\n*MODAL DAMPING\n1, 8, 0.03\n*END STEP\n", "modal")):
            deck = self.deck(text + self.CONTACT.format(""))
            model = deck.model(force=[(1, 1, 1.0)])
            curve = self.curve(model, 2.2, 2.8)
            w = 2 * numpy.pi * curve.frequency_hz
            c = 0.3 * MASS + 1e-3 * STIFFNESS if want == "rayleigh" else 2 * 0.03 * numpy.sqrt(STIFFNESS * MASS)
            numpy.testing.assert_allclose(curve.amplitude(0), 1 / abs(STIFFNESS - w * w * MASS + 1j * w * c), rtol=1e-6)

        deck = self.deck("*MATERIAL, NAME=M\n*DAMPING, ALPHA=0.3\n*MATERIAL, NAME=N\n*DAMPING, ALPHA=0.4\n")
        self.assertEqual((deck.rayleigh, deck.unread[0][1:]),
                         (None, (21, "*DAMPING differs between the materials; it is left out, set it on the model")))

    def test_beam_of_a_line_of_nodes(self):
        """Nodes 1 and 2 follow 9 with levers along one axis; its idle rotation about it is held, the others move. What is left: three
        translations of two masses and two turns, all on springs and masses alike, so of one frequency."""
        path = os.path.join(self.folder, "line.inp")
        with open(path, "w", encoding="ascii") as file:
            file.write("*NODE\n1, -1, 0, 0\n2, 1, 0, 0\n9, 0, 0, 0\n*NSET, NSET=A\n1, 2\n*RIGID BODY, NSET=A, REF NODE=9\n")
        deck = read_deck(path, matrices(nodes=(1, 2)))
        self.assertEqual((deck.n_dof, deck.dof(9, 6)), (12, 11))
        model = deck.model()
        self.assertEqual(model.n_free, 5)
        numpy.testing.assert_allclose(model.modes(5), numpy.sqrt(STIFFNESS / MASS) / (2 * numpy.pi), rtol=1e-10)

    def test_what_is_wrong_is_said(self):
        with self.assertRaisesRegex(ValueError, "no node of the matrices is in"):
            self.deck("", matrices(nodes=range(101, 109))).model()
        with self.assertRaisesRegex(ValueError, "two rows for node 1 in direction 1: 0 and 24"):
            deck = self.deck("")
            eye = scipy.sparse.identity(25, format="csr")
            deck.set_matrices(type("Twice", (), dict(stiffness=eye, mass=eye, damping=None, dofs=[*matrices().dofs.tolist(), (1, 1)]))())
            deck.model()
        with self.assertRaisesRegex(ValueError, "node 1 in direction 5, where the model has no DOF"):
            self.model("", force=[(1, 5, 1.0)])
        with self.assertRaisesRegex(ValueError, r"force has shape \(3,\)"):
            self.model("", force=[1.0, 2.0, 3.0])
        with self.assertRaisesRegex(FileError, "deck.inp:23: a load acts at node 9 in direction 1"):
            self.model("*NODE\n9, 5., 5., 5.\n*STEP\n*STATIC\n*CLOAD\n9, 1, 1.\n*END STEP\n")
        with self.assertWarnsRegex(plm.PlmWarning, "not taken: .*deck.inp:18: .FRICTION is not read; 1 lines"):
            self.deck("*FRICTION\n0.2\n").model(build=False)
        deck = self.deck("")
        deck.set_matrices(None)
        with self.assertRaisesRegex(ValueError, "no matrices yet"):
            deck.dof(1, 1)
        with self.assertRaisesRegex(FileError, "nowhere is not installed to make them"):
            deck.matrices_by_calculix(program="nowhere")


if __name__ == "__main__":
    unittest.main()
