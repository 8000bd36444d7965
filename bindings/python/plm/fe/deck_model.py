"""A deck as a plm.Model: matrices, supports, constraints, contact, loads."""
import re
import warnings

import numpy
import scipy.sparse

from .. import Model, PlmError, PlmWarning
from . import deck_loads
from .deck_surface_contact import SurfaceTable, add_contact
from .errors import FileError

TIE_TOLERANCE = 0.025  # of the mean side of the master's faces, where a tie gives none


def build_model(deck, context=None, *, force=None, preload=True, contact_stiffness=None, search=None, closed=None,
                symmetric=False, smooth=False, build=True, **options):
    """A plm.Model of a deck.

    force: the harmonic excitation: [(node, direction, value)], {(node, direction): value} or n_dof numbers, real or complex;
        None: the loads of the deck's *STEADY STATE DYNAMICS step
    preload: True: the loads of its *STATIC steps; False: none; or n_dof numbers
    contact_stiffness: by area (force/length^3); None: that of the deck (LINEAR), or chosen by the library
    search: how far partners in contact may be apart (length); None: the largest side of the master's faces
    closed: gaps and interferences up to this length are none; None: ADJUST= of the pair, or 1e-6 of `search`, rounding of the file
    symmetric, smooth: as of Model.add_surface_contact
    build: False leaves the model open for more
    options: of plm.Model

    Warns (plm.PlmWarning) where places of the deck were not understood.
    """
    if deck.matrices is None:
        deck.matrices_by_calculix()
    model = _with_matrices(deck, context, options)
    hand_over(deck, model, force=force, preload=preload, contact_stiffness=contact_stiffness, search=search, closed=closed,
              symmetric=symmetric, smooth=smooth)
    return model.build() if build else model


def hand_over(deck, model, *, force=None, preload=True, contact_stiffness=None, search=None, closed=None, symmetric=False, smooth=False):
    """Tells `model` all that a deck says beside its matrices: damping, supports, constraints, contact, coordinates, loads; the options
    are those of build_model. model: a plm.Model, or anything with the methods of one that are called, as a host has that writes
    them down (examples/calculix)."""
    _add_damping(deck, model)
    _add_supports(deck, model)
    surfaces = SurfaceTable(deck, model)
    _add_constraints(deck, model, surfaces)
    for pair in deck.contact_pairs:
        with _naming(pair):
            add_contact(deck, model, surfaces, pair, contact_stiffness, search, closed, symmetric, smooth)
    _add_coordinates(deck, model)
    _add_loads(deck, model, force, preload)
    _tell_unread(deck)


def _add_coordinates(deck, model):
    """For the audit. The directions of a node that stands for rotations of another one are rotations there."""
    rows = deck._dofs().rows(deck.node_labels, range(1, 7))
    stand_in = [coupling.rotation for coupling in deck.couplings if coupling.rotation is not None]
    rows[numpy.isin(deck.node_labels, stand_in), :3] = -1
    flat = rows.ravel()
    first = numpy.zeros(flat.size, dtype=bool)
    first[numpy.unique(flat, return_index=True)[1]] = True
    flat[~first] = -1
    has_dof = (rows >= 0).any(axis=1)
    if has_dof.any():
        turns = (rows[:, 3:] >= 0).any()
        model.set_coordinates(numpy.ascontiguousarray(rows[has_dof, :6 if turns else 3]), deck.coordinates[has_dof])


