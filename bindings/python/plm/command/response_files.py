"""What plm response leaves in its folder."""
import importlib
import pathlib

from ..fe.hdf5 import write_hdf5
from ..fe.vtu import write_vtu_series


def write_files(folder, structure, dof, found, settings, console):
    """The curve as table, picture and HDF5, the motion of the peak for viewers. Returns the names."""
    folder = pathlib.Path(folder)
    files = ["response.csv"]
    found.curve.write_csv(folder / files[0], dof, settings["measure"])
    if found.larger:
        files.append("larger.csv")  # the curve of the larger motion
        found.larger.branch.write_csv(folder / files[1], dof, settings["measure"])
    files += _draw(folder, found, dof, settings, structure.name_of(dof), console)
    files += _hdf5(folder, found.curve, dof, console)
    if structure.mesh.coordinates is None:
        console.note("no .vtu files: the nodes have no coordinates; --coordinates FILE names a table of them")
    else:
        files.append(write_vtu_series(folder, found.peak, 0, structure.mesh, settings["frames"], "peak").name)
    return files


def plot_or_none(console):
    """plm.plot; without matplotlib None, and a note."""
    try:
        return importlib.import_module("..plot", __package__)
    except ImportError:
        console.note("no pictures: they need matplotlib (pip install plm[plot])")
        return None


def _draw(folder, found, dof, settings, name, console):
    """The curve with its peak, and the contact over the cycle there."""
    plot = plot_or_none(console)
    if plot is None:
        return []
    figure, (curve, contact) = plot.figure(1, 2, width=plot.PAGE, window=False)
    beside = [found.larger.branch] if found.larger else []
    plot.response([found.curve, *beside], dof, settings["measure"], labels=["curve", "beside it"] if beside else None, peaks=[found],
                  units=settings["length_unit"], name=name, ax=curve)
    plot.contact_over_cycle(found.peak, 0, ax=contact)
    return [path.name for path in plot.save(figure, folder / "response")]


def _hdf5(folder, curve, dof, console):
    try:
        write_hdf5(folder / "response.h5", curve, [dof], n_times=64)
    except ImportError:
        console.note("no response.h5: it needs h5py (pip install plm[hdf5])")
        return []
    return ["response.h5"]
