"""The one style of all pictures: sizes, colours, units, legends, files."""
import functools
import os
import pathlib
from typing import NamedTuple

import matplotlib
import numpy
from matplotlib import ticker
from matplotlib.figure import Figure
from scipy.interpolate import PchipInterpolator

from ..fe.replacing import replacing

COLUMN, PAGE = 3.5, 7.2  # inches: the width of a column and of a page of most journals

# Okabe and Ito's colours, which colour-blind readers tell apart, the darkest first; markers do it in grey.
COLOURS = ("#0072B2", "#D55E00", "#009E73", "#CC79A7", "#000000", "#E69F00", "#56B4E9")
MARKERS = ("o", "s", "^", "D", "v", "P", "X")
LINE = 8  # pieces of a drawn line between two points of a curve
REFERENCE, FAINT = "0.7", "0.35"  # a wide line below others; what is beside the matter

_STYLE = {
    "font.size": 8, "axes.titlesize": 8, "axes.labelsize": 8, "xtick.labelsize": 8, "ytick.labelsize": 8, "legend.fontsize": 8,
    "figure.titlesize": 8, "lines.linewidth": 1.3, "lines.markersize": 4, "axes.linewidth": 0.7, "axes.grid": False,
    "grid.alpha": 0.3, "grid.linewidth": 0.5, "xtick.direction": "in", "ytick.direction": "in", "xtick.major.pad": 5, "ytick.major.pad": 4, "legend.frameon": False,
    "axes.prop_cycle": matplotlib.cycler(color=COLOURS), "figure.dpi": 150, "savefig.dpi": 300,
    "axes.formatter.useoffset": False, "axes.formatter.limits": (-4, 5),
    "pdf.fonttype": 42, "svg.hashsalt": "plm",  # fonts that printers take; the same file for the same picture
}


def style():
    """A context in which matplotlib draws as this package does.

        with plm.plot.style():
            figure, ax = pyplot.subplots()
    """
    return matplotlib.rc_context(_STYLE)


def styled(draw):
    """Of a function that draws."""
    @functools.wraps(draw)
    def in_style(*arguments, **options):
        with style():
            return draw(*arguments, **options)
    return in_style


def figure(rows=1, columns=1, width=COLUMN, height=None, window=True, **options):
    """(figure, axes) in the style, as pyplot.subplots gives them. width, height: inches; window: False for one that is only
    saved.

        figure, (left, right) = plm.plot.figure(1, 2, width=plm.plot.PAGE)
    """
    size = (width, height or rows * (0.72 if width / columns < 4.5 else 0.55) * width / columns)
    with style():
        if window:
            from matplotlib import pyplot
            made = pyplot.figure(figsize=size, layout="constrained")
        else:  # not pyplot's: it opens none, whatever the backend
            made = Figure(figsize=size, layout="constrained")
        return made, made.subplots(rows, columns, **options)


def save(drawn, path, kinds=("png", "pdf", "svg")):
    """Writes a figure, or that of an axes, beside `path` as a file of each kind; returns their paths.

        plm.plot.save(plm.plot.response(curve, dof=12), "curve")
    """
    drawn = getattr(drawn, "figure", None) or drawn
    path = pathlib.Path(path)
    stem = path.with_suffix("") if path.suffix[1:] in kinds else path
    files = [stem.with_name(f"{stem.name}.{kind}") for kind in kinds]
    no_date = {"pdf": {"CreationDate": None}, "svg": {"Date": None}}
    with style():
        for file, kind in zip(files, kinds):
            with replacing(file) as beside:
                drawn.savefig(os.fspath(beside), format=kind, metadata=no_date.get(kind))
    return files


