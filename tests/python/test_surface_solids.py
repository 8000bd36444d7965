"""Contact between surfaces of solids, linear and quadratic: patch tests, cylinders against Lame, peaks, forces at rest."""
import unittest
import warnings

import numpy
import plm

from solids import Joined, Solid

KINDS = "brick8", "tetra4", "brick20", "tetra10"
SCHEMES = {"nodes": {}, "points": {"points": True}, "symmetric": {"symmetric": True},
           "symmetric points": {"symmetric": True, "points": True}}


def blocks(kind, below, above):
    """One on the other, held below in z, along the sides nowhere, 3 x 2 x 1 each, Poisson's number 0."""
    two = Joined(*(Solid(kind, cells, lambda x, y, z: (3 * x, 2 * y, z + up), poisson=0) for cells, up in ((below, 0), (above, 1))))
    two.hold(two.one.nodes(2, 0), 2)
    for z, nodes in ((0, two.dof[:two.n, 0] // 3), (1, two.dof[two.n:, 0] // 3)):
        near = lambda *at: nodes[numpy.argmin(abs(two.xyz[nodes] - at).sum(1)), None]
        two.hold(near(0, 0, z), 0, 1)
        two.hold(near(3, 0, z), 1)
    return two


def rings(kind, inside, outside, pressure, interference=0.0, **options):
    """A quarter of one in the other, radii 0.8, 1 and 1.2, plane strain, at rest under a pressure inside."""
    def quarter(low, high):
        return lambda x, y, z: ((low + (high - low) * z) * numpy.cos(x * numpy.pi / 2), (low + (high - low) * z) * numpy.sin(x * numpy.pi / 2), y / 10)
    two = Joined(Solid(kind, (inside, 1, 2), quarter(0.8, 1 + interference)), Solid(kind, (outside, 1, 2), quarter(1, 1.2)))
    two.hold(range(len(two.xyz)), 2)
    two.hold(two.sides(0, 0), 1)
    two.hold(two.sides(0, -1), 0)
    two.model.set_preload(two.loads(two.one.pressure(2, 0, pressure)))
    two.touch((2, -1), (2, 0), 2e3, 2e-3, turned=True, **options)
    two.model.build().solve_rest()
    return two


def lame(pressure, interference, spring, modulus=100, poisson=0.3):
    """Pressure between the rings, with a layer of springs between."""
    def outwards(a, b, inside, outside):  # displacement of r = 1
        A, C = (inside * a**2 - outside * b**2) / (b**2 - a**2), (inside - outside) * a**2 * b**2 / (b**2 - a**2)
        return (1 + poisson) / modulus * ((1 - 2 * poisson) * A + C)
    misfit = [outwards(0.8, 1, pressure, p) - outwards(1, 1.2, p, 0) + interference - p / spring for p in (0, 1)]
    return misfit[0] / (misfit[0] - misfit[1])


def arch(inside, outside):
    """Half rings of 20-node bricks, clamped at both ends and pressed together, shaken from outside: frequency and height of the
    peak at the top, by three harmonics on either mesh."""
    def half(low, high):
        return lambda x, y, z: ((low + (high - low) * z) * numpy.cos(x * numpy.pi), (low + (high - low) * z) * numpy.sin(x * numpy.pi), y / 10)
    two = Joined(Solid("brick20", (inside, 1, 1), half(0.8, 1)), Solid("brick20", (outside, 1, 1), half(1, 1.2)))
    two.hold(range(len(two.xyz)), 2)
    two.hold(numpy.concatenate([two.sides(0, 0), two.sides(0, -1)]), 0, 1)
    two.model.set_preload(two.loads(two.one.pressure(2, 0, 0.1)))
    ring = two.other.pressure(2, -1)
    x, y = two.other.xyz[:, 0], two.other.xyz[:, 1]
    two.model.set_excitation(two.loads(other=3.6e-3 / 1.44 * (x**2 - y**2)[:, None] * ring))
    two.touch((2, -1), (2, 0), 100.0, 1e-6, turned=True)
    two.model.set_modal_damping(0.01)
    basis = plm.Basis(two.model.build(), plm.Sampler(two.model).run()).build()
    hbm = plm.Hbm(basis, motion="harmonics", n_harmonics=3, stability="off")
    curve = hbm.sweep()
    peak = hbm.find_peak(curve, two.dof[two.node(0, 1.2, 0), 1])
    return peak.frequency_hz, peak.amplitude


class SurfacesOfSolids(unittest.TestCase):
    def patch(self, kind, below, above, **options):
        """Largest errors of the pressure of pairs, and of the displacement of the top, under a uniform pressure of 1."""
        two, spring = blocks(kind, below, above), 1e4
        two.model.set_preload(two.loads(other=two.other.pressure(2, -1)))
        two.touch((2, -1), (2, 0), spring, 1e-6, **options)
        with warnings.catch_warnings():
            warnings.simplefilter("error", plm.PlmWarning)
            two.model.build().solve_rest()
        numpy.testing.assert_allclose(two.model.rest_force.sum(), 6, rtol=1e-12)
        top = two.model.rest_displacement.reshape(-1, 3)[two.n + two.other.nodes(2, -1), 2]
        pressure = two.model.rest_force / two.areas(options.get("symmetric"))
        return abs(pressure - 1).max(), abs(top / -(2 / 100 + 1 / spring) - 1).max()

    def test_patch_of_matching_meshes(self):
        """Exact with nothing set, whatever the elements; faces with middle nodes take points by themselves. So are displacements,
        though nothing holds the upper block but contact."""
        for kind in KINDS:
            for options in {}, {"points": True}, {"symmetric": True, "points": True}:
                pressure, top = self.patch(kind, (3, 2, 2), (3, 2, 2), **options)
                self.assertLess(pressure, 1e-9)
                self.assertLess(top, 1e-10)

    def test_patch_of_others(self):
        """3 x 2 against 5 x 3 cells: at most a third more than what was found, so that these are the errors of the schemes. Nodes
        carry shares of their own that the other side cannot; with points the displacements are right to parts of a thousand."""
        found = {  # pressure, displacement of the top
            "nodes": {"brick8": (0.117, 0.063), "tetra4": (0.172, 0.055), "brick20": (0.31, 0.0018), "tetra10": (0.174, 0.0014)},
            "points": {"brick8": (0.128, 0.003), "tetra4": (0.127, 0.0028), "brick20": (0.31, 0.0018), "tetra10": (0.174, 0.0014)},
            "symmetric": {"brick8": (0.672, 0.0076), "tetra4": (0.96, 0.01), "brick20": (0.383, 0.0011), "tetra10": (0.535, 0.0008)},
            "symmetric points": {"brick8": (0.147, 0.0025), "tetra4": (0.187, 0.0014), "brick20": (0.383, 0.0011),
                                 "tetra10": (0.535, 0.0008)}}
        for name, of_kind in found.items():
            for kind, errors in of_kind.items():
                for got, was in zip(self.patch(kind, (3, 2, 2), (5, 3, 2), **SCHEMES[name]), errors):
                    self.assertLess(got, 4 / 3 * was, (name, kind))

    def curved(self, kind, pressure, interference=0.0, **options):
        """16 faces around a quarter against 24, as 64 against 96: errors of the mean, and of each pair by their mean square."""
        two = rings(kind, 16, 24, pressure, interference, **options)
        got = two.model.rest_force / two.areas() / lame(pressure, interference, 2e3)
        return abs(two.model.rest_force.sum() / two.areas().sum() / lame(pressure, interference, 2e3) - 1), ((got - 1)**2).mean()**0.5

    def test_patch_of_cylinders(self):
        """A pressure inside, against Lame's: gaps of facets are `closed`. Bricks of 8 nodes are 16 around: 1.6e-3 of the mean are theirs."""
        for kind, options, mean, each in (("brick8", {}, 2.5e-3, 0.16), ("brick8", {"points": True}, 1.5e-3, 5e-3),
                                          ("brick20", {}, 5e-5, 8e-3), ("tetra10", {}, 1.2e-3, 0.016)):
            got = self.curved(kind, 1.0, **options)
            self.assertLess(got[0], mean, (kind, options))
            self.assertLess(got[1], each, (kind, options))

    def test_press_fit(self):
        """0.5 % of the radius, against Lame's, whose geometry is as much off. Faces of 4 nodes cut off a fifth of that, which stiff
        springs turn into pressure: they need smooth surfaces, and then are as good as under a pressure."""
        for kind, options, mean, each in (("brick8", {"smooth": True}, 8e-3, 0.16), ("brick8", {"smooth": True, "points": True}, 8e-3, 0.02),
                                          ("brick20", {}, 7e-3, 0.012), ("tetra10", {}, 7e-3, 0.02)):
            got = self.curved(kind, 0.0, 5e-3, **options)
            self.assertLess(got[0], mean, (kind, options))
            self.assertLess(got[1], each, (kind, options))
        self.assertGreater(self.curved("brick8", 0.0, 5e-3)[1], 0.5)

    def test_peak_of_rings(self):
        """As 64 against 96 elements around: the peak, of motions that open, is that of meshes that match to 0.5 %. Whole rings:
        rings.py."""
        frequency, height = arch(32, 48)
        for same in (32, 48):
            other = arch(same, same)
            self.assertLess(abs(height / other[1] - 1), 5e-3)
            self.assertLess(abs(frequency / other[0] - 1), 2e-3)

    def test_force_at_rest(self):
        """Given forces are those at rest, to the last digit, for k_n over nine decades, and after both changed."""
        settled = blocks("brick8", (3, 2, 2), (5, 3, 2))
        settled.model.set_preload(settled.loads(other=settled.other.pressure(2, -1)))
        settled.touch((2, -1), (2, 0), 300.0, 1e-6)
        force = settled.model.build().solve_rest().rest_force
        for spring in 10.0**numpy.arange(-2, 7):
            two = blocks("brick8", (3, 2, 2), (5, 3, 2))
            press = two.loads(other=two.other.pressure(2, -1))
            two.model.set_preload(press)
            two.touch((2, -1), (2, 0), spring, 1e-6)
            two.model.set_rest_force(force)
            numpy.testing.assert_array_equal(two.model.build().solve_rest().rest_force, force)
            with self.assertRaisesRegex(plm.PlmError, "remove the forces by NULL, set the pre-load, then the new forces"):
                two.model.set_preload(2 * press)
            two.model.set_rest_force(None)
            two.model.set_preload(2 * press)
            two.model.set_rest_force(2 * force)
            numpy.testing.assert_array_equal(two.model.solve_rest().rest_force, 2 * force)

    def test_lap_joint(self):
        """Two plates that bolts press together, free to slide: across that the pre-load has no terms but rounding, and it rests;
        the resultant goes through the middle of the bolts."""
        for kind, cells in ("brick8", (12, 4, 1)), ("brick8", (18, 5, 1)), ("brick20", (9, 4, 1)), ("tetra10", (9, 4, 1)):
            two = Joined(Solid(kind, (12, 4, 1), lambda x, y, z: (6 * x, 2 * y, 0.3 * z), modulus=1000),
                         Solid(kind, cells, lambda x, y, z: (4 + 6 * x, 2 * y, 0.3 + 0.3 * z), modulus=1000))
            two.hold(two.one.nodes(0, 0), 0, 1, 2)
            bolts = numpy.zeros_like(two.xyz)
            for x, y in (4.5, 0.5), (4.5, 1.5), (5.5, 0.5), (5.5, 1.5):
                bolts[two.n + numpy.argmin(abs(two.other.xyz - [x, y, 0.6]).sum(1)), 2] -= 1
                bolts[numpy.argmin(abs(two.one.xyz - [x, y, 0]).sum(1)), 2] += 1
            two.model.set_preload(bolts.ravel())
            two.touch((2, -1), (2, 0), 1e4, 1e-6)
            with warnings.catch_warnings():
                warnings.simplefilter("error", plm.PlmWarning)
                two.model.build().solve_rest()
            force = two.model.rest_force
            self.assertLess(abs(force.sum() / 4 - 1), 1e-11)
            if kind == "brick8":
                at = two.other.xyz[two.model.surface_point[two.model.surface_pair >= 0]]
                numpy.testing.assert_allclose(force @ at[:, :2], -bolts[two.n:, 2] @ two.other.xyz[:, :2], rtol=1e-9)

    def test_twins(self):
        """Nodes that face each other find each other from both sides: one pair of the whole stiffness, which both points name."""
        made = []
        for symmetric in False, True:
            two = blocks("brick8", (3, 2, 2), (3, 2, 2))
            two.model.set_preload(two.loads(other=two.other.pressure(2, -1)))
            two.touch((2, -1), (2, 0), 1e4, 1e-6, symmetric=symmetric)
            two.model.build().solve_rest()
            made.append(two.model)
        self.assertEqual(made[1].n_pairs, 12)
        self.assertEqual(sorted(made[1].surface_pair), sorted(2 * list(range(12))))
        numpy.testing.assert_allclose(made[1].contact_stiffness, made[0].contact_stiffness, rtol=1e-13)
        numpy.testing.assert_allclose(made[1].rest_force, made[0].rest_force, rtol=1e-10)

    def test_what_is_left_out(self):
        """A master smaller than the slave, and nodes that are fixed on both sides."""
        two = Joined(Solid("brick8", (3, 2, 1), lambda x, y, z: (3 * x, 2 * y, z)), Solid("brick8", (6, 2, 1), lambda x, y, z: (6 * x, 2 * y, 1 + z)))
        two.hold(numpy.concatenate([two.one.nodes(0, 0), two.n + two.other.nodes(0, 0)]), 0, 1, 2)
        two.touch((2, -1), (2, 0), 50.0, 1e-6)
        self.assertEqual(two.model.n_pairs, 9)  # of 7 x 3: three are fixed, nine stand beside
        self.assertEqual(two.model.n_surface_alone, 9)
        self.assertRegex(two.model.surface_report, "9 pairs.* 9 have no face near them, and at 3 nothing can move")
        two.model.build()


if __name__ == "__main__":
    unittest.main()
