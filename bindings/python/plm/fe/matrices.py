"""Mass, stiffness and damping matrices of other codes, and the DOF that each of their rows is."""
import os

import numpy
import scipy.sparse

from .assembly import Places, dofs_of, key_of
from .errors import FileError
from .formats import abaqus, dmig, dof_list, harwell_boeing, market, output4, substructure, triplets
from .formats.found import KINDS, Found, Request
from .one_list import one_list, remarks

READERS = (market, output4, substructure, dmig, harwell_boeing, triplets, abaqus)  # the first whose mark a file bears reads it
WRITERS = {
    "market": market.write,
    "calculix": triplets.write,
    "abaqus": abaqus.write,
    "abaqus-coordinate": lambda path, matrices: abaqus.write(path, matrices, coordinate=True),
    "abaqus-substructure": substructure.write,
    "harwell-boeing": harwell_boeing.write,
    "ansys": lambda path, matrices: harwell_boeing.write(path, matrices, ansys=True),
    "dmig": dmig.write,
    "output4": output4.write,
    "output4-binary": lambda path, matrices, **options: output4.write(path, matrices, binary=True, **options),
}


class Matrices:
    """K, M and C of a structure, and what DOF each row is.

    stiffness, mass      scipy.sparse CSR, n x n, both triangles
    damping              the same, or None: viscous damping, C q'
    structural_damping   the same, or None: i S q of a harmonic motion. A plm.Model has a loss factor instead; where S = eta K,
                         the notes name eta
    loads                (n, k) right-hand sides that came with the stiffness matrix, or None
    dofs                 (n, 2) int64: node label and direction 1 .. 6. Direction 0 is a scalar point or a modal coordinate, a label
                         below one an internal node; without a list of DOFs row i has the label -(i + 1)
    name, source, notes  of the model; the files that were read; what was assumed or not understood, with file and line

        own = plm.fe.Matrices(scipy.sparse.csr_matrix([[2e4, -1e4], [-1e4, 1e4]]), scipy.sparse.identity(2), dofs=[(1, 1), (2, 1)])
    """

    def __init__(self, stiffness, mass, damping=None, dofs=None, name="", source=(), notes=(), structural_damping=None, loads=None):
        given = {"stiffness": stiffness, "mass": mass, "damping": damping, "structural_damping": structural_damping}
        for kind, matrix in given.items():
            if matrix is not None:
                matrix = scipy.sparse.csr_matrix(matrix, dtype=float)
                if matrix.shape != (n := numpy.shape(stiffness)[0], n):
                    raise ValueError(f"{kind} is {matrix.shape[0]} x {matrix.shape[1]}, the stiffness has {n} rows")
            setattr(self, kind, matrix)
        n = self.n_dof
        self.dofs = dof_list.as_dofs(numpy.column_stack([-numpy.arange(1, n + 1), numpy.zeros(n, int)]) if dofs is None else dofs)
        if len(self.dofs) != n:
            raise ValueError(f"{len(self.dofs)} DOFs for matrices of {n} rows")
        self.loads = None if loads is None else numpy.asarray(loads, float).reshape(n, -1)
        self.name, self.source, self.notes = name, list(source), list(notes)
        self.dofs.flags.writeable = False  # rows() has looked at them
        self._places = Places(key_of(self.dofs[:, 0], self.dofs[:, 1]))

    @property
    def n_dof(self):
        """Rows of the matrices."""
        return self.stiffness.shape[0]

    def rows(self, node, direction):
        """The row of a node and direction, or the rows of arrays of them. LookupError where there is none."""
        wanted = numpy.atleast_1d(key_of(node, direction))
        at = self._places(wanted)
        if (at < 0).any():
            missing, = dofs_of(wanted[at < 0][:1])
            there = sorted(self.dofs[self.dofs[:, 0] == missing[0], 1].tolist())
            words = f"it has {', '.join(map(str, there))}" if there else "no row is of this node"
            raise LookupError(f"the matrices have no row for node {missing[0]}, direction {missing[1]}: {words}")
        return int(at[0]) if numpy.ndim(node) == numpy.ndim(direction) == 0 else at

    def by_kind(self):
        """(kind, matrix) of the matrices that are there."""
        return [(kind, getattr(self, kind)) for kind in KINDS if getattr(self, kind) is not None]

    def by_letter(self):
        """("K", matrix), ... for formats that have no place for structural damping."""
        if self.structural_damping is not None:
            raise ValueError("this format has no place for structural damping; write abaqus, dmig or output4")
        return [(letter, matrix) for letter, matrix in zip("KMC", (self.stiffness, self.mass, self.damping)) if matrix is not None]

    def __repr__(self):
        damped = "".join(f", {kind.replace('_', ' ')}" for kind in KINDS[2:] if getattr(self, kind) is not None)
        return f"<plm.fe.Matrices {self.name or 'without a name'}: {self.n_dof} DOFs{damped}, {len(self.notes)} notes>"


