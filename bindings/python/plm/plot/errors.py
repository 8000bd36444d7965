"""Error against time, and what else a study compares."""
import numpy

from .labels import name_points
from .style import COLOURS, FAINT, MARKERS, REFERENCE, axes, legend_above, length_unit, round_ticks, styled

_STYLES = ("-", (0, (6, 1.5)), (0, (3, 1, 1, 1)), (0, (1, 1)), (0, (5, 1, 1, 1, 1, 1)))


@styled
def error_over_time(seconds, error, labels=None, pareto=None, reference=None, smallest=0.0, ax=None):
    """Error of several reductions over their run time. pareto: flags of those that no other one beats in both: they are filled,
    and the stairs below which none lies lead from one to the next. reference: the run time (s) of what the others are compared
    with, a line, for its error of 0 has no place on the axis. Errors of at most `smallest`, which are those of the reference
    itself, and NaN are left out.

        plm.plot.error_over_time([1.3, 1.8, 10.9], [1.6e-2, 2.2e-4, 3.2e-3], ["coarse", "default", "Craig-Bampton"],
                                 pareto=[True, True, False], reference=4.5)
    """
    ax = axes(ax, "run time (s)", "relative error")
    shown = [i for i, e in enumerate(error) if e > smallest and seconds[i] > 0]
    best = [i for i in shown if pareto is not None and pareto[i] == 1]
    ax.set_xscale("log")
    ax.set_yscale("log")
    ax.plot([seconds[i] for i in shown], [error[i] for i in shown], "o", color=COLOURS[0], mfc="white", zorder=3)
    lines = []
    if best:
        lines.append(stairs([(seconds[i], error[i]) for i in best]))
        ax.plot(*lines[0], color=COLOURS[0], lw=1, zorder=2.9)
        ax.plot([seconds[i] for i in best], [error[i] for i in best], "o", color=COLOURS[0], zorder=3.1)
        ax.plot([], [], "o-", color=COLOURS[0], lw=1, label="Pareto front: none faster and better")
    ax.margins(0.15)
    if reference is not None:
        ax.axvline(reference, color=FAINT, ls="--", lw=1, label=f"the reference: {reference:.3g} s, error 0")
        lines.append(([reference, reference], ax.get_ylim()))
    round_ticks(ax.xaxis, *ax.get_xlim())
    legend_above(ax, columns=1)
    if labels:
        name_points(ax, [(seconds[i], error[i], labels[i]) for i in shown], lines)
    return ax


def stairs(points):
    """(x, y) of the stairs through points of a front: level from one to the next, then down."""
    x, y = numpy.array(sorted(points)).T
    return numpy.repeat(x, 2)[1:], numpy.repeat(y, 2)[:-1]


_ERRORS = {"curve_error_l2": "error of the curve (rms)", "curve_error_max": "error of the curve (largest)",
           "amplitude_error": "relative error of the peak", "frequency_error": "relative error of its frequency"}


def _front(seconds, error):
    """Flags of those that no other one beats in time or error without losing in the other."""
    return [seconds[i] == seconds[i] and error[i] == error[i] and
            not any(t <= seconds[i] and e <= error[i] and (t < seconds[i] or e < error[i]) for t, e in zip(seconds, error))
            for i in range(len(error))]


@styled
def study_errors(study, error="curve_error_l2", ax=None):
    """Error of every method of a study over its run time (set-up and curves), named, with the Pareto front and the run time of
    the reference. error: "curve_error_l2", "curve_error_max", "amplitude_error" or "frequency_error". Methods that failed, and
    those nearer to the reference than rounding tells, are left out.

        plm.plot.study_errors(study.run(), "amplitude_error")
    """
    seconds, values = study.setup_seconds + study.curve_seconds, study[error]
    reference = study.reference_setup_seconds + study.reference_curve_seconds
    ax = error_over_time(seconds, values, study.names, _front(seconds, values), reference, 1e-13, ax)
    ax.set_xlabel("set-up and curves (s)")
    ax.set_ylabel(_ERRORS[error])
    return ax


@styled
def study_curves(study, level=0, methods=None, units="m", ax=None):
    """The curves of the methods (indices or names; None: all) at a force level, thin, over that of the reference. Steady
    states of a method that marches in time are markers; methods that failed are left out.

        plm.plot.study_curves(study, methods=["4 samples", "Craig-Bampton"])
    """
    marches = numpy.isnan(study.iteration_seconds)
    chosen = [i for i, name in enumerate(study.names)
              if (methods is None or i in methods or name in methods) and study.basis_size[i] >= 0]
    hz, truth = study.points("reference", level)
    unit = length_unit(units, truth)
    ax = axes(ax, "frequency (Hz)", unit.label("amplitude"))
    ax.plot(hz, unit.factor * truth, color=REFERENCE, lw=4, label="reference")
    for n, i in enumerate(chosen):
        hz, amplitude = study.points(i, level)
        ax.plot(hz, unit.factor * amplitude, color=COLOURS[n % len(COLOURS)], lw=1, label=study.names[i],
                ls="" if marches[i] else _STYLES[n % len(_STYLES)], marker=MARKERS[n % len(MARKERS)], mfc="white",
                markevery=1 if marches[i] else _apart(len(hz), n, len(chosen)))
    legend_above(ax)
    return ax


def _apart(n_points, number, count):
    """Places of four markers on a curve, apart from those of the other curves."""
    return [int((k + (number + 0.5) / count) * n_points / 4) for k in range(4)]


@styled
def study_convergence(study, parameter, methods=None, errors=("curve_error_l2", "amplitude_error", "frequency_error"),
                      xlabel="parameter", ax=None):
    """Errors of the methods (indices or names; None: all) over a parameter of theirs, one number for each: samples,
    harmonics, columns, a tolerance. An error of 0 has no place on the axis and is left out, and so is NaN.

        plm.plot.study_convergence(study, [1, 3, 5], methods=["H = 1", "H = 3", "H = 5"], xlabel="harmonics")
    """
    names = study.names
    methods = range(len(names)) if methods is None else methods
    indices = [names.index(m) if isinstance(m, str) else m for m in methods]
    if len(indices) != len(parameter):
        raise ValueError(f"parameter has {len(parameter)} numbers for {len(indices)} methods")
    ax = axes(ax, xlabel, "error")
    for n, error in enumerate(errors):
        shown = sorted((x, study[error][i]) for x, i in zip(parameter, indices) if study[error][i] > 0)
        ax.loglog([x for x, _ in shown], [e for _, e in shown], color=COLOURS[n], marker=MARKERS[n], mfc="white",
                  ls=_STYLES[n], label=_ERRORS[error])
    if len(parameter) <= 12:  # the numbers themselves instead of powers of ten
        ax.set_xticks(sorted(set(parameter)), [f"{x:g}" for x in sorted(set(parameter))])
        ax.minorticks_off()
    legend_above(ax, columns=1)
    return ax
