"""From the files and settings to a built model with its nodes."""
import pathlib
import re

import numpy
import scipy.sparse

from .._c import AUTO_STIFFNESS
from .._model import Model
from ..fe import deck_loads
from ..fe.deck import read_deck
from ..fe.matrices import read_matrices
from ..fe.mesh import read_mesh
from ..fe.node_motion import DIRECTIONS as N_DIRECTIONS
from ..fe.pair_nodes import pair_nodes_of
from .nodes import NodeCloud, direction_of, read_coordinates
from .pairs import read_pairs
from .settings import Wrong

DECKS = (".inp", ".deck")
ASSUMED_DAMPING = 0.01


class Structure:
    """A model, the nodes it belongs to, and what was noted while they were read.

    mesh: as plm.fe takes it; its coordinates are None where nothing tells them. unread: texts, what of a deck was not taken.
    is_loaded, is_damped, is_preloaded: whether the files say so themselves; first_load: a DOF on which the excitation acts, or None."""

    def __init__(self, model, mesh, notes, unread=(), is_loaded=False, is_damped=False, first_load=None,
                 is_preloaded=False):
        self.model, self.mesh, self.notes, self.unread = model, mesh, list(notes), list(unread)
        self.is_loaded, self.is_damped, self.first_load = is_loaded, is_damped, first_load
        self.is_preloaded, self._names = is_preloaded, None

    def nodes(self, given, what):
        """Labels of nodes: of one, or of a set of the deck by its name."""
        if isinstance(given, int) and not isinstance(given, bool) or re.fullmatch(r"\s*[-+]?[0-9]{1,15}\s*", str(given)):
            return [int(given)]
        sets = getattr(self.mesh, "node_sets", {})
        found = next((labels for name, labels in sets.items() if name.upper() == str(given).upper()), None)
        if found is None:
            known = f"; there are the sets {', '.join(sorted(sets))}" if sets else ""
            raise Wrong(f"{what}: {given!r} is neither a node nor a set of nodes{known}")
        if not len(found):
            raise Wrong(f"{what}: the set {given} has no nodes")
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
        if self._names is None:  # one that stands for two, as the same rotation of nodes that are one, has its first name
            self._names = {self.mesh.dof(node, direction): f"node {node} {word}" for node in reversed(self.mesh.node_labels.tolist())
                           for direction, word in reversed([*enumerate(("x", "y", "z", "rx", "ry", "rz"), 1)])}
        return self._names.get(dof, f"DOF {dof}")

    def one_dof(self, given, what, first=False):
        """The DOF of [node, direction]; first: of the first node of a set."""
        nodes = self.nodes(given[0], what)
        if len(nodes) != 1 and not first:
            raise Wrong(f"{what}: the set {given[0]} has {len(nodes)} nodes; one is needed")
        return self.dof(nodes[0], direction_of(given[1], what), what)

    def force(self, loads, what):
        """n_dof complex numbers of loads (node or set, direction, amplitude, phase in degrees)."""
        force = numpy.zeros(self.model.n_dof, dtype=complex)
        for node, direction, amplitude, phase in loads:
            for label in self.nodes(node, what):
                row = self.dof(label, direction_of(direction, what), what)
                force[row] += amplitude * numpy.exp(1j * numpy.radians(phase))
        return force if numpy.iscomplexobj(force) and force.imag.any() else force.real


def read_structure(settings, context):
    """A structure, not built yet, without loads and supports of the settings."""
    files = settings["model"]
    for path in [*files, *settings["matrices"], *([settings["mesh"]] if settings["mesh"] else [])]:
        if not pathlib.Path(path).is_file():
            raise Wrong(f"{path} is no file")
    if pathlib.Path(files[0]).suffix.lower() in DECKS:
        return _of_deck(files, settings, context)
    return _of_matrices(files, settings, context)


def assemble(settings, console, assume_damping=False):
    """The structure with all that the settings say, ready to be built."""
    structure = read_structure(settings, console.context)
    model, console.name_of = structure.model, structure.name_of
    for given in settings["fix"]:
        for node in structure.nodes(given[0], "fix"):
            model.fix_dofs(_fixed(structure, node, given[1]))
    if settings["preload"]:
        model.set_preload(structure.force(settings["preload"], "preload").real)
        structure.is_preloaded = True
    if settings["force"]:
        model.set_excitation(structure.force(settings["force"], "force"))
        structure.is_loaded, structure.first_load = True, structure.one_dof(settings["force"][0][:2], "force", first=True)
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
    """Sets the damping given, in place of that of a deck; whether there is any."""
    model = structure.model
    given = any(settings[name] is not None for name in ("damping_ratio", "loss_factor", "rayleigh"))
    if given:
        model.set_rayleigh_damping(0, 0)
        model.set_modal_damping([])
    if settings["damping_ratio"] is not None:
        model.set_modal_damping(settings["damping_ratio"])
    if settings["loss_factor"] is not None:
        model.set_structural_damping(settings["loss_factor"])
    if settings["rayleigh"] is not None:
        model.set_rayleigh_damping(*settings["rayleigh"])
    return structure.is_damped or given


def _of_deck(files, settings, context):
    if len(files) > 1:
        raise Wrong(f"{files[1]} is too much behind a deck; its matrices are named by --matrices")
    deck = read_deck(files[0])
    if settings["matrices"]:
        deck.set_matrices(_matrices_of(settings["matrices"], settings))
    contact = {name: settings[name] for name in ("contact_stiffness", "search", "closed", "symmetric", "smooth")}
    model = deck.model(context, build=False, **contact)
    deck.pair_nodes, notes = pair_nodes_of(deck, model, settings["symmetric"])
    load, step = deck_loads.excitation(deck), deck_loads.harmonic_step(deck)
    shaken = any(boundary.value and boundary.step == step for boundary in deck.boundaries) and step is not None
    structure = Structure(model, deck, [*deck.notes, *deck.matrices.notes, *notes], [f"{file}:{line}: {text}" for file, line, text in
                          deck.unread], is_loaded=load is not None or shaken,
                          is_damped=bool(deck.rayleigh or deck.modal_damping or deck.matrices.damping is not None),
                          first_load=None if load is None else int(numpy.argmax(numpy.abs(load))),
                          is_preloaded=deck_loads.preload(deck) is not None)
    _add_pairs(structure, read_pairs(settings["contact"]))
    return structure


def _matrices_of(files, settings):
    """Stiffness, or one file with all, then mass, then damping."""
    if len(files) > 3:
        raise Wrong(f"{files[3]} is too much: matrices are stiffness, mass and damping")
    return read_matrices(*files, dofs=settings["dofs"])


def _of_matrices(files, settings, context):
    matrices = _matrices_of(files, settings)
    if not (matrices.dofs[:, 0] > 0).any():
        raise Wrong(f"{files[0]} comes without a list of DOFs: --dofs names one")
    notes = list(matrices.notes)
    if matrices.loads is not None:
        notes.append(f"{files[0]}: {matrices.loads.shape[1]} load vectors came with the matrices and are not used; --force sets the load")
    if settings["mesh"]:
        mesh = read_mesh(settings["mesh"], matrices)
        mesh.pair_nodes = None
        notes += mesh.notes
    else:
        mesh = NodeCloud(matrices.dofs, read_coordinates(settings["coordinates"]) if settings["coordinates"] else None)
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
    structure.mesh.pair_nodes = [*(structure.mesh.pair_nodes or ()), *nodes]  # behind those of a deck
