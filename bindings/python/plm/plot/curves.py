"""Response curves, their levels, the resonance over the force, Floquet multipliers."""
import numpy

from .style import COLOURS, FAINT, LINE, MARKERS, axes, legend_above, length_unit, smooth_line, styled

_KINDS = {"fold": "s", "branch point": "D", "period doubling": "^", "Neimark-Sacker": "o"}
_MEASURES = {"half_peak_to_peak": "half peak-to-peak", "peak": "largest displacement", "rms": "root mean square"}
_SPREAD = 7  # markers on a curve that tell it from others in grey
_UNSTABLE = "unstable"


@styled
def response(branches, dof, measure="half_peak_to_peak", harmonic=0, labels=None, peaks=(), stable=None, bifurcations=True,
             units="m", name=None, ax=None):
    """Amplitude of a DOF over frequency: one branch or a list of them, with what was located on them.

    Unstable parts are dashed, and the legend says so, where the branch has stability (option stability of Hbm). stable: flags
    of every point instead (of several branches a list, with None for the branch's own); False: all solid. bifurcations: mark
    folds, branch points, period doublings and Neimark-Sacker points. peaks: results of Hbm.find_peak, or a Response, each a
    cross. Between its points a curve is drawn smooth, through all of them. units: see help(plm.plot). name: of the DOF.

        plm.plot.response([main, loop], dof=0, labels=["main curve", "isolated"], units=("m", "mm"), name="tip")
    """
    if not isinstance(branches, (list, tuple)):
        branches, stable = [branches], stable if stable is False else [stable]
    stable = [False] * len(branches) if stable is False else stable or [None] * len(branches)
    amplitudes = [branch.amplitude(dof, measure, harmonic) for branch in branches]
    unit = length_unit(units, numpy.concatenate(amplitudes))
    what = f"harmonic {harmonic}" if measure == "harmonic" else _MEASURES[measure]
    ax = axes(ax, "frequency (Hz)", unit.label(f"{what} of {f'DOF {dof}' if name is None else name}"))
    before = len([line for line in ax.lines if getattr(line, "plm_curve", False)])  # of earlier calls
    any_unstable = False
    for i, (branch, amplitude) in enumerate(zip(branches, amplitudes)):
        flags = _stability_of(branch) if stable[i] is None else None if stable[i] is False else stable[i]
        look = {"color": COLOURS[(before + i) % len(COLOURS)],
                "marker": MARKERS[(before + i) % len(MARKERS)] if before + len(branches) > 1 else None}
        any_unstable |= _draw_curve(ax, branch.frequency_hz, unit.factor * amplitude, flags, labels[i] if labels else None, look)
    if any_unstable:
        _once(ax, _UNSTABLE, color=FAINT, ls="--")
    if bifurcations:
        for branch, amplitude in zip(branches, amplitudes):
            _mark_bifurcations(ax, branch, unit.factor * amplitude)
    for peak in peaks:
        ax.plot(peak.frequency_hz, unit.factor * peak.amplitude, "k+", markersize=9, mew=1.2, ls="",
                label=f"peak: {unit.factor * peak.amplitude:.4g} {unit.name} at {peak.frequency_hz:.5g} Hz".replace("  ", " "))
    ax.set_ylim(bottom=min(0, ax.get_ylim()[0]) if measure != "harmonic" or harmonic else None)
    legend_above(ax)
    return ax


def levels(branches, dof, measure="half_peak_to_peak", harmonic=0, force=None, normalised=False, **options):
    """Response curves at several levels of force in one picture, from Hbm.sweep_levels or a list of branches. force: what a
    force scale of 1 stands for, in N (None: levels are named by their scales). normalised: amplitudes over the force scale, so
    that those of a linear structure fall together. options: as those of response.

        plm.plot.levels(hbm.sweep_levels([1, 2, 4]), dof=12, force=0.5)
    """
    labels = [f"{b.force_scale:g} times the force" if force is None else f"{force * b.force_scale:g} N" for b in branches]
    if not normalised:
        return response(branches, dof, measure, harmonic, labels, **options)
    ax = response([_Scaled(b) for b in branches], dof, measure, harmonic, labels, **options)
    ax.set_ylabel(ax.get_ylabel().replace(" of ", " / force scale of ", 1))
    return ax


class _Scaled:
    """A branch whose amplitudes are divided by its force scale."""

    def __init__(self, branch):
        self._branch = branch

    def __getattr__(self, key):
        return getattr(self._branch, key)

    def __len__(self):
        return len(self._branch)

    def amplitude(self, *what):
        """Of every point, for a force scale of 1."""
        return self._branch.amplitude(*what) / self._branch.force_scale


@styled
def backbone(branches, dof, measure="half_peak_to_peak", harmonic=0, over="force", force=None, labels=None, units="m", name=None,
             ax=None):
    """Amplitude at resonance over the force (over="force"; force: what a force scale of 1 stands for, in N), or over the
    frequency (over="frequency"), of branches from Hbm.find_backbones. Squares mark where the force turns back: between two of
    them a force has several resonances, and curves beside the main one are born and merge.

        plm.plot.backbone(hbm.find_backbones(), dof=0, force=0.6)
    """
    if over not in ("force", "frequency"):
        raise ValueError(f"over must be 'force' or 'frequency', not {over!r}")
    branches = branches if isinstance(branches, (list, tuple)) else [branches]
    if not branches:
        raise ValueError("there is no branch to draw: find_backbones returned none, as where no pair opens or closes at resonance")
    amplitudes = [branch.amplitude(dof, measure, harmonic) for branch in branches]
    unit = length_unit(units, numpy.concatenate(amplitudes))
    xlabel = "frequency (Hz)" if over == "frequency" else "force scale" if force is None else "force (N)"
    ax = axes(ax, xlabel, unit.label(f"{f'DOF {dof}' if name is None else name} at resonance"))
    for i, (branch, amplitude) in enumerate(zip(branches, amplitudes)):
        x = branch.frequency_hz if over == "frequency" else (force or 1.0) * branch.point_force_scale
        look = {"color": COLOURS[i % len(COLOURS)], "marker": MARKERS[i % len(MARKERS)] if len(branches) > 1 else None}
        _draw_curve(ax, x, unit.factor * amplitude, None, labels[i] if labels else None, look)
        turns = _turns(branch.point_force_scale)
        if turns.size:
            _once(ax, "fold of the force", x[turns], unit.factor * amplitude[turns], ls="", marker="s", color="k", mfc="white",
                  markersize=5, zorder=3)
    legend_above(ax)
    return ax


