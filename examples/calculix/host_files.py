#!/usr/bin/env python3
"""Reads a deck with contact through plm.fe and writes what calculix_response needs, for run.sh.

    host_files.py DECK FOLDER [--force NODE DIRECTION AMPLITUDE]... [--output NODE DIRECTION]

matrices.sti, .mas, .dof  K and M of mesh, materials and sections, by ccx
model.txt                 all else that the deck says of the model, a record for each call of the library: "word integers reals", then
                          so many integers and so many reals; DOFs are rows of the matrices from 0 on, -1 where there is none
open.inp                  the deck without contact, its natural frequencies
closed.inp                the same with every contact pair as an equation and a spring of stiffness k_n, where the meshes match

NODE is a number or the name of a set, DIRECTION 1 to 3.
"""
import argparse
import os
import sys
import warnings

import numpy
import plm
import plm.fe
import scipy.sparse
from plm.fe import deck_masses, deck_model
from plm.fe.deck_lines import read_blocks
from plm.fe.pair_nodes import pair_nodes_of

CONTACT = {"CONTACTPAIR", "SURFACEINTERACTION", "SURFACEBEHAVIOR", "FRICTION", "CLEARANCE"}
N_FREQUENCIES = 26  # the host compares ten that are no rigid motions: ARPACK has converged the lower ones far better
ASSUMED_DAMPING = 0.01


class Records:
    """Has the methods of plm.Model by which a deck tells its model, and writes down what it is told."""
    context = None  # of trials that are made on the way

    def __init__(self, n_dof):
        self.n_dof, self.lines, self.n_surfaces, self.is_damped = n_dof, [], 0, False
        self.force = None

    def _record(self, word, integers, reals=()):
        flat = [numpy.concatenate([numpy.ravel(part) for part in parts]) if len(parts) else [] for parts in (integers, reals)]
        self.lines.append(f"{word} {len(flat[0])} {len(flat[1])}")
        self.lines.append(" ".join(str(int(value)) for value in flat[0]))
        self.lines.append(" ".join(f"{value:.17g}" for value in flat[1]))

    @staticmethod
    def _compressed(faces):
        start = numpy.concatenate([[0], numpy.cumsum([len(face) for face in faces])])
        return start, numpy.concatenate(faces) if len(faces) else []

    def set_rayleigh_damping(self, alpha, beta):
        self.is_damped = True
        self._record("rayleigh", [], [[alpha, beta]])

    def set_modal_damping(self, ratio):
        self.is_damped = True
        self._record("modal_damping", [], [ratio])

    def fix_dofs(self, dof):
        self._record("fix", [dof])

    def add_masses(self, masses):
        """{row: mass}"""
        self._record("mass", [list(masses)], [list(masses.values())])

    def add_constraints(self, rows):
        rows = scipy.sparse.csr_matrix(rows)
        self._record("constraints", [[rows.shape[0]], rows.indptr, rows.indices], [rows.data])

    def add_rigid_link(self, reference, at, nodes, xyz):
        self._record("rigid_link", [[len(reference), len(nodes), nodes.shape[1]], reference, nodes], [at, xyz])

    def add_distributing_coupling(self, reference, at, nodes, xyz, weight=None):
        weight = numpy.broadcast_to(1.0 if weight is None else weight, len(nodes))
        self._record("distributing", [[len(reference), len(nodes)], reference, nodes], [at, xyz, weight])

    def add_tie(self, dof, xyz, surface_dof, surface_xyz, faces, tolerance):
        start, node = self._compressed(faces)
        self._record("tie", [[len(dof), len(surface_dof), len(faces)], dof, surface_dof, start, node], [[tolerance], xyz, surface_xyz])

    def add_surface(self, dof, xyz, faces=(), area=None):
        start, node = self._compressed(faces)
        given = [] if area is None else [numpy.broadcast_to(area, len(dof))]
        self._record("surface", [[len(dof), len(faces), len(given)], dof, start, node], [xyz, *given])
        self.n_surfaces += 1
        return self.n_surfaces - 1

    def add_surface_contact(self, slave, master, search, stiffness=None, closed=0.0, points=False, symmetric=False, smooth=False):
        self._record("contact", [[slave, master, points, symmetric, smooth, stiffness is None]], [[stiffness or 0.0, search, closed]])

    def set_coordinates(self, dof, xyz):
        self._record("coordinates", [[len(dof), dof.shape[1]], dof], [xyz])

    def set_base_motion(self, motion, quantity="displacement"):
        number = ("displacement", "velocity", "acceleration").index(quantity)
        self._record("base_motion", [[number]], [numpy.real(motion), numpy.imag(motion)])

    def set_preload(self, force):
        self._record("preload", [], [force])

    def set_excitation(self, force):
        self.force = numpy.asarray(force)
        self._record("excitation", [], [numpy.real(force), numpy.imag(force)])

    def write(self, path):
        with open(path, "w", encoding="ascii") as file:
            file.write("\n".join(self.lines) + "\n")


def nodes_of(deck, name):
    """[label] of a number, or of a set by its name."""
    try:
        return [int(name)]
    except ValueError:
        if name not in deck.node_sets:
            sys.exit(f"{deck.path}: {name} is neither a number nor a set of nodes")
        return deck.node_sets[name].tolist()


