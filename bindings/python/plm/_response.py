"""Hbm and Branch: the periodic response."""
import ctypes
import os
from typing import NamedTuple

import numpy

from . import _c
from ._context import status_text
from ._handle import Handle, address, branch_array, context_of, handle_of, reals
from ._methods import BranchMethods, HbmMethods
from ._model import choice
from ._reduction import Basis

MEASURES = {"peak": _c.PEAK, "half_peak_to_peak": _c.HALF_PEAK_TO_PEAK, "rms": _c.RMS, "harmonic": _c.HARMONIC}

BIFURCATIONS = {_c.BIFURCATION_FOLD: "fold", _c.BIFURCATION_BRANCH_POINT: "branch point",
                _c.BIFURCATION_PERIOD_DOUBLING: "period doubling", _c.BIFURCATION_NEIMARK_SACKER: "Neimark-Sacker"}


class Peak(NamedTuple):
    """The highest point of a curve; branch: that point."""
    frequency_hz: float
    amplitude: float
    branch: "Branch"


class ErrorParts(NamedTuple):
    """Corrected less computed, by cause; total: their sum."""
    basis: float
    contact: float
    harmonics: float

    @property
    def total(self):
        return self.basis + self.contact + self.harmonics


class ErrorEstimate(NamedTuple):
    """How wrong a point is: ErrorParts of the amplitude of a DOF and of the frequency."""
    amplitude: ErrorParts
    frequency_hz: ErrorParts


class Isolated(NamedTuple):
    """A closed branch beside the main one; force_range: the force scales between which it exists, NaN where unknown."""
    branch: "Branch"
    force_range: tuple


class Bifurcation(NamedTuple):
    """A located point of a branch. kind: "fold", "branch point", "period doubling" or "Neimark-Sacker"."""
    point: int
    kind: str
    frequency_hz: float


class Energy(NamedTuple):
    """Means over the period: mechanical energy less that of the structure at rest, and the closed share of the pairs."""
    energy: float
    contact_area: float


class Refined(NamedTuple):
    """A basis made for a tolerance, and the error of reduction estimated on it."""
    basis: Basis
    error: float


class Larger(NamedTuple):
    """The highest stable motion known beside the curve of a Response at the same force; branch: the curve that it lies on;
    force_range: the force scales between which that exists, NaN where unknown."""
    frequency_hz: float
    amplitude: float
    branch: "Branch"
    force_range: tuple


class Response(NamedTuple):
    """Peak, curve and solver of Model.compute_response; error: relative, of the peak by the basis, estimated (NaN: not
    known)."""
    frequency_hz: float
    amplitude: float
    error: float
    curve: "Branch"
    hbm: "Hbm"

    def report(self):
        """The page of text of Branch.describe.

            print(model.compute_response(dof=12).report())
        """
        return self.curve.describe()

    @property
    def larger(self):
        """Larger(frequency_hz, amplitude, branch, force_range), where the curve is not all that the force allows, or None.
        To be read before other searches of hbm."""
        if not self.hbm.larger_amplitude > self.amplitude:
            return None
        beside = self.hbm._get_found(0)
        return Larger(self.hbm.larger_frequency_hz, self.hbm.larger_amplitude, *beside)


class Contact(NamedTuple):
    """Contact over the cycle, each n_pairs x n_times; time: fraction of the period."""
    time: numpy.ndarray
    penetration: numpy.ndarray
    force: numpy.ndarray
    closed: numpy.ndarray


