"""A structure that is spread over the ranks of an MPI program: libplm_mpi and mpi4py.

    team = plm.mpi.Team(MPI.COMM_WORLD, n_dof)          # all ranks
    team.own_dofs(dof)                                  # all ranks, each its own part
    team.add_mass(m); team.add_stiffness(k)             # scipy.sparse, as assembled here
    peak = team.run(program)                            # rank 0: program(model), the others serve until it is done
    team.destroy()                                      # all ranks

What a function does is said in plm_mpi.h. Only the communicator's py2f() and rank are asked for.
"""
import ctypes
import ctypes.util
import os
import pathlib

import numpy
import scipy.sparse

from . import _c
from ._context import default_context, look, status_text
from ._errors import make_error
from ._handle import address, integers, list_of_reals, real_parts, reals
from ._model import PARTS, Model, choice

_FIELD_FN = ctypes.CFUNCTYPE(ctypes.c_int32, ctypes.c_void_p, ctypes.c_int64, ctypes.c_void_p, ctypes.c_void_p, ctypes.c_void_p)
_I, _Q, _P = ctypes.c_int32, ctypes.c_int64, ctypes.c_void_p
_FUNCTIONS = {"create": (_I, _Q, _P), "destroy": (_P,), "own_dofs_i64": (_P, _I, _Q, _P), "add_entries_i64": (_P, _I, _I, _I, _Q, _P, _P, _P),
              "fix_dofs_i64": (_P, _I, _Q, _P), "add_gap_rows_i64": (_P, _I, _Q, _P, _P, _P, _P, _P), "add_preload_i64": (_P, _I, _Q, _P, _P),
              "add_excitation_i64": (_P, _I, _I, _Q, _P, _P, _P), "set_field": (_P, _P, _P), "create_model": (_P, _P, _P),
              "deliver": (_P, _Q, _P), "dismiss": (_P, _I), "serve": (_P,), "get_error_text": (_P, _Q, _P, _P)}


def _candidates():
    """Where the library may be: $PLM_MPI_LIBRARY, beside libplm, where the system keeps its libraries."""
    if os.environ.get("PLM_MPI_LIBRARY"):
        yield os.environ["PLM_MPI_LIBRARY"]
        return
    beside = pathlib.Path(_c.lib.path).resolve().parent / "libplm_mpi.so.0"
    if beside.exists():
        yield str(beside)
    yield ctypes.util.find_library("plm_mpi") or "libplm_mpi.so.0"


def _load():
    failures = []
    for name in _candidates():
        try:
            library = ctypes.CDLL(name)
        except OSError as error:
            failures.append(str(error))
            continue
        for function, arguments in _FUNCTIONS.items():
            getattr(library, f"plm_team_{function}").argtypes = arguments
        return library
    raise ImportError("libplm_mpi was not found; install it, or let the environment variable PLM_MPI_LIBRARY name the shared library "
                      "(" + "; ".join(failures) + ")")


_library = _load()


def _wide(values, name):
    """A contiguous array of int64."""
    return numpy.ascontiguousarray(numpy.atleast_1d(integers(values, name)).ravel(), dtype=numpy.int64)


