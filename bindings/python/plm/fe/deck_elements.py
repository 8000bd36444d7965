"""Elements of CalculiX and Abaqus: how many nodes they have, and which of them make their faces.

Corner nodes of a face run so that its normal by the right-hand rule points out of the solid (the manuals list them the
other way round); behind them come the middles of the sides, from the one between the first two corners on.
"""
import re

import numpy

_BRICK = ((1, 4, 3, 2), (5, 6, 7, 8), (1, 2, 6, 5), (2, 3, 7, 6), (3, 4, 8, 7), (4, 1, 5, 8))
_TETRAHEDRON = ((1, 3, 2), (1, 2, 4), (2, 3, 4), (3, 1, 4))
_WEDGE = ((1, 3, 2), (4, 5, 6), (1, 2, 5, 4), (2, 3, 6, 5), (3, 1, 4, 6))
_PYRAMID = ((1, 4, 3, 2), (1, 2, 5), (2, 3, 5), (3, 4, 5), (4, 1, 5))
_TRIANGLE, _SQUARE = ((1, 2, 3),), ((1, 2, 3, 4),)

_BRICK_EDGES = ((1, 2), (2, 3), (3, 4), (4, 1), (5, 6), (6, 7), (7, 8), (8, 5), (1, 5), (2, 6), (3, 7), (4, 8))
_TETRAHEDRON_EDGES = ((1, 2), (2, 3), (3, 1), (1, 4), (2, 4), (3, 4))
_WEDGE_EDGES = ((1, 2), (2, 3), (3, 1), (4, 5), (5, 6), (6, 4), (1, 4), (2, 5), (3, 6))
_TRIANGLE_EDGES, _SQUARE_EDGES = ((1, 2), (2, 3), (3, 1)), ((1, 2), (2, 3), (3, 4), (4, 1))


def _faces(corners, edges, faces):
    """Faces as places in the element's list of nodes, from 0, with the middles that its edges have."""
    middle = {frozenset(edge): corners + i for i, edge in enumerate(edges)}
    made = []
    for face in faces:
        sides = [frozenset((a, b)) for a, b in zip(face, face[1:] + face[:1])]
        made.append(tuple(n - 1 for n in face) + tuple(middle[side] for side in sides if middle))
    return tuple(made)


SOLIDS = {  # number of nodes -> faces S1, S2, ... of the solid elements C3D<number>
    4: _faces(4, (), _TETRAHEDRON), 10: _faces(4, _TETRAHEDRON_EDGES, _TETRAHEDRON),
    5: _faces(5, (), _PYRAMID),
    6: _faces(6, (), _WEDGE), 15: _faces(6, _WEDGE_EDGES, _WEDGE),
    8: _faces(8, (), _BRICK), 20: _faces(8, _BRICK_EDGES, _BRICK),
}
SHEETS = {  # of shells and membranes: the positive side
    3: _faces(3, (), _TRIANGLE), 6: _faces(3, _TRIANGLE_EDGES, _TRIANGLE),
    4: _faces(4, (), _SQUARE), 8: _faces(4, _SQUARE_EDGES, _SQUARE),
}
OTHERS = {"B31": 2, "B31R": 2, "B32": 3, "B32R": 3, "B33": 2, "T3D2": 2, "T3D3": 3, "MASS": 1, "ROTARYI": 1, "SPRING1": 1,
          "SPRING2": 2, "SPRINGA": 2, "DASHPOT1": 1, "DASHPOT2": 2, "DASHPOTA": 2, "DCOUP3D": 1, "GAPUNI": 2, "CONN3D2": 2}
SOLID = re.compile(r"(?:C3D|SC|CSS)(4|5|6|8|10|15|20)[A-Z]*$")
SHEET = re.compile(r"(?:S|STRI|M3D|SFM3D|R3D|DS)(3|4|6|8|65)[A-Z0-9]*$")
PLANE = re.compile(r"(?:CPS|CPE|CAX)(3|4|6|8)[A-Z]*$")


def n_nodes(kind):
    """Nodes of an element type; None where the type is not known."""
    if kind in OTHERS:
        return OTHERS[kind]
    for pattern in (SOLID, SHEET, PLANE):
        match = pattern.match(kind)
        if match:
            return {65: 6}.get(int(match.group(1)), int(match.group(1)))
    return None


def is_sheet(kind):
    return kind not in OTHERS and bool(SHEET.match(kind))


