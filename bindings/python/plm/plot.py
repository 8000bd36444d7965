"""Figures with matplotlib. Every function draws into `ax` (None: a new figure) and returns it."""
import numpy
from matplotlib import pyplot


def _axes(ax, xlabel, ylabel):
    if ax is None:
        ax = pyplot.figure(layout="constrained").add_subplot()
    ax.set_xlabel(xlabel)
    ax.set_ylabel(ylabel)
    ax.grid(alpha=0.3)
    return ax


def _runs(flags):
    """(first, last, flag) of every run of equal flags; a run reaches to the first point of the next one."""
    starts = [0, *(numpy.flatnonzero(flags[1:] != flags[:-1]) + 1), len(flags)]
    return [(a, min(b, len(flags) - 1), flags[a]) for a, b in zip(starts[:-1], starts[1:])]


def _curve(ax, x, y, stable, label):
    """A line whose unstable parts are dashed, in one colour."""
    marker = {"marker": "o" if len(x) == 1 else "", "markersize": 4}
    if stable is None:
        ax.plot(x, y, label=label, **marker)
        return
    flags = numpy.asarray(stable, dtype=bool)
    if flags.shape != numpy.shape(x):
        raise ValueError(f"stable has the shape {flags.shape}, the branch has {len(x)} points")
    colour, named = None, False
    for first, last, flag in _runs(flags):
        name = label if not named and (flag or not flags.any()) else None  # one entry of the legend, solid if there is one
        line, = ax.plot(x[first:last + 1], y[first:last + 1], ls="-" if flag else "--", color=colour, label=name, **marker)
        colour, named = line.get_color(), named or name is not None


_MARKERS = {"fold": "s", "branch point": "D", "period doubling": "^", "Neimark-Sacker": "o"}


def _stability_of(branch):
    """Flags of every point, None where the branch has no stability. A point without it takes that of the one before."""
    flags = branch.stable.copy()
    known = numpy.flatnonzero(flags >= 0)
    if not known.size:
        return None
    last = numpy.searchsorted(known, numpy.arange(len(flags)), side="right") - 1
    return flags[known[last.clip(0)]] == 1


def _mark_bifurcations(ax, branch, amplitude, drawn):
    """One marker for each kind, one entry of the legend for each kind in the axes."""
    for kind, marker in _MARKERS.items():
        points = [b.point for b in branch.bifurcations if b.kind == kind]
        if not points:
            continue
        ax.plot(branch.frequency_hz[points], amplitude[points], ls="", marker=marker, color="k", mfc="white", markersize=6,
                zorder=3, label=None if kind in drawn else kind)
        drawn.add(kind)


def response(branches, dof, measure="half_peak_to_peak", harmonic=0, labels=None, peaks=(), stable=None, bifurcations=True,
             ax=None):
    """Amplitude of a DOF over frequency: one branch or several, with their folds; peaks: results of Hbm.find_peak.

    Unstable parts are dashed where the branch has stability (option stability of Hbm). stable: flags of every point instead
    of those (of several branches a list, with None for the branch's own); False: all lines solid. bifurcations: mark the
    folds, branch points, period doublings and Neimark-Sacker points that were located."""
    if not isinstance(branches, (list, tuple)):
        branches, stable = [branches], stable if stable is False else [stable]
    stable = [False] * len(branches) if stable is False else stable or [None] * len(branches)
    ax = _axes(ax, "frequency (Hz)", f"amplitude of DOF {dof} ({measure.replace('_', ' ')})")
    drawn = {line.get_label() for line in ax.lines}  # of an earlier call
    for i, branch in enumerate(branches):
        amplitude = branch.amplitude(dof, measure, harmonic)
        flags = _stability_of(branch) if stable[i] is None else None if stable[i] is False else stable[i]
        _curve(ax, branch.frequency_hz, amplitude, flags, labels[i] if labels else None)
        if bifurcations:
            _mark_bifurcations(ax, branch, amplitude, drawn)
    for peak in peaks:
        ax.plot(peak.frequency_hz, peak.amplitude, "k+", markersize=9)
        ax.annotate(f"{peak.amplitude:.4g} at {peak.frequency_hz:.4g} Hz", (peak.frequency_hz, peak.amplitude),
                    textcoords="offset points", xytext=(6, 4))
    if labels or drawn & _MARKERS.keys():
        ax.legend()
    return ax


