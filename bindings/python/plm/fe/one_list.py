"""What readers found, each matrix on DOFs of its own, brought onto one list; and what is worth saying about it."""
import numpy

from .assembly import Places, check_labels, dofs_of, in_order, key_of, spread
from .errors import FileError


def one_list(path, found, request):
    """({kind: matrix}, (n, 2) DOFs or None, loads): rows by the caller's list, else as the files name them, else by number."""
    for kind in ("stiffness", "mass"):
        if kind not in found.matrices:
            passed = f" (passed over: {'; '.join(found.notes[:3])})" if found.notes else ""
            raise FileError(path, 0, f"no {kind} matrix was found here or beside it; hand over its path or its name{passed}")
    named = [kind for kind in found.matrices if found.keys[kind] is not None]
    if len(named) == len(found.matrices):
        return by_label(path, found, request)
    if named:
        other = next(kind for kind in found.matrices if kind not in named)
        raise FileError(found.files[other], 0, f"the {other} matrix does not name its DOFs, the {named[0]} matrix does: write both "
                        "in the same form")
    return by_number(path, found, request)


def by_label(path, found, request):
    keys, stiff = found.keys, found.keys["stiffness"]
    if request.dofs is not None:
        check_labels(path, request.dofs)
        onto = key_of(request.dofs[:, 0], request.dofs[:, 1])
        for kind, own in keys.items():
            missing = own[Places(onto)(own) < 0]
            if len(missing):
                (node, direction), = dofs_of(missing[:1]).tolist()
                raise FileError(found.files[kind], 0, f"has node {node}, direction {direction}, which the DOFs handed over have not")
    elif all(len(own) == len(stiff) and (own == stiff).all() for own in keys.values()):
        onto = stiff
    else:
        onto = in_order(numpy.concatenate(list(keys.values())))
    loads = found.loads
    if loads is not None:
        loads = numpy.zeros((len(onto), found.loads.shape[1]))
        loads[Places(onto)(stiff)] = found.loads
    return {kind: spread(matrix, keys[kind], onto) for kind, matrix in found.matrices.items()}, dofs_of(onto), loads


def by_number(path, found, request):
    n = found.matrices["stiffness"].shape[0]
    for kind, matrix in found.matrices.items():
        if matrix.shape[0] != n:
            raise FileError(found.files[kind], 0, f"has {matrix.shape[0]} rows, the stiffness matrix {n}")
    dofs = found.listed if request.dofs is None else request.dofs
    if dofs is None:
        found.note(path, 0, "no list of DOFs was found: rows are known by their number alone (row i has the label -(i + 1)); "
                   "hand one over by dofs=")
    elif len(dofs) != n:
        raise FileError(path, 0, f"{len(dofs)} DOFs are listed for matrices of {n} rows")
    else:
        check_labels(path, dofs)
    return found.matrices, dofs, found.loads


def remarks(path, matrices):
    """Notes on what a reader of the matrices should know: rows without stiffness and mass, multipliers, structural damping."""
    stiffness, mass = matrices.stiffness, matrices.mass
    notes, dofs = [], matrices.dofs
    filled = numpy.diff(stiffness.indptr) > 0
    zero = (stiffness.diagonal() == 0) & (mass.diagonal() == 0)
    multipliers = "rows with zero on the diagonals, coupled to others: taken to be Lagrange multipliers, kept as rows"
    for rows, text in ((zero & filled, multipliers), (zero & ~filled, "rows without stiffness and mass")):
        if rows.any():
            labels = ", ".join(f"{node}.{direction}" for node, direction in dofs[rows][:5].tolist())
            notes.append(f"{path}: {rows.sum()} {text} ({labels}{', ...' if rows.sum() > 5 else ''})")
    negative = stiffness.diagonal() < 0
    if negative.any():
        node, direction = dofs[numpy.argmax(negative)].tolist()
        notes.append(f"{path}: {negative.sum()} diagonal entries of the stiffness matrix are below zero, the first at "
                     f"{node}.{direction}")
    if _balances(mass) and not _balances(stiffness):
        notes.append(f"{path}: most rows of the mass matrix sum up to zero, as those of a stiffness matrix do, which does not resist a "
                     "rigid motion: are the two exchanged?")
    if matrices.structural_damping is not None:
        scale = matrices.structural_damping.diagonal().sum() / (stiffness.diagonal().sum() or 1.0)
        same = abs(matrices.structural_damping - scale * stiffness).max() <= 1e-9 * abs(scale) * abs(stiffness).max()
        notes.append(f"{path}: structural damping is " + (
            f"{scale:.9g} times the stiffness matrix: set it as that loss factor" if same else
            "not a multiple of the stiffness matrix; no loss factor stands for it"))
    return notes


def _balances(matrix):
    """Whether at least half of the rows with entries beside the diagonal sum up to nothing."""
    size = abs(matrix) @ numpy.ones(matrix.shape[1])
    coupled = size > abs(matrix.diagonal())
    sums = abs(matrix @ numpy.ones(matrix.shape[1]))[coupled]
    return bool(sums.size) and 2 * numpy.count_nonzero(sums <= 1e-6 * size[coupled]) >= sums.size
