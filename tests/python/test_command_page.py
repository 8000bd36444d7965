"""What docs/command.md shows is what the command prints.

    test_command_page.py [--all] [--renew]    --all: also the commands that take long; --renew: writes the page anew
"""
import contextlib
import io
import os
import pathlib
import re
import shlex
import shutil
import sys
import tempfile
import unittest

import numpy
from plm.command import main
from plm.command.settings import SETTINGS

ROOT = pathlib.Path(__file__).resolve().parents[2]
PAGE = ROOT / "docs" / "command.md"
BLOCK = re.compile(r"(?:<!-- (?P<mark>[^>]*) -->\n)?```(?P<language>\w*)\n(?P<text>.*?)```\n", re.S)
VARIES = r"(?<=may be off by )\S+|(?<=reduced equations: )\S+|\S+ s for the \w+|  Pareto$"
NUMBER = re.compile(r"[-+]?\d+\.?\d*(?:e[-+]?\d+)?")


def printed(line):
    """What a command prints, in either stream."""
    out = io.StringIO()
    with contextlib.redirect_stdout(out), contextlib.redirect_stderr(out):
        main(shlex.split(line)[1:])
    return out.getvalue()


def keys_table():
    """The table of keys, from that of the settings."""
    lines = ["| key | default | commands | |", "|---|---|---|---|"]
    for one in SETTINGS:
        default = "" if one.default in (None, [], False) else f"`{str(one.default).replace(chr(39), '')}`"
        every = "all" if len(one.commands) == 5 else ", ".join(one.commands)
        lines.append(f"| `{one.name}` | {default} | {every} | {one.text} |")
    return "\n".join(lines) + "\n"


def commands(text):
    """(command, what is shown for it) of a block."""
    parts = re.split(r"^\$ (.*)\n", text, flags=re.M)[1:]
    return list(zip(parts[::2], parts[1::2]))


class Page(unittest.TestCase):
    @classmethod
    def setUpClass(cls):
        folder = tempfile.TemporaryDirectory()
        cls.addClassCleanup(folder.cleanup)
        before = os.getcwd()
        os.chdir(folder.name)
        cls.addClassCleanup(os.chdir, before)
        shutil.copytree(ROOT / "examples" / "decks", "decks")
        os.environ.setdefault("OMP_NUM_THREADS", "1")
        cls.blocks = list(BLOCK.finditer(PAGE.read_text()))
        for block in cls.blocks:
            if (block["mark"] or "").startswith("file: "):
                pathlib.Path(block["mark"][6:]).write_text(block["text"])

    def same(self, found, shown, with_numbers, line):
        """Word by word; numbers to 1e-3. Not errors and residuals, which are rounding where they are smallest, nor times."""
        found, shown = (re.sub(VARIES, "", text, flags=re.M) for text in (found, shown))
        words = [NUMBER.sub("#", text).split() for text in (found, shown)]
        self.assertEqual(*words, f"$ {line}\n{found}")
        if with_numbers:
            numbers = [[float(x) for x in NUMBER.findall(text)] for text in (found, shown)]
            numpy.testing.assert_allclose(*numbers, rtol=1e-3, err_msg=f"$ {line}")

    def test_commands(self):
        ran = 0
        for block in self.blocks:
            if block["language"] != "console" or block["mark"] == "long" and "--all" not in sys.argv:
                continue
            for line, shown in commands(block["text"]):
                if "decks/" in line and not shutil.which("ccx"):
                    continue
                self.same(printed(line), shown, block["mark"] != "times", line)
                ran += 1
        self.assertGreater(ran, 5)

    def test_keys(self):
        self.assertIn(keys_table(), PAGE.read_text())


def renew():
    """The page with what is printed now."""
    Page.setUpClass()
    text = PAGE.read_text()

    def block_now(block):
        if block["language"] != "console":
            return block[0]
        lines = "".join(f"$ {line}\n{printed(line)}" for line, _ in commands(block["text"]))
        return block[0].replace(block["text"], lines)
    text = BLOCK.sub(block_now, text)
    text = re.sub(r"## Keys\n\n.*?\n\n## ", lambda _: f"## Keys\n\n{keys_table()}\n## ", text, flags=re.S)
    PAGE.write_text(text)
    Page.doClassCleanups()


if __name__ == "__main__":
    if "--renew" in sys.argv:
        renew()
    else:
        unittest.main(argv=[sys.argv[0]])
