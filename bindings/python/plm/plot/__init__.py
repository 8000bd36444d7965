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
from .contact import contact_area_over_cycle, contact_map, contact_over_cycle, contact_over_frequency
from .curves import backbone, levels, multipliers, response
from .errors import error_over_time, study_convergence, study_curves, study_errors
from .labels import name_points
from .motion import field, harmonics, phase_portrait
from .style import COLUMN, PAGE, figure, legend_above, save, style

__all__ = ["response", "levels", "backbone", "multipliers", "contact_over_cycle", "contact_over_frequency",
           "contact_area_over_cycle", "contact_map", "field", "harmonics", "phase_portrait", "error_over_time", "study_errors",
           "study_curves", "study_convergence", "figure", "save", "style", "legend_above", "name_points", "COLUMN", "PAGE"]
