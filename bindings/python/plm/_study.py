"""Study: error against run time."""
import ctypes
import os
from typing import NamedTuple

import numpy

from . import _c
from ._handle import Handle, address, context_of, handle_of
from ._methods import StudyMethods
from ._model import choice
from ._response import MEASURES, Branch

REFERENCE = -1  # in the place of a method's index


class StudyPoints(NamedTuple):
    """Points of a curve, of the amplitude looked at."""
    frequency_hz: numpy.ndarray
    amplitude: numpy.ndarray


class Study(StudyMethods, Handle, noun="study", kind=_c.KIND_STUDY):
    """Methods, each a way to the same response curve, run and timed beside a reference and compared with it.

    Study(model, **options), e.g.

        study = plm.Study(model, repeats=3)
        study.set_output(dof=12)
        study.add_response("4 samples", plm.Hbm(plm.Basis(model, sampler)))     # nothing need be built or run
        study.add_response("Craig-Bampton", plm.Hbm(plm.Basis(model, sampler, kind="craig_bampton")))
        study.run()
        study.curve_error_l2, study.setup_seconds + study.curve_seconds         # arrays, one entry per method

    A method holds copies of options, taken when it is added. Everywhere below a method is its index, from 0, or its name;
    -1 or "reference" is the reference. NaN (or -1) stands where a method failed or a figure has no meaning.
    """

    def __init__(self, model, **options):
        super().__init__(context_of(model, "model", "model"))
        self._model, self._status = model, _c.OK
        self.context.call("plm_study_create", model._h, ctypes.byref(self._h))
        self.set_options(options)

    @property
    def model(self):
        """The model it was made of."""
        return self._model

    @property
    def names(self):
        """The names of the methods, in the order they were added."""
        return [_c.text_of(_c.lib.plm_study_get_name, self._h, i) for i in range(self.n_methods)]

    @property
    def status(self):
        """plm.OK, WARNING (a method failed or ended early, see outcome) or CANCELLED, as the last run returned."""
        return self._status

    def set_output(self, dof, measure="half_peak_to_peak", harmonic=0):
        """The amplitude looked at, as in Branch.amplitude. Must be set."""
        self._call("set_output", dof, choice(measure, MEASURES, "measure"), harmonic)

    def add_response(self, name, hbm):
        """A method: the curve of hbm by the options that it, its basis and its sampler hold now. Returns its index."""
        return self._add("response", name, handle_of(hbm, "hbm", "hbm"))

    def add_compressed(self, name, hbm, size=0):
        """That response at the lowest and highest force level, then a basis of kind "pod" from it, of `size` columns (0: as
        many as pod_tolerance asks for), and its curve. Returns the method's index."""
        return self._add("compressed", name, handle_of(hbm, "hbm", "hbm"), size)

    def add_refined(self, name, hbm, tolerance):
        """The curve on the basis that Hbm.refine_basis makes for the tolerance. Returns the method's index."""
        return self._add("refined", name, handle_of(hbm, "hbm", "hbm"), tolerance)

    def add_marching(self, name, transient, n_frequencies):
        """Steady states by marching in time at n_frequencies frequencies; give the transient `settled`. Returns the method's
        index."""
        return self._add("marching", name, handle_of(transient, "transient", "transient"), n_frequencies)

    def run(self, progress=None):
        """Runs each method once to warm up, then `repeats` times for the times. See .status and outcome for how it ended. What
        was run before a cancel is kept if the reference was complete. Returns the study."""
        name = "plm_study_run"
        self._status = status = self.context.run(name, self._h, progress=progress)
        self.context.finish(name, status, has_result=status != _c.CANCELLED or self._has_run())
        return self

    def outcome(self, method):
        """How a method ended in the last run, or why it failed."""
        index, needed = self._index(method), ctypes.c_int64(0)
        self._call("get_outcome", index, 0, None, ctypes.byref(needed))  # a study that has not run refuses here
        return _c.text_of(_c.lib.plm_study_get_outcome, self._h, index)

    def curve(self, method, level=0):
        """The curve of a method at a force level of the last run: a Branch. A method that marches in time has none."""
        branch = Branch(self)
        self._call("get_curve", self._index(method), level, ctypes.byref(branch._h))
        return branch

    def points(self, method, level=0):
        """StudyPoints(frequency_hz, amplitude): the same as points for pictures, as many as curve_tolerance asks for; of a
        method that marches in time its steady states."""
        index, count = self._index(method), ctypes.c_int64(0)
        self._call("get_points", index, level, 0, None, None, ctypes.byref(count))
        frequency, amplitude = numpy.empty(count.value), numpy.empty(count.value)
        if count.value:
            self._call("get_points", index, level, count.value, address(frequency), address(amplitude), ctypes.byref(count))
        return StudyPoints(frequency, amplitude)

    def write(self, folder):
        """Writes report.md, table.csv and a file for each curve into a folder, which is made if its parent exists."""
        self._call("write", os.fsencode(folder))

    def _add(self, method, name, *arguments):
        index = ctypes.c_int64(0)
        self._call(f"add_{method}", name.encode(), *arguments, ctypes.byref(index))
        return index.value

    def _index(self, method):
        if not isinstance(method, str):
            return method
        names = self.names
        if method != "reference" and method not in names:
            raise ValueError(f"no method is called {method!r}; there are {names}")
        return REFERENCE if method == "reference" else names.index(method)

    def _summary(self):
        return f"methods: {', '.join(self.names) or 'none'}; {'run' if self._has_run() else 'not run'}"

    def _has_run(self):
        count = ctypes.c_int64(0)
        return _c.lib.plm_study_get_array(self._h, b"peak_hz", 0, None, ctypes.byref(count)) == _c.OK