class _naming:
    """What the library refuses of one record, or warns of, comes with the record's place in the deck. nodes: the labels of those that
    it counts from 0."""

    def __init__(self, record, nodes=()):
        self._record, self._nodes = record, nodes

    def __enter__(self):
        self._catching = warnings.catch_warnings(record=True)
        self._issued = self._catching.__enter__()
        warnings.simplefilter("always")
        return self

    def __exit__(self, kind, error, trace):
        self._catching.__exit__(kind, error, trace)
        for one in self._issued:
            warnings.warn(self._in_place(one.message), stacklevel=5)
        if isinstance(error, PlmError):
            raise FileError(self._record.file, self._record.line, self._in_labels(error)) from error
        return False

    def _in_place(self, warning):
        if not isinstance(warning, PlmWarning):
            return warning
        return PlmWarning(f"{self._record.file}:{self._record.line}: {self._in_labels(warning)}", warning.status, warning.reason)

    def _in_labels(self, text):
        return re.sub(r"\bnode (\d+) \(counted from 0\)", lambda found: f"node {self._nodes[int(found[1])]}" if len(self._nodes) else found[0],
                      str(text))


def _with_matrices(deck, context, options):
    n = deck.n_dof
    given = [deck.matrices.mass, deck.matrices.stiffness, getattr(deck.matrices, "damping", None)]
    for i, matrix in enumerate(given):
        if matrix is not None:
            given[i] = scipy.sparse.csr_matrix(matrix, copy=True)
            given[i].resize((n, n))
    if getattr(deck.matrices, "structural_damping", None) is not None:
        warnings.warn(PlmWarning("the matrices have structural damping, which a model takes as one loss factor: set_structural_damping; "
                                 "left out here"), stacklevel=4)
    return Model(*given, context=context, **options)


def _add_damping(deck, model):
    if deck.rayleigh:
        model.set_rayleigh_damping(*deck.rayleigh)
    if deck.modal_damping and len(deck.modal_damping) == 1:
        model.set_modal_damping(deck.modal_damping[0])
    elif deck.modal_damping:
        model.set_rayleigh_damping(*deck.modal_damping)


# ---- supports ----

def _active_boundaries(deck):
    """Those of the last step: OP=NEW ends the ones of earlier steps."""
    active, cleared = [], set()
    for boundary in deck.boundaries:
        if boundary.clears and boundary.step not in cleared:
            cleared.add(boundary.step)
            active = [other for other in active if other.step in (-1, boundary.step)]
        active.append(boundary)
    return active


def _add_supports(deck, model):
    rows, harmonic = [], deck_loads.harmonic_step(deck)
    motion, quantity = numpy.zeros(deck.n_dof, dtype=complex), {}
    for boundary in _active_boundaries(deck):
        found = deck._dofs().rows(boundary.nodes, boundary.directions)
        found = found[found >= 0]  # the others are held already: the matrices do not have them
        rows.append(found)
        if boundary.value and boundary.step == harmonic and harmonic is not None:
            motion[found] += boundary.value * (1j if boundary.imaginary else 1)
            quantity[boundary.quantity.lower()] = boundary
    if rows:
        model.fix_dofs(numpy.unique(numpy.concatenate(rows)))
    if len(quantity) > 1:
        boundary = quantity.popitem()[1]
        raise FileError(boundary.file, boundary.line, "supports move by two of displacement, velocity and acceleration; give one of them")
    if quantity:
        model.set_base_motion(motion if motion.imag.any() else motion.real, *quantity)


# ---- constraints ----

def _add_constraints(deck, model, surfaces):
    _add_equations(deck, model)
    for coupling in deck.couplings:
        with _naming(coupling):
            _add_coupling(deck, model, coupling)
    _hold_idle_rotations(deck, model)
    for tie in deck.ties:
        slave = deck.surfaces[tie.slave].nodes
        with _naming(tie, slave):
            dof, xyz, faces = surfaces.table(tie.master)
            tolerance = tie.tolerance or TIE_TOLERANCE * mean_side(xyz, faces)
            model.add_tie(deck._dofs().rows(slave), deck.coordinates[deck.node_rows(slave)], dof, xyz, faces, tolerance)


def _add_equations(deck, model):
    """Terms of DOFs that are held drop out, and equations of such terms alone."""
    start, dof, coefficient = [0], [], []
    for equation in deck.equations:
        terms = [(deck.dof(node, direction), value) for node, direction, value in equation.terms]
        terms = [(row, value) for row, value in terms if row is not None and value]
        if terms:
            dof += [row for row, _ in terms]
            coefficient += [value for _, value in terms]
            start.append(len(dof))
    if dof:
        rows = scipy.sparse.csr_matrix((coefficient, dof, start), shape=(len(start) - 1, deck.n_dof))
        rows.sum_duplicates()
        model.add_constraints(rows)


