"""The command plm as a shell sees it: exit status, where what is said goes, and every wrong usage in words."""
import contextlib
import os
import pty
import signal
import subprocess
import sys
import time
import unittest

import scipy.io
import scipy.sparse

from command_case import Folder


class Shell(Folder):
    def test_version_and_help(self):
        out, _ = self.shell("--version")
        self.assertRegex(out, r"^plm, libplm \d+\.\d+\.\d+; .*licence")
        for command in ("response", "modes", "audit", "rest", "study"):
            with self.assertRaises(SystemExit) as end:
                self.here(command, "--help")
            self.assertEqual(end.exception.code, 0)
        out, _ = self.shell("response", "--help")
        self.assertRegex(out, r"example: plm response .*--out")
        self.assertIn("exit status: 0", out)

    def test_progress_is_for_terminals(self):
        """A bar on the standard error where that is a terminal, and nowhere else."""
        master, slave = pty.openpty()
        done = subprocess.run([sys.executable, "-m", "plm", "response", "case.toml"], stdout=subprocess.PIPE, stderr=slave,
                              cwd=self.folder, timeout=60, check=False)
        os.close(slave)
        shown = b""
        with contextlib.suppress(OSError):  # the end of a terminal without a writer
            while True:
                shown += os.read(master, 65536)
        os.close(master)
        self.assertEqual(done.returncode, 0)
        self.assertIn(b"%", shown)
        self.assertNotIn(b"%\r", done.stdout)
        _, err = self.shell("response", "case.toml")
        self.assertEqual(err, "")

    def test_ctrl_c(self):
        with subprocess.Popen([sys.executable, "-m", "plm", "study", "case.toml", "--repeats", "1000", "--out", "study"],
                              stdout=subprocess.PIPE, stderr=subprocess.PIPE, cwd=self.folder, text=True) as process:
            end = time.monotonic() + 60
            while not (self.folder / "study").exists() and time.monotonic() < end:  # made before the work begins
                time.sleep(0.05)
            time.sleep(0.5)
            self.assertIsNone(process.poll())
            process.send_signal(signal.SIGINT)
            out, err = process.communicate(timeout=30)
        self.assertEqual((process.returncode, out, err), (130, "", "plm: stopped\n"))

    def test_a_reader_that_has_seen_enough(self):
        with subprocess.Popen([sys.executable, "-m", "plm", "audit", "case.toml"], stdout=subprocess.PIPE, stderr=subprocess.PIPE,
                              cwd=self.folder) as process:
            process.stdout.close()
            self.assertEqual((process.wait(timeout=30), process.stderr.read()), (0, b""))

    def test_failures(self):
        """A body that nothing holds, pushed: no equilibrium."""
        scipy.io.mmwrite(self.folder / "K.mtx", scipy.sparse.coo_matrix([[1e4, -1e4], [-1e4, 1e4]]), symmetry="symmetric")
        _, err = self.here("rest", *self.matrices, "--contact", self.path("pairs.csv"), "--preload", "20", "x", "-7.5", status=3)
        self.assertRegex(err, r"^plm: the pre-load drives a rigid-body motion")

    def test_without_the_library(self):
        """One line and a status for the command; for any other program a failed import."""
        nowhere = {**os.environ, "PLM_LIBRARY": "/nowhere"}
        out, err = self.shell("audit", "case.toml", status=3, env=nowhere)
        self.assertEqual(out, "")
        self.assertRegex(err, r"^plm: libplm was not found; [^\n]*PLM_LIBRARY[^\n]*/nowhere[^\n]*\n$")
        other = subprocess.run([sys.executable, "-c", "import plm"], capture_output=True, text=True, env=nowhere, check=False)
        self.assertRegex(other.stderr, r"ImportError: libplm was not found")

    def test_folder_that_cannot_be(self):
        self.write("file", "")
        self.refused("file", "response", self.path("case.toml"), "--out", self.path("file"))


