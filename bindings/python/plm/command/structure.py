"""From the files and settings to a built model with its nodes."""
import pathlib

import numpy
import scipy.sparse

from .._c import AUTO_STIFFNESS
from .._model import Model
from ..fe.matrices import read_matrices
from ..fe.node_motion import DIRECTIONS as N_DIRECTIONS
from .nodes import NodeCloud, direction_of, read_coordinates, read_dofs
from .pairs import read_pairs
from .settings import Wrong

DECKS = (".inp", ".deck")
ASSUMED_DAMPING = 0.01


class Structure:
    """A model, the nodes it belongs to, and what was noted while they were read.

    mesh: as plm.fe takes it; its coordinates are None where nothing tells them."""

    def __init__(self, model, mesh, notes, is_loaded=False, is_damped=False):
        self.model, self.mesh, self.notes = model, mesh, list(notes)
        self.is_loaded, self.is_damped = is_loaded, is_damped
        self.first_load = None  # DOF

    def nodes(self, given, what):
        """Labels of nodes: of one, or of a set of the deck by its name."""
        try:
            return [int(given)]
        except (TypeError, ValueError):
            pass
        sets = getattr(self.mesh, "node_sets", {})
        found = next((labels for name, labels in sets.items() if name.upper() == str(given).upper()), None)
        if found is None:
            known = f"; there are the sets {', '.join(sorted(sets))}" if sets else ""
            raise Wrong(f"{what}: {given!r} is neither a node nor a set of nodes{known}")
        return [int(label) for label in found]

    def dof(self, node, direction, what):
        """The DOF of a node in a direction by its number."""
        row = self.mesh.dof(node, direction)
        if row is None:
            there = [d for d in range(1, N_DIRECTIONS + 1) if self.mesh.dof(node, d) is not None]
            raise Wrong(f"{what}: node {node} has no direction {direction}; it has {', '.join(map(str, there))}" if there else
                        f"{what}: there is no node {node} in the model")
        return row

    def name_of(self, dof):
        """A DOF in words: its node and direction."""
        for node in self.mesh.node_labels.tolist():
            for direction, word in enumerate(("x", "y", "z", "rx", "ry", "rz"), 1):
                if self.mesh.dof(node, direction) == dof:
                    return f"node {node} {word}"
        return f"DOF {dof}"

    def one_dof(self, given, what):
        """The DOF of [node, direction]."""
        nodes = self.nodes(given[0], what)
        if len(nodes) != 1:
            raise Wrong(f"{what}: the set {given[0]} has {len(nodes)} nodes; one is needed")
        return self.dof(nodes[0], direction_of(given[1], what), what)

    def force(self, loads, what):
        """n_dof complex numbers of loads (node or set, direction, amplitude, phase in degrees)."""
        force = numpy.zeros(self.model.n_dof, dtype=complex)
        for node, direction, amplitude, phase in loads:
            for label in self.nodes(node, what):
                row = self.dof(label, direction_of(direction, what), what)
                force[row] += amplitude * numpy.exp(1j * numpy.radians(phase))
                self.first_load = row if self.first_load is None else self.first_load
        return force if numpy.iscomplexobj(force) and force.imag.any() else force.real


def read_structure(settings, context):
    """A structure, not built yet, without loads and supports of the settings."""
    files = settings["model"]
    for path in [*files, *settings["matrices"]]:
        if not pathlib.Path(path).is_file():
            raise Wrong(f"{path} is no file")
    if pathlib.Path(files[0]).suffix.lower() in DECKS:
        return _of_deck(files, settings, context)
    return _of_matrices(files, settings, context)


def assemble(settings, console, assume_damping=False):
    """The structure with all that the settings say, ready to be built."""
    structure = read_structure(settings, console.context)
    model = structure.model
    for given in settings["fix"]:
        for node in structure.nodes(given[0], "fix"):
            model.fix_dofs(_fixed(structure, node, given[1]))
    if settings["preload"]:
        model.set_preload(structure.force(settings["preload"], "preload").real)
        structure.first_load = None
    if settings.get("force"):
        model.set_excitation(structure.force(settings["force"], "force"))
        structure.is_loaded = True
    if not _damp(structure, settings) and assume_damping and structure.is_loaded:
        model.set_modal_damping(ASSUMED_DAMPING)
        structure.notes.append(f"no damping was given: {100 * ASSUMED_DAMPING:g} % of critical in every mode is assumed; --damping-ratio "
                               "sets it")
    for note in structure.notes:
        console.note(note)
    return structure


def require_pairs(model):
    """Refuses a model without contact."""
    if not model.n_pairs:
        raise Wrong("the model has no contact pairs: --contact FILE names a table of them (in a deck: *CONTACT PAIR)")


def _fixed(structure, node, direction):
    if str(direction).lower() != "all":
        return [structure.dof(node, direction_of(direction, "fix"), "fix")]
    rows = [structure.mesh.dof(node, d) for d in range(1, N_DIRECTIONS + 1)]
    rows = [row for row in rows if row is not None]
    if not rows:
        raise Wrong(f"fix: there is no node {node} in the model")
    return rows


def _damp(structure, settings):
    """Sets the damping given; whether there is any."""
    model = structure.model
    if settings["damping_ratio"] is not None:
        model.set_modal_damping(settings["damping_ratio"])
    if settings["loss_factor"] is not None:
        model.set_structural_damping(settings["loss_factor"])
    if settings["rayleigh"] is not None:
        model.set_rayleigh_damping(*settings["rayleigh"])
    return structure.is_damped or any(settings[name] is not None for name in ("damping_ratio", "loss_factor", "rayleigh"))


def _of_matrices(files, settings, context):
    """files: the stiffness matrix, or one with both, then mass, then damping."""
    if len(files) > 3:
        raise Wrong(f"{files[3]} is too much: matrices are stiffness, mass and damping")
    dofs = read_dofs(settings["dofs"]) if settings["dofs"] else None
    matrices = read_matrices(files[0], *files[1:], dofs=dofs)
    if not (matrices.dofs[:, 0] > 0).any():
        raise Wrong(f"{files[0]} comes without a list of DOFs: --dofs names one")
    notes = list(matrices.notes)
    if matrices.loads is not None:
        notes.append(f"{files[0]}: {matrices.loads.shape[1]} load vectors came with the matrices and are not used; --force sets the load")
    coordinates = read_coordinates(settings["coordinates"]) if settings["coordinates"] else None
    mesh = NodeCloud(matrices.dofs, coordinates)
    model = Model(matrices.mass, matrices.stiffness, matrices.damping, context=context)
    structure = Structure(model, mesh, notes, is_damped=matrices.damping is not None)
    _add_pairs(structure, read_pairs(settings["contact"]))
    return structure


def _add_pairs(structure, pairs):
    """One gap row for each pair, in their order."""
    if not pairs:
        return
    rows, nodes = scipy.sparse.lil_matrix((len(pairs), structure.model.n_dof)), []
    for i, pair in enumerate(pairs):
        what = f"contact pair {i + 1}"
        rows[i, structure.dof(pair.node, pair.direction, what)] += pair.sign
        if pair.to:
            rows[i, structure.dof(*pair.to, what)] -= pair.sign
        nodes.append((pair.node, pair.to[0]) if pair.to and pair.to[0] != pair.node else (pair.node,))
    stiffness = [AUTO_STIFFNESS if pair.stiffness is None else pair.stiffness for pair in pairs]
    structure.model.add_gap_rows(rows.tocsr(), stiffness, [pair.gap for pair in pairs])
    structure.mesh.pair_nodes = nodes
