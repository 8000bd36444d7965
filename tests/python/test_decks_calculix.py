"""What CalculiX is given to make the matrices of a deck: numbers that fit its cards, point masses that it would leave out, errors in
words. Measured against closed forms and CalculiX's own frequencies."""
import math
import os
import random
import sys

import numpy

import calculix_runs
from plm.fe import FileError, read_deck
from plm.fe.deck_calculix import card_number

sys.path.insert(0, calculix_runs.DECKS)
from bricks import STEEL, Block, box, labels  # noqa: E402

BAR = Block((6, 1, 1), box((0, 0, 0), (12, 1, 1)))
ROOT = labels("ROOT", "NSET", [BAR.node(0, j, k) for j in (0, 1) for k in (0, 1)]) + ["*BOUNDARY", "ROOT, 1, 3"]
END = [BAR.node(6, j, k) for j in (0, 1) for k in (0, 1)]
SECTION = [*STEEL, "*SOLID SECTION, ELSET=BAR, MATERIAL=STEEL"]


class Calculix(calculix_runs.Case):
    def deck(self, lines):
        path = os.path.join(self.folder, "deck.inp")
        with open(path, "w", encoding="ascii") as file:
            file.write("\n".join(lines) + "\n")
        return read_deck(path)

    def modes_of(self, lines, n=6):
        deck = self.deck(lines)
        self.assertEqual(deck.unread, [])
        return deck.model().modes(n)

    def test_numbers_fit_their_cards(self):
        """Of 20 characters, and right to 14 digits: a double has 15.9, signs and exponents take up to 7 characters."""
        draw = random.Random(1)
        values = [draw.choice((-1, 1)) * draw.uniform(1, 10) * 10.0**draw.randint(-98, 98) for _ in range(5000)]
        for value in [0.0, 3.0616169978699998e-16, -1.234567890123456e-10, 1.2345678901234567e-05, *values]:
            text = card_number(value)
            self.assertLessEqual(len(text), 20)
            self.assertTrue(math.isclose(float(text), value, rel_tol=1e-13), text)

    def test_small_coordinates(self):
        """A bar in coordinates with all their digits and an exponent, 1.2345678901234567e-05: its frequencies are those of the bar of
        length 1 by the scale. 1e-9: solvers, and the 14 digits that CalculiX writes."""
        scale, lines = 1.2345678901234567e-5, BAR.lines("BAR") + SECTION + ROOT
        small = self.deck(lines)
        small.coordinates *= scale
        numpy.testing.assert_allclose(small.model().modes(6) * scale, self.modes_of(lines), rtol=1e-9)

    def test_coordinates_next_to_nothing(self):
        """The sine of pi of a mesh tool, where a zero is meant."""
        lines = BAR.lines("BAR")
        at = next(i for i, line in enumerate(lines) if line.startswith(f"{BAR.node(0, 0, 0)},"))
        there = lines[:at] + [f"{BAR.node(0, 0, 0)}, 1.2246467991473532e-16, 0., -1.234567890123456e-17"] + lines[at + 1:]
        numpy.testing.assert_allclose(self.modes_of(there + SECTION + ROOT), self.modes_of(lines + SECTION + ROOT), rtol=1e-9)

    def test_mass_at_a_coupling(self):
        """A mass at the reference of a distributing coupling, at no solid, and one at a node of the bar: CalculiX has the first in
        its own modes and not in the matrices that it writes. Seven digits are printed."""
        lines = (BAR.lines("BAR") + ["*NODE", "901, 12., 0.5, 0.5", "*ELEMENT, TYPE=MASS, ELSET=LUMP", "901, 901",
                                     "*ELEMENT, TYPE=MASS, ELSET=SMALL", f"903, {BAR.node(3, 0, 0)}",
                                     "*MASS, ELSET=LUMP", "3e-8", "*MASS, ELSET=SMALL", "1e-8",
                                     "*ELEMENT, TYPE=DCOUP3D, ELSET=SPREAD", "902, 901", "*DISTRIBUTING COUPLING, ELSET=SPREAD"]
                 + [f"{node}, 1." for node in END] + SECTION + ROOT)
        numpy.testing.assert_allclose(self.modes_of(lines, 4), self.frequencies(lines, 10)[:4], rtol=1e-6)

    def test_two_masses_of_one_node_add_up(self):
        """What a mass adds to the sum of the mass matrix is itself in each direction, exactly."""
        lines = BAR.lines("BAR") + ["*NODE", "901, 12., 0.5, 0.5", "*ELEMENT, TYPE=MASS, ELSET=LUMP", "901, 901", "902, 901",
                                    "*MASS, ELSET=LUMP", "3e-8"] + SECTION
        found = self.deck(lines).matrices_by_calculix()
        rows = found.rows(numpy.array([901] * 3), numpy.array([1, 2, 3]))
        self.assertEqual(found.mass[rows][:, rows].toarray().tolist(), (6e-8 * numpy.eye(3)).tolist())
        self.assertEqual(found.stiffness[rows].nnz, 0)

    def test_wrong_masses(self):
        base = BAR.lines("BAR") + ["*ELEMENT, TYPE=MASS, ELSET=LUMP", f"901, {END[0]}"] + SECTION
        for more, words in ((["*MASS, ELSET=LUMP", "-1."], "below 0"), (["*MASS, ELSET=LUMP"], "without a number"), ([], "element 901"),
                            (["*MASS, ELSET=LUMP, TYPE=ANISOTROPIC", "1., 2., 3."], "ANISOTROPIC")):
            with self.assertRaisesRegex(FileError, words):
                self.deck(base + more).matrices_by_calculix()

    def test_sets_without_nodes_are_listed(self):
        """A support or load of an empty set does nothing, which is not what its writer thinks."""
        deck = self.deck(BAR.lines("BAR") + ["*NSET, NSET=NOBODY", "*ELSET, ELSET=NOTHING", "*BOUNDARY", "NOBODY, 1, 3", "*STEP", "*STATIC",
                                             "*CLOAD", "NOBODY, 1, 5.", "*DLOAD", "NOTHING, P1, 5.", "*END STEP"])
        at = len(BAR.lines("BAR"))
        self.assertEqual([(line, text.split(",")[0]) for _, line, text in deck.unread],
                         [(at + 4, "*BOUNDARY: the set 'NOBODY' has no nodes"), (at + 8, "*CLOAD: the set 'NOBODY' has no nodes"),
                          (at + 10, "*DLOAD: the set 'NOTHING' has no elements")])

    def test_names_with_blanks_and_long_ones(self):
        """Quoted, in other cases, of more than the eighty letters that CalculiX reads, the section before what it names: one and the
        same bar. Axes along those of the whole change nothing of a bar that is alike in all directions."""
        usual = self.modes_of(BAR.lines("BAR") + SECTION + ROOT)
        for name in ('"carbon steel"', "M" * 100):
            material = [STEEL[0].replace("STEEL", name), *STEEL[1:]]
            section = [f"*SOLID SECTION, ELSET=BAR, MATERIAL={name.upper()}, ORIENTATION=\"my axes\""]
            axes = ['*ORIENTATION, SYSTEM=RECTANGULAR, NAME="My Axes"', "1., 0., 0., 0., 1., 0."]
            numpy.testing.assert_array_equal(self.modes_of(BAR.lines("BAR") + section + material + axes + ROOT), usual)
        for wrong in (SECTION[-1].replace("=STEEL", "=STEAL"), SECTION[-1] + ", ORIENTATION=NONE"):
            lines = BAR.lines("BAR") + STEEL + [wrong]
            with self.assertRaisesRegex(FileError, rf"deck.inp:{len(lines)}: there is no \*(MATERIAL|ORIENTATION) of the name (STEAL|NONE)"):
                self.deck(lines).matrices_by_calculix()

    def test_axes_that_turn_with_their_instance(self):
        """They would have to be turned: refused with the line."""
        part = ["*PART, NAME=P", *BAR.lines("BAR"), "*ORIENTATION, NAME=O", "1., 0., 0., 0., 1., 0.",
                "*SOLID SECTION, ELSET=BAR, MATERIAL=STEEL, ORIENTATION=O", "*END PART", "*INSTANCE, NAME=I, PART=P"]
        for turn, is_refused in ((["1., 0., 0."], False), (["0., 0., 0.", "0., 0., 0., 0., 0., 1., 90."], True)):
            deck = self.deck([*part, *turn, "*END INSTANCE", *STEEL])
            if is_refused:
                with self.assertRaisesRegex(FileError, rf":{len(BAR.lines('BAR')) + 2}: .ORIENTATION in an instance that is turned"):
                    deck.matrices_by_calculix()
            else:
                deck.matrices_by_calculix()

    def test_its_errors_say_where(self):
        """CalculiX tells the element on the line below its error."""
        lines = BAR.lines("BAR") + SECTION
        at = next(i for i, line in enumerate(lines) if line.upper().startswith("*ELEMENT")) + 1
        label, *nodes = [int(field) for field in lines[at].replace(" ", "").strip(",").split(",")]
        lines[at] = ", ".join(map(str, [label, *nodes[4:], *nodes[:4]]))  # upside down
        with self.assertRaisesRegex(FileError, rf"nonpositive jacobian.*element +{label}\b"):
            self.deck(lines).matrices_by_calculix()


if __name__ == "__main__":
    calculix_runs.main()
