"""Two masses beside a stop as files, and the command plm run on them: what the tests of the command share."""
import contextlib
import io
import pathlib
import subprocess
import sys
import tempfile
import unittest

import numpy
import scipy.io
import scipy.sparse
from plm.command import main

# two masses on springs, the second one beside a stop: kg, N, m, s
STIFFNESS, MASS, STOP, BETA = numpy.array([[2e4, -1e4], [-1e4, 1e4]]), numpy.eye(2), 5e3, 2e-4
FILES = {
    "dofs.txt": "10.1\n20.1\n",
    "pairs.csv": "node,direction,stiffness\n20,x,5000\n",
    "xyz.csv": "node,x,y,z\n20,1,0,0\n10,0,0,0\n",
    "case.toml": 'model = ["K.mtx", "M.mtx"]\ndofs = "dofs.txt"\ncoordinates = "xyz.csv"\ncontact = "pairs.csv"\n'
                 'force = [20, "x", 1.0]\nrayleigh = [0, 2e-4]\nframes = 12\n',
}


class Folder(unittest.TestCase):
    def setUp(self):
        folder = tempfile.TemporaryDirectory()
        self.addCleanup(folder.cleanup)
        self.folder = pathlib.Path(folder.name)
        for name, matrix in (("K.mtx", STIFFNESS), ("M.mtx", MASS)):
            scipy.io.mmwrite(self.folder / name, scipy.sparse.coo_matrix(matrix), symmetry="symmetric", precision=17)
        for name, text in FILES.items():
            self.write(name, text)
        self.matrices = [self.path("K.mtx"), self.path("M.mtx"), "--dofs", self.path("dofs.txt")]

    def path(self, name):
        return str(self.folder / name)

    def write(self, name, text):
        (self.folder / name).write_text(text, encoding="utf-8")
        return self.path(name)

    def shell(self, *arguments, status=0, **options):
        """Output and messages of `python -m plm` with this exit status."""
        done = subprocess.run([sys.executable, "-m", "plm", *arguments], capture_output=True, text=True, cwd=self.folder, timeout=120,
                              check=False, **options)
        self.assertEqual(done.returncode, status, done.stdout + done.stderr)
        return done.stdout, done.stderr

    def here(self, *arguments, status=0):
        """The same in this process, which is quicker."""
        out, err = io.StringIO(), io.StringIO()
        with contextlib.redirect_stdout(out), contextlib.redirect_stderr(err):
            found = main(list(arguments))
        self.assertEqual(found, status, out.getvalue() + err.getvalue())
        return out.getvalue(), err.getvalue()

    def refused(self, words, *arguments):
        """Wrong usage or a wrong file: status 2, one line that says what and what to do, nothing on the standard output."""
        out, err = self.here(*arguments, status=2)
        self.assertEqual(out, "")
        self.assertRegex(err, words)
        self.assertEqual(err.count("\n"), 1, err)