class Hbm(HbmMethods, Handle, noun="hbm", kind=_c.KIND_HBM):
    """Harmonic balance with continuation.

    Hbm(basis, **options), e.g. Hbm(basis, n_harmonics=7).sweep()
    """

    def __init__(self, basis, **options):
        super().__init__(context_of(basis, "basis", "basis"))
        self._basis = basis
        self.context.call("plm_hbm_create", basis._h, ctypes.byref(self._h))
        self.set_options(options)

    @classmethod
    def _made_by(cls, model):
        """One of this model whose handle the library is about to fill."""
        hbm = cls.__new__(cls)
        Handle.__init__(hbm, model.context)
        hbm._basis = Basis._made_by(model)
        return hbm

    def sweep(self, progress=None):
        """The response curve over [frequency_min_hz, frequency_max_hz], through its folds. See Branch.status for how it
        ended. After Ctrl-C the KeyboardInterrupt has the points found so far as its attribute `branch`."""
        branch = Branch(self)
        return self._deliver("sweep", branch, ctypes.byref(branch._h), progress=progress)

    def save_every(self, n_points, path=None):
        """From now on sweep() and resume() write the curve to the file `path` after every n_points more points and at their
        end, as Branch.to_bytes() gives it; the file is replaced as a whole. 0: no longer."""
        self._call("save_every", n_points, None if path is None else os.fsencode(path))

    def resume(self, branch, progress=None):
        """Goes on with a curve that was cancelled (KeyboardInterrupt.branch), ended by "max_points" or for want of effort, or
        was saved on its way (save_every, Branch.from_bytes): the curve that sweep() would have returned, with the same
        points. With the options of the sweep; max_points alone may differ."""
        resumed = Branch(self)
        return self._deliver("resume", resumed, handle_of(branch, "branch", "branch"), ctypes.byref(resumed._h), progress=progress)

    def solve(self, frequency_hz, start=None, point=0, progress=None):
        """The response at one frequency, from a point of the branch `start` or from rest."""
        branch, first_guess = Branch(self), handle_of(start, "branch", "start", None)
        return self._deliver("solve", branch, frequency_hz, first_guess, point if start is None else start._from_end(point),
                             ctypes.byref(branch._h), progress=progress)

    def find_peak(self, branch, dof, measure="half_peak_to_peak", harmonic=0, progress=None):
        """The highest amplitude of a DOF on the exact curve."""
        hz, amplitude, top = ctypes.c_double(), ctypes.c_double(), Branch(self)
        self._deliver("find_peak", top, handle_of(branch, "branch", "branch"), dof, choice(measure, MEASURES, "measure"), harmonic,
                      ctypes.byref(hz), ctypes.byref(amplitude), ctypes.byref(top._h), progress=progress)
        return Peak(hz.value, amplitude.value, top)

    def estimate_error(self, branch, point, dof, measure="half_peak_to_peak", harmonic=0, progress=None):
        """ErrorEstimate(amplitude, frequency_hz) of a point without the unreduced solution: corrected less computed, by
        cause: .basis, .contact (contact sets), .harmonics, and .total; NaN where the steps do not contract, see
        `warning`."""
        amplitude, hz = numpy.empty(3), numpy.empty(3)
        self._work("estimate_error", handle_of(branch, "branch", "branch"), branch._from_end(point), dof,
                   choice(measure, MEASURES, "measure"), harmonic, address(amplitude), address(hz), progress=progress)
        return ErrorEstimate(ErrorParts(*amplitude.tolist()), ErrorParts(*hz.tolist()))

    def refine_basis(self, dof, tolerance, measure="half_peak_to_peak", harmonic=0, progress=None):
        """Refined(basis, error): a small basis, of kind "pod", on which the curve's error of reduction is estimated to be
        below `tolerance`, whatever the basis of this hbm. Where it cannot be reached, error says what is left."""
        refined, error = Basis._made_by(self._basis.model), ctypes.c_double()
        self._work("refine_basis", dof, choice(measure, MEASURES, "measure"), harmonic, tolerance, ctypes.byref(refined._h),
                   ctypes.byref(error), progress=progress)
        return Refined(refined, error.value)

    def switch_branch(self, branch, point, mirrored=False, progress=None):
        """The curve that crosses `branch` at a located branch point, or leaves it at a period doubling (with twice the
        period); see Branch.bifurcations. mirrored: on the other side."""
        other = Branch(self)
        return self._deliver("switch_branch", other, handle_of(branch, "branch", "branch"), branch._from_end(point), int(mirrored),
                             ctypes.byref(other._h), progress=progress)

    def sweep_levels(self, force_scales, progress=None):
        """A list of response curves, one at each of these force scales in their order (none where a level has no first
        motion; see force_scale of each)."""
        scales = reals(force_scales, (len(force_scales),), "force_scales")
        return [one.branch for one in self._found("sweep_levels", len(scales), address(scales), progress=progress)]

    def find_isolated(self, main_branch, force_max=0.0, progress=None):
        """A list of Isolated(branch, force_range): closed branches beside the whole main curve. force_max: the largest force
        scale looked at, 0: eight times force_scale."""
        return self._found("find_isolated", handle_of(main_branch, "branch", "main_branch"), force_max, progress=progress)

    def find_backbones(self, force_max=0.0, progress=None):
        """A list of branches: frequency and amplitude of the resonance against the force, see point_force_scale."""
        return [found.branch for found in self._found("find_backbones", force_max, progress=progress)]

    def find_by_marching(self, known=(), n_frequencies=20, n_states=5, progress=None):
        """A list of branches that are none of the `known` ones. Motions are marched in time until they are periodic, at
        n_frequencies frequencies of the range, from rest and from n_states states: 1, 2, 4, ... times the largest response
        on the known branches (without any: from rest only)."""
        curves, n_known = branch_array(known)
        found = self._found("find_by_marching", n_known, curves, n_frequencies, n_states, progress=progress)
        return [one.branch for one in found]

    def nonlinear_mode(self, mode, dof, amplitude_max=0.0, progress=None):
        """Motion without excitation from an elastic mode (1, 2, ...) of the structure about its contact at rest, until the
        first harmonic of the DOF reaches amplitude_max; 0: to a hundred times the amplitude at which a pair first opens or
        closes. See Branch.energy."""
        branch = Branch(self)
        return self._deliver("find_nonlinear_mode", branch, mode, dof, amplitude_max, ctypes.byref(branch._h),
                             progress=progress)

    def track_fold(self, branch, point, force_min, force_max, progress=None):
        """The curve of folds over frequency and force (point_force_scale) from a located fold of `branch`."""
        folds = Branch(self)
        return self._deliver("track_fold", folds, handle_of(branch, "branch", "branch"), branch._from_end(point), force_min, force_max,
                             ctypes.byref(folds._h), progress=progress)

    def _found(self, verb, *arguments, progress):
        """What a plm_hbm_find_... that counts has found."""
        count = ctypes.c_int64(0)
        self._work(verb, *arguments, ctypes.byref(count), progress=progress)
        return [self._get_found(i) for i in range(count.value)]

    def _get_found(self, index):
        branch, force_range = Branch(self), numpy.empty(2)
        self._call("get_found", index, address(force_range), ctypes.byref(branch._h))
        return Isolated(branch, tuple(force_range.tolist()))

    def _summary(self):
        harmonics = f"{self.n_harmonics} harmonics" if self.n_harmonics else "automatic harmonics"
        return f"{harmonics}, on {self._basis!r}" if self._basis._h else f"{harmonics}, on a basis of the library's choice"

    def _deliver(self, verb, branch, *arguments, progress):
        name = f"plm_hbm_{verb}"
        try:
            branch._status = status = self.context.run(name, self._h, *arguments, progress=progress)
            self.context.finish(name, status, has_result=bool(branch._h))
        except KeyboardInterrupt as interrupt:
            interrupt.branch = branch if branch._h else None
            raise
        return branch


