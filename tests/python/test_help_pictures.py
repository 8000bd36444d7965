"""help() of plm.plot and plm.fe: each argument is explained, and an example calls the function; all of them run."""
import contextlib
import inspect
import io
import os
import re
import tempfile
import textwrap
import unittest
import warnings

import matplotlib

matplotlib.use("Agg")
import numpy  # noqa: E402
import plm  # noqa: E402
import scipy.sparse  # noqa: E402
from matplotlib import pyplot  # noqa: E402

import models  # noqa: E402

NEEDS_MORE = {"plm.fe.Deck.matrices_by_calculix", "plm.fe.Deck.section_set"}  # CalculiX; a card of another deck


def public():
    """(name, what an example calls, function or class)."""
    for name in plm.plot.__all__:
        if callable(getattr(plm.plot, name)):
            yield f"plm.plot.{name}", f"plm.plot.{name}(", getattr(plm.plot, name)
    for name, one in sorted(vars(plm.fe).items()):
        if getattr(one, "__module__", "").startswith("plm.fe") and not name.startswith("_"):
            yield f"plm.fe.{name}", f"plm.fe.{name}", one
    for name, one in inspect.getmembers(plm.fe.Deck, inspect.isfunction):
        if not name.startswith("_"):
            yield f"plm.fe.Deck.{name}", f".{name}(", one


def example_of(one, call):
    """The last paragraph of its text that has the call, "" where there is none."""
    return next((textwrap.dedent(block) for block in reversed(inspect.getdoc(one).split("\n\n")) if call in block), "")


def given(folder):
    """What the examples are about, and the files that they read in the folder in which they run."""
    stiffness, mass = scipy.sparse.csr_matrix([[2e4, -1e4], [-1e4, 1e4]]), scipy.sparse.identity(2, format="csr")
    with open(os.path.join(folder, "two.inp"), "w", encoding="ascii") as file:
        file.write("*NODE\n1, 0, 0, 0\n2, 1, 0, 0\n*ELEMENT, TYPE=T3D2, ELSET=BAR\n1, 1, 2\n*SURFACE, NAME=TOP, TYPE=NODE\n2\n"
                   "*STEP\n*CLOAD\n2, 1, 1\n*END STEP\n")
    own = plm.fe.Matrices(stiffness, mass, dofs=[(1, 1), (2, 1)])
    plm.fe.write_matrices(os.path.join(folder, "two.mtx"), own, "market")
    deck = plm.fe.read_deck(os.path.join(folder, "two.inp"), own)
    plm.fe.write_vtu(os.path.join(folder, "two.vtu"), deck, {})
    model = plm.Model(mass, stiffness)
    model.set_rayleigh_damping(0, 2e-4)
    model.add_gap_rows([[0, 1]], stiffness=5e3)
    model.set_excitation([0, 1])
    response = model.build().compute_response(dof=1)
    sampler = plm.Sampler(model, mode=1)
    study = plm.Study(model, repeats=1)
    study.set_output(dof=1)
    for n in (1, 3, 5):
        study.add_response(f"H = {n}", plm.Hbm(plm.Basis(model, sampler), n_harmonics=n, stability="off"))
    study.add_response("4 samples", plm.Hbm(plm.Basis(model, sampler), n_harmonics=3, stability="off"))
    study.add_response("Craig-Bampton", plm.Hbm(plm.Basis(model, sampler, kind="craig_bampton"), n_harmonics=3, stability="off"))
    study.set_reference(plm.Hbm(plm.Basis(model, sampler, kind="full"), n_harmonics=7, stability="off"))
    carrier = plm.Hbm(models.carrier(), force_scale=0.006)  # of which two resonances are known at one force
    return {"plm": plm, "numpy": numpy, "scipy": scipy, "pyplot": pyplot, "response": response, "curve": response.curve, "hbm": carrier,
            "peak": response.hbm.find_peak(response.curve, 1), "study": study, "main": response.curve, "loop": response.curve, "deck": deck, "matrices": own, "areas": [1.0],
            "xyz": numpy.zeros((1, 3)), "n_dof": 2, "x": numpy.array([0.0]), "ax": plm.plot.response(response.curve, dof=1)}


class Help(unittest.TestCase):
    def test_every_argument_is_explained(self):
        count = 0
        for name, _, one in public():
            text = inspect.getdoc(one)
            for argument in inspect.signature(one).parameters:
                if argument not in ("self", "args", "kwargs"):
                    count += 1
                    self.assertRegex(text, rf"\b{argument}\b", name)
        self.assertGreater(count, 100)

    def test_the_examples_run(self):
        with tempfile.TemporaryDirectory() as folder, contextlib.redirect_stdout(io.StringIO()), warnings.catch_warnings():
            warnings.simplefilter("ignore")
            here = os.getcwd()
            os.chdir(folder)
            try:
                about, count = given(folder), 0
                for name, call, one in public():
                    with self.subTest(name):
                        example = example_of(one, call)
                        self.assertTrue(example, f"help({name}) has no example")
                        if name not in NEEDS_MORE:
                            exec(compile(re.sub(r"\[12, 15\]", "[0, 1]", re.sub(r"dof=12\b", "dof=1", example)), name, "exec"), dict(about))
                            count += 1
                        pyplot.close("all")
                self.assertGreater(count, 30)
            finally:
                os.chdir(here)


if __name__ == "__main__":
    unittest.main()
