"""Solids of bricks or tetrahedra, linear or quadratic, on a grid that is bent to any shape: the host of tests with surfaces."""
import itertools

import numpy
import plm
import scipy.sparse

CORNERS = numpy.array([[0, 0, 0], [2, 0, 0], [2, 2, 0], [0, 2, 0], [0, 0, 2], [2, 0, 2], [2, 2, 2], [0, 2, 2]])
SIDES = [(0, 1), (1, 2), (2, 3), (3, 0), (4, 5), (5, 6), (6, 7), (7, 4), (0, 4), (1, 5), (2, 6), (3, 7)]


def elements_of(kind):
    """Of a cell: the places of each element's nodes, in halves of the cell, and the exponents of its polynomials."""
    powers = numpy.array(list(itertools.product(range(3), repeat=3)))
    if kind in ("brick8", "brick20"):
        middles = [(CORNERS[a] + CORNERS[b]) // 2 for a, b in SIDES]
        linear = powers[powers.max(1) <= 1]
        if kind == "brick8":
            return [CORNERS], linear
        return [numpy.vstack([CORNERS, middles])], powers[(powers > 1).sum(1) <= 1]
    tetrahedra = []
    for axes in itertools.permutations(range(3)):
        path = numpy.vstack([numpy.zeros(3, int), numpy.cumsum(2 * numpy.eye(3, dtype=int)[list(axes)], 0)])
        middles = [(path[a] + path[b]) // 2 for a, b in itertools.combinations(range(4), 2)]
        tetrahedra.append(path if kind == "tetra4" else numpy.vstack([path, middles]))
    return tetrahedra, powers[powers.sum(1) <= (1 if kind == "tetra4" else 2)]


def points_in(kind, path):
    """Integration points, in halves of the cell, with weights."""
    x, w = numpy.polynomial.legendre.leggauss(3 if kind.startswith("brick") else 4)
    x, w = (x + 1) / 2, w / 2
    if kind.startswith("brick"):
        return 2 * numpy.array(list(itertools.product(x, repeat=3))), 8 * numpy.prod(list(itertools.product(w, repeat=3)), axis=1)
    at, weight = [], []
    for i, j, k in itertools.product(range(4), repeat=3):  # a cube with one face drawn to a point, and an edge of that
        a, b, c = x[i], x[j] * (1 - x[i]), x[k] * (1 - x[i]) * (1 - x[j])
        at.append(path[0] + a * (path[1] - path[0]) + b * (path[2] - path[0]) + c * (path[3] - path[0]))
        weight.append(8 * w[i] * w[j] * w[k] * (1 - x[i])**2 * (1 - x[j]))
    return numpy.array(at), numpy.array(weight)


def polynomials(powers, x):
    """Values and gradients, points x polynomials (x 3)."""
    value = numpy.prod(x[:, None, :]**powers, -1)
    slope = [numpy.prod([powers[:, b] * x[:, None, b]**numpy.maximum(powers[:, b] - 1, 0) if a == b else x[:, None, b]**powers[:, b]
                         for b in range(3)], 0) for a in range(3)]
    return value, numpy.stack(slope, -1)


class Solid:
    """cells: along the three axes of the grid; place: from the unit cube, right-handed; closed: the first axis goes round."""

    def __init__(self, kind, cells, place, modulus=100.0, poisson=0.3, density=1.0, closed=False):
        self.kind, self.cells = kind, cells
        elements, powers = elements_of(kind)
        grid = numpy.arange(numpy.prod(2 * numpy.array(cells) + 1)).reshape(2 * numpy.array(cells) + 1)
        if closed:
            grid[-1] = grid[0]
        low = 2 * numpy.array(list(numpy.ndindex(*cells)))
        nodes = [grid[tuple(numpy.moveaxis(low[:, None] + e, -1, 0))] for e in elements]
        used, where = numpy.unique(numpy.concatenate([n.ravel() for n in nodes]), return_index=True)
        self.number = numpy.full(grid.max() + 1, -1)
        self.number[used] = numpy.arange(len(used))
        self.number = self.number[grid]  # of the nodes, on the grid with middles; -1: none
        self.xyz = numpy.empty((len(used), 3))
        for at in numpy.argwhere(self.number >= 0)[::-1]:  # the first of what goes round wins
            self.xyz[self.number[tuple(at)]] = place(*(at / (2.0 * numpy.array(cells))))
        D = numpy.zeros((6, 6))
        D[:3, :3] = poisson
        D[range(6), range(6)] = [1 - poisson] * 3 + [0.5 - poisson] * 3
        D *= modulus / (1 + poisson) / (1 - 2 * poisson)
        M, K = [], []
        for path, node in zip(elements, nodes):
            node = self.number.ravel()[node]
            inverse = numpy.linalg.inv(polynomials(powers, path)[0])
            m, k = numpy.zeros((len(low),) + (3 * len(path),) * 2), 0
            for p, w in zip(*points_in(kind, path)):
                value, slope = (numpy.einsum("qp...,pn->qn...", f, inverse)[0] for f in polynomials(powers, p[None]))
                J = numpy.einsum("na,eni->eai", slope, self.xyz[node])
                volume = w * numpy.linalg.det(J)
                assert (volume > 0).all(), "the grid is turned inside out"
                G = numpy.linalg.solve(J, numpy.broadcast_to(slope.T, (len(low),) + slope.T.shape))
                B = numpy.zeros((len(low), 6, len(path), 3))
                for i in range(3):
                    B[:, i, :, i] = G[:, i]
                    a, b = (i + 1) % 3, (i + 2) % 3
                    B[:, 3 + i, :, a], B[:, 3 + i, :, b] = G[:, b], G[:, a]
                B = B.reshape(len(low), 6, -1)
                k = k + volume[:, None, None] * (B.transpose(0, 2, 1) @ D @ B)
                m += density * volume[:, None, None] * numpy.kron(numpy.outer(value, value), numpy.eye(3))
            dof = (3 * node[:, :, None] + numpy.arange(3)).reshape(len(low), -1)
            row, column = numpy.repeat(dof, dof.shape[1], 1).ravel(), numpy.tile(dof, dof.shape[1]).ravel()
            M.append(scipy.sparse.coo_matrix((m.ravel(), (row, column)), (self.xyz.size,) * 2))
            K.append(scipy.sparse.coo_matrix((k.ravel(), (row, column)), (self.xyz.size,) * 2))
        self.mass, self.stiffness = sum(a.tocsc() for a in M), sum(a.tocsc() for a in K)

    def nodes(self, axis, end):
        """On a side of the grid; end: 0 or -1."""
        side = self.number.take(end, axis)
        return numpy.unique(side[side >= 0])

    def faces(self, axis, end):
        """Of a side, their normals outwards."""
        side, faces = self.number.take(end, axis), []
        for i, j in itertools.product(range(0, side.shape[0] - 1, 2), range(0, side.shape[1] - 1, 2)):
            c = side[i:i + 3, j:j + 3]
            quad = [c[0, 0], c[2, 0], c[2, 2], c[0, 2]], [c[1, 0], c[2, 1], c[1, 2], c[0, 1]]
            one, two = ([c[0, 0], c[2, 0], c[2, 2]], [c[1, 0], c[2, 1], c[1, 1]]), ([c[0, 0], c[2, 2], c[0, 2]], [c[1, 1], c[1, 2], c[0, 1]])
            for corners, middles in [quad] if self.kind.startswith("brick") else [one, two]:
                if (end == 0) != (axis == 1):
                    corners, middles = corners[:1] + corners[:0:-1], middles[::-1]
                faces.append(corners + (middles if self.kind in ("brick20", "tetra10") else []))
        return faces

    def on_faces(self, axis, end):
        """Integration points of a side: the nodes of the face, their shape functions there, and the area with its inward normal."""
        for face in self.faces(axis, end):
            square = self.kind.startswith("brick")
            corners = numpy.array([[0, 0], [1, 0], [1, 1], [0, 1]] if square else [[0, 0], [1, 0], [0, 1]], float)
            around = corners if len(face) == len(corners) else numpy.vstack([corners, (corners + numpy.roll(corners, -1, 0)) / 2])
            powers = numpy.array(list(itertools.product(range(3), repeat=2)))
            size = powers.max(1) if square else powers.sum(1)
            linear = len(face) == len(corners)
            powers = powers[size <= 1 if linear else (powers.min(1) < 2 if square else size <= 2)]
            inverse = numpy.linalg.inv(flat(powers, around)[0])
            x, w = numpy.polynomial.legendre.leggauss(4)
            for (s, a), (t, b) in itertools.product(zip((x + 1) / 2, w / 2), repeat=2):
                if not square:
                    t, b = t * (1 - s), b * (1 - s)
                N, ds, dt = (f[0] @ inverse for f in flat(powers, numpy.array([[s, t]])))
                yield face, N, -a * b * numpy.cross(ds @ self.xyz[face], dt @ self.xyz[face])

    def pressure(self, axis, end, value=1.0):
        """Nodal forces of a uniform pressure on a side, n x 3."""
        force = numpy.zeros_like(self.xyz)
        for face, N, area in self.on_faces(axis, end):
            force[face] += value * numpy.outer(N, area)
        return force

    def bed(self, axis, end, spring):
        """Springs under a side in all directions, of so much on an area, join the stiffness."""
        springs = scipy.sparse.lil_matrix((len(self.xyz),) * 2)
        for face, N, area in self.on_faces(axis, end):
            springs[numpy.ix_(face, face)] += spring * numpy.linalg.norm(area) * numpy.outer(N, N)
        self.stiffness = (self.stiffness + scipy.sparse.kron(springs, numpy.eye(3))).tocsc()


def flat(powers, x):
    """Polynomials of the plane at points, and their two slopes."""
    def power(a, n):
        return x[:, None, a]**numpy.maximum(n, 0)
    i, j = powers.T
    return power(0, i) * power(1, j), i * power(0, i - 1) * power(1, j), j * power(0, i) * power(1, j - 1)


class Joined:
    """Two solids and their contact: the model, its DOFs (nodes x 3), and where the second's nodes begin."""

    def __init__(self, one, other):
        self.one, self.other, self.n = one, other, len(one.xyz)
        self.xyz = numpy.vstack([one.xyz, other.xyz])
        self.dof = numpy.arange(self.xyz.size).reshape(-1, 3)
        self.mass = scipy.sparse.block_diag([one.mass, other.mass]).tocsc()
        self.stiffness = scipy.sparse.block_diag([one.stiffness, other.stiffness]).tocsc()
        self.model, self.held = plm.Model(self.mass, self.stiffness), []

    def hold(self, nodes, *components):
        for c in components:
            self.held += list(self.dof[nodes, c])

    def sides(self, axis, end):
        """The nodes there, of both."""
        return numpy.concatenate([self.one.nodes(axis, end), self.n + self.other.nodes(axis, end)])

    def node(self, *at):
        """The nearest."""
        return int(numpy.argmin(abs(self.xyz - at).sum(1)))

    def touch(self, of_one, of_other, stiffness, closed, search=0.1, turned=False, **options):
        """The sides that meet; the other is the slave, or, turned, the master."""
        self.model.fix_dofs(numpy.unique(self.held))
        one = self.model.add_surface(self.dof[:self.n], self.one.xyz, self.one.faces(*of_one))
        other = self.model.add_surface(self.dof[self.n:], self.other.xyz, self.other.faces(*of_other))
        slave, master = (one, other) if turned else (other, one)
        self.model.add_surface_contact(slave, master, search, stiffness, closed, **options)

    def areas(self, symmetric=False):
        """Of each pair; each side carries half where both are slaves."""
        has = self.model.surface_pair >= 0
        return numpy.bincount(self.model.surface_pair[has], self.model.surface_area[has]) * (0.5 if symmetric else 1)

    def loads(self, one=None, other=None):
        return numpy.vstack([numpy.zeros_like(s.xyz) if f is None else f for s, f in ((self.one, one), (self.other, other))]).ravel()
