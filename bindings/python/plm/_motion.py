"""Transient: motion in time."""
import ctypes
from typing import NamedTuple

import numpy

from . import _c
from ._handle import Handle, address, alike, integers, reals
from ._methods import TransientMethods
from ._model import Model
from ._reduction import Basis


class MotionState(NamedTuple):
    """Displacement and velocity of all DOFs."""
    q: numpy.ndarray
    v: numpy.ndarray


class Transient(TransientMethods, Handle, noun="transient", kind=_c.KIND_TRANSIENT):
    """Motion in time of a reduced model, by its exact piecewise-linear flow, or of the full model, by implicit steps.

    Transient(basis, **options) or Transient(model, **options), e.g. Transient(basis, frequency_hz=12, periods=100).run()

    At rest under the pre-load at first.
    """

    def __init__(self, basis_or_model, **options):
        if not isinstance(basis_or_model, (Basis, Model)):
            raise TypeError(f"a transient is made of a plm.Basis or a plm.Model, not {type(basis_or_model).__name__}")
        super().__init__(basis_or_model.context)
        self._model = getattr(basis_or_model, "model", basis_or_model)
        basis = None if self._model is basis_or_model else basis_or_model._h
        self._observed = self._recorded = []  # DOFs of the next runs, of the last one
        self.context.call("plm_transient_create", self._model._h, basis, ctypes.byref(self._h))
        self.set_options(options)

    @property
    def model(self):
        """The model it was made of."""
        return self._model

    def observe(self, dof):
        """The DOFs whose motion the next runs record; []: none."""
        (dof,), width = alike(integers(dof, "dof").ravel())
        self._call("observe" + width, 0, dof.size, address(dof))
        self._observed = dof.tolist()

    def set_state(self, q=None, v=None):
        """Displacement and velocity of all DOFs at the beginning of a period; None: zero."""
        n = self._model.n_dof
        q, v = reals(q, (n,), "q"), reals(v, (n,), "v")
        self._call("set_state", n, address(q), address(v))

    def run(self, progress=None):
        """Marches `periods` periods of the excitation, less when `settled` stops it earlier; a next run goes on from there.
        After Ctrl-C what was marched is kept. Returns the transient."""
        self._march("run", progress)
        return self

    def find_periodic(self, progress=None):
        """The periodic motion nearest the present state (reduced models only). Returns True when it was found; else the state
        is the best one, see periodicity_defect."""
        return self._march("find_periodic", progress) == _c.OK

    def state(self):
        """MotionState(q, v): the present displacement and velocity."""
        n = self._model.n_dof
        q, v = numpy.empty(n), numpy.empty(n)
        self._call("get_state", n, address(q), address(v))
        return MotionState(q, v)

    def history(self, dof=None):
        """Displacement of an observed DOF, or n_times x n of all of them, at the instants `time` of the last run."""
        if dof is None:
            columns = [self._history(i) for i in range(len(self._recorded))]
            return numpy.stack(columns, axis=1) if columns else numpy.empty((0, 0))
        if dof not in self._recorded:
            raise ValueError(f"the last run did not record DOF {dof}; it recorded {self._recorded}")
        return self._history(self._recorded.index(dof))

    def multipliers(self):
        """Floquet multipliers of the motion find_periodic found, complex, largest modulus first."""
        return self._get_complex("get_multipliers")

    def _history(self, i):
        count = ctypes.c_int64(0)
        self._call("get_history", i, 0, None, ctypes.byref(count))
        values = numpy.empty(count.value)
        if count.value:
            self._call("get_history", i, values.size, address(values), ctypes.byref(count))
        return values

    def _march(self, verb, progress):
        name = f"plm_transient_{verb}"
        status = self.context.run(name, self._h, progress=progress)
        if verb == "run" and status >= 0:
            self._recorded = self._observed
        return self.context.finish(name, status, has_result=True)

    def _n_pairs(self):
        return self._model.n_pairs

    def _summary(self):
        return f"{self.motion} model at {self.frequency_hz:.6g} Hz, observed DOFs: {len(self._observed)}"