def contact_over_frequency(branch, n_times=64, ax=None):
    """Share of the pairs that are closed, over frequency: mean over the period, and from the least to the most closed."""
    ax = _axes(ax, "frequency (Hz)", "share of the pairs that are closed")
    mean = [branch.closed_share(i).mean() for i in range(len(branch))]
    area = numpy.array([branch.contact(i, n_times).closed.mean(axis=0) for i in range(len(branch))])
    frequency = branch.frequency_hz
    for limit, label in ((area.min(axis=1), "least in the period"), (area.max(axis=1), "most in the period")):
        ax.plot(frequency, limit, lw=0.8, color="C7", ls="--" if label.startswith("least") else "-.", label=label)
    ax.plot(frequency, mean, color="C0", label="mean over the period")
    ax.set_ylim(-0.03, 1.03)
    ax.legend()
    return ax


def contact_over_cycle(branch, point, n_times=256, ax=None):
    """Which pairs are closed during the period at a point of the branch, and their share."""
    ax = _axes(ax, "time / period", "pair")
    contact = branch.contact(point, n_times)
    n_pairs = len(contact.closed)
    ax.imshow(contact.closed, aspect="auto", interpolation="nearest", cmap="Greys", vmin=0, vmax=2, origin="lower",
              extent=(0, 1, -0.5, n_pairs - 0.5))
    ax.grid(False)
    share = ax.twinx()
    share.plot(contact.time, contact.closed.mean(axis=0), color="C3", drawstyle="steps-post")
    share.set_ylim(-0.03, 1.03)
    share.set_ylabel("share of the pairs that are closed", color="C3")
    ax.set_title(f"{branch.frequency_hz[point]:.5g} Hz; dark: closed")
    return ax


def harmonics(branch, point, dofs, labels=None, ax=None):
    """Magnitude of every harmonic of some DOFs at a point of the branch."""
    dofs = numpy.atleast_1d(dofs)
    ax = _axes(ax, "harmonic", "magnitude")
    width = 0.8 / len(dofs)
    for i, dof in enumerate(dofs):
        magnitude = numpy.abs(branch.harmonics(point, int(dof)))
        ax.bar(numpy.arange(len(magnitude)) + (i - (len(dofs) - 1) / 2) * width, magnitude, width,
               label=labels[i] if labels else f"DOF {dof}")
    ax.set_yscale("log")
    ax.legend()
    return ax


def contact_area_over_cycle(branch, point, n_times=256, area=None, ax=None):
    """Contact area during the period at a point of the branch; area: that of each pair (None: the pairs are counted)."""
    contact = branch.contact(point, n_times)
    area = numpy.ones(len(contact.closed)) if area is None else numpy.asarray(area)
    ax = _axes(ax, "time / period", "pairs in contact" if (area == 1).all() else "contact area")
    ax.plot(numpy.append(contact.time, 1), numpy.append(area @ contact.closed, area @ contact.closed[:, 0]),
            drawstyle="steps-post", label=f"{branch.frequency_hz[point]:.5g} Hz")
    ax.set_ylim(-0.03 * area.sum(), 1.03 * area.sum())
    ax.legend()
    return ax


def error_over_time(seconds, error, labels=None, pareto=None, ax=None):
    """Error of several reductions against their run time; pareto: flags of those that no other one beats in both, which a
    stepped line then joins. An error of 0, as the reference has it, has no place on the axis and is left out, and so is
    NaN."""
    ax = _axes(ax, "run time (s)", "relative error")
    shown = [i for i, e in enumerate(error) if e > 0 and seconds[i] > 0]
    ax.loglog([seconds[i] for i in shown], [error[i] for i in shown], "o")
    front = sorted((i for i in shown if pareto is not None and pareto[i]), key=lambda i: seconds[i])
    if front:
        ax.loglog([seconds[i] for i in front], [error[i] for i in front], "o-", color="C3", lw=1, mfc="none", markersize=11,
                  drawstyle="steps-post", zorder=1, label="Pareto front")
        ax.legend()
    if labels:
        _name_points(ax, [(seconds[i], error[i], labels[i]) for i in shown])
    return ax