def smooth_line(x, y):
    """A smooth line through the points of a curve, which may turn back: (x, y) with LINE - 1 places between each two, monotone
    where the points are (Fritsch and Carlson's cubics over the chord length)."""
    x, y = numpy.asarray(x, dtype=float), numpy.asarray(y, dtype=float)
    way = numpy.concatenate([[0], numpy.cumsum(numpy.hypot(numpy.diff(x) / (numpy.ptp(x) or 1), numpy.diff(y) / (numpy.ptp(y) or 1)))])
    if len(x) < 3 or not (numpy.diff(way) > 0).all():
        return x, y
    between = numpy.interp(numpy.arange(LINE * (len(x) - 1) + 1) / LINE, numpy.arange(len(x)), way)
    lines = [PchipInterpolator(way, values)(between) for values in (x, y)]
    for line, values in zip(lines, (x, y)):
        line[::LINE] = values  # the points themselves, to the last digit
    return lines


def axes(ax, xlabel, ylabel):
    """ax, or that of a new figure, with its labels and a grid."""
    if ax is None:
        ax = figure()[1]
        ax.plm_height = ax.figure.get_figheight()  # to which legend_above adds
    ax.set_xlabel(xlabel)
    ax.set_ylabel(ylabel)
    ax.grid(True)
    ax.set_axisbelow(True)
    return ax


@styled
def legend_above(ax, columns=None):
    """The legend above the axes, where it covers nothing, in as many columns as fit it (None: by the length of its texts).

        plm.plot.legend_above(ax, columns=2)
    """
    handles, labels = ax.get_legend_handles_labels()
    if not handles:
        return None
    if columns is None:
        width = ax.figure.get_figwidth() * ax.get_position().width  # inches, about
        columns = max(1, min(len(labels), int(width / (0.055 * max(map(len, labels)) + 0.42))))
    if hasattr(ax, "plm_height"):  # a figure of our own grows by the lines of the legend
        ax.figure.set_figheight(ax.plm_height + 0.155 * (-(-len(labels) // columns) - 1))
    return ax.legend(handles, labels, loc="lower left", bbox_to_anchor=(0, 1.01), ncol=columns, borderaxespad=0,
                     columnspacing=1.2, handlelength=2.2)


def round_ticks(axis, low, high):
    """Round numbers on a logarithmic axis (ax.xaxis or ax.yaxis) from low to high, also where it spans less than a decade."""
    if high / low < 8:
        ticks = ticker.MaxNLocator(5, steps=[1, 2, 5, 10]).tick_values(low, high)
    else:
        first, last = int(numpy.floor(numpy.log10(low))), int(numpy.ceil(numpy.log10(high)))
        ticks = [m * 10.0**e for e in range(first, last + 1) for m in ((1, 2, 5) if high / low < 200 else (1,))]
    axis.set_major_locator(ticker.FixedLocator([tick for tick in ticks if low <= tick <= high]))
    axis.set_minor_locator(ticker.NullLocator())
    axis.set_major_formatter(ticker.FuncFormatter(lambda value, _: f"{value:g}"))


class Unit(NamedTuple):
    """A factor on the numbers of a model, and what stands in brackets behind a label."""
    factor: float
    name: str

    def label(self, words):
        """The words with the unit."""
        return f"{words} ({self.name})" if self.name else words


_METRES = {"m": 1.0, "mm": 1e-3, "um": 1e-6}
_SHOWN = {"m": "m", "mm": "mm", "um": "µm"}


def length_unit(units, values):
    """The Unit that lengths such as `values` are shown in."""
    if units == "":
        return Unit(1.0, "")
    model, shown = (units, None) if isinstance(units, str) else units
    for name in (model, *([shown] if shown else [])):
        if name not in _METRES:
            raise ValueError(f"units has {name!r}; lengths are in {', '.join(_METRES)}, or '' for none: what the model counts "
                             "lengths in, or that and what is to be shown, as ('m', 'mm')")
    if shown is None:
        values = numpy.abs(numpy.asarray(values, dtype=float))
        largest = _METRES[model] * max(numpy.nanmax(values, initial=0.0), 0.0)
        shown = "m" if largest >= 1 else "mm" if largest >= 1e-3 or largest == 0 else "um"
    return Unit(_METRES[model] / _METRES[shown], _SHOWN[shown])
