"""plm study: error against run time of several ways to the response."""
import pathlib

from .._functions import OK
from .._reduction import Basis, Sampler
from .._response import Hbm
from .._study import Study
from .response import output_dof, range_of, window_options
from .response_files import plot_or_none
from .structure import assemble


def run(settings, console):
    with console.listening(with_log=True):
        structure = assemble(settings, console, assume_damping=True)
        dof, (low, high) = output_dof(structure, settings), range_of(structure.model, settings)
        structure.model.build(progress=console.progress)
    with console.listening():
        study = Study(structure.model, repeats=settings["repeats"], accuracy=settings["accuracy"])
        study.set_output(dof, settings["measure"])
        _add_methods(study, structure.model, low, high, settings)
        study.run(progress=console.progress)
    _show(study, console)
    if study.status != OK:
        console.matters = True
    if settings["out"]:
        study.write(settings["out"])
        files = ["report.md", "table.csv", *_draw(study, pathlib.Path(settings["out"]), settings, console)]
        console.say(f"files: {', '.join(files)} and a curve of each method in {settings['out']}")


def _add_methods(study, model, low, high, settings):
    """Piecewise-linear modes of every number of samples and harmonics, the last of them refined, and two rivals."""
    window = window_options(low, high)

    def hbm(kind, n_harmonics, sampler):
        return Hbm(Basis(model, sampler, kind=kind), n_harmonics=n_harmonics, stability="off")

    sampler = None
    for n_samples in settings["samples"]:
        sampler = Sampler(model, n_samples=n_samples, **window)
        for n_harmonics in settings["harmonics"]:
            study.add_response(f"{n_samples} samples, H = {n_harmonics}", hbm("plm", n_harmonics, sampler))
    most = max(settings["harmonics"])
    study.add_refined(f"for {settings['accuracy']:g}", hbm("plm", most, sampler), settings["accuracy"])
    for name, kind in (("Craig-Bampton", "craig_bampton"), ("bilinear modes", "bilinear")):
        study.add_response(name, hbm(kind, most, sampler))
    # as accurate as the library can, not with the harmonics of the first method
    study.set_reference(Hbm(Basis(model, sampler, kind="full"), stability="off"))


def _show(study, console):
    width = max(map(len, [*study.names, "reference"]))
    console.say(f"{'method':{width}s} columns   set-up   curves   error of frequency      peak     curve")
    rows = zip(study.names, study.basis_size, study.setup_seconds, study.curve_seconds, study.frequency_error, study.amplitude_error,
               study.curve_error_l2, study.pareto)
    for i, (name, size, setup, curves, frequency, peak, curve, is_best) in enumerate(rows):
        if size < 0:
            console.warn(f"{name}: {study.outcome(i)}")
        console.say(f"{name:{width}s} {size:7d} {setup:8.3f} {curves:8.3f} s {frequency:18.1e} {peak:9.1e} {curve:9.1e}"
                    f"{'  Pareto' if is_best == 1 else ''}")
    console.say(f"{'reference':{width}s} {study.reference_size:7d} {study.reference_setup_seconds:8.3f} "
                f"{study.reference_curve_seconds:8.3f} s, peak {study.reference_peak_amplitude:.6g} at {study.reference_peak_hz:.6g} Hz")


def _draw(study, folder, settings, console):
    plot = plot_or_none(console)
    if plot is None:
        return []
    figure, (errors, curves) = plot.figure(1, 2, width=plot.PAGE, window=False)
    plot.study_errors(study, ax=errors)
    plot.study_curves(study, units=settings["length_unit"], ax=curves)
    return [path.name for path in plot.save(figure, folder / "study")]
