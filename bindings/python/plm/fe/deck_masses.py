"""Point masses of a deck (*MASS), added to the mass matrix here: CalculiX leaves those at nodes without other elements out of the
matrices it writes, without a word."""
import numpy
import scipy.sparse

from .errors import FileError
from .matrices import Matrices

ELEMENT = "MASS"


def with_point_masses(deck, matrices):
    """plm.fe.matrices.Matrices with the masses; nodes that have no rows get three of their own."""
    masses = point_masses(deck)
    if not masses:
        return matrices
    dofs = [(node, direction) for node in masses for direction in (1, 2, 3)]
    place = {tuple(dof): row for row, dof in enumerate(matrices.dofs.tolist())}
    new = [dof for dof in dofs if dof not in place]
    place.update({dof: matrices.n_dof + i for i, dof in enumerate(new)})
    rows, n = [place[dof] for dof in dofs], len(place)
    points = scipy.sparse.coo_matrix(([masses[node] for node, _ in dofs], (rows, rows)), shape=(n, n))
    stiffness, mass = (_widened(matrix, n) for matrix in (matrices.stiffness, matrices.mass))
    return Matrices(stiffness, mass + points.tocsr(), dofs=numpy.vstack([matrices.dofs, new]) if new else matrices.dofs,
                    name=matrices.name, source=matrices.source, notes=matrices.notes)


def _widened(matrix, n):
    """The matrix with rows and columns of zeros behind its own."""
    wide = matrix.copy()
    wide.resize((n, n))
    return wide


def point_masses(deck):
    """{node: mass} of all elements of the type MASS."""
    values = _values(deck)
    masses = {}
    for block in deck.elements:
        if block.type != ELEMENT:
            continue
        for label, (node,) in zip(block.labels.tolist(), block.connectivity.tolist()):
            if label not in values:
                raise FileError(deck.path, 0, f"element {label} of the type MASS is in no set that a *MASS names")
            masses[node] = masses.get(node, 0.0) + values[label]
    return masses


def _values(deck):
    """{element: mass}."""
    values = {}
    for block in deck.property_blocks:
        if block.key != "MASS":
            continue
        if block.word("TYPE", "ISOTROPIC") != "ISOTROPIC":
            block.fail(f"*MASS of the type {block.get('TYPE')}: one mass for all directions is read")
        if not block.lines:
            block.fail("*MASS without a number")
        value = block.lines[0].real(0, "the mass")
        if value < 0:
            block.lines[0].fail(f"the mass {value:g}; it cannot be below 0")
        values.update(dict.fromkeys(deck.element_sets[deck.section_set(block)].tolist(), value))
    return values