class WrongUsage(Folder):
    def test_command_line(self):
        case = self.path("case.toml")
        self.refused("a command is needed: response, resume, modes, audit, rest, study")
        self.refused("invalid choice: 'respond'.*'response'", "respond")
        self.refused("there is no option --acuracy; did you mean --accuracy?", "response", case, "--acuracy", "1e-3")
        self.refused("there is no option --acc;", "response", case, "--acc", "1e-3")  # no abbreviations: they stop working one day
        self.refused("there is no option --frames", "modes", case, "--frames", "3")
        self.refused("required: FILE", "response")
        self.refused("expected 3 arguments", "response", case, "--force", "20", "x")
        self.refused("accuracy is 'high'; it must be a number", "response", case, "--accuracy", "high")
        self.refused("accuracy is 0.9; it must be from 1e-8 to 0.5", "response", case, "--accuracy", "0.9")
        self.refused("damping_ratio is 2; it must be from 0 to below 1", "response", case, "--damping-ratio", "2")
        self.refused("frames is '2.5'; it must be a whole number", "response", case, "--frames", "2.5")
        self.refused("measure is 'peek'; did you mean peak", "response", case, "--measure", "peek")
        self.refused("belong together", "response", case, "--frequency-min-hz", "3")
        self.refused("must be below", "response", case, "--frequency-min-hz", "3", "--frequency-max-hz", "2")
        self.refused("is too much: matrices are", "response", *self.matrices[:2], *self.matrices[:2], "--dofs", self.path("dofs.txt"))

    def test_nodes_and_directions(self):
        case = self.path("case.toml")
        self.refused("force: there is no node 30 in the model", "response", case, "--force", "30", "x", "1")
        self.refused("force: node 20 has no direction 2; it has 1", "response", case, "--force", "20", "y", "1")
        self.refused("force: 'w' is no direction; those are x, y, z, rx, ry, rz", "response", case, "--force", "20", "w", "1")
        self.refused("force: 'TIP' is neither a node nor a set", "response", case, "--force", "TIP", "x", "1")
        self.refused("the amplitude of force is 'one'", "response", case, "--force", "20", "x", "one")
        self.refused("output: there is no node 5", "response", case, "--output", "5", "x")
        self.refused("fix: there is no node 5", "modes", *self.matrices, "--fix", "5", "all")

    def test_what_is_missing(self):
        self.refused("nothing excites the model: --force", "response", *self.matrices, "--contact", self.path("pairs.csv"))
        self.refused("no contact pairs: --contact", "response", *self.matrices, "--force", "20", "x", "1", "--damping-ratio", "0.1")
        self.refused("no contact pairs: --contact", "rest", *self.matrices)
        self.refused("without a list of DOFs: --dofs", "modes", *self.matrices[:2])
        self.refused("nowhere.mtx is no file", "modes", self.path("nowhere.mtx"))
        self.refused("nowhere.csv", "modes", *self.matrices, "--contact", self.path("nowhere.csv"))
        self.refused("names no model", "modes", self.write("empty.toml", "count = 3\n"))

    def test_case_files(self):
        for text, words in (("acuracy = 1e-3\n", "t.toml:1: acuracy is unknown; did you mean accuracy?"),
                            ("frames = 3\n\naccuracy = 'high'\n", "t.toml:3: accuracy is 'high'; it must be a number"),
                            ("frames = 3\nforce = [20, 'x']\n", "t.toml:2: force is .*a node, a direction and an amplitude"),
                            ("[[contact]]\nnode = 3\nside = 'x'\n", "contact: side is unknown; there are node"),
                            ("[[contact]]\nnode = 3\n", "contact: a pair needs direction"),
                            ("[contact]\nnode = 3\n", "t.toml:1: contact is .*tables"),
                            ("frames = \n", "t.toml:1: no TOML"), ("frames = true\n", "t.toml:1: frames is True; it must be a number"),
                            ("model = 3\n", "t.toml:1: model is 3; it must be the name of a file")):
            head = "" if "model" in text else "model = ['K.mtx', 'M.mtx']\ndofs = 'dofs.txt'\n"
            text = text + head if "[" not in text.split("\n")[0] else text  # keys of the top stand before tables
            if not head or head not in text:
                text = text if "model" in text else head + text
                words = words.replace("t.toml:1", f"t.toml:{1 + head.count(chr(10))}") if head else words
            self.refused(words, "response", self.write("t.toml", text), "--force", "20", "x", "1")
        (self.folder / "t.toml").write_bytes(b"model = '\xff'\n")
        self.refused("t.toml: byte 9 is no UTF-8", "modes", self.path("t.toml"))

    def test_tables(self):
        for name, option, text, words in (
                ("dofs.txt", None, "10.1\nten.1\n", r"dofs.txt:2: "),
                ("dofs.txt", None, "10.1\n20.1\n30.1\n", r"3 DOFs are listed for matrices of 2 rows"),
                ("pairs.csv", "--contact", "node,side\n20,x\n", r"pairs.csv:1: column 'side' is unknown"),
                ("pairs.csv", "--contact", "node\n20\n", r"pairs.csv:1: there is no column direction; the first line must name"),
                ("pairs.csv", "--contact", "", r"pairs.csv:1: there is no column node"),
                ("pairs.csv", "--contact", "node,direction\n20,u\n", r"pairs.csv:2: contact: 'u' is no direction"),
                ("pairs.csv", "--contact", "node,direction\n20,x\n20,x,1\n", r"pairs.csv:3: 3 fields for 2 columns"),
                ("xyz.csv", "--coordinates", "node,x,y,z\nten,0,0,0\n", r"xyz.csv:2: node is 'ten'; it must be a whole number"),
                ("pairs.csv", "--contact", "node,direction,gap\n20,x,wide\n", r"pairs.csv:2: contact: gap is 'wide'"),
                ("pairs.csv", "--contact", "node,direction,stiffness\n20,x,-3\n", r"pairs.csv:2: contact: stiffness is -3; it must be above 0"),
                ("pairs.csv", "--contact", "node,direction\n25,x\n", r"contact pair 1: there is no node 25"),
                ("pairs.csv", "--contact", "node,direction,to_direction\n20,x,x\n", r"pairs.csv:2: contact: to_direction stands without to_node"),
                ("xyz.csv", "--coordinates", "node,x,y,z\n10,0,0,0\n", r"node 20 of the matrices has no coordinates"),
                ("xyz.csv", "--coordinates", "node,x,y,z\n10,0,0,0\n10,0,0,0\n", r"xyz.csv:3: node 10 comes twice")):
            before = (self.folder / name).read_text()
            self.write(name, text)
            self.refused(words, "modes", *self.matrices, *([option, self.path(name)] if option else []))
            self.write(name, before)

    def test_matrices_of_another_shape(self):
        scipy.io.mmwrite(self.folder / "M.mtx", scipy.sparse.identity(3))
        self.refused("3 rows, the stiffness matrix 2", "modes", *self.matrices)


if __name__ == "__main__":
    unittest.main()