class Branch(BranchMethods, Handle, noun="branch", kind=_c.KIND_BRANCH):
    """Points of a response curve, read-only; made by Hbm."""

    def __init__(self, hbm):
        super().__init__(hbm.context)
        self._status = _c.OK

    @classmethod
    def from_bytes(cls, basis, data):
        """The branch that to_bytes() gave, on the basis that it was computed on, or on that one read from its bytes."""
        handle_of(basis, "basis", "basis")
        branch, data = cls(basis), bytes(data)
        basis.context.call("plm_branch_read", basis._h, len(data), data, ctypes.byref(branch._h))
        return branch

    def to_bytes(self):
        """Its points and how it ended, to be kept in a file, and read by from_bytes()."""
        return self._bytes()

    def write_to(self, write):
        """The bytes of to_bytes() to a function of bytes, as the write of a file opened with "wb", piece after piece."""
        self._hand_to(write, "write_to")

    def write_csv(self, path, dof, measure="half_peak_to_peak", harmonic=0):
        """The curve as a file of comma-separated text, replaced as a whole: frequency_hz, amplitude of the DOF, arclength,
        force_scale, stable, bifurcation, residual, iterations, n_harmonics, harmonic_error, n_switching."""
        self._call("write_csv", dof, choice(measure, MEASURES, "measure"), harmonic, os.fsencode(path))

    def write_csv_to(self, write, dof, measure="half_peak_to_peak", harmonic=0):
        """The text of write_csv() to a function of bytes, piece after piece."""
        self._hand_to(write, "write_csv_to", dof, choice(measure, MEASURES, "measure"), harmonic)

    def describe(self):
        """A page of text about the curve: model, basis, peak, stability, other motions, error and by what it was judged,
        warnings with remedies, times. Peak and error are those that Model.compute_response, or Hbm.find_peak and
        Hbm.estimate_error at that peak, found of it.

            print(hbm.sweep().describe())
        """
        needed = ctypes.c_int64()
        self._call("describe", 0, None, ctypes.byref(needed))
        return _c.text_of(_c.lib.plm_branch_describe, self._h)

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

    def history(self, point, dof, n_times=128):
        """Motion of a DOF at n_times equidistant times of the period: of an exact motion itself, not of its harmonics."""
        q = numpy.empty(n_times)
        self._call("get_history", self._from_end(point), dof, n_times, address(q))
        return q

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

    @property
    def bifurcations(self):
        """The located points: a list of Bifurcation(point, kind, frequency_hz)."""
        frequency = self.frequency_hz
        return [Bifurcation(int(i), BIFURCATIONS[int(kind)], float(frequency[i]))
                for i, kind in enumerate(self.bifurcation) if int(kind) in BIFURCATIONS]

    def energy(self, point):
        """Energy(energy, contact_area): mean mechanical energy over the period (kinetic, elastic, contact, potential of the
        pre-load), less that of the structure at rest, and mean closed share of the pairs."""
        energy, area = ctypes.c_double(), ctypes.c_double()
        self._work("get_energy", self._from_end(point), ctypes.byref(energy), ctypes.byref(area))
        return Energy(energy.value, area.value)

    def multipliers(self, point):
        """Floquet multipliers over one period, complex, largest modulus first; empty where they were not computed (option
        stability)."""
        return self._get_complex("get_multipliers", self._from_end(point))

    def _from_end(self, point):
        """-1 is the last point."""
        return point + self.n_points if point < 0 else point

    def _n_pairs(self):
        return self.n_pairs

    def _summary(self):
        hz = self.frequency_hz
        span = f", {hz.min():.6g} .. {hz.max():.6g} Hz" if hz.size else ""
        return f"{self.n_points} points{span}, {self.end_text}"

    _instead_of_index = ('; what is known of one point: branch["frequency_hz"][i], branch.amplitude(dof)[i], '
                         "branch.coefficients(i), branch.field(i), branch.contact(i)")
