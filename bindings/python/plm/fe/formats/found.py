"""What a reader found, and what it was asked to look for."""
from typing import NamedTuple, Optional

import numpy
import scipy.sparse

from ..assembly import check_labels, key_of
from ..errors import FileError

KINDS = ("stiffness", "mass", "damping", "structural_damping")


class Request(NamedTuple):
    """What the caller says beside the path. Each may be None.

    paths  kind -> path of a matrix in a file of its own
    names  kind -> name of a matrix in a file of several
    dofs   (n, 2) of node, direction, in the order of the rows
    """
    paths: dict
    names: dict
    dofs: Optional[numpy.ndarray]


class Found:
    """Matrices by kind, each with the keys of its DOFs (assembly.key_of) or None where the file has none."""

    def __init__(self):
        self.matrices, self.keys, self.files = {}, {}, {}
        self.loads, self.name = None, ""
        self.listed = None  # (n, 2) DOFs of a list beside files that have none
        self.source, self.notes = [], []

    def add(self, kind, matrix, dofs, path):
        """kind: one of KINDS. matrix: whole, real or complex. dofs: (n, 2) or None."""
        if kind in self.matrices:
            raise FileError(path, 0, f"a second {kind} matrix; the first is in {self.files[kind]}. Say which to take")
        if scipy.sparse.issparse(matrix) and numpy.iscomplexobj(matrix):
            matrix = self.real_part(kind, matrix, dofs, path)
        self.matrices[kind], self.files[kind] = matrix, str(path)
        if dofs is not None:
            check_labels(path, dofs)
        self.keys[kind] = None if dofs is None else key_of(dofs[:, 0], dofs[:, 1])
        self.read_from(path)

    def real_part(self, kind, matrix, dofs, path):
        """A complex stiffness is K + i times structural damping; nothing else has an imaginary part that means something."""
        imaginary = matrix.imag.tocsr()
        imaginary.eliminate_zeros()
        if imaginary.nnz and kind != "stiffness":
            raise FileError(path, 0, f"the {kind} matrix is complex; only a stiffness matrix may be")
        if imaginary.nnz:
            self.notes.append(f"{path}: the imaginary part of the stiffness matrix was taken for structural damping")
            self.add("structural_damping", imaginary, dofs, path)
        return matrix.real.tocsr()

    def read_from(self, path):
        if str(path) not in self.source:
            self.source.append(str(path))

    def note(self, path, line, text):
        self.notes.append(f"{path}:{line}: {text}" if line else f"{path}: {text}")


def refuse(path):
    """fail(k, text) of a file whose entries have no lines of their own."""
    def fail(_, text):
        raise FileError(path, 0, text)
    return fail
