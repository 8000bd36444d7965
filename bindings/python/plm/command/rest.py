"""plm rest: contact at rest under the pre-load."""
import csv
import pathlib

import numpy

from ..fe.node_motion import contact_at_nodes, rows_of
from ..fe.replacing import replacing
from ..fe.vtu import write_vtu
from .report import number_text
from .structure import assemble, require_pairs


def run(settings, console):
    with console.listening():
        structure = assemble(settings, console)
        model = structure.model
        require_pairs(model)
        model.build(progress=console.progress).solve_rest(progress=console.progress)
        if not structure.is_preloaded and not (model.initial_gap < 0).any():
            console.note("no pre-load acts and no gap is below 0, so that nothing moves: --preload NODE DIRECTION FORCE sets a force (in a "
                         "deck: a *STATIC step)")
    force, displacement = model.rest_force, model.rest_displacement
    console.say(f"closed        {model.rest_n_closed} of {model.n_pairs} pairs")
    console.say(f"force         {number_text(force.sum())} of all pairs together, {number_text(force.max())} at most")
    largest = int(numpy.argmax(numpy.abs(displacement)))
    console.say(f"displacement  {number_text(displacement[largest])} at most, {structure.name_of(largest)}")
    if settings["out"]:
        files = _write(pathlib.Path(settings["out"]), structure, console)
        console.say(f"files         {', '.join(files)} in {settings['out']}")


def _write(folder, structure, console):
    model, mesh, files = structure.model, structure.mesh, ["rest.csv"]
    penetration, force, closed = model.rest_penetration, model.rest_force, model.rest_closed
    with replacing(folder / files[0]) as beside, open(beside, "w", newline="", encoding="utf-8") as file:
        table = csv.writer(file, lineterminator="\n")
        table.writerow(["pair", "penetration", "force", "closed", "initial_gap", "contact_stiffness"])
        for i, row in enumerate(zip(penetration, force, closed, model.initial_gap, model.contact_stiffness)):
            table.writerow([i, *(int(value) if j == 2 else repr(float(value)) for j, value in enumerate(row))])
    if mesh.coordinates is None:
        console.note("no rest.vtu: the nodes have no coordinates; --coordinates FILE names a table of them")
        return files
    rows = rows_of(mesh)[:, :3]
    data = {"displacement": numpy.where(rows >= 0, model.rest_displacement[rows.clip(0)], 0.0)}
    data.update(contact_at_nodes(mesh, penetration, force, closed))
    write_vtu(folder / "rest.vtu", mesh, data)
    return [*files, "rest.vtu"]
