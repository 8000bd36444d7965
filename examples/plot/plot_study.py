#!/usr/bin/env python3
"""Pictures of what plm-study computed: plot_study.py FOLDER [--to FOLDER].

Draws what the folder has figures for: error_against_time, levels, curves, contact_over_cycle, convergence, each as .png, .pdf and
.svg, in the style of plm.plot (PYTHONPATH: bindings/python; PLM_LIBRARY: the library).
"""
import argparse
import csv
import math
import pathlib
import re

import matplotlib

matplotlib.use("Agg")
import numpy as np  # noqa: E402
from matplotlib import ticker  # noqa: E402
from plm import plot  # noqa: E402
from plm.plot.errors import stairs  # noqa: E402
from plm.plot.style import COLOURS, FAINT, MARKERS, REFERENCE, round_ticks, smooth_line  # noqa: E402

BLUE, ORANGE, GREEN, PINK, BLACK, YELLOW, SKY = COLOURS
FAMILIES = {  # colour and marker
    "piecewise-linear modes": (GREEN, "o"),
    "the paper's bands rule": (YELLOW, "X"),
    "published rivals": (ORANGE, "D"),
    "unreduced, fewer pairs": (BLACK, "P"),
    "static contact snapshots": (PINK, "v"),
    "compressed and refined": (BLUE, "s"),
}
SHOWN = {  # curves of the picture of curves: colour and line
    "1 sample": (YELLOW, "-"),
    "4 samples": (GREEN, "-"),
    "bilinear modes": (ORANGE, (0, (4, 2))),
    "updated LELSM": (BLACK, (0, (1, 1))),
    "Craig-Bampton": (SKY, (0, (3, 1, 1, 1))),
    "snapshots": (PINK, (0, (5, 1))),
    "compressed to 12": (BLUE, (0, (6, 3))),
}


def rows_of(path):
    with open(path, newline="", encoding="utf-8") as file:
        return list(csv.DictReader(file))


def family_of(name, way):
    if way in ("1", "2") and not name.startswith("POD"):
        return "compressed and refined"
    if name.endswith(", bands"):
        return "the paper's bands rule"
    if name == "snapshots":
        return "static contact snapshots"
    if name.startswith(("full", "half")):
        return "unreduced, fewer pairs"
    if re.match(r"\d+ sample|sampled|marching", name):
        return "piecewise-linear modes"
    return "published rivals"


class Run:
    """The methods of one run of the study: at one force level, or at several."""

    def __init__(self, folder):
        self.folder = folder
        about = {row["name"]: row for row in rows_of(folder / "methods.csv")}
        table = rows_of(folder / "table.csv")
        self.reference = table[0]
        self.rows = {}
        for number, row in enumerate(table[1:]):
            row.update(about[row["name"]], number=number, family=family_of(row["name"], about[row["name"]]["way"]))
            if row["basis_size"]:
                self.rows[row["name"]] = row

    def group(self, name):
        return [row for row in self.rows.values() if name in row["groups"].split()]

    def curve(self, row):
        pattern = "curve_reference_0.csv" if row is self.reference else f"curve_{row['number']}_*_0.csv"
        path = next(self.folder.glob(pattern))
        return np.atleast_1d(np.genfromtxt(path, delimiter=",", names=True))


class Study:
    """The files of one folder."""

    def __init__(self, folder):
        self.folder = pathlib.Path(folder)
        self.facts = {row["key"]: row["value"] for row in rows_of(self.folder / "study.csv")}
        self.one, self.levels = (Run(self.folder / name) if (self.folder / name / "methods.csv").exists() else None
                                 for name in ("one_level", "levels"))
        self.n_pairs = int(self.facts["n_pairs"])
        oscillator = self.facts["scene"] == "bilinear_oscillator"  # the one scene without units
        self.unit, self.length = ("", 1.0) if oscillator else (" (µm)", 1e3)

    def title(self):
        f = self.facts
        scene = f["scene"].replace("_", " ")
        load = "with" if f["preload"] == "1" else "without"
        return (f"{scene[0].upper()}{scene[1:]}, {int(f['n_dof']):,} DOFs, {self.n_pairs} contact pairs, "
                f"{load} pre-load, H = {f['harmonics']}")


def number(row, column):
    return float(row[column]) if row[column] else math.nan