def read_matrices(path, mass=None, damping=None, structural_damping=None, dofs=None, names=None, format=None):
    """The Matrices of a model from the files of another code. FileError says what is wrong, with file and line.

    path     any of the files, usually the stiffness matrix; the others are looked for beside it, and .source tells what was taken
    mass, damping, structural_damping
             paths of matrices in files of their own that are not found, or not meant to be
    dofs     (n, 2) of node and direction in the order of the rows, or the path of a list of them, for formats that have none
    names    {"stiffness": "KAAX", ...} where a file has several matrices (DMIG, OUTPUT4) that could be meant
    format   one of "market", "calculix", "abaqus", "abaqus-substructure", "harwell-boeing", "dmig", "output4"; by default the
             contents tell

        matrices = plm.fe.read_matrices("two_K.mtx")
    """
    path = located(os.fspath(path))
    given = {"mass": mass, "damping": damping, "structural_damping": structural_damping}
    wrong = set(names or ()) - set(KINDS)
    if wrong:
        raise ValueError(f"names has {wrong.pop()!r}; it maps {', '.join(KINDS)} to names of matrices")
    request = Request({kind: os.fspath(p) for kind, p in given.items() if p is not None}, dict(names or {}),
                      None if dofs is None else dof_list.as_dofs(dofs))
    for other in request.paths.values():
        located(other)
    found = Found()
    found.name = os.path.splitext(os.path.basename(path))[0]
    reader_of(path, format).read(path, request, found)
    matrices, dofs, loads = one_list(path, found, request)
    result = Matrices(matrices["stiffness"], matrices["mass"], matrices.get("damping"), dofs, found.name, found.source, found.notes,
                      matrices.get("structural_damping"), loads)
    result.notes += remarks(path, result)
    return result


def located(path):
    """The path of a file; a stem finds x.sti."""
    if not os.path.isfile(path):
        if os.path.isfile(path + ".sti"):
            return path + ".sti"
        raise FileError(path, 0, "is no file" if not os.path.isdir(path) else "is a folder; name one of the files of the matrices")
    return path


def reader_of(path, format):
    by_name = {reader.NAME: reader for reader in READERS}
    if format is not None:
        if format not in by_name:
            raise ValueError(f"format is {format!r}; it must be one of {', '.join(by_name)}")
        return by_name[format]
    try:
        with open(path, "rb") as file:
            head = file.read(1 << 16)
    except OSError as error:
        raise FileError(path, 0, f"cannot be read: {error.strerror or error}") from None
    for reader in READERS:
        if reader.matches(path, head):
            return reader
    if not head:
        raise FileError(path, 0, "is empty")
    line = head.split(b"\n")[0][:60].decode("latin-1")
    raise FileError(path, 1, f"is of no format that is known; it begins with {line!r}. Known are {', '.join(by_name)}")


def write_matrices(path, matrices, format, **options):
    """Writes Matrices in a format, as files whose names begin with the path without its suffix. Returns their paths.

    format   "market", "calculix", "abaqus", "abaqus-coordinate", "abaqus-substructure", "harwell-boeing", "ansys", "dmig",
             "output4", "output4-binary"
    options  of "dmig": free=True; of the two OUTPUT4 forms: layout="dense", "sparse" or "bigmat", precision="double" or "single",
             byteorder="<" or ">" (binary)
    matrices plm.fe.Matrices

        paths = plm.fe.write_matrices("again", matrices, "market")
    """
    if format not in WRITERS:
        raise ValueError(f"format is {format!r}; it must be one of {', '.join(WRITERS)}")
    return WRITERS[format](os.fspath(path), matrices, **options)