class Team:
    """The ranks of a communicator of mpi4py; each hands over its own part, rank 0 computes. DOFs count from 0.

    Collective are Team(...), destroy() and run(...). A rank whose own call raised goes on as if it had not: run raises on all ranks then,
    and names it. Nothing is destroyed by the collector of garbage, which runs on each rank when it likes: call destroy(), or write
    with plm.mpi.Team(comm, n_dof) as team.
    """

    def __init__(self, comm, n_dof):
        self._h = ctypes.c_void_p()
        self.comm, self.n_dof = comm, n_dof
        self._raised = self._receive = self._function = None
        self._check("create", _library.plm_team_create(comm.py2f(), n_dof, ctypes.byref(self._h)))

    def __enter__(self):
        return self

    def __exit__(self, *raised):
        self.destroy()

    def __repr__(self):
        return f"<plm.mpi.Team: rank {self.comm.rank} of {self.comm.size}, {self.n_dof} DOFs>"

    def destroy(self):
        """Collective. Rank 0 dismisses the others if that has not been done."""
        self._check("destroy", _library.plm_team_destroy(ctypes.byref(self._h)))

    # ---- what a rank hands over ----

    def own_dofs(self, dof):
        """What this rank owns: any DOFs; each has one owner in the end."""
        dof = _wide(dof, "dof")
        self._call("own_dofs_i64", 0, dof.size, address(dof))

    def add_mass(self, matrix, part="full"):
        """Entries of M as this rank has assembled them, n_dof x n_dof in numbers of the whole structure, sparse. What comes for one
        place is summed, over calls and ranks. part: "full", "lower" or "upper", the triangle that is stored."""
        self._add(_c.MASS, matrix, part)

    def add_stiffness(self, matrix, part="full"):
        """Entries of K likewise."""
        self._add(_c.STIFFNESS, matrix, part)

    def add_damping(self, matrix, part="full"):
        """Entries of C likewise."""
        self._add(_c.DAMPING, matrix, part)

    def _add(self, which, matrix, part):
        matrix = scipy.sparse.coo_matrix(matrix)
        if matrix.shape != (self.n_dof, self.n_dof):
            raise ValueError(f"the matrix is {matrix.shape[0]} x {matrix.shape[1]}, but the structure has {self.n_dof} DOFs")
        row, column = _wide(matrix.row, "row"), _wide(matrix.col, "column")
        value = numpy.ascontiguousarray(real_parts(matrix.data, "the matrix"))
        self._call("add_entries_i64", which, choice(part, PARTS, "part"), 0, value.size, address(row), address(column), address(value))

    def fix_dofs(self, dof):
        """DOFs held at zero; by any rank, or by several."""
        dof = _wide(dof, "dof")
        self._call("fix_dofs_i64", 0, dof.size, address(dof))

    def add_gap_rows(self, rows, stiffness, gap=0.0):
        """Contact pairs u = rows @ q - gap (n x n_dof, sparse), numbered from those of rank 0 on; stiffness, gap: one for each or one
        for all."""
        rows = scipy.sparse.csr_matrix(rows)
        if rows.shape[1] != self.n_dof:
            raise ValueError(f"rows has {rows.shape[1]} columns; needed is n_dof = {self.n_dof}")
        start, dof = _wide(rows.indptr, "rows"), _wide(rows.indices, "rows")
        value = numpy.ascontiguousarray(real_parts(rows.data, "rows"))
        n = rows.shape[0]
        stiffness, gap = (reals(x, (n,), name, "one for each pair") for x, name in ((stiffness, "stiffness"), (gap, "gap")))
        self._call("add_gap_rows_i64", 0, n, address(start), address(dof), address(value), address(stiffness), address(gap))

    def add_preload(self, dof, force):
        """Static forces at some DOFs; what comes for one is summed."""
        dof = _wide(dof, "dof")
        force = reals(force, dof.shape, "force", "one for each DOF")
        self._call("add_preload_i64", 0, dof.size, address(dof), address(force))

    def add_excitation(self, dof, force, harmonic=1):
        """Amplitudes of a harmonic at some DOFs, real or complex; what comes for one is summed."""
        dof = _wide(dof, "dof")
        force = numpy.broadcast_to(numpy.asarray(force), dof.shape)
        real = numpy.ascontiguousarray(force.real, dtype=float)
        imaginary = numpy.ascontiguousarray(force.imag, dtype=float) if numpy.iscomplexobj(force) and harmonic else None
        self._call("add_excitation_i64", harmonic, 0, dof.size, address(dof), address(real), address(imaginary))

    def set_field(self, receive):
        """Who receives fields on this rank: receive(dof, value) at the DOFs it owns; None: nobody."""
        self._receive = receive
        self._function = _FIELD_FN(self._on_field) if receive else None  # kept alive here: ctypes does not
        self._call("set_field", ctypes.cast(self._function, _P) if receive else None, None)

    def _on_field(self, _team, n, dof, value, _user):
        try:
            self._receive(look(dof, n, ctypes.c_int64).copy(), look(value, n, ctypes.c_double).copy())
            return 0
        except BaseException as error:  # pylint: disable=broad-except
            self._raised = error
            return 1

    # ---- the work ----

    def run(self, program, context=None):
        """Collective: rank 0 makes the model of all parts and calls program(model), the others serve. What program returns, rank 0
        returns, and the others None. What it raises on rank 0 is raised there, and a PlmError on the others."""
        if self.comm.rank > 0:
            return self.serve()
        outcome = _c.ERR_CALLBACK  # what the others hear of an exception that is none of libplm
        try:
            result, outcome = program(self.create_model(context)), _c.OK
            return result
        except Exception as error:
            outcome = min(getattr(error, "status", outcome), _c.ERR_HANDLE)
            raise
        finally:
            _library.plm_team_dismiss(self._h, outcome)

    def create_model(self, context=None):
        """Rank 0: a plm.Model of what the ranks have added, to be built."""
        model = Model._adopted(context or default_context())
        self._call("create_model", model.context._h, ctypes.byref(model._h))
        return model

    def deliver(self, value):
        """Rank 0: each rank's function receives its part of n_dof values."""
        value = list_of_reals(value, "value")
        self._call("deliver", value.size, address(value))

    def dismiss(self, outcome=_c.OK):
        """Rank 0: the others come back from serve, with outcome as their status."""
        self._call("dismiss", outcome)

    def serve(self):
        """The other ranks: does what rank 0 says until it dismisses."""
        self._call("serve")

    def _call(self, verb, *arguments):
        self._check(verb, getattr(_library, f"plm_team_{verb}")(self._h, *arguments))

    def _check(self, verb, status):
        raised, self._raised = self._raised, None
        if raised is not None:
            raise raised
        if status >= 0:
            return
        text = _c.text_of(_library.plm_team_get_error_text, self._h) or f"plm_team_{verb}: {status_text(status)}"
        raise make_error(text, status, function=f"plm_team_{verb}")
