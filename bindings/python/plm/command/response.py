"""plm response: from the files to the curve, its peak and the motion there."""
import contextlib
import math
import pathlib
import warnings
from typing import NamedTuple

from .._errors import PlmError, PlmWarning
from .._functions import NOT_CONVERGED, TRUNCATED
from .._reduction import Basis, Sampler
from .._response import Hbm, Response
from .report import write_report
from .response_files import write_files
from .saving import SavedCurve
from .settings import Wrong, settings_text
from .structure import assemble, require_pairs


class Found(NamedTuple):
    """What a response is made of; error: estimated bound, relative; peak: the branch of one point; larger: or None."""
    frequency_hz: float
    amplitude: float
    error: float
    curve: object
    peak: object
    larger: object


def run(settings, console, resumes=False):
    saved = SavedCurve(settings, resumes, console) if resumes or settings["save_every"] else None
    with console.listening(with_log=True):
        structure = assemble(settings, console, assume_damping=True)
        dof, (low, high) = output_dof(structure, settings), range_of(structure.model, settings)
        structure.model.build(progress=console.progress)
    with console.listening():  # what the log says of curves on the way, the call repeats if it still holds at the end
        found = compute(structure.model, dof, low, high, settings, console.progress, saved)
    if found.curve.status in (NOT_CONVERGED, TRUNCATED):
        console.matters = True
    if not found.error <= settings["accuracy"]:
        console.warn("the error of the peak is " + (f"estimated to be {found.error:.1e}, more than the accuracy asked for, "
                     f"{settings['accuracy']:g}" if math.isfinite(found.error) else "not known"))
    page = console.in_words(found.curve.describe())
    console.say(page.rstrip("\n"))
    if settings["out"]:
        with console.listening():
            files = write_files(settings["out"], structure, dof, found, settings, console)
        files += saved.files if saved else []
        write_report(pathlib.Path(settings["out"]) / "report.md", settings_text("response", settings), page, console, structure.unread,
                     files)
        console.say(f"\nFiles\n  report.md, {', '.join(files)} in {settings['out']}")


def output_dof(structure, settings):
    """The DOF that is looked at."""
    if not structure.is_loaded:
        raise Wrong("nothing excites the model: --force NODE DIRECTION AMPLITUDE does")
    if settings["output"]:
        return structure.one_dof(settings["output"], "output")
    if structure.first_load is None:
        raise Wrong("--output NODE DIRECTION is needed: it says what is looked at")
    return structure.first_load


def compute(model, dof, low, high, settings, progress, saved=None):
    """Found of a built model: in the range given, or around the resonance that the library chooses. A curve that is saved is
    followed on one basis."""
    if low is None and saved is None:
        return _around_resonance(model, dof, settings, progress)
    return _in_range(model, dof, low, high, settings, progress, saved)


def range_of(model, settings):
    """(low, high) in Hz as they were given, None where the library is to find them; of a model that has contact."""
    low, high = settings["frequency_min_hz"], settings["frequency_max_hz"]
    if (low is None) != (high is None):
        raise Wrong("frequency_min_hz and frequency_max_hz belong together; give both or none")
    if low is not None and not low < high:
        raise Wrong(f"frequency_min_hz, {low:g}, must be below frequency_max_hz, {high:g}")
    require_pairs(model)
    return low, high


def window_options(low, high):
    """Of a sampler for this range; none for a range that the library is to find."""
    return {} if low is None else {"mode_frequency_hz": math.sqrt(low * high), "window_min_hz": low, "window_max_hz": high}


def _around_resonance(model, dof, settings, progress):
    response = model.compute_response(dof, settings["accuracy"], settings["measure"], progress=progress)
    larger = response.larger
    with warnings.catch_warnings():  # the call above has warned of all of it
        warnings.simplefilter("ignore")
        peak = response.hbm.find_peak(response.curve, dof, settings["measure"], progress=progress)
    return Found(response.frequency_hz, response.amplitude, response.error, response.curve, peak.branch, larger)


def _in_range(model, dof, low, high, settings, progress, saved):
    """On the basis from the mode nearest to the middle of the range, or the dominant one; where its error is too large, on a
    refined one."""
    def make():
        return Basis(model, Sampler(model, **window_options(low, high)).run(progress)).build(progress)
    basis = saved.basis(model, make) if saved else make()
    found, told = _on_basis(basis, dof, low, high, settings, progress, saved)
    if not found.error <= settings["accuracy"] and _is_inside(found.frequency_hz, found.curve):
        with contextlib.suppress(PlmError):  # then the first answer stands, with its error
            first = _solver(basis, low, high, settings)

            def refine():
                return first.refine_basis(dof, settings["accuracy"], settings["measure"], progress=progress).basis
            if saved:
                saved.go_on_refined()
            larger = saved.basis(model, refine) if saved else refine()
            better, of_better = _on_basis(larger, dof, low, high, settings, progress, saved)
            if better.error <= found.error or math.isnan(found.error):
                found, told = better, of_better
    for one in told:
        warnings.warn(one, stacklevel=2)
    return found


def _is_inside(frequency_hz, curve):
    """Whether the highest point is a peak, not an end of the curve."""
    return curve.frequency_hz.min() < frequency_hz < curve.frequency_hz.max()


def _solver(basis, low, high, settings):
    limits = {} if low is None else {"frequency_min_hz": low, "frequency_max_hz": high}
    return Hbm(basis, accuracy=settings["accuracy"], **limits)


def _on_basis(basis, dof, low, high, settings, progress, saved=None):
    """(Found of this basis between these frequencies, what the library warned of meanwhile)."""
    measure, error = settings["measure"], math.nan
    with warnings.catch_warnings(record=True) as issued:
        warnings.simplefilter("always")
        hbm = _solver(basis, low, high, settings)
        curve = saved.sweep(hbm, basis, progress) if saved else hbm.sweep(progress)
        peak = hbm.find_peak(curve, dof, measure, progress=progress)
        if peak.amplitude > 0 and _is_inside(peak.frequency_hz, curve):
            with contextlib.suppress(PlmError):
                parts = hbm.estimate_error(peak.branch, 0, dof, measure, progress=progress)
                error = max(abs(parts.amplitude.total) / peak.amplitude, abs(parts.frequency_hz.total) / peak.frequency_hz)
        larger = _beside(Response(peak.frequency_hz, peak.amplitude, error, curve, hbm), progress) if low is None else None
    told = [one.message for one in issued]
    if larger:
        told.append(PlmWarning(f"beside the curve, at the same force, there is a stable motion of {larger.amplitude:.6g} at "
                               f"{larger.frequency_hz:.6g} Hz, {larger.amplitude / peak.amplitude:.3g} times the peak: a disturbance or a force "
                               "that was larger before may leave the structure there"))
    return Found(peak.frequency_hz, peak.amplitude, error, curve, peak.branch, larger), told


def _beside(response, progress):
    """The larger motion beside a whole curve, as the call that does all of it looks for it."""
    with contextlib.suppress(PlmError):  # where walls move, resonance is not told by its phase
        response.hbm.find_isolated(response.curve, progress=progress)
    return response.larger
