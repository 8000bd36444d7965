"""Contact pairs of a deck as surface contacts of a model."""
import warnings

import numpy

from .. import Model, PlmWarning

ROUNDING = 1e-6  # of the search length: what a file rounds of coordinates is no gap


class SurfaceTable:
    """Surfaces of a deck as the library takes them: nodes with DOFs and coordinates, faces by places among these."""

    def __init__(self, deck, model):
        self._deck, self._model, self._numbers = deck, model, {}

    def table(self, name):
        """(dof n x 3, xyz n x 3, faces as lists of places) of the surface of this name."""
        surface = self._deck.surfaces[name]
        faces = [numpy.searchsorted(surface.nodes, face) for face in surface.faces]
        return self._deck._dofs().rows(surface.nodes), self._deck.coordinates[self._deck.node_rows(surface.nodes)], faces

    def number(self, name):
        """The number of a surface in the model, to which it is added with its first use."""
        if name not in self._numbers:
            dof, xyz, faces = self.table(name)
            self._numbers[name] = self._model.add_surface(dof, xyz, faces, self._deck.surfaces[name].areas)
        return self._numbers[name]


def add_contact(deck, model, surfaces, pair, stiffness, search, closed, symmetric, smooth):
    """One *CONTACT PAIR."""
    _, xyz, faces = surfaces.table(pair.master)
    if search is None:
        search = max(numpy.ptp(xyz[face], axis=0).max() for face in faces)
        if pair.clearance is not None:
            search = max(search, 2 * abs(pair.clearance))
    if closed is None:
        closed = ROUNDING * search if pair.adjust is None else max(pair.adjust, ROUNDING * search)
    interaction = deck.interactions.get(pair.interaction)
    slave = deck.surfaces[pair.slave]
    if stiffness is None and interaction is not None:
        stiffness = interaction.stiffness
        if stiffness is not None and not slave.faces and slave.areas is None:
            stiffness = None
            warnings.warn(PlmWarning(f"{pair.file}:{pair.line}: the slave {pair.slave} has nodes without areas, so that the "
                                     "deck's stiffness by area says nothing; the library chooses the stiffness"), stacklevel=6)
    number = surfaces.number(pair.slave)
    if pair.clearance is not None:
        number = _moved(deck, model, surfaces, pair, search)
        closed = ROUNDING * search if closed >= abs(pair.clearance) else closed
    model.add_surface_contact(number, surfaces.number(pair.master), search, stiffness, closed, points=pair.points,
                              symmetric=symmetric, smooth=smooth)


def _moved(deck, model, surfaces, pair, search):
    """The slave as a surface whose nodes stand at the clearance that the deck asks for, along the normals of the master."""
    dof, xyz, faces = surfaces.table(pair.slave)
    trial = Model(n_dof=deck.n_dof, context=model.context)
    master = trial.add_surface(*surfaces.table(pair.master))
    slave = trial.add_surface(dof, xyz, faces, 1.0)  # areas given: contact at the nodes, whatever the faces
    trial.add_surface_contact(slave, master, search)
    pairs = trial.surface_pair >= 0
    nodes, normal, gap = trial.surface_point[pairs], trial.surface_normal.reshape(-1, 3)[pairs], trial.surface_gap[pairs]
    xyz = xyz.copy()
    xyz[nodes] += (gap - pair.clearance)[:, None] * normal
    return model.add_surface(dof, xyz, faces, deck.surfaces[pair.slave].areas)
