"""Whole rings of 20-node bricks, one pressed into the other, ovalized in time: the peak on meshes that do not match against those
that do.
    python3 tests/python/rings.py [INSIDE OUTSIDE] ...
of so many elements around: 64 96  64 64  96 96 unless they are given. Both rings lie on beds of springs and are driven by a pressure
that varies smoothly around, so that nothing holds or drives single points of a mesh: meshes that match agree."""
import sys
import time

import numpy
import plm

from solids import Joined, Solid


def peak_of_rings(inside, outside):
    """Frequency and height at 45 degrees outside, by three harmonics."""
    def ring(low, high):
        return lambda x, y, z: ((low + (high - low) * z) * numpy.cos(x * 2 * numpy.pi), (low + (high - low) * z) * numpy.sin(x * 2 * numpy.pi), y / 10)
    one = Solid("brick20", (inside, 1, 1), ring(0.8, 1), closed=True)
    other = Solid("brick20", (outside, 1, 1), ring(1, 1.2), closed=True)
    one.bed(2, 0, 0.5)
    other.bed(2, -1, 0.5)
    two = Joined(one, other)
    two.hold(range(len(two.xyz)), 2)
    two.model.set_preload(two.loads(one.pressure(2, 0, 0.1)))
    x, y = other.xyz[:, 0], other.xyz[:, 1]
    two.model.set_excitation(two.loads(other=0.012 / 1.44 * (x**2 - y**2)[:, None] * other.pressure(2, -1)))
    two.touch((2, -1), (2, 0), 100.0, 1e-6, turned=True)
    two.model.set_modal_damping(0.01)
    basis = plm.Basis(two.model.build(), plm.Sampler(two.model).run()).build()
    hbm = plm.Hbm(basis, motion="harmonics", n_harmonics=3, stability="off")
    curve = hbm.sweep()
    at = two.dof[two.node(*(1.2 * numpy.cos(numpy.pi / 4),) * 2, 0), 0]
    peak = hbm.find_peak(curve, at)
    return peak.frequency_hz, peak.amplitude, int(curve.n_switching.max())


if __name__ == "__main__":
    given = [int(n) for n in sys.argv[1:]] or [64, 96, 64, 64, 96, 96]
    first = None
    for inside, outside in zip(given[::2], given[1::2]):
        begin = time.process_time()
        frequency, height, switching = peak_of_rings(inside, outside)
        first = first or (frequency, height)
        print(f"{inside} against {outside}: {frequency:.7g} Hz, {height:.7g}, {switching} pairs open and close; from this the first differs "
              f"by {first[0] / frequency - 1:.1e} and {first[1] / height - 1:.1e} ({time.process_time() - begin:.0f} s)", flush=True)