def head(figure, axes, title, columns):
    """The title and the legend of the axes above all, where they cover nothing."""
    handles, labels = axes.get_legend_handles_labels()
    with plot.style():
        legend = figure.legend(handles, labels, title=title, loc="upper left", ncol=columns, columnspacing=1.2)
        legend._legend_box.align = "left"
        inches = 0.17 * (-(-len(labels) // columns) + title.count("\n") + 1) + 0.1
        figure.get_layout_engine().set(rect=(0, 0, 1, 1 - inches / figure.get_figheight()))


def save(figure, axes, title, columns, path):
    head(figure, axes, title, columns)
    return plot.save(figure, path)


# ---- response curves ----

def region_of_peak(f, a):
    """(f_low, f_high, a_low, a_high) of the top of a curve."""
    top = int(np.argmax(a))
    first, last = top, top
    while first > 0 and a[first - 1] > 0.9 * a[top]:
        first -= 1
    while last < len(a) - 1 and a[last + 1] > 0.9 * a[top]:
        last += 1
    low, high = f[first:last + 1].min(), f[first:last + 1].max()
    margin = 0.25 * (high - low) + 1e-4 * f[top]
    return low - margin, high + margin, 0.9 * a[top], 1.02 * a[top]


def draw_curves(axes, study):
    run = study.one
    truth = run.curve(run.reference)
    axes.plot(truth["frequency_hz"], study.length * truth["amplitude"], color=REFERENCE, linewidth=4,
              label=f"reference, r = {run.reference['basis_size']}", zorder=1)
    for name, (color, style) in SHOWN.items():
        if name in run.rows:
            curve = run.curve(run.rows[name])
            axes.plot(curve["frequency_hz"], study.length * curve["amplitude"], color=color, linestyle=style,
                      linewidth=1.1, label=f"{name}, r = {run.rows[name]['basis_size']}")
    exact = study.folder / "curve_exact.csv"
    if exact.exists():
        curve = np.genfromtxt(exact, delimiter=",", names=True)
        axes.plot(*smooth_line(curve["frequency_hz"], study.length * curve["amplitude"]), color=BLACK, linewidth=1.1,
                  marker="o", markersize=3, mfc="white", markevery=0.12, label="nothing set: exact motions", zorder=1.5)
    peak = study.folder / "nothing_set.csv"
    if peak.exists():
        (row,) = rows_of(peak)
        axes.plot(float(row["peak_hz"]), study.length * float(row["peak_amplitude"]), "k+", markersize=9, mew=1.2, ls="",
                  label="nothing set: peak")
    return truth["frequency_hz"], study.length * truth["amplitude"]


def plot_curves(study, path):
    figure, axes = plot.figure(width=plot.PAGE, height=4.4, window=False)
    with plot.style():
        f, a = draw_curves(axes, study)
        axes.set(xlabel="excitation frequency (Hz)", ylabel=f"half peak-to-peak displacement{study.unit}")
        axes.grid(alpha=0.3)
        axes.set_ylim(bottom=0, top=1.08 * axes.get_ylim()[1])
        f_low, f_high, a_low, a_high = region_of_peak(f, a)
        a_high = max([a_high, *(1.02 * line.get_ydata()[0] for line in axes.lines if line.get_marker() == "+")])
        left = 0.5 * (f_low + f_high) > 0.5 * sum(axes.get_xlim())  # the emptier side
        inset = axes.inset_axes([0.1 if left else 0.66, 0.48, 0.31, 0.44])
        draw_curves(inset, study)
        inset.set(xlim=(f_low, f_high), ylim=(a_low, a_high), title="around the peak")
        inset.xaxis.set_major_locator(ticker.MaxNLocator(3))
        inset.grid(alpha=0.3)
        axes.indicate_inset_zoom(inset, edgecolor=FAINT)
    return save(figure, axes, study.title(), 3, path)


# ---- error against time ----

def front_of(points):
    """Those that no other beats in one of time and error without losing in the other, by time."""
    front, best = [], math.inf
    for point in sorted(points):
        if point[1] < best:
            front.append(point)
            best = point[1]
    return front


def draw_errors(axes, run, rows, column, whole):
    """Points of the families, the front as stairs, the reference as a line at its time; returns what is to be named."""
    def seconds_of(row):
        return number(row, "curve_seconds") + (number(row, "setup_seconds") if whole else 0)
    points = [(seconds_of(row), number(row, column), f"{row['name']} ({row['basis_size']})", row["family"]) for row in rows]
    points = [point for point in points if point[0] > 0 and point[1] > 1e-9]  # below: the reference itself
    for seconds, error, _, family in points:
        colour, marker = FAMILIES[family]
        axes.plot([seconds], [error], ls="none", marker=marker, color=colour, zorder=3)
    front = front_of(points)
    lines = [stairs([point[:2] for point in front])]
    axes.plot(*lines[0], color=FAINT, lw=0.8, zorder=1)
    axes.set(xscale="log", yscale="log")
    axes.margins(0.13)
    axes.autoscale_view()
    reference = seconds_of(run.reference)
    if reference > 0:
        axes.axvline(reference, color=FAINT, ls="--", lw=1)
        lines.append(([reference, reference], axes.get_ylim()))
    round_ticks(axes.xaxis, *axes.get_xlim())
    axes.grid(alpha=0.3)
    ordered = front + [point for point in points if point not in front]  # names of the front have the first choice
    return [(x, y, name, FAMILIES[family][0]) for x, y, name, family in ordered], lines


def plot_errors(study, run, rows, what, path):
    columns = [("time of the curve (s)", False), ("time of set-up and curve (s)", True)]
    names = [("frequency_error", "error of the frequency"), ("amplitude_error", "error of the amplitude"),
             ("curve_error_l2", "error of the curve (rms)")]
    figure, axes = plot.figure(3, 2, width=plot.PAGE, height=9.4, window=False, sharey="row")
    named = []
    with plot.style():
        for i, (column, name) in enumerate(names):
            for j, (text, whole) in enumerate(columns):
                named.append((axes[i, j], *draw_errors(axes[i, j], run, rows, column, whole)))
                if i == 2:
                    axes[i, j].set_xlabel(text)
            axes[i, 0].set_ylabel(name)
        present = {row["family"] for row in rows}
        for family, (colour, marker) in FAMILIES.items():
            if family in present:
                axes[0, 0].plot([], [], ls="none", marker=marker, color=colour, label=family)
        axes[0, 0].plot([], [], color=FAINT, lw=0.8, label="front: none faster and nearer")
        axes[0, 0].plot([], [], color=FAINT, ls="--", lw=1, label="time of the reference")
    head(figure, axes[0, 0], f"{study.title()}\n{what}; in brackets: size of the basis", 3)
    for place, points, lines in named:
        plot.name_points(place, points, lines)
    return plot.save(figure, path)


# ---- contact ----

CONTACTS = {"reference": (REFERENCE, 4, "-"), "1_sample": (YELLOW, 1.1, "-"), "4_samples": (GREEN, 1.1, "--"),
            "compressed_12": (BLUE, 1.1, (0, (1, 1)))}


def plot_contact(study, path):
    figure, (left, right) = plot.figure(1, 2, width=plot.PAGE, window=False)
    scale = 100 / study.n_pairs
    with plot.style():
        for name, (colour, width, dashes) in CONTACTS.items():
            file = study.folder / f"contact_cycle_{name}.csv"
            if not file.exists():
                continue
            cycle = np.genfromtxt(file, delimiter=",", names=True)
            left.step(cycle["time_fraction"], 100 * cycle["closed_share"], where="post", color=colour, lw=width, ls=dashes,
                      label=name.replace("_", " "))
            curve = np.genfromtxt(study.folder / f"contact_curve_{name}.csv", delimiter=",", names=True)
            right.plot(curve["frequency_hz"], scale * curve["closed_mean"], color=colour, lw=width, ls=dashes)
            if name == "reference":
                for column in ("closed_min", "closed_max"):
                    right.plot(curve["frequency_hz"], scale * curve[column], color=FAINT, lw=0.8, ls=":", zorder=1)
        left.plot([], [], color=FAINT, lw=0.8, ls=":", label="most and fewest, reference")
        left.set(xlabel="time / period, at the peak", ylabel="closed pairs (%)", ylim=(-3, 103), xlim=(0, 1))
        right.set(xlabel="excitation frequency (Hz)", ylabel="closed pairs, mean (%)", ylim=(-3, 103))
        for axes in (left, right):
            axes.grid(alpha=0.3)
    return save(figure, left, study.title(), 3, path)


# ---- convergence ----

def errors_of_steps(rows):
    """Numbers and relative errors of frequency and peak against the last step; the first and last are left out where
    they have no number."""
    truth = rows[-1]
    kept = [row for row in rows[:-1] if int(row["number"]) > 0]
    return [int(row["number"]) for row in kept], *(
        [max(1e-12, abs(float(row[key]) / float(truth[key]) - 1)) for row in kept]
        for key in ("peak_hz", "peak_amplitude"))


def draw_two(axes, x, frequency, amplitude, style="-", suffix=""):
    for n, (error, label) in enumerate(((frequency, "frequency"), (amplitude, "peak amplitude"))):
        shown = [(place, e) for place, e in zip(x, error) if e > 1e-12]
        axes.plot(*np.transpose(shown) if shown else ([], []), style, marker=MARKERS[n], color=COLOURS[n], mfc="white", label=label + suffix)


def samples_of(run, ending):
    rows = [(int(m.group(1)), row) for row in run.group("samples")
            if (m := re.fullmatch(r"(\d+) samples?" + ending, row["name"]))]
    return sorted(rows, key=lambda pair: pair[0])


def draw_samples(axes, times, run):
    for ending, style, suffix in (("", "-", ""), (", bands", ":", ", bands")):
        rows = samples_of(run, ending)
        if rows:
            x = [n for n, _ in rows]
            draw_two(axes, x, [number(r, "frequency_error") for _, r in rows],
                     [number(r, "amplitude_error") for _, r in rows], style, suffix)
            times.plot(x, [1e3 * number(r, "iteration_seconds") for _, r in rows], style, marker="o", color=GREEN,
                       label="piecewise-linear modes" + suffix)
    if "Craig-Bampton" in run.rows:
        times.axhline(1e3 * number(run.rows["Craig-Bampton"], "iteration_seconds"), color=ORANGE,
                      label="Craig-Bampton")
    axes.set(xscale="log", yscale="log", xlabel="contact samples")
    times.set(xscale="log", yscale="log", xlabel="contact samples", ylabel="Newton iteration (ms)")


def draw_svd(axes, run):
    rows = [(float(row["name"].split()[1]), row) for row in run.group("svd") if row["name"].startswith("svd")]
    rows.append((1e-6, run.rows["4 samples"]))  # the default
    rows.sort(key=lambda pair: pair[0])
    draw_two(axes, [t for t, _ in rows], [number(r, "frequency_error") for _, r in rows],
             [number(r, "amplitude_error") for _, r in rows])
    for tolerance, row in rows:
        axes.annotate(row["basis_size"], (tolerance, max(number(row, "amplitude_error"), 1e-12)), fontsize=8,
                      textcoords="offset points", xytext=(4, 4), color=FAINT)
    axes.set(xscale="log", yscale="log", xlabel="svd_tolerance (and size)")
    axes.margins(0.12)


def plot_convergence(study, path):
    figure, axes = plot.figure(2, 3, width=plot.PAGE, height=5.4, window=False)
    with plot.style():
        draw_samples(axes[0, 0], axes[0, 1], study.one)
        draw_svd(axes[0, 2], study.one)
        for place, file, name in ((axes[1, 0], "harmonics.csv", "harmonics"),
                                  (axes[1, 1], "time_samples.csv", "time samples in a period")):
            draw_two(place, *errors_of_steps(rows_of(study.folder / file)))
            place.set(xscale="log", yscale="log", xlabel=name)
        steps = [row for row in rows_of(study.folder / "harmonics.csv") if int(row["number"]) > 0]
        axes[1, 2].plot([int(r["number"]) for r in steps], [float(r["seconds"]) for r in steps], marker="o", color=GREEN, mfc="white")
        axes[1, 2].set(xscale="log", yscale="log", xlabel="harmonics", ylabel="time of the curve (s)")
        for place in axes.flat:
            if place is not axes[0, 2]:
                round_ticks(place.xaxis, *place.get_xlim())
            place.grid(alpha=0.3)
        for place in axes[:, 0]:
            place.set_ylabel("relative error")
        for line in axes[0, 1].lines:  # named above all, where no legend lies on a curve
            axes[0, 0].plot([], [], ls=line.get_linestyle(), marker=line.get_marker(), color=line.get_color(),
                            label=f"iteration: {line.get_label()}")
    return save(figure, axes[0, 0], study.title(), 3, path)


def draw_all(study):
    """(name, function of the path that draws it)."""
    one = "errors against the unreduced structure at the same H"
    if study.one and study.one.group("methods"):
        yield "error_against_time", lambda p: plot_errors(study, study.one, study.one.group("methods"), one, p)
        yield "curves", lambda p: plot_curves(study, p)
        yield "contact_over_cycle", lambda p: plot_contact(study, p)
    if study.levels:
        what = f"{study.facts['levels']} force levels, worst errors, sum of times"
        yield "levels", lambda p: plot_errors(study, study.levels, study.levels.group("levels"), what, p)
    if study.one and (study.folder / "harmonics.csv").exists():
        yield "convergence", lambda p: plot_convergence(study, p)


def main():
    parser = argparse.ArgumentParser(description=__doc__, formatter_class=argparse.RawDescriptionHelpFormatter)
    parser.add_argument("folder", help="where plm-study wrote its files")
    parser.add_argument("--to", help="folder of the pictures (the same)")
    arguments = parser.parse_args()
    study = Study(arguments.folder)
    to = pathlib.Path(arguments.to or arguments.folder)
    for name, draw in draw_all(study):
        print(*draw(to / name))


if __name__ == "__main__":
    main()
