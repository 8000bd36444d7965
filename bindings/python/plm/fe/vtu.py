"""Meshes with results for viewers: .vtu files, and the .pvd that makes a series of them."""
import base64
import os
import pathlib
import sys
from xml.sax.saxutils import quoteattr

import numpy

from .cells import Cells
from .node_motion import NodeMotion
from .replacing import replacing

_TYPES = {"f8": "Float64", "i4": "Int32", "i8": "Int64", "u1": "UInt8"}


def write_vtu_series(folder, branch, point, mesh, n_times=24, name="cycle", recover=None):
    """A point of a branch over its period: NAME_000.vtu, ... and NAME.pvd with their times (s), into a folder that is there.
    Returns the path of the .pvd. What is in the files, and what a mesh is: NodeMotion.
    n_times: instants of the period. name: of the files. recover: Model.recover of a superelement; None: the rows of the model are
    those of the mesh.

        plm.fe.write_vtu_series(".", response.curve, -1, deck, n_times=8, name="motion")
    """
    motion, cells = NodeMotion(branch, point, mesh, n_times, recover), Cells(mesh)
    folder, digits = pathlib.Path(folder), max(3, len(str(n_times - 1)))
    names = [f"{name}_{k:0{digits}d}.vtu" for k in range(n_times)]
    for k, file in enumerate(names):
        field = {"TimeValue": motion.time[k:k + 1], **motion.pairs(k)}
        write_vtu(folder / file, mesh, motion.frame(k), field, cells)
    series = folder / f"{name}.pvd"
    _write_pvd(series, zip(motion.time, names))  # last: it names no file that is not there
    return series


def write_vtu(path, mesh, point_data, field_data=None, cells=None):
    """One mesh with arrays at its nodes (n or n x k) and others of any length; the labels of nodes and elements are added.
    path: of the file. point_data: {name: array at the nodes}. field_data: {name: array}. cells: of the mesh, where they are known
    from another file of the series; None: made.

        plm.fe.write_vtu("mesh.vtu", deck, {"displacement": 0 * deck.coordinates})
    """
    cells = cells or Cells(mesh)
    n_points, n_cells = len(mesh.node_labels), len(cells.types)
    points = numpy.asarray(mesh.coordinates, dtype=float).reshape((-1, 3))
    if len(points) != n_points:
        raise ValueError(f"the mesh has {n_points} nodes and coordinates of {len(points)}")
    point_data = {**point_data, "node": numpy.asarray(mesh.node_labels, dtype=numpy.int64)}
    with replacing(path) as beside, open(beside, "wb") as file:
        order = "LittleEndian" if sys.byteorder == "little" else "BigEndian"
        _put(file, '<?xml version="1.0"?>\n'
             f'<VTKFile type="UnstructuredGrid" version="1.0" byte_order="{order}" header_type="UInt64">\n<UnstructuredGrid>\n')
        _put_section(file, "FieldData", field_data or {})
        _put(file, f'<Piece NumberOfPoints="{n_points}" NumberOfCells="{n_cells}">\n')
        _put_section(file, "Points", {"Points": points})
        _put_section(file, "Cells", {"connectivity": cells.connectivity, "offsets": cells.offsets[1:], "types": cells.types})
        _put_section(file, "PointData", point_data, n_points)
        _put_section(file, "CellData", {"element": cells.labels})
        _put(file, "</Piece>\n</UnstructuredGrid>\n</VTKFile>\n")


def _put(file, text):
    file.write(text.encode())


def _put_section(file, section, arrays, rows=None):
    _put(file, f"<{section}>\n")
    for name, values in arrays.items():
        values = _plain(values)
        if rows is not None and len(values) != rows:
            raise ValueError(f"{name} has {len(values)} rows for {rows} nodes")
        size = f' NumberOfTuples="{len(values)}"' if section == "FieldData" else ""
        parts = values.shape[1] if values.ndim == 2 else 1
        _put(file, f'<DataArray type="{_TYPES[values.dtype.str[1:]]}" Name={quoteattr(name)} NumberOfComponents="{parts}"{size} '
             'format="binary">\n')
        data = values.tobytes()
        file.write(base64.b64encode(numpy.uint64(len(data)).tobytes() + data))  # its length in front
        _put(file, "\n</DataArray>\n")
    _put(file, f"</{section}>\n")


def _plain(values):
    """Doubles, or integers of a width that VTK knows, row after row."""
    values = numpy.asarray(values)
    if values.dtype == numpy.bool_:
        values = values.astype(numpy.uint8)
    if values.dtype.str[1:] not in _TYPES:
        values = values.astype(numpy.int64 if numpy.issubdtype(values.dtype, numpy.integer) else numpy.float64)
    return numpy.ascontiguousarray(values.astype(values.dtype.newbyteorder("="), copy=False))


def _write_pvd(path, steps):
    with replacing(path) as beside, open(beside, "w", encoding="utf-8") as file:
        file.write('<?xml version="1.0"?>\n<VTKFile type="Collection" version="0.1">\n<Collection>\n')
        for time, name in steps:
            file.write(f'<DataSet timestep="{float(time)!r}" part="0" file={quoteattr(os.fspath(name))}/>\n')
        file.write("</Collection>\n</VTKFile>\n")
