"""Pictures with matplotlib, fit for a journal: 8 pt at the width of a column, colours that colour-blind readers tell apart and
line styles and markers that tell them apart in grey, units on every axis, legends beside the curves.

Every function draws into `ax` (None: a new figure) and returns it. `save` writes a picture as PNG, PDF and SVG.

    import plm
    model = plm.Model(mass=[[1]], stiffness=[[1e4]])
    model.set_rayleigh_damping(0, 2e-4)
    model.add_gap_rows([[1]], stiffness=5e3)
    model.set_excitation([1])
    response = model.build().compute_response(dof=0)
    ax = plm.plot.response(response.curve, dof=0)
    plm.plot.save(ax, "curve")                      # curve.png, curve.pdf, curve.svg

units: what the model counts lengths in, "m" (the default), "mm" or "um"; pictures show them in m, mm or um by their size. A pair
says both: units=("m", "mm"). "": numbers as the model has them, axes without a unit. Frequencies are in Hz, forces in N.
"""
from .. import _help
from .contact import contact_area_over_cycle, contact_map, contact_over_cycle, contact_over_frequency
from .curves import backbone, levels, multipliers, response
from .errors import error_over_time, study_convergence, study_curves, study_errors
from .labels import name_points
from .motion import field, harmonics, phase_portrait
from .style import COLUMN, PAGE, figure, legend_above, save, style

__all__ = ["response", "levels", "backbone", "multipliers", "contact_over_cycle", "contact_over_frequency",
           "contact_area_over_cycle", "contact_map", "field", "harmonics", "phase_portrait", "error_over_time", "study_errors",
           "study_curves", "study_convergence", "figure", "save", "style", "legend_above", "name_points", "COLUMN", "PAGE"]

_help.explain((globals()[name] for name in __all__ if callable(globals()[name])), {
    "ax": "axes to draw into; None: a new figure",
    "branch": "a plm.Branch",
    "branches": "a plm.Branch, or a list of them",
    "columns": "how many axes beside each other",
    "dof": "number of a DOF or of an output, from 0",
    "dofs": "numbers of DOFs, from 0",
    "drawn": "a figure or axes",
    "errors": "names of the errors drawn, as those of study_errors",
    "harmonic": "number of the harmonic where measure is \"harmonic\"; 0: the mean",
    "kinds": "endings of the files",
    "labels": "a text for each, shown in the legend; None: none, or numbers",
    "measure": "\"half_peak_to_peak\", \"peak\", \"rms\" or \"harmonic\"",
    "n_times": "number of instants of the period",
    "name": "of the DOF, for the axis",
    "options": "handed on",
    "point": "number of a point of the branch, from 0; -1: the last one",
    "points": "numbers of points of the branch, from 0",
    "rows": "how many axes one below the other",
    "seconds": "run times (s)",
    "time_fraction": "instant, from 0 to 1 of the period",
    "units": "what the model counts lengths in: help(plm.plot)",
})
