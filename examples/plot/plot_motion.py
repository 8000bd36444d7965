#!/usr/bin/env python3
"""Draws the motion of a .vtu series as plm response and plm.fe.write_vtu_series leave it.

    plot_motion.py SERIES.pvd PICTURE.png [--frame N] [--scale FACTOR] [--view ELEVATION AZIMUTH]

The surface of the mesh, moved by its displacement times FACTOR (by default the largest displacement is a tenth of the size), in the
colours of how far it moves. Without --frame: when contact is widest open, by the mean penetration of all pairs. Needs meshio and
matplotlib, no display.
"""
import argparse
import collections
import pathlib
import sys
import xml.etree.ElementTree

import matplotlib

matplotlib.use("Agg")
import meshio
import numpy
from matplotlib import pyplot
from mpl_toolkits.mplot3d.art3d import Poly3DCollection

# corners of the faces of cells; middle nodes are not drawn
FACES = {"hexahedron": ((0, 3, 2, 1), (4, 5, 6, 7), (0, 1, 5, 4), (1, 2, 6, 5), (2, 3, 7, 6), (3, 0, 4, 7)),
         "wedge": ((0, 2, 1), (3, 4, 5), (0, 1, 4, 3), (1, 2, 5, 4), (2, 0, 3, 5)),
         "tetra": ((0, 2, 1), (0, 1, 3), (1, 2, 3), (2, 0, 3)), "pyramid": ((0, 3, 2, 1), (0, 1, 4), (1, 2, 4), (2, 3, 4), (3, 0, 4)),
         "triangle": ((0, 1, 2),), "quad": ((0, 1, 2, 3),)}


def frames_of(series):
    """[(time, path)] of a .pvd."""
    root = xml.etree.ElementTree.parse(series).getroot()
    return [(float(one.get("timestep")), series.parent / one.get("file")) for one in root.iter("DataSet")]


def surface_of(mesh):
    """The faces that one cell alone has, as tuples of places of their corners."""
    found = collections.defaultdict(list)
    for block in mesh.cells:
        shape = block.type.rstrip("0123456789")
        for nodes in block.data:
            for corners in FACES.get(shape, ()):
                face = tuple(int(nodes[corner]) for corner in corners)
                found[frozenset(face)].append(face)
    return [faces[0] for faces in found.values() if len(faces) == 1]


def widest_open(frames):
    """The number of the frame whose contact is open most."""
    means = []
    for _, path in frames:
        penetration = meshio.read(path).point_data.get("penetration")
        if penetration is None:
            return 0
        means.append(numpy.nanmean(penetration))
    return int(numpy.argmin(means))


def draw(mesh, time, scale, view, picture):
    moved = mesh.point_data["displacement"]
    size, largest = numpy.ptp(mesh.points, axis=0).max(), numpy.linalg.norm(moved, axis=1).max()
    scale = scale or (0.1 * size / largest if largest else 1.0)
    points, far = mesh.points + scale * moved, numpy.linalg.norm(moved, axis=1)
    faces = surface_of(mesh)
    colours = pyplot.cm.viridis(numpy.array([far[list(face)].mean() for face in faces]) / (largest or 1.0))
    figure = pyplot.figure(figsize=(12, 8))
    ax = figure.add_subplot(projection="3d", proj_type="ortho")
    ax.add_collection3d(Poly3DCollection([points[list(face)] for face in faces], facecolors=colours, edgecolors="k", linewidths=0.3))
    low, high = points.min(axis=0), points.max(axis=0)
    ax.set(xlim=(low[0], high[0]), ylim=(low[1], high[1]), zlim=(low[2], high[2]))
    ax.set_box_aspect(numpy.maximum(high - low, 0.02 * size), zoom=0.95)
    ax.view_init(*view)
    ax.set_axis_off()
    bar = pyplot.cm.ScalarMappable(pyplot.Normalize(0, largest), "viridis")
    figure.colorbar(bar, ax=ax, label=f"displacement at {time:.4g} s; drawn times {scale:.3g}", shrink=0.4, pad=0)
    figure.savefig(picture, dpi=110, bbox_inches="tight")


def main():
    parser = argparse.ArgumentParser(description=__doc__.splitlines()[0])
    parser.add_argument("series", type=pathlib.Path)
    parser.add_argument("picture")
    parser.add_argument("--frame", type=int, help="number of the frame, from 0")
    parser.add_argument("--scale", type=float, help="factor on the displacement")
    parser.add_argument("--view", type=float, nargs=2, default=(35, -60), metavar=("ELEVATION", "AZIMUTH"), help="degrees")
    given = parser.parse_args()
    frames = frames_of(given.series)
    number = widest_open(frames) if given.frame is None else given.frame
    if not 0 <= number < len(frames):
        sys.exit(f"{given.series} has the frames 0 to {len(frames) - 1}, not {number}")
    time, path = frames[number]
    draw(meshio.read(path), time, given.scale, given.view, given.picture)


if __name__ == "__main__":
    main()
