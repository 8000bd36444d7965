"""Natural frequencies of the decks of examples/decks by deck.model() and by CalculiX itself, without contact."""
import os

import numpy

import calculix_runs
from plm.fe import read_deck


class Frequencies(calculix_runs.Case):
    def compare(self, name, n, n_rigid):
        model = read_deck(os.path.join(calculix_runs.DECKS, name + ".inp")).model()
        self.assertEqual(model.n_rigid_modes, n_rigid)
        want = self.frequencies(self.on_mesh(name), n)[n_rigid:]
        self.assertGreaterEqual(len(want), n - n_rigid)
        # printed with seven digits, 5e-7 of the smallest mantissa; half of those asked for, the others Lanczos has not finished
        half = len(want) // 2
        numpy.testing.assert_allclose(model.modes(n_rigid + half)[n_rigid:], want[:half], rtol=1e-6)

    def test_plate(self):
        self.compare("cracked_plate", 20, 0)

    def test_blade(self):
        self.compare("blade_casing", 20, 0)

    def test_joint(self):
        self.compare("lap_joint", 26, 6)

    def test_joint_that_does_not_match(self):
        self.compare("lap_joint_nonmatching", 26, 6)


if __name__ == "__main__":
    calculix_runs.main()
