"""What plm response leaves in its folder."""
import importlib
import pathlib

from ..fe.hdf5 import write_hdf5
from ..fe.replacing import replacing
from ..fe.vtu import write_vtu_series


def write_files(folder, structure, dof, found, settings, report, console):
    """The curve as table, picture and HDF5, the motion of the peak for viewers, the report. Returns the names."""
    folder = pathlib.Path(folder)
    files = ["response.csv"]
    found.curve.write_csv(folder / files[0], dof, settings["measure"])
    if found.larger:
        files.append("larger.csv")  # the curve of the larger motion
        found.larger.branch.write_csv(folder / files[1], dof, settings["measure"])
    files += _draw(folder, found, dof, settings["measure"], structure.name_of(dof), console)
    files += _hdf5(folder, found.curve, dof, console)
    if structure.mesh.coordinates is None:
        console.note("no .vtu files: the nodes have no coordinates; --coordinates FILE names a table of them")
    else:
        files.append(write_vtu_series(folder, found.peak, 0, structure.mesh, settings["frames"], "peak").name)
    report.write(folder / "report.md", console, structure.unread, files)
    return ["report.md", *files]


def _draw(folder, found, dof, measure, name, console):
    """response.png and .pdf; without matplotlib a note."""
    try:
        figures, agg = importlib.import_module("matplotlib.figure"), importlib.import_module("matplotlib.backends.backend_agg")
        plot = importlib.import_module("..plot", __package__)
    except ImportError:
        console.note("no pictures: they need matplotlib (pip install plm[plot])")
        return []
    figure = figures.Figure(figsize=(11, 4.5), layout="constrained")  # not pyplot's: no window, whatever the backend
    agg.FigureCanvasAgg(figure)
    curve, contact = figure.subplots(1, 2)
    beside = [found.larger.branch] if found.larger else []
    plot.response([found.curve, *beside], dof, measure, labels=["curve", "beside it"] if beside else None, ax=curve)
    curve.plot(found.frequency_hz, found.amplitude, "k+", markersize=9)
    curve.set_title(f"{found.amplitude:.5g} at {found.frequency_hz:.5g} Hz")
    curve.set_ylabel(f"{measure.replace('_', ' ')} of {name}")
    plot.contact_over_cycle(found.peak, 0, ax=contact)
    files = []
    for kind in ("png", "pdf"):
        files.append(f"response.{kind}")
        with replacing(folder / files[-1]) as beside:
            figure.savefig(beside, format=kind)
    return files


def _hdf5(folder, curve, dof, console):
    try:
        write_hdf5(folder / "response.h5", curve, [dof], n_times=64)
    except ImportError:
        console.note("no response.h5: it needs h5py (pip install plm[hdf5])")
        return []
    return ["response.h5"]
