"""Decks that are wrong are refused with their file and line; decks damaged by chance make no other exception and end soon.

    test_decks_broken.py [seconds [seed]]     the damage by chance alone, for longer
"""
import glob
import os
import random
import re
import shutil
import sys
import tempfile
import time
import unittest

from plm.fe import FileError, read_deck

HERE = os.path.dirname(os.path.abspath(__file__))
PIECES = ["*", "**", ",", "=", "\n", '"', "'", "-1", "0", "1e308", "nan", "99999999999999999999", "1.5", " ", "\t", "\0", "ü", "*STEP\n", "*END STEP\n",
          "*INCLUDE, INPUT=", "GENERATE", "E", "S1", "ALL", ".", "*NODE\n", "*PART, NAME=P\n", "*END PART\n", "1,", "*EQUATION\n", "_"]
EXTRA = """*PART, NAME=P
*NODE, NSET=N
1, 0., 0., 0.
2, 1., 0., 0.
3, 0., 1., 0.
4, 0., 0., 1.
*ELEMENT, TYPE=C3D4, ELSET=E
1, 1, 2, 3, 4
*SURFACE, NAME=S
E, S1
*END PART
*INSTANCE, NAME=I, PART=P
1., 2., 3.
0., 0., 0., 1., 1., 0., 30.
*END INSTANCE
*INSTANCE, NAME=J, PART=P
*END INSTANCE
*NSET, NSET=A, INSTANCE=I, GENERATE
1, 4, 1
*TIE, NAME=T
I.S, J.S
*COUPLING, REF NODE=I.1, SURFACE=J.S, CONSTRAINT NAME=C
*DISTRIBUTING
1, 6
*MPC
BEAM, I.1, J.1
*EQUATION
2
I.1, 1, 1., J.2, 2, -1.
*RIGID BODY, NSET=A, REF NODE=J.3
*BOUNDARY
A, 1, 3
*STEP
*STATIC
*DLOAD
J.E, P1, 2.
*END STEP
"""


def seeds():
    texts = [EXTRA]
    for path in sorted(glob.glob(os.path.join(HERE, "..", "..", "examples", "decks", "*.inp"))):
        with open(path, encoding="utf-8") as file:
            lines = file.read().split("\n")
        # of the long lists some lines are enough: what is damaged is to be read often
        texts.append("\n".join(line for i, line in enumerate(lines) if i < 40 or not line[:1].isdigit() or i % 40 < 2))
    for path in sorted(glob.glob(os.path.join(HERE, "broken_decks", "*.inp"))):
        with open(path, encoding="utf-8") as file:
            texts.append(file.read())
    return texts


def damaged(text, chance):
    """A text with some places changed."""
    for _ in range(chance.choice((1, 1, 2, 3, 8))):
        at = chance.randrange(len(text) + 1)
        kind = chance.randrange(5)
        if kind == 0:
            text = text[:at] + chance.choice(PIECES) + text[at:]
        elif kind == 1:
            text = text[:at] + text[at + chance.choice((1, 1, 5, 40)):]
        elif kind == 2:
            text = text[:at] + chance.choice(PIECES) + text[at + 1:]
        elif kind == 3:  # a line elsewhere
            lines = text.split("\n")
            lines.insert(chance.randrange(len(lines)), lines.pop(chance.randrange(len(lines))))
            text = "\n".join(lines)
        else:
            text = text[:at] if chance.random() < 0.2 else re.sub(r"\d+", lambda m: chance.choice((m.group(), "7")), text[:200]) + text[200:]
    return text


def fuzz(seconds, seed):
    """(decks read, decks refused). Any other exception comes out, with the deck that made it left in the folder it names."""
    chance, texts, end = random.Random(seed), seeds(), time.monotonic() + seconds
    folder, counts = tempfile.mkdtemp(), [0, 0]
    path = os.path.join(folder, "fuzzed.inp")
    while time.monotonic() < end:
        with open(path, "w", encoding="utf-8", newline="") as file:
            file.write(damaged(chance.choice(texts), chance))
        begin = time.monotonic()
        try:
            read_deck(path)
            counts[0] += 1
        except FileError as error:
            counts[1] += 1
            if not (error.file and error.text and error.line >= 0):
                raise AssertionError(f"{path}: a refusal without file or words: {error!r}") from error
        except BaseException as error:
            raise AssertionError(f"{path}: {error!r}") from error
        if time.monotonic() - begin > 5:
            raise AssertionError(f"{path}: took {time.monotonic() - begin:.1f} s")
    shutil.rmtree(folder)
    return counts


class Broken(unittest.TestCase):
    def test_each_is_refused_with_its_line(self):
        """The first line of each file says on which line and in which words."""
        paths = sorted(glob.glob(os.path.join(HERE, "broken_decks", "*.inp")))
        self.assertGreater(len(paths), 50)
        for path in paths:
            with self.subTest(os.path.basename(path)), open(path, encoding="utf-8") as file:
                line, words = re.match(r"\*\* refused on line (\d+): (.*)", file.readline()).groups()
                with self.assertRaisesRegex(FileError, words) as caught:
                    read_deck(path)
                self.assertEqual(caught.exception.line, int(line))
                self.assertEqual(os.path.basename(caught.exception.file), os.path.basename(path))

    def test_no_file(self):
        with self.assertRaisesRegex(FileError, "cannot be read"):
            read_deck(os.path.join(HERE, "broken_decks", "nowhere.inp"))

    def test_damage_by_chance(self):
        read, refused = fuzz(3, 48)
        self.assertGreater(min(read, refused), 20)


if __name__ == "__main__":
    if len(sys.argv) > 1 and sys.argv[1].isdigit():
        print("read {}, refused {}".format(*fuzz(float(sys.argv[1]), int(sys.argv[2]) if len(sys.argv) > 2 else 0)))
    else:
        unittest.main()
