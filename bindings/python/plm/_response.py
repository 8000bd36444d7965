"""Hbm and Branch: the periodic response."""
import ctypes
from typing import NamedTuple

import numpy

from . import _c
from ._context import status_text
from ._handle import Handle, address
from ._model import choice

MEASURES = {"peak": _c.PEAK, "half_peak_to_peak": _c.HALF_PEAK_TO_PEAK, "rms": _c.RMS, "harmonic": _c.HARMONIC}


class Peak(NamedTuple):
    """The highest point of a curve; branch: that point."""
    frequency_hz: float
    amplitude: float
    branch: "Branch"


class Contact(NamedTuple):
    """Contact over the cycle, each n_pairs x n_times; time: fraction of the period."""
    time: numpy.ndarray
    penetration: numpy.ndarray
    force: numpy.ndarray
    closed: numpy.ndarray


class Hbm(Handle, noun="hbm", kind=_c.KIND_HBM):
    """Harmonic balance with continuation.

    Hbm(basis, **options), e.g. Hbm(basis, n_harmonics=7).sweep()
    """

    def __init__(self, basis, **options):
        super().__init__(basis.context)
        self._basis = basis
        self.context.call("plm_hbm_create", basis._h, ctypes.byref(self._h))
        self.set_options(options)

    def sweep(self, progress=None):
        """The response curve over [frequency_min_hz, frequency_max_hz], through its folds. See Branch.status for how it
        ended. After Ctrl-C the KeyboardInterrupt has the points found so far as its attribute `branch`."""
        branch = Branch(self)
        return self._deliver("sweep", branch, ctypes.byref(branch._h), progress=progress)

    def solve(self, frequency_hz, start=None, point=0, progress=None):
        """The response at one frequency, from a point of the branch `start` or from rest."""
        branch = Branch(self)
        return self._deliver("solve", branch, frequency_hz, start._h if start is not None else None, point,
                             ctypes.byref(branch._h), progress=progress)

    def find_peak(self, branch, dof, measure="half_peak_to_peak", harmonic=0, progress=None):
        """The highest amplitude of a DOF on the exact curve."""
        hz, amplitude, top = ctypes.c_double(), ctypes.c_double(), Branch(self)
        self._deliver("find_peak", top, branch._h, dof, choice(measure, MEASURES, "measure"), harmonic,
                      ctypes.byref(hz), ctypes.byref(amplitude), ctypes.byref(top._h), progress=progress)
        return Peak(hz.value, amplitude.value, top)

    def _deliver(self, verb, branch, *arguments, progress):
        name = f"plm_hbm_{verb}"
        status = self.context.run(name, self._h, *arguments, progress=progress)
        branch._status = status
        try:
            self.context.finish(name, status, has_result=bool(branch._h))
        except KeyboardInterrupt as interrupt:
            interrupt.branch = branch if branch._h else None
            raise
        return branch


class Branch(Handle, noun="branch", kind=_c.KIND_BRANCH):
    """Points of a response curve, read-only; made by Hbm."""

    def __init__(self, hbm):
        super().__init__(hbm.context)
        self._status = _c.OK

    def __len__(self):
        return self.n_points

    @property
    def status(self):
        """plm.OK, NOT_CONVERGED, TRUNCATED or CANCELLED, as the call that made it returned."""
        return self._status

    @property
    def status_text(self):
        """The same in words."""
        return status_text(self._status)

    def amplitude(self, dof, measure="half_peak_to_peak", harmonic=0):
        """Amplitude of a DOF at every point. measure: "peak", "half_peak_to_peak", "rms", "harmonic"."""
        count = ctypes.c_int64(self.n_points)
        values = numpy.empty(count.value)
        self._call("get_amplitude", dof, choice(measure, MEASURES, "measure"), harmonic, count.value, address(values),
                   ctypes.byref(count))
        return values

    def coefficients(self, point, dof=None):
        """Fourier coefficients a0, a1, b1, ..., aH, bH: 2H + 1 of one DOF, or (2H + 1) x n_dof of all."""
        point = self._from_end(point)
        first, n = (0, self.n_dof) if dof is None else (dof, 1)
        values = numpy.empty((2 * self.n_harmonics + 1, n), order="F")
        self._call("get_coefficients", point, first, n, address(values))
        return values if dof is None else values[:, 0]

    def harmonics(self, point, dof):
        """Magnitude of the harmonics 0, 1, ..., H of a DOF (0: the mean, with its sign)."""
        c = self.coefficients(point, dof)
        return numpy.concatenate([c[:1], numpy.hypot(c[1::2], c[2::2])])

    def field(self, point, time_fraction=0.0):
        """All DOFs at a time, given as a fraction of the period."""
        q = numpy.empty(self.n_dof)
        self._call("get_field", self._from_end(point), time_fraction, q.size, address(q))
        return q

    def contact(self, point, n_times=128):
        """Penetration, force and status of every pair at n_times equidistant times of the period."""
        shape = (self.n_pairs, n_times)
        penetration, force = numpy.empty(shape, order="F"), numpy.empty(shape, order="F")
        closed = numpy.empty(shape, dtype=numpy.int32, order="F")
        self._call("get_contact", self._from_end(point), n_times, address(penetration), address(force), address(closed))
        return Contact(numpy.arange(n_times) / n_times, penetration, force, closed)

    def closed_share(self, point):
        """Share of the period during which each pair is closed."""
        share = numpy.empty(self.n_pairs)
        self._call("get_closed_share", self._from_end(point), share.size, address(share))
        return share

    def full_residual(self, point):
        """How well the recovered field satisfies the unreduced equations: relative residual."""
        value = ctypes.c_double()
        self._work("get_full_residual", self._from_end(point), ctypes.byref(value))
        return value.value

    def _from_end(self, point):
        """-1 is the last point."""
        return point + self.n_points if point < 0 else point

    def _n_pairs(self):
        return self.n_pairs
