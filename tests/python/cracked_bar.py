"""A mesh with a crack as plm.fe takes meshes, and its model: nodes joined by springs, not elements, since only numbers count."""
import numpy
import plm


class Mesh:
    """Bricks on both sides of a crack, a quadratic tetrahedron, a shell, a beam of three nodes; labels with holes, in disorder."""

    def __init__(self):
        layer = [(0, 0, 0), (1, 0, 0), (1, 1, 0), (0, 1, 0)]
        points = [(x, y, z) for z in (0, 1) for x, y, _ in layer] + [(x, y, z) for z in (1, 2) for x, y, _ in layer]
        points += [(3, 0, 0), (4, 0, 0), (3, 1, 0), (3, 0, 1)]
        corners = points[16:]
        points += [tuple(numpy.mean([corners[i], corners[j]], axis=0)) for i, j in ((0, 1), (1, 2), (2, 0), (0, 3), (1, 3), (2, 3))]
        points += [(5, 0, 0), (6, 0, 0), (7, 0, 0)]
        self.coordinates = numpy.array(points, dtype=float)
        n = len(points)
        self.node_labels = 7 * ((5 * numpy.arange(n)) % n) + 3
        label = self.node_labels
        self.elements = [("C3D8", [11, 12], label[numpy.arange(16).reshape(2, 8)]), ("C3D10", [40], label[16:26][None]),
                         ("S4R", [50], label[[8, 9, 10, 11]][None]), ("B32", [60], label[26:29][None])]
        self.pair_nodes = [(label[4 + i], label[8 + i]) for i in range(4)] + [(label[28],)]
        self._place = {int(name): i for i, name in enumerate(label)}

    def dof(self, node, direction):
        """Nodes have three DOFs, those of the beam six; the first node has none in y."""
        i = self._place[node]
        if i == 0 and direction == 2:
            return None
        if direction > 3:
            return 3 * len(self.node_labels) + 3 * (i - 26) + direction - 4 if i >= 26 else None
        return 3 * i + direction - 1


def make_model(mesh, context=None):
    n = len(mesh.node_labels)
    n_dof = 3 * n + 9
    random = numpy.random.default_rng(3)
    stiffness = numpy.diag(random.uniform(2e3, 4e3, n_dof))
    for _ in range(4 * n_dof):
        i, j = random.integers(0, n_dof, 2)
        if i != j:
            stiffness[numpy.ix_([i, j], [i, j])] += 3e3 * numpy.array([[1, -1], [-1, 1]])
    model = plm.Model(numpy.diag(random.uniform(0.5, 1.5, n_dof)), stiffness, context=context)
    model.set_rayleigh_damping(1.0, 1e-4)
    rows = numpy.zeros((2, n_dof))
    rows[0, [0, 3, 6]] = 1, -0.5, -0.5  # a node that hangs on two others
    rows[1, [3 * n + 8, 78]] = 1, -2
    model.add_constraints(rows)
    model.add_node_pairs([[3 * (4 + i), 3 * (4 + i) + 1, 3 * (4 + i) + 2] for i in range(4)],
                         [[3 * (8 + i), 3 * (8 + i) + 1, 3 * (8 + i) + 2] for i in range(4)], [0, 0, 1], stiffness=2e4)
    model.add_ground_contacts([[3 * 28, 3 * 28 + 1, 3 * 28 + 2]], [1, 0, 0], stiffness=1e4, gap=1e-4)
    force = numpy.zeros(n_dof)
    force[[3 * 9 + 2, 3 * 28]] = 5, 2
    model.set_excitation(force)
    return model.build()