@styled
def multipliers(branch, points=None, ax=None):
    """Floquet multipliers of the points of a branch (numbers; None: all that have some) in the complex plane, with the unit
    circle: filled where the motion is stable, hollow squares where it is not. One that leaves the circle at 1 is a fold or a
    branch point, at -1 a period doubling, elsewhere a Neimark-Sacker point.

        plm.plot.multipliers(hbm.sweep())
    """
    ax = axes(ax, "real part", "imaginary part")
    angle = numpy.linspace(0, 2 * numpy.pi, 361)
    ax.plot(numpy.cos(angle), numpy.sin(angle), color=FAINT, lw=0.8, label="unit circle")
    stable, unstable = [], []
    for point in range(len(branch)) if points is None else numpy.atleast_1d(points):
        (unstable if branch.stable[point] == 0 else stable).extend(branch.multipliers(int(point)))
    for found, label, look in ((stable, "stable motions", {"marker": "o", "color": COLOURS[0], "markersize": 2.5}),
                               (unstable, "unstable motions", {"marker": "s", "color": COLOURS[1], "mfc": "white"})):
        if found:
            ax.plot(numpy.real(found), numpy.imag(found), ls="", label=label, **look)
    if not stable and not unstable:
        raise ValueError("the points have no multipliers: the option stability of Hbm computes them")
    ax.set_aspect("equal", adjustable="datalim")
    legend_above(ax)
    return ax


def _runs(flags):
    """(first, last, flag) of every run of equal flags; a run reaches to the first point of the next one."""
    starts = [0, *(numpy.flatnonzero(flags[1:] != flags[:-1]) + 1), len(flags)]
    return [(a, min(b, len(flags) - 1), flags[a]) for a, b in zip(starts[:-1], starts[1:])]


def _draw_curve(ax, x, y, stable, label, look):
    """A line whose unstable parts are dashed, in one colour, with a few markers where there are several; whether some are."""
    colour, marker = look["color"], look["marker"]
    flags = numpy.ones(len(x), dtype=bool) if stable is None else numpy.asarray(stable, dtype=bool)
    if flags.shape != numpy.shape(x):
        raise ValueError(f"stable has the shape {flags.shape}, the branch has {len(x)} points")
    whole = smooth_line(x, y)
    per_point = LINE if len(whole[0]) > len(x) else 1
    for first, last, flag in _runs(flags):
        part = slice(per_point * first, per_point * last + 1)
        line, = ax.plot(whole[0][part], whole[1][part], ls="-" if flag else "--", color=colour)
        line.plm_curve = first == 0
    dots = slice(0, 1) if len(x) == 1 else _spread(ax, x, y) if marker else slice(0, 0)
    if label or marker or len(x) == 1:  # one entry of the legend, with line and marker
        ax.plot(x[dots], y[dots], ls="", marker=marker or "o", color=colour, mfc="white", zorder=2.5)
    if label:
        ax.plot([], [], ls="-", color=colour, marker=marker or ("o" if len(x) == 1 else None), mfc="white", label=label)
    return not flags.all()


def _spread(ax, x, y):
    """Points that are about as far from each other on the page."""
    width, height = numpy.ptp(x) or 1.0, numpy.ptp(y) or 1.0
    way = numpy.concatenate([[0], numpy.cumsum(numpy.hypot(numpy.diff(x) / width, numpy.diff(y) / height))])
    return numpy.unique(numpy.searchsorted(way, way[-1] * (numpy.arange(_SPREAD) + 0.5) / _SPREAD).clip(0, len(x) - 1))


def _stability_of(branch):
    """Flags of every point, None where the branch has no stability. A point without it takes that of the one before."""
    flags = branch.stable.copy()
    known = numpy.flatnonzero(flags >= 0)
    if not known.size:
        return None
    last = numpy.searchsorted(known, numpy.arange(len(flags)), side="right") - 1
    return flags[known[last.clip(0)]] == 1


def _once(ax, label, x=(), y=(), **look):
    """Drawn with a label, unless the axes have that already."""
    ax.plot(x, y, label=None if label in ax.get_legend_handles_labels()[1] else label, **look)


def _mark_bifurcations(ax, branch, amplitude):
    """One marker for each kind, one entry of the legend for each kind in the axes."""
    for kind, marker in _KINDS.items():
        points = [b.point for b in branch.bifurcations if b.kind == kind]
        if points:
            _once(ax, kind, branch.frequency_hz[points], amplitude[points], ls="", marker=marker, color="k", mfc="white",
                  markersize=5, zorder=3)


def _turns(values):
    """Points where a sequence turns back."""
    step = numpy.sign(numpy.diff(values))
    return numpy.flatnonzero(step[1:] * step[:-1] < 0) + 1