def _name_points(ax, points):
    """(x, y, name): the names beside the points, one above the other where they would overlap."""
    ax.margins(x=0.25)
    ax.figure.draw_without_rendering()  # lays the axes out: only then is known where a point lies on the page
    per_point = ax.figure.dpi / 72
    taken = []  # x, y in points of the page, and the width of the text
    for x, y, name in sorted(points):
        left, low = ax.transData.transform((x, y)) / per_point
        width, up = 6.0 * len(name), 4.0
        while any(abs(low + up - y0) < 13 and left < x0 + w0 and x0 < left + width for x0, y0, w0 in taken):
            up += 4
        taken.append((left, low + up, width))
        ax.annotate(name, (x, y), textcoords="offset points", xytext=(6, up),
                    arrowprops={"arrowstyle": "-", "lw": 0.5, "color": "0.5", "relpos": (0, 0)} if up > 4 else None)


_ERRORS = {"curve_error_l2": "error of the curve, root mean square", "curve_error_max": "error of the curve, largest",
           "amplitude_error": "relative error of the peak", "frequency_error": "relative error of the peak's frequency"}


def _front(seconds, error):
    """Flags of those that no other one beats in time or error without losing in the other."""
    return [seconds[i] == seconds[i] and error[i] == error[i] and
            not any(t <= seconds[i] and e <= error[i] and (t < seconds[i] or e < error[i]) for t, e in zip(seconds, error))
            for i in range(len(error))]


def study_errors(study, error="curve_error_l2", ax=None):
    """Error of every method of a study over its run time (set-up and curves), named, with the Pareto front. error:
    "curve_error_l2", "curve_error_max", "amplitude_error" or "frequency_error". Methods that failed are left out."""
    seconds, values = study.setup_seconds + study.curve_seconds, study[error]
    ax = error_over_time(seconds, values, study.names, _front(seconds, values), ax)
    ax.set_xlabel("set-up and curves (s)")
    ax.set_ylabel(_ERRORS[error])
    return ax


def study_curves(study, level=0, methods=None, ax=None):
    """The curves of the methods (indices or names; None: all) at a force level, thin, over that of the reference. Steady
    states of a method that marches in time are dots; methods that failed are left out."""
    ax = _axes(ax, "frequency (Hz)", "amplitude")
    ax.plot(*study.points("reference", level), color="0.75", lw=5, label="reference")
    marches = numpy.isnan(study.iteration_seconds)
    for i, name in enumerate(study.names):
        if (methods is None or i in methods or name in methods) and study.basis_size[i] >= 0:
            ax.plot(*study.points(i, level), "o" if marches[i] else "-", markersize=4, lw=1.2, label=name)
    ax.legend()
    return ax


def study_convergence(study, parameter, methods=None, errors=("curve_error_l2", "amplitude_error", "frequency_error"),
                      xlabel="parameter", ax=None):
    """Errors of the methods (indices or names; None: all) over a parameter of theirs, one number for each: samples,
    harmonics, columns, a tolerance. An error of 0 has no place on the axis and is left out, and so is NaN."""
    names = study.names
    methods = range(len(names)) if methods is None else methods
    indices = [names.index(m) if isinstance(m, str) else m for m in methods]
    if len(indices) != len(parameter):
        raise ValueError(f"parameter has {len(parameter)} numbers for {len(indices)} methods")
    ax = _axes(ax, xlabel, "error")
    for error, marker in zip(errors, "os^D"):
        shown = sorted((x, study[error][i]) for x, i in zip(parameter, indices) if study[error][i] > 0)
        ax.loglog([x for x, _ in shown], [e for _, e in shown], marker + "-", label=_ERRORS[error])
    if len(parameter) <= 12:  # the numbers themselves instead of powers of ten
        ax.set_xticks(sorted(set(parameter)), [f"{x:g}" for x in sorted(set(parameter))])
        ax.minorticks_off()
    ax.legend()
    return ax