def _add_coupling(deck, model, coupling):
    dofs = deck._dofs()
    at = deck.coordinates[deck.node_rows([coupling.reference])[0]]
    reference = dofs.rows([coupling.reference], range(1, 7))[0]
    xyz = deck.coordinates[deck.node_rows(coupling.nodes)]
    if coupling.kind == "distributing":
        reference = reference if reference[3:].max() >= 0 else reference[:3]
        model.add_distributing_coupling(reference, at, dofs.rows(coupling.nodes), xyz, coupling.weights)
        return
    nodes = dofs.rows(coupling.nodes, range(1, 7))
    for direction in range(1, 7):
        if direction not in coupling.directions:
            nodes[:, direction - 1] = -1
    model.add_rigid_link(reference, at, nodes, xyz)


def _hold_idle_rotations(deck, model):
    """Nodes on a line through their reference, or at it, leave open its rotation about that line. Where nothing else in the deck
    asks for it, it is held: it has neither stiffness nor mass."""
    dofs, rows = deck._dofs(), []
    extra, levers = set(dofs.extra), {}
    for coupling in deck.couplings:
        if coupling.kind != "distributing" and coupling.rotation is None and (coupling.reference, 4) in extra:
            arms = deck.coordinates[deck.node_rows(coupling.nodes)] - deck.coordinates[deck.node_rows([coupling.reference])]
            turned = dofs.rows(coupling.nodes, (4, 5, 6)).max() >= 0
            levers.setdefault(coupling.reference, []).append(numpy.full((2, 3), numpy.inf) if turned else arms)
    for node, arms in levers.items():
        arms = numpy.vstack(arms)
        if node in dofs.asked_rotations or not numpy.all(numpy.isfinite(arms)):
            continue
        for axis in _idle_axes(arms):
            row = numpy.zeros(deck.n_dof)
            row[dofs.rows([node], (4, 5, 6))[0]] = axis
            rows.append(scipy.sparse.csr_matrix(row))
    if rows:
        model.add_constraints(scipy.sparse.vstack(rows))


def _idle_axes(arms):
    """Axes (0, 1 or 3 rows) about which a turn does not move the ends of arms (n x 3)."""
    length = numpy.linalg.norm(arms, axis=1)
    if length.max() == 0:
        return numpy.eye(3)
    axis = arms[length.argmax()] / length.max()
    across = arms - numpy.outer(arms @ axis, axis)
    return axis[None] if numpy.linalg.norm(across, axis=1).max() < 1e-6 * length.max() else numpy.empty((0, 3))


def mean_side(xyz, faces):
    """Mean distance between neighbouring corners of faces (rows of places in xyz)."""
    sides = []
    for face in faces:
        corners = face if len(face) in (3, 4) else face[:len(face) // 2]
        sides.append(numpy.linalg.norm(xyz[corners] - xyz[numpy.roll(corners, 1)], axis=1).mean())
    return numpy.mean(sides)


# ---- loads ----

def _add_loads(deck, model, force, preload):
    if preload is True:
        preload = deck_loads.preload(deck)
    if preload is not None and preload is not False:
        model.set_preload(preload)
    force = deck_loads.excitation(deck) if force is None else deck_loads.given_force(deck, force)
    if force is not None:
        model.set_excitation(force)


def _tell_unread(deck):
    if deck.unread:
        shown = "; ".join(f"{file}:{line}: {text}" for file, line, text in deck.unread[:3])
        more = f", and {len(deck.unread) - 3} more (deck.unread has all)" if len(deck.unread) > 3 else ""
        warnings.warn(PlmWarning(f"of the deck this was not taken: {shown}{more}"), stacklevel=5)