def row_of(deck, node, direction):
    row = deck.dof(node, int(direction))
    if row is None:
        sys.exit(f"{deck.path}: node {node} has no direction {direction}")
    return row


def write_model(deck, folder, force, output):
    records = Records(deck.n_dof)
    records._record("size", [[deck.n_dof]])
    masses = {deck.dof(node, d): mass for node, mass in deck_masses.point_masses(deck).items() for d in (1, 2, 3)}
    if masses:
        records.add_masses(masses)
    given = [(node, int(d), float(value)) for name, d, value in force for node in nodes_of(deck, name)] or None
    deck_model.hand_over(deck, records, force=given)
    if not records.is_damped:
        print(f"the deck has no damping: {100 * ASSUMED_DAMPING:g} % of critical in every mode")
        records.set_modal_damping([ASSUMED_DAMPING])
    if output is None and records.force is None:
        sys.exit(f"{deck.path}: nothing excites the model, or supports do: --force and --output say what is driven and looked at")
    row = int(numpy.argmax(numpy.abs(records.force))) if output is None else row_of(deck, nodes_of(deck, output[0])[0], output[1])
    records._record("output", [[row]])
    records.write(os.path.join(folder, "model.txt"))


# ---- decks for ccx's own frequencies ----

def open_lines(deck):
    """All that stands before the first step but contact; supports of the steps behind it."""
    lines = []
    for block in read_blocks(deck.path):
        if block.key == "STEP":
            break
        if block.key not in CONTACT:
            lines += [block.text, *(line.text for line in block.lines)]
    held = [(n, d) for support in deck.boundaries if support.step >= 0 for n in support.nodes for d in support.directions]
    return lines + (["*BOUNDARY"] + [f"{n}, {d}, {d}" for n, d in held] if held else [])


def node_pairs(deck, model):
    """[(node, node it meets, normal)] of every contact pair; None where meshes do not match."""
    labels, _ = pair_nodes_of(deck, model, False)
    masters = numpy.unique(numpy.concatenate([deck.surfaces[contact.master].nodes for contact in deck.contact_pairs]))
    at = deck.coordinates[deck.node_rows(masters)]
    points = numpy.argsort(model.surface_pair)[-model.n_pairs:]  # of each pair
    found = []
    for names, point in zip(labels, points.tolist()):
        normal = model.surface_normal.reshape(-1, 3)[point]
        if not names:
            return None
        here = deck.coordinates[deck.node_rows(names)[0]] + model.surface_gap[point] * normal
        away = numpy.linalg.norm(at - here, axis=1)
        if away.min() > 1e-6 * numpy.ptp(at, axis=0).max():
            return None
        found.append((names[0], int(masters[away.argmin()]), normal))
    return found


def spring_lines(pairs, stiffness, node, element):
    """Every pair: a node of its own, labels from `node` on, moves as the gap closes, and a spring holds it."""
    lines = []
    for i, ((a, b, normal), k) in enumerate(zip(pairs, stiffness)):
        terms = [f"{label},{d},{sign * normal[d - 1]:.12e}" for label, sign in ((a, 1), (b, -1)) for d in (1, 2, 3) if normal[d - 1]]
        terms = [f"{node + i},1,-1.0", *terms]
        lines += ["*NODE", f"{node + i},0.,0.,0.", "*EQUATION", str(len(terms))]
        lines += [",".join(terms[at:at + 4]) for at in range(0, len(terms), 4)]
        lines += [f"*ELEMENT, TYPE=SPRING1, ELSET=PAIR{i}", f"{element + i},{node + i}", f"*SPRING, ELSET=PAIR{i}", "1", f"{k:.12e}"]
    return lines + ["*BOUNDARY"] + [f"{node + i},2,3" for i in range(len(stiffness))]


def write_deck(folder, name, lines):
    with open(os.path.join(folder, name), "w", encoding="ascii", errors="replace") as file:
        file.write("\n".join([*lines, "*STEP", "*FREQUENCY", str(N_FREQUENCIES), "*END STEP"]) + "\n")


def main():
    parser = argparse.ArgumentParser(description=__doc__, formatter_class=argparse.RawDescriptionHelpFormatter)
    parser.add_argument("deck")
    parser.add_argument("folder")
    parser.add_argument("--force", nargs=3, action="append", default=[], metavar=("NODE", "DIRECTION", "AMPLITUDE"))
    parser.add_argument("--output", nargs=2, metavar=("NODE", "DIRECTION"))
    options = parser.parse_args()
    warnings.simplefilter("ignore", plm.PlmWarning)  # the host prints what the library says of the model
    try:
        deck = plm.fe.read_deck(options.deck)
        for file, line, text in deck.unread:
            print(f"{file}:{line}: {text}")
        if not deck.contact_pairs:
            sys.exit(f"{deck.path}: no *CONTACT PAIR")
        deck.matrices_by_calculix(options.folder)
        write_model(deck, options.folder, options.force, options.output)
        model = deck.model()
    except plm.fe.FileError as error:
        sys.exit(str(error))
    lines = open_lines(deck)
    write_deck(options.folder, "open.inp", lines)
    pairs = node_pairs(deck, model)
    if pairs:
        element = max(int(block.labels.max()) for block in deck.elements)
        write_deck(options.folder, "closed.inp",
                   lines + spring_lines(pairs, model.contact_stiffness, int(deck.node_labels[-1]) + 1, element + 1))


if __name__ == "__main__":
    main()
