"""Load vectors of a deck: what is at rest before the excitation, and the excitation."""
import numbers

import numpy

from . import deck_elements
from .deck_steps import Gravity, Load
from .errors import FileError


def harmonic_step(deck):
    """The number of the last *STEADY STATE DYNAMICS step; None where there is none."""
    steps = [i for i, kind in enumerate(deck.procedures) if kind == "STEADYSTATEDYNAMICS"]
    return steps[-1] if steps else None


def preload(deck):
    """Static loads (n_dof) at the end of the last *STATIC step before the excitation; None where there are none."""
    end = harmonic_step(deck)
    steps = [i for i, kind in enumerate(deck.procedures) if kind == "STATIC" and (end is None or i < end)]
    if not steps:
        return None
    vector = _vector(deck, _acting([load for load in deck.loads if load.step in steps]))
    return vector if vector.any() else None


def excitation(deck):
    """Loads (n_dof, complex where they have both parts) of the *STEADY STATE DYNAMICS step; None where there are none."""
    step = harmonic_step(deck)
    loads = [load for load in deck.loads if load.step == step and step is not None]
    if not loads:
        return None
    real, imaginary = (_vector(deck, _acting([load for load in loads if load.imaginary == part])) for part in (False, True))
    return real + 1j * imaginary if imaginary.any() else real


def given_force(deck, force):
    """force= of deck.model: n_dof numbers, {(node, direction): value}, or a list of (node, direction, value)."""
    if isinstance(force, dict):
        force = [(*key, value) for key, value in force.items()]
    elif not _is_list_of_loads(force):
        force = numpy.asarray(force)
        if force.shape != (deck.n_dof,):
            raise ValueError(f"force has shape {force.shape}; needed are (node, direction, value) of each load, or one number for each "
                             f"of the {deck.n_dof} rows of the model")
        return force
    vector = numpy.zeros(deck.n_dof, dtype=complex if any(isinstance(value, complex) for _, _, value in force) else float)
    for node, direction, value in force:
        row = deck.dof(node, direction)
        if row is None:
            raise ValueError(f"a force acts at node {node} in direction {direction}, where the model has no DOF")
        vector[row] += value
    return vector


def _is_list_of_loads(force):
    """Whether these are triples whose first two are whole numbers."""
    if isinstance(force, numpy.ndarray) or not len(force):
        return False
    return all(numpy.ndim(load) == 1 and len(load) == 3 and isinstance(load[0], numbers.Integral)
               and isinstance(load[1], numbers.Integral) for load in force)


def _acting(loads):
    """{what it acts on: [step, value, record]} after all of these: OP=NEW ends those of earlier steps and of its kind, a load
    takes the place of that of an earlier step, and adds to that of its own."""
    acting, cleared = {}, set()
    for load in loads:
        kind = type(load) is Load  # *CLOAD and *DLOAD end their own kind
        if load.clears and (load.step, kind) not in cleared:
            cleared.add((load.step, kind))
            acting = {key: entry for key, entry in acting.items() if (key[0] == "node") != kind or entry[0] == load.step}
        for key, value in _parts(load):
            if key in acting and acting[key][0] == load.step:
                acting[key][1] = acting[key][1] + value
            else:
                acting[key] = [load.step, value, load]
    return acting


def _parts(load):
    if isinstance(load, Load):
        return [(("node", node, load.direction), load.value) for node in load.nodes.tolist()]
    if isinstance(load, Gravity):
        return [(("weight",), load.acceleration)]
    return [(("face", *face.tolist()), load.value) for face in load.faces]


def _vector(deck, acting):
    dofs, vector = deck._dofs(), numpy.zeros(deck.n_dof)
    for key, (_, value, load) in acting.items():
        if key[0] == "node":
            row = dofs.row(*key[1:])
            if row is not None:
                vector[row] += value
            elif value and not dofs.is_held(*key[1:]):
                raise FileError(load.file, load.line, f"a load acts at node {key[1]} in direction {key[2]}, where the model has no DOF; "
                                "no element and no coupling holds it")
        elif key[0] == "weight":
            vector += _weight(deck, value)
        else:
            nodes = numpy.array(key[1:])
            force = -value * deck_elements.area_vectors(deck.coordinates[deck.node_rows(nodes)])
            rows = dofs.rows(nodes)
            numpy.add.at(vector, rows[rows >= 0], force[rows >= 0])
    return vector


def _weight(deck, acceleration):
    """M times a rigid translation: the shares that the elements give to nodes. Inner nodes (of incompatible modes) neither move
    with it nor are loaded, as in the codes themselves."""
    dofs = numpy.asarray(deck.matrices.dofs)
    of_nodes = numpy.isin(dofs[:, 0], deck.node_labels)
    motion, force = numpy.zeros(len(dofs)), numpy.zeros(deck.n_dof)
    for i in range(3):
        motion[of_nodes & (dofs[:, 1] == i + 1)] = acceleration[i]
    force[:len(dofs)] = numpy.where(of_nodes, deck.matrices.mass @ motion, 0.0)
    return force
