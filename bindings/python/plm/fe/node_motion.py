"""What the nodes of a mesh and the contacts on them do over the period, at a point of a curve."""
import numpy

from .cells import Places

DIRECTIONS = 6  # x, y, z and the rotations about them


class NodeMotion:
    """A point of a branch at the nodes of a mesh, at n_times equidistant times from 0 over the period of the response.

    mesh: node_labels (n), coordinates (n x 3), elements: list of (type, labels, labels of nodes), dof(node, direction) -> row of
    the model or None, direction 1 to 6; and where it has them pair_nodes: for every contact pair the labels of the nodes it
    stands at. recover: Model.recover of a superelement, whose mesh is that of the whole structure; dof gives rows there.

    Displacements are of all DOFs, dependent ones included. Velocities follow from the Fourier coefficients: those of harmonic
    balance itself; of an exact motion they leave out what its "harmonic_error" says.
    """

    def __init__(self, branch, point, mesh, n_times=24, recover=None):
        if n_times < 1:
            raise ValueError(f"n_times is {n_times}; a period needs one time at least")
        self._branch, self._mesh, self._recover = branch, mesh, recover
        self._point = point + len(branch) if point < 0 else point
        self.n_times = n_times
        self.frequency_hz = float(branch.frequency_hz[self._point])
        self.fraction = numpy.arange(n_times) / n_times
        self.time = self.fraction * branch.period_multiple / self.frequency_hz
        self._rows = rows_of(mesh)
        self._has_rotations = bool((self._rows[:, 3:] >= 0).any())
        self._contact = branch.contact(self._point, n_times) if branch.n_pairs else None
        self._coefficients = None

    @property
    def n_nodes(self):
        return len(self._rows)

    def frame(self, k):
        """A dict of arrays with a row for each node at time k: displacement, velocity (n x 3), with rotations rotation (n x 3);
        with contact pairs at nodes what contact_at_nodes gives."""
        q = self._whole(self._branch.field(self._point, self.fraction[k]))
        data = {"displacement": self._at_nodes(q, 0), "velocity": self._at_nodes(self._velocity(k), 0)}
        if self._has_rotations:
            data["rotation"] = self._at_nodes(q, 3)
        if self._contact is not None:
            data.update(contact_at_nodes(self._mesh, *self.pairs(k).values()))
        return data

    def pairs(self, k):
        """Penetration, force and status of every contact pair at time k, each n_pairs; {} without pairs."""
        if self._contact is None:
            return {}
        return {"pair_penetration": self._contact.penetration[:, k], "pair_force": self._contact.force[:, k],
                "pair_status": self._contact.closed[:, k]}

    def _whole(self, q):
        return q if self._recover is None else self._recover(q)

    def _velocity(self, k):
        """Of all DOFs at time k, from q = a0 + sum a_h cos h omega t + b_h sin h omega t."""
        if self._coefficients is None:
            self._coefficients = self._branch.coefficients(self._point)
        h = numpy.arange(1, len(self._coefficients) // 2 + 1)
        angle, omega = 2 * numpy.pi * h * self.fraction[k], 2 * numpy.pi * self.frequency_hz / self._branch.period_multiple
        weight = numpy.zeros(len(self._coefficients))
        weight[1::2], weight[2::2] = -h * omega * numpy.sin(angle), h * omega * numpy.cos(angle)
        return self._whole(weight @ self._coefficients)

    def _at_nodes(self, q, first):
        """Three components of every node, from direction `first` + 1 on; 0 where the node has no such DOF."""
        rows = self._rows[:, first:first + 3]
        if rows.size and rows.max() >= len(q):
            node, direction = numpy.argwhere(rows >= len(q))[0]
            raise ValueError(f"direction {first + direction + 1} of node {self._mesh.node_labels[node]} is DOF {rows.max()} by the "
                             f"mesh, but the motion has {len(q)} DOFs: the mesh is not that of the model")
        return numpy.where(rows >= 0, q[rows.clip(0)], 0.0)


def contact_at_nodes(mesh, penetration, force, closed):
    """Arrays with a value for each node from those of all pairs (n_pairs): penetration (the largest of the node's pairs, NaN
    without one), contact_force (their sum), contact_status (1 closed, 0 open, -1: no pair); {} where no pair is at a node."""
    n, (pair, node) = len(mesh.node_labels), _pairs_at_nodes(mesh, len(penetration))
    if not pair.size:
        return {}
    data = {"penetration": numpy.full(n, numpy.nan), "contact_force": numpy.zeros(n),
            "contact_status": numpy.full(n, -1, dtype=numpy.int32)}
    numpy.fmax.at(data["penetration"], node, penetration[pair])
    numpy.add.at(data["contact_force"], node, force[pair])
    numpy.maximum.at(data["contact_status"], node, closed[pair])
    return data


def rows_of(mesh):
    """The row in the model of every DOF of every node: n x 6, -1 where there is none."""
    rows = numpy.full((len(mesh.node_labels), DIRECTIONS), -1, dtype=numpy.int64)
    for i, label in enumerate(mesh.node_labels):
        for direction in range(DIRECTIONS):
            row = mesh.dof(int(label), direction + 1)
            if row is not None:
                rows[i, direction] = row
    return rows


def _pairs_at_nodes(mesh, n_pairs):
    """(pair, place of its node) for all pairs that stand at nodes."""
    nodes = getattr(mesh, "pair_nodes", None)
    if nodes is None or not n_pairs:
        return numpy.empty(0, dtype=numpy.int64), numpy.empty(0, dtype=numpy.int64)
    if len(nodes) != n_pairs:
        raise ValueError(f"pair_nodes of the mesh has {len(nodes)} rows for {n_pairs} contact pairs; needed is one for each")
    pair = numpy.repeat(numpy.arange(n_pairs), [len(labels) for labels in nodes])
    labels = numpy.array([label for row in nodes for label in row], dtype=numpy.int64)
    return pair, Places(mesh.node_labels).of(labels, "pair_nodes")
