"""plm response --save-every and plm resume: a response that was stopped ends with the curve that it would have had."""
import re
import unittest
import unittest.mock
import warnings

import numpy
import plm
import scipy.io
import scipy.sparse
from command_case import Folder
from plm.command import response


class Resumed(Folder):
    def stop_after(self, points):
        """The folder as a process that was killed leaves it."""
        basis = plm.Basis.from_bytes((self.folder / "out/basis.plm").read_bytes(), plm.Context())
        with warnings.catch_warnings():
            warnings.simplefilter("ignore")
            part = plm.Hbm(basis, accuracy=1e-3, max_points=points).sweep()
        (self.folder / "out/curve.plm").write_bytes(part.to_bytes())
        (self.folder / "out/response.csv").unlink()

    def test_the_same_table_as_without_a_stop(self):
        out = self.path("out")
        said, _ = self.here("response", self.path("case.toml"), "--save-every", "5", "--out", out)
        self.assertIn("basis.plm, curve.plm", said)
        table = (self.folder / "out/response.csv").read_text().splitlines()
        self.stop_after(13)
        again, told = self.here("resume", self.path("case.toml"), "--out", out)
        self.assertIn("has 13 points; the curve goes on", told)
        without_times = [re.sub(r"[-+.e\d]+ s for", "s for", text) for text in (again, said)]
        self.assertEqual(*without_times)
        one, other = (numpy.loadtxt(text, delimiter=",", skiprows=1) for text in (table, self.folder / "out/response.csv"))
        self.assertTrue(numpy.array_equal(one[:, 0], other[:, 0]))
        self.assertLess(abs(one[:, 1] / other[:, 1] - 1).max(), 1e-10)  # extrema of what was read are found anew
        self.assertIn("has the whole curve", self.here("resume", self.path("case.toml"), "--out", out)[1])

    def test_a_basis_that_is_refined_is_left_there_too(self):
        case, out, refined = self.path("case.toml"), self.path("out"), self.folder / "out/refined_curve.plm"
        real, calls = response._on_basis, []

        def first_is_too_small(basis, *arguments):
            found, told = real(basis, *arguments)
            calls.append(basis)
            return (found._replace(error=0.5) if len(calls) == 1 else found), told
        for command in ("response", "resume"):
            calls.clear()
            with unittest.mock.patch.object(response, "_on_basis", first_is_too_small):
                said, told = self.here(command, case, "--out", out, *(["--save-every", "5"] if command == "response" else []))
            self.assertEqual(len(calls), 2)
            self.assertIn("basis.plm, curve.plm, refined_basis.plm, refined_curve.plm", said)
            if command == "response":
                whole = (self.folder / "out/response.csv").read_text()
                basis = plm.Basis.from_bytes((self.folder / "out/refined_basis.plm").read_bytes(), plm.Context())
                with warnings.catch_warnings():
                    warnings.simplefilter("ignore")
                    refined.write_bytes(plm.Hbm(basis, accuracy=1e-3, max_points=13).sweep().to_bytes())
        self.assertIn("out/curve.plm has the whole curve", told)
        self.assertIn("refined_curve.plm has 13 points; the curve goes on", told)
        one, other = (numpy.loadtxt(text.splitlines(), delimiter=",", skiprows=1)
                      for text in (whole, (self.folder / "out/response.csv").read_text()))
        self.assertTrue(numpy.array_equal(one[:, 0], other[:, 0]))
        self.here("response", case, "--save-every", "5", "--out", out)  # another curve begins: what belongs to the last one goes
        self.assertFalse(refined.exists())

    def test_what_lies_beside_a_saved_curve_is_looked_for(self):
        """The two masses of test_beside.py, whose closed curve has motions twice as large; those of the stop have none."""
        self.assertIn("no larger stable one was found", self.here("response", self.path("case.toml"), "--save-every", "5", "--out",
                                                                  self.path("none"))[0])
        for name, matrix in (("K.mtx", [[30480, -20480], [-20480, 20480]]), ("M.mtx", [[1, 0], [0, 0.2]])):
            scipy.io.mmwrite(self.folder / name, scipy.sparse.coo_matrix(numpy.array(matrix, dtype=float)), symmetry="symmetric", precision=17)
        self.write("pairs.csv", "node,direction,stiffness\n10,x,10000\n")
        case = self.write("two.toml", 'model = ["K.mtx", "M.mtx"]\ndofs = "dofs.txt"\ncontact = "pairs.csv"\npreload = [10, "x", 50.0]\n'
                          'force = [10, "x", 0.6]\nrayleigh = [0, 4e-5]\nmeasure = "half_peak_to_peak"\n')
        for command in (["response", case, "--save-every", "5"], ["resume", case], ["response", case]):
            said, told = self.here(*command, "--out", self.path("out"), status=1)
            self.assertRegex(said, r"a larger stable one beside the curve: 0\.01\d+ at")
            self.assertRegex(told, "at the same force, there is a stable motion of 0.0")
            self.assertIn("larger.csv", said)

    def test_mistakes(self):
        case, out = self.path("case.toml"), self.path("out")
        self.refused("resume needs --out", "resume", case)
        self.refused("save_every needs --out", "response", case, "--save-every", "5")
        self.refused("plm response --save-every", "resume", case, "--out", out)
        self.refused("save_every is '0'", "response", case, "--save-every", "0", "--out", out)
        self.here("response", case, "--save-every", "5", "--out", out)
        self.stop_after(13)
        self.refused("accuracy = 0.01", "resume", case, "--out", out, "--accuracy", "0.01", "--quiet")
        self.refused("another one than the basis was made of", "resume", case, "--out", out, "--fix", "10", "x")


if __name__ == "__main__":
    unittest.main()
