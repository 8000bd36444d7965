"""plm modes: natural frequencies and shapes."""
import csv
import pathlib

import numpy

from ..fe.node_motion import rows_of
from ..fe.replacing import replacing
from ..fe.vtu import write_vtu
from .structure import assemble


def run(settings, console):
    n, system, folder = settings["count"], settings["system"], settings["out"]
    with console.listening():
        structure = assemble(settings, console)
        structure.model.build(progress=console.progress)
        n = min(n, structure.model.n_free)
        result = structure.model.modes(n, system, shapes=folder is not None)
    frequencies = result[0] if folder else result
    console.say("mode  frequency (Hz)")
    for i, frequency in enumerate(frequencies, 1):
        console.say(f"{i:4d}  {frequency:.9g}")
    if folder:
        files = _write(pathlib.Path(folder), structure, *result, console)
        console.say(f"files {', '.join(files)} in {folder}")


def _write(folder, structure, frequencies, shapes, console):
    files = ["modes.csv"]
    with replacing(folder / files[0]) as beside, open(beside, "w", newline="", encoding="utf-8") as file:
        table = csv.writer(file, lineterminator="\n")
        table.writerow(["mode", "frequency_hz"])
        table.writerows([i, repr(float(frequency))] for i, frequency in enumerate(frequencies, 1))
    mesh = structure.mesh
    if mesh.coordinates is None:
        console.note("no modes.vtu: the nodes have no coordinates; --coordinates FILE names a table of them")
        return files
    rows = rows_of(mesh)[:, :3]
    fields = {f"mode_{i + 1}": numpy.where(rows >= 0, shapes[rows.clip(0), i], 0.0) for i in range(len(frequencies))}
    write_vtu(folder / "modes.vtu", mesh, fields, {"frequency_hz": frequencies})
    return [*files, "modes.vtu"]
