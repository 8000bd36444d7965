"""One file with a mesh and its motion over the period for viewers: VTKHDF, an UnstructuredGrid with steps in time."""
import numpy

from .cells import Cells
from .node_motion import NodeMotion
from .replacing import replacing
from .with_h5py import h5py_for


def write_vtkhdf(path, branch, point, mesh, n_times=24, recover=None):
    """A point of a branch over its period in one file (.vtkhdf): the mesh once, and for each of n_times what NodeMotion.frame
    gives. Version 2.0 of the format; ParaView 5.12 and VTK 9.3 read the steps, older ones the first.
    path: of the file. recover: Model.recover of a superelement; None: the rows of the model are those of the mesh.

        plm.fe.write_vtkhdf("motion.vtkhdf", response.curve, -1, deck, n_times=8)
    """
    h5py = h5py_for("write_vtkhdf")
    motion, cells = NodeMotion(branch, point, mesh, n_times, recover), Cells(mesh)
    with replacing(path) as beside, h5py.File(beside, "w") as file:
        root = file.create_group("VTKHDF")
        root.attrs["Version"] = numpy.array([2, 0], dtype=numpy.int64)
        root.attrs.create("Type", numpy.bytes_("UnstructuredGrid"))  # of fixed length: older readers take no other
        _put_mesh(root, mesh, cells)
        _put_steps(root, motion)


def _put_mesh(root, mesh, cells):
    root["NumberOfPoints"] = numpy.array([len(mesh.node_labels)], dtype=numpy.int64)
    root["NumberOfCells"] = numpy.array([len(cells.types)], dtype=numpy.int64)
    root["NumberOfConnectivityIds"] = numpy.array([len(cells.connectivity)], dtype=numpy.int64)
    root["Points"] = numpy.asarray(mesh.coordinates, dtype=float).reshape((-1, 3))
    root["Connectivity"], root["Offsets"], root["Types"] = cells.connectivity, cells.offsets, cells.types
    root["CellData/element"] = cells.labels


def _put_steps(root, motion):
    """Arrays of all steps one behind the other; Steps says where each step begins. The mesh stands still: one part for all."""
    n, n_nodes = motion.n_times, motion.n_nodes
    steps = root.create_group("Steps")
    steps.attrs["NSteps"] = numpy.int64(n)
    steps["Values"] = motion.time
    nothing, begin = numpy.zeros(n, dtype=numpy.int64), numpy.arange(n, dtype=numpy.int64) * n_nodes
    steps["NumberOfParts"] = numpy.ones(n, dtype=numpy.int64)
    for name in ("PartOffsets", "PointOffsets"):
        steps[name] = nothing
    for name in ("CellOffsets", "ConnectivityIdOffsets"):
        steps[name] = nothing.reshape((n, 1))
    steps["CellDataOffsets/element"] = nothing
    arrays = root.create_group("PointData")
    for k in range(n):
        for name, values in motion.frame(k).items():
            if k == 0:
                arrays.create_dataset(name, (n * n_nodes, *values.shape[1:]), values.dtype)
                steps[f"PointDataOffsets/{name}"] = begin
            arrays[name][k * n_nodes:(k + 1) * n_nodes] = values
