"""Mistakes at the command plm that once went through in silence, came as numbers of the system, or named options that it has not."""
import os
import subprocess
import sys
import unittest

from plm.command.console import in_words_of_the_command

from command_case import Folder

HEAD = "model = ['K.mtx', 'M.mtx']\ndofs = 'dofs.txt'\n"


class Mistakes(Folder):
    def case(self, text):
        return self.write("t.toml", HEAD + text)

    def test_nodes_are_whole_numbers(self):
        """Node 20.7 is none; it is not node 20."""
        pair = "[[contact]]\nnode = {}\ndirection = 'x'\n"
        self.refused("contact: 20.7 is no node", "rest", self.case(pair.format("20.7")))
        self.refused("contact: True is no node", "rest", self.case(pair.format("true")))
        self.refused("contact: 10.5 is no node", "rest", self.case(pair.format("20") + "to_node = 10.5\n"))
        for node in ("20.7", "true"):
            self.refused("is neither a node nor a set", "response", self.case(f"force = [{node}, 'x', 1.0]\n" + pair.format(20)))

    def test_numbers_of_pairs(self):
        pair = "[[contact]]\nnode = 20\ndirection = 'x'\n"
        for line, words in (("gap = true", "gap is True"), ("gap = nan", "gap is nan"), ("stiffness = inf", "stiffness is inf")):
            self.refused(f"contact: {words}; it must be a number", "rest", self.case(f"{pair}{line}\n"))
        self.refused("p.csv:3: contact: gap is 'nan'", "rest", *self.matrices, "--contact",
                     self.write("p.csv", "node,direction,gap\n20,x,0\n20,x,nan\n"))

    def test_mass_and_stiffness_exchanged(self):
        """Files in the wrong order: K and M by name, where M leads to K; and names that say nothing. Nothing is said of the right one."""
        stiffness, mass, *rest = self.matrices
        self.refused("K.mtx: would be stiffness and mass: give the file of the stiffness first", "modes", mass, stiffness, *rest)
        for name, path in (("one.mtx", stiffness), ("two.mtx", mass)):
            (self.folder / name).write_bytes((self.folder / path).read_bytes())
        _, err = self.here("modes", self.path("two.mtx"), self.path("one.mtx"), *rest, status=1)  # 1e-3 Hz is a warning, too
        self.assertIn("are the two exchanged?", err)
        _, err = self.here("modes", self.path("one.mtx"), self.path("two.mtx"), *rest)
        self.assertEqual(err, "")

    def test_a_column_twice(self):
        self.refused("p.csv:1: column 'gap' comes twice", "rest", *self.matrices, "--contact",
                     self.write("p.csv", "node,direction,gap,gap\n20,x,1,2\n"))

    def test_sets_without_nodes(self):
        """A support, pre-load or force of nothing would do nothing."""
        mesh = self.write("deck.inp", "*NODE\n10,0.,0.,0.\n20,1.,0.,0.\n*NSET,NSET=NOBODY\n")
        deck = [mesh, "--matrices", self.path("K.mtx"), "--matrices", self.path("M.mtx"), "--dofs", self.path("dofs.txt"), "--contact",
                self.path("pairs.csv")]
        for option in (["--fix", "nobody", "all"], ["--preload", "nobody", "x", "1"], ["--force", "NOBODY", "x", "1"]):
            self.refused(f"{option[0][2:]}: the set {option[1]} has no nodes", "response", *deck, *option)

    def test_nothing_moves(self):
        """Without pre-load zeros are right, and it is said why; with one it is not."""
        _, err = self.here("rest", *self.matrices, "--contact", self.path("pairs.csv"))
        self.assertIn("no pre-load acts", err)
        for more in (["--preload", "20", "x", "1"], ["--contact", self.write("tight.csv", "node,direction,gap\n20,x,-0.1\n")]):
            _, err = self.here("rest", *self.matrices, "--contact", self.path("pairs.csv"), *more)
            self.assertNotIn("no pre-load", err)

    def test_files_and_folders_in_words(self):
        self.refused(r"plm: \S*nowhere.toml is no file$", "rest", self.path("nowhere.toml"))
        self.refused(r"plm: \S*nowhere.csv: No such file", "rest", *self.matrices, "--contact", self.path("nowhere.csv"))
        self.write("file", "")
        for name in ("file", "file/below"):
            self.refused(f"out: .*{name} is a file, or a part of it is; name a folder", "rest", *self.matrices, "--out", self.path(name))

    def test_a_folder_that_takes_no_files(self):
        """Before the work, not behind it. The user may be root, who writes everywhere: nobody then."""
        (self.folder / "shut").mkdir(mode=0o555)
        self.folder.chmod(0o755)
        user = {"user": 65534} if os.geteuid() == 0 else {}
        _, err = self.shell("study", "case.toml", "--out", "shut", status=2, **user)
        self.assertRegex(err, "^plm: out: no files can be written to shut: Permission denied\n$")

    def test_a_full_disk(self):
        if not os.path.exists("/dev/full"):
            self.skipTest("no /dev/full")
        with open("/dev/full", "w", encoding="ascii") as full:
            done = subprocess.run([sys.executable, "-m", "plm", "modes", "case.toml"], stdout=full, stderr=subprocess.PIPE, text=True,
                                  cwd=self.folder, timeout=60, check=False)
        self.assertEqual((done.returncode, done.stderr), (3, "plm: No space left on device\n"))

    def test_names_that_the_terminal_cannot_show(self):
        """The work is not lost for them."""
        out, _ = self.shell("modes", "case.toml", "--out", "Bögen", env={**os.environ, "PYTHONIOENCODING": "ascii", "PYTHONUTF8": "0"})
        self.assertIn(r"in B\xf6gen", out)
        self.assertTrue((self.folder / "Bögen" / "modes.csv").exists())

    def test_advice_names_options_of_the_command(self):
        _, err = self.here("response", self.path("case.toml"), "--effort", "1e-9", "--frequency-min-hz", "1", "--frequency-max-hz", "100", status=3)
        self.assertIn("raise --effort (0: no limit)", err)
        self.assertNotIn("raise effort", err)
        _, err = self.here("response", self.path("case.toml"), "--frequency-min-hz", "100", "--frequency-max-hz", "200", status=1)
        self.assertIn("over a wider range --frequency-min-hz and --frequency-max-hz", err)

    def test_words_of_the_command(self):
        """Nodes in place of DOFs, wherever the library counts them; no names of functions; advice that begins a sentence."""
        said = in_words_of_the_command("plm_hbm_sweep: it ended. Raise the effort of\nthe context (the first: DOF 0, counted from 0), of DOFs 0 and 1: "
                                       "motion of DOF 1 (counted from 0); x.inp:3: plm_model_build: DOFs 0, 1, ...", lambda dof: f"node {10 + dof} y")
        self.assertEqual(said, "it ended. Raise --effort (0: no limit) (the first: node 10 y), of node 10 y and node 11 y: motion of node 11 y; "
                         "x.inp:3: node 10 y, node 11 y, ...")
        self.assertEqual(in_words_of_the_command('name it ("mode" or "mode_frequency_hz")'),
                         "name it by --frequency-min-hz and --frequency-max-hz around it")
        out, _ = self.here("audit", self.path("case.toml"))
        self.assertIn("motion of node 20 x in its positive direction closes pair 0", out)
        empty = "%%MatrixMarket matrix coordinate real symmetric\n2 2 1\n1 1 1e4\n"
        _, err = self.here("modes", *(self.write(name, empty) for name in ("K.mtx", "M.mtx")), "--dofs", self.path("dofs.txt"), status=2)
        self.assertRegex(err, "plm: node 20 x has neither stiffness nor mass")

    def test_options_that_come_again(self):
        self.refused("'M.mtx' is too much: .* written again for each", "modes", "deck.inp", "--matrices", "K.mtx", "M.mtx")


if __name__ == "__main__":
    unittest.main()
