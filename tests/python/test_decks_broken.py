"""Decks that are wrong are refused with their file and line; decks damaged by chance make no other exception and end soon.

    test_decks_broken.py [SECONDS [SEED]]     for longer, see fuzzing.py
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

from fuzzing import seconds_and_seed

HERE = os.path.dirname(os.path.abspath(__file__))
SECONDS, SEED = seconds_and_seed(0.0, 48)
PIECES = ["*", "**", ",", "=", "\n", '"', "'", "-1", "0", "1e308", "nan", "99999999999999999999", "1.5", " ",
          "\t", "\0", "ü", "*STEP\n", "*END STEP\n",
          "*INCLUDE, INPUT=", "GENERATE", "E", "S1", "ALL", ".", "*NODE\n",
          "*PART, NAME=P\n", "*END PART\n", "1,", "*EQUATION\n", "_"]
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


FLAT = """*HEADING
two cubes
*NODE, NSET=ALL
1, 0., 0., 0.
2, 1., 0., 0.
3, 1., 1., 0.
4, 0., 1., 0.
5, 0., 0., 1.
6, 1., 0., 1.
7, 1., 1., 1.
8, 0., 1., 1.
9, 0., 0., 2.
10, 1., 0., 2.
11, 1., 1., 2.
12, 0., 1., 2.
13, 0., 0., 1.
14, 1., 0., 1.
15, 1., 1., 1.
16, 0., 1., 1.
20, .5, .5, 2.
*ELEMENT, TYPE=C3D8, ELSET=LOW
1, 1,2,3,4,5,6,7,8
*ELEMENT, TYPE=C3D8, ELSET=HIGH
2, 13,14,15,16,
9,10,11,12
*ELEMENT, TYPE=DCOUP3D, ELSET=REF
3, 20
*ELSET, ELSET="both of them"
LOW, HIGH
*NSET, NSET=BASE, GENERATE
1, 4
*NSET, NSET=TOP, ELSET=HIGH
*SURFACE, NAME=A, TYPE=ELEMENT
LOW, S2
*SURFACE, NAME=B
HIGH, S1
*SURFACE, NAME=C, TYPE=NODE
TOP, 0.25
*DISTRIBUTING COUPLING, ELSET=REF
9, 1.
10, 2.5
11, 1.
*MATERIAL, NAME=M
*ELASTIC
210000., .3
*DENSITY
7.8e-9
*DAMPING, ALPHA=1., BETA=1e-5
*SOLID SECTION, ELSET="both of them", MATERIAL=M
*SURFACE INTERACTION, NAME=I
*SURFACE BEHAVIOR, PRESSURE-OVERCLOSURE=LINEAR
1000.
*CONTACT PAIR, INTERACTION=I, TYPE=NODE TO SURFACE, ADJUST=0.1
B, A
*CLEARANCE, SLAVE=B, MASTER=A, VALUE=0.01
*BOUNDARY
BASE, ENCASTRE
9, 1, 2
*STEP, NAME=PRESS
*STATIC
*CLOAD, OP=NEW
TOP, 3, -2.
*DLOAD
LOW, P2, 1.
HIGH, GRAV, 9810., 0., 0., -1.
*DSLOAD
A, P, 2.
*END STEP
*STEP
*STEADY STATE DYNAMICS
1., 100.
*MODAL DAMPING
1, 10, 0.01
*CLOAD, LOAD CASE=2
20, 1, 3.
*NODE PRINT, NSET=ALL
U
*END STEP
"""


def seeds():
    """Mostly decks that are right, so that what is damaged gets far."""
    texts = [FLAT, EXTRA] * 20
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
            text = text[:at] if chance.random() < 0.2 else re.sub(r"\d+", lambda m: chance.choice((m.group(), "7")),
                                                                  text[:200]) + text[200:]
    return text


def fuzz(seconds, seed, least=300):
    """(decks read, decks refused) in these seconds, or of the least number of decks. Any other exception comes out, with the deck that made it left in the folder it names."""
    chance, texts, end = random.Random(seed), seeds(), time.monotonic() + seconds
    folder, counts = tempfile.mkdtemp(), [0, 0]
    path = os.path.join(folder, "fuzzed.inp")
    while time.monotonic() < end or sum(counts) < least:
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
        for text in (FLAT, EXTRA):
            with tempfile.NamedTemporaryFile("w", suffix=".inp") as file:
                file.write(text)
                file.flush()
                self.assertLess(len(read_deck(file.name).unread), 2)  # weight of a part of the elements
        read, refused = fuzz(SECONDS, SEED)
        print(f"{read} damaged decks read, {refused} refused")
        self.assertGreater(min(read, refused), 10)


if __name__ == "__main__":
    unittest.main(argv=sys.argv[:1])