def faces_of(kind):
    """{name of a face: places in the element's nodes, from 0}; empty for elements without faces in space.

    Solids have S1 ... S6. Shells have SPOS and SNEG, and by CalculiX's names S1 for the negative and S2 for the positive side."""
    if kind not in OTHERS and SOLID.match(kind):
        return {f"S{i}": face for i, face in enumerate(SOLIDS[n_nodes(kind)], 1)}
    if is_sheet(kind):
        front = SHEETS[n_nodes(kind)][0]
        back = turned(front)
        return {"SPOS": front, "SNEG": back, "S1": back, "S2": front}
    return {}


def turned(face):
    """The same face seen from behind."""
    corners = len(face) if len(face) in (3, 4) else len(face) // 2
    back = face[:1] + face[corners - 1:0:-1]
    return back + tuple(face[:corners - 1:-1]) if len(face) > corners else back


def corner_key(face):
    """A face (array of labels) by its corners, whatever side it is seen from."""
    return frozenset(face[:len(face) if len(face) in (3, 4) else len(face) // 2].tolist())


def shape(n, s, t):
    """Values and derivatives (n, n x 2) of the shape functions of a face of n nodes, corners at (0, 0), (1, 0), (0, 1) of a
    triangle and (-1, -1) ... (-1, 1) of a square."""
    if n in (3, 6):
        corner, slope = numpy.array([1 - s - t, s, t]), numpy.array([[-1.0, -1.0], [1.0, 0.0], [0.0, 1.0]])
        if n == 3:
            return corner, slope
        a, b = corner[[0, 1, 2]], corner[[1, 2, 0]]
        da, db = slope[[0, 1, 2]], slope[[1, 2, 0]]
        return (numpy.concatenate([corner * (2 * corner - 1), 4 * a * b]),
                numpy.vstack([(4 * corner - 1)[:, None] * slope, 4 * (a[:, None] * db + b[:, None] * da)]))
    x, y = numpy.array([-1, 1, 1, -1]), numpy.array([-1, -1, 1, 1])
    u, v = 1 + s * x, 1 + t * y
    if n == 4:
        return u * v / 4, numpy.column_stack([x * v, u * y]) / 4
    e = s * x + t * y - 1
    x2, y2 = numpy.array([0, 1, 0, -1]), numpy.array([-1, 0, 1, 0])
    along = x2 == 0
    p, q = numpy.where(along, 1 - s * s, 1 + s * x2), numpy.where(along, 1 + t * y2, 1 - t * t)
    dp, dq = numpy.where(along, -2 * s, x2), numpy.where(along, y2, -2 * t)
    return (numpy.concatenate([u * v * e / 4, p * q / 2]),
            numpy.vstack([numpy.column_stack([x * v * (e + u), y * u * (e + v)]) / 4, numpy.column_stack([dp * q, p * dq]) / 2]))


_THIRD = ((1 / 6, 1 / 6), (2 / 3, 1 / 6), (1 / 6, 2 / 3))
_LINE = ((-numpy.sqrt(0.6), 5 / 9), (0.0, 8 / 9), (numpy.sqrt(0.6), 5 / 9))
POINTS = {  # places and weights that integrate a shape function times the area of its face
    3: [(*p, 1 / 6) for p in _THIRD], 6: [(*p, 1 / 6) for p in _THIRD],
    4: [(s, t, a * b) for s, a in _LINE for t, b in _LINE],
}
POINTS[8] = POINTS[4]


def area_vectors(xyz):
    """n x 3: integral of each shape function times the normal of a face with nodes at xyz (n x 3), which is what a unit
    pressure, turned round, does to its nodes."""
    result = numpy.zeros(numpy.shape(xyz))
    for s, t, weight in POINTS[len(xyz)]:
        N, slope = shape(len(xyz), s, t)
        along = slope.T @ xyz
        result += weight * N[:, None] * numpy.cross(along[0], along[1])
    return result


def shares(xyz):
    """n: what each node stands for of the area of a face with nodes at xyz (n x 3). With middle nodes by the squares of the shape
    functions: their integrals are not positive at corners."""
    vectors = area_vectors(xyz)
    area = numpy.linalg.norm(vectors.sum(axis=0))
    if len(xyz) in (3, 4):
        size = numpy.linalg.norm(vectors, axis=1)
    else:
        size = sum(weight * shape(len(xyz), s, t)[0]**2 for s, t, weight in POINTS[len(xyz)])
    return area * size / size.sum() if size.sum() > 0 else size
