"""Sampler and Basis: from the model to the reduction matrices."""
import ctypes

import numpy

from . import _c
from ._context import default_context
from ._handle import Handle, address, branch_array, context_of, handle_of, reals
from ._methods import BasisMethods, SamplerMethods
from ._model import SYSTEMS, choice


class Sampler(SamplerMethods, Handle, noun="sampler", kind=_c.KIND_SAMPLER):
    """The evolution of the contact area: dominant mode, sweep, samples, frequency window.

    Sampler(model, **options), e.g. Sampler(model, system="open", mode=1, n_samples=4).run()
    """

    def __init__(self, model, **options):
        super().__init__(context_of(model, "model", "model"))
        self._model = model
        self.context.call("plm_sampler_create", model._h, ctypes.byref(self._h))
        self.set_options(options)

    @property
    def model(self):
        """The model it was made of."""
        return self._model

    def add_dominant_mode(self, system, mode):
        """A further dominant mode, 1, 2, ... of the system "open" or "sliding"."""
        self._call("add_dominant_mode", choice(system, SYSTEMS, "system"), mode)

    def run(self, progress=None):
        """Finds the dominant mode, the sweep, the samples and the window. Returns the sampler."""
        self._work("run", progress=progress)
        return self

    def _n_pairs(self):
        return self._model.n_pairs

    _unfinished = "not run"

    def _summary(self):
        return (f"{self.n_selected} samples along mode {self.dominant_mode} of the {self.dominant_system} system, "
                f"window {self.window_low_hz:.6g} .. {self.window_high_hz:.6g} Hz")


class Basis(BasisMethods, Handle, noun="basis", kind=_c.KIND_BASIS):
    """Reduction matrices P (h >= 1) and P_0 (h = 0).

    Basis(model, sampler=None, parent=None, responses=None, **options), e.g. Basis(model, sampler).build(), and of curves
    computed on it Basis(model, parent=basis, responses=curves, kind="pod").build()
    """

    def __init__(self, model, sampler=None, parent=None, responses=None, **options):
        super().__init__(context_of(model, "model", "model"))
        self._model = model
        self.context.call("plm_basis_create", model._h, ctypes.byref(self._h))
        if sampler is not None:
            self.set_sampler(sampler)
        if parent is not None:
            self.set_parent(parent)
        if responses is not None:
            self.set_responses(responses)
        self.set_options(options)

    @classmethod
    def _made_by(cls, model):
        """One of this model whose handle the library is about to fill."""
        basis = cls.__new__(cls)
        Handle.__init__(basis, model.context)
        basis._model = model
        return basis

    @classmethod
    def from_bytes(cls, data, context=None):
        """The basis that to_bytes() gave, built: it sweeps at once, in this process or another. Without its model (.model is
        None) until attach(); what asks the structure itself raises plm.PlmError. context: where it is to be (default: that
        of all models without one)."""
        basis = cls.__new__(cls)
        Handle.__init__(basis, default_context() if context is None else context)
        basis._model = None
        data = bytes(data)
        basis.context.call("plm_basis_read", basis.context._h, len(data), data, ctypes.byref(basis._h))
        return basis

    def to_bytes(self):
        """All that curves need of it, to be kept in a file, and read by from_bytes(): about 8 n_dof (columns of P and P_0)
        bytes."""
        return self._bytes()

    def write_to(self, write):
        """The same bytes to a function of bytes, as the write of a file opened with "wb", piece after piece: no second copy of
        the basis is in memory."""
        self._hand_to(write, "write_to")

    def attach(self, model):
        """Gives a basis that was read the model that it was made of: full residual, error estimates and refinement work
        again. plm.PlmError for another one. Returns the basis."""
        self._call("attach", handle_of(model, "model", "model"))
        self._model = model
        return self

    @property
    def model(self):
        """The model it was made of; None: it was read from bytes, and none is attached."""
        return self._model

    def set_responses(self, branches):
        """For kind "pod": the curves, computed on the parent, whose motions span the basis; () forgets them. They are read
        here."""
        curves, n = branch_array(branches)
        self._call("set_responses", n, curves)

    def build(self, progress=None):
        """Makes the basis; look at .warning afterwards. Returns the basis."""
        self._work("build", progress=progress)
        return self

    def vectors(self, static=False):
        """P, or P_0 if static: n_dof x size."""
        n_dof, n = self.n_dof, self.static_size if static else self.size
        vectors = numpy.empty((n_dof, n), order="F")
        self._call("get_vectors", int(static), 0, n, address(vectors), n_dof)
        return vectors

    def residual(self, q, static=False, mass=False):
        """|q - P eta| / |q|, eta by least squares; mass: in the norm of M."""
        q = reals(q, (self.n_dof,), "q")
        value = ctypes.c_double()
        self._call("get_residual", int(static), int(mass), q.size, address(q), ctypes.byref(value))
        return value.value

    def _n_pairs(self):
        return self.n_pairs

    def _summary(self):
        return f"{self.kind}, {self.size} columns, static ones: {self.static_size}"
