#!/usr/bin/env python3
"""Pictures of what plm-study computed: plot_study.py FOLDER [--to FOLDER] [--dpi N].

Draws what the folder has figures for: error_against_time.png, levels.png, curves.png, contact_over_cycle.png,
convergence.png.
"""
import argparse
import csv
import math
import pathlib
import re

import matplotlib

matplotlib.use("Agg")
import matplotlib.pyplot as plt  # noqa: E402
import matplotlib.ticker as ticker  # noqa: E402
import numpy as np  # noqa: E402

from labels import Labels  # noqa: E402

GREY = "0.35"
FAMILIES = {  # colour and marker
    "piecewise-linear modes": ("tab:green", "o"),
    "the paper's bands rule": ("tab:orange", "X"),
    "published rivals": ("tab:red", "D"),
    "unreduced, all or fewer pairs": ("0.45", "P"),
    "static contact snapshots": ("tab:purple", "v"),
    "compressed and refined": ("tab:blue", "s"),
}
SHOWN = {  # curves of the picture of curves: colour and line
    "1 sample": ("tab:orange", "-"),
    "4 samples": ("tab:green", "-"),
    "bilinear modes": ("tab:red", (0, (4, 2))),
    "updated LELSM": ("tab:brown", (0, (1, 1))),
    "Craig-Bampton": ("tab:pink", (0, (3, 1, 1, 1))),
    "snapshots": ("tab:purple", (0, (5, 1))),
    "compressed to 12": ("tab:blue", (0, (6, 3))),
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
        return "unreduced, all or fewer pairs"
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
        self.unit, self.length = ("", 1.0) if oscillator else (" in µm", 1e3)

    def title(self):
        f = self.facts
        scene = f["scene"].replace("_", " ")
        load = "with" if f["preload"] == "1" else "without"
        return (f"{scene[0].upper()}{scene[1:]}, {int(f['n_dof']):,} DOFs, {self.n_pairs} contact pairs, "
                f"{load} pre-load, H = {f['harmonics']}")


def number(row, column):
    return float(row[column]) if row[column] else math.nan


def save(figure, path, dpi):
    figure.savefig(path, dpi=dpi)
    plt.close(figure)


def legend_below(figure, axes, columns):
    handles, labels = axes.get_legend_handles_labels()
    figure.legend(handles, labels, loc="lower center", ncol=columns, frameon=False)


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
    axes.plot(truth["frequency_hz"], study.length * truth["amplitude"], color="0.75", linewidth=5,
              label=f"reference, {run.reference['basis_size']}", zorder=1)
    for name, (color, style) in SHOWN.items():
        if name in run.rows:
            curve = run.curve(run.rows[name])
            axes.plot(curve["frequency_hz"], study.length * curve["amplitude"], color=color, linestyle=style,
                      linewidth=1.3, label=f"{name}, r = {run.rows[name]['basis_size']}")
    return truth["frequency_hz"], study.length * truth["amplitude"]


def plot_curves(study, path, dpi):
    figure, axes = plt.subplots(figsize=(9, 5.8))
    f, a = draw_curves(axes, study)
    axes.set(xlabel="excitation frequency in Hz", ylabel=f"half peak-to-peak displacement{study.unit}")
    axes.set_title(study.title(), fontsize=11)
    axes.grid(alpha=0.3)
    axes.set_ylim(bottom=0, top=1.08 * axes.get_ylim()[1])
    f_low, f_high, a_low, a_high = region_of_peak(f, a)
    left = 0.5 * (f_low + f_high) > 0.5 * sum(axes.get_xlim())  # the emptier side
    inset = axes.inset_axes([0.1 if left else 0.66, 0.5, 0.31, 0.44])
    draw_curves(inset, study)
    inset.set(xlim=(f_low, f_high), ylim=(a_low, a_high))
    inset.set_title("around the peak", fontsize=9)
    inset.tick_params(labelsize=8)
    inset.xaxis.set_major_locator(ticker.MaxNLocator(4))
    inset.grid(alpha=0.3)
    axes.indicate_inset_zoom(inset, edgecolor=GREY)
    figure.tight_layout(rect=(0, 0.12, 1, 1))
    legend_below(figure, axes, 4)
    save(figure, path, dpi)


# ---- error against time ----

def front_of(points):
    """Those that no other beats in one of time and error without losing in the other, by time."""
    front, best = [], math.inf
    for time, error in sorted(points):
        if error < best:
            front.append((time, error))
            best = error
    return front


def set_round_ticks(axes):
    """Round numbers, also where the axis spans less than a decade."""
    low, high = axes.get_xlim()
    if high / low < 8:
        ticks = ticker.MaxNLocator(6, steps=[1, 2, 5, 10]).tick_values(low, high)
    else:
        ticks = [m * 10.0 ** e for e in range(-6, 6) for m in ((1, 2, 5) if high / low < 200 else (1,))]
    axes.xaxis.set_major_locator(ticker.FixedLocator([t for t in ticks if low <= t <= high]))
    axes.xaxis.set_minor_locator(ticker.NullLocator())
    axes.xaxis.set_major_formatter(ticker.FuncFormatter(lambda v, _: f"{v:g}"))


def draw_errors(axes, rows, column, whole):
    labels, points = Labels(axes), []
    for row in rows:
        seconds = number(row, "curve_seconds") + (number(row, "setup_seconds") if whole else 0)
        error = number(row, column)
        if not seconds > 0 or math.isnan(error):
            continue
        error = max(error, 1e-9)  # the solver's tolerance
        points.append((seconds, error))
        color, marker = FAMILIES[row["family"]]
        axes.plot([seconds], [error], linestyle="none", marker=marker, markersize=6, color=color, zorder=3)
        labels.add(seconds, error, f"{row['name']} ({row['basis_size']})", color)
    front = front_of(points)
    axes.plot([p[0] for p in front], [p[1] for p in front], color="0.8", linewidth=3, zorder=1)
    axes.set(xscale="log", yscale="log")
    axes.margins(0.13)
    axes.autoscale_view()
    set_round_ticks(axes)
    axes.grid(alpha=0.3)
    return labels


def plot_errors(study, rows, what, path, dpi):
    columns = [("curve_seconds", "time of the curve in s", False),
               ("both", "time of set-up (contact space, samples, basis) and curve in s", True)]
    names = [("frequency_error", "relative error of the\nresonance frequency"),
             ("amplitude_error", "relative error of the\npeak amplitude"),
             ("curve_error_l2", "error of the whole curve\n(L2 over its arc length)")]
    figure, axes = plt.subplots(3, 2, figsize=(14, 14.5), sharey="row")
    labels = []
    for i, (column, name) in enumerate(names):
        for j, (_, text, whole) in enumerate(columns):
            labels.append(draw_errors(axes[i, j], rows, column, whole))
            if i == 2:
                axes[i, j].set_xlabel(text)
        axes[i, 0].set_ylabel(name)
    present = {row["family"] for row in rows}
    for family, (color, marker) in FAMILIES.items():
        if family in present:
            axes[0, 0].plot([], [], linestyle="none", marker=marker, color=color, label=family)
    axes[0, 0].plot([], [], color="0.8", linewidth=3, label="front: none faster and nearer")
    figure.suptitle(f"{study.title()}\n{what}; in brackets: size of the basis", fontsize=11)
    figure.tight_layout(rect=(0, 0.05, 1, 1))
    legend_below(figure, axes[0, 0], 4)
    figure.canvas.draw()
    for group in labels:
        group.place()
    save(figure, path, dpi)


# ---- contact ----

CONTACTS = {"reference": ("0.72", 5), "1_sample": ("tab:orange", 1.3), "4_samples": ("tab:green", 1.3),
            "compressed_12": ("tab:blue", 1.3)}


def plot_contact(study, path, dpi):
    figure, (left, right) = plt.subplots(1, 2, figsize=(10, 5.2))
    scale = 100 / study.n_pairs
    for name, (color, width) in CONTACTS.items():
        file = study.folder / f"contact_cycle_{name}.csv"
        if not file.exists():
            continue
        cycle = np.genfromtxt(file, delimiter=",", names=True)
        left.step(cycle["time_fraction"], 100 * cycle["closed_share"], where="post", color=color, linewidth=width,
                  label=name.replace("_", " "))
        curve = np.genfromtxt(study.folder / f"contact_curve_{name}.csv", delimiter=",", names=True)
        right.plot(curve["frequency_hz"], scale * curve["closed_mean"], color=color, linewidth=width)
        if name == "reference":
            for column in ("closed_min", "closed_max"):
                right.plot(curve["frequency_hz"], scale * curve[column], color="0.55", linewidth=1, zorder=1)
    left.set(xlabel="time in periods", ylabel="closed pairs in %", ylim=(-3, 103), xlim=(0, 1))
    left.set_title("over the cycle at the peak", fontsize=10)
    right.set(xlabel="excitation frequency in Hz", ylabel="closed pairs in %", ylim=(-3, 112))
    right.set_yticks(range(0, 101, 20))
    right.set_title("mean over the cycle, along the curve (thin: most and fewest)", fontsize=10)
    for axes in (left, right):
        axes.grid(alpha=0.3)
    figure.suptitle(study.title(), fontsize=11)
    figure.tight_layout(rect=(0, 0.08, 1, 1))
    legend_below(figure, left, 4)
    save(figure, path, dpi)


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
    axes.plot(x, np.maximum(frequency, 1e-12), style, marker="o", color="tab:blue", label="frequency" + suffix)
    axes.plot(x, np.maximum(amplitude, 1e-12), style, marker="s", color="tab:red", label="peak amplitude" + suffix)


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
            times.plot(x, [1e3 * number(r, "iteration_seconds") for _, r in rows], style, marker="o", color="tab:green",
                       label="piecewise-linear modes" + suffix)
    if "Craig-Bampton" in run.rows:
        times.axhline(1e3 * number(run.rows["Craig-Bampton"], "iteration_seconds"), color="tab:red",
                      label="Craig-Bampton")
    axes.set(xscale="log", yscale="log", xlabel="contact samples", title="samples")
    times.set(xscale="log", yscale="log", xlabel="contact samples", ylabel="ms", title="time of a Newton iteration")


def draw_svd(axes, run):
    rows = [(float(row["name"].split()[1]), row) for row in run.group("svd") if row["name"].startswith("svd")]
    rows.append((1e-6, run.rows["4 samples"]))  # the default
    rows.sort(key=lambda pair: pair[0])
    draw_two(axes, [t for t, _ in rows], [number(r, "frequency_error") for _, r in rows],
             [number(r, "amplitude_error") for _, r in rows])
    for tolerance, row in rows:
        axes.annotate(row["basis_size"], (tolerance, max(number(row, "amplitude_error"), 1e-12)), fontsize=8,
                      textcoords="offset points", xytext=(4, 4), color=GREY)
    axes.set(xscale="log", yscale="log", xlabel="svd_tolerance (with the size of the basis)",
             title="tolerance of the singular values")


def plot_convergence(study, path, dpi):
    figure, axes = plt.subplots(2, 3, figsize=(13, 7.6))
    draw_samples(axes[0, 0], axes[0, 1], study.one)
    draw_svd(axes[0, 2], study.one)
    for place, file, name in ((axes[1, 0], "harmonics.csv", "harmonics"),
                              (axes[1, 1], "time_samples.csv", "time samples in a period")):
        steps = rows_of(study.folder / file)
        draw_two(place, *errors_of_steps(steps))
        place.set(xscale="log", yscale="log", xlabel=name, title=name)
    steps = [row for row in rows_of(study.folder / "harmonics.csv") if int(row["number"]) > 0]
    axes[1, 2].plot([int(r["number"]) for r in steps], [float(r["seconds"]) for r in steps], marker="o", color="tab:green")
    axes[1, 2].set(xscale="log", yscale="log", xlabel="harmonics", ylabel="s", title="time of the curve")
    for place in axes.flat:
        if place is not axes[0, 2]:
            set_round_ticks(place)
        place.grid(alpha=0.3)
        if place.get_legend_handles_labels()[0]:
            place.legend(fontsize=8)
    figure.suptitle(study.title() + "\nrelative errors", fontsize=11)
    figure.tight_layout()
    save(figure, path, dpi)


def draw_all(study, to, dpi):
    one = "errors against the unreduced structure at the same H"
    if study.one and study.one.group("methods"):
        yield "error_against_time", lambda p: plot_errors(study, study.one.group("methods"), one, p, dpi)
        yield "curves", lambda p: plot_curves(study, p, dpi)
        yield "contact_over_cycle", lambda p: plot_contact(study, p, dpi)
    if study.levels:
        what = f"{study.facts['levels']} force levels, worst errors, sum of times"
        yield "levels", lambda p: plot_errors(study, study.levels.group("levels"), what, p, dpi)
    if study.one and (study.folder / "harmonics.csv").exists():
        yield "convergence", lambda p: plot_convergence(study, p, dpi)


def main():
    parser = argparse.ArgumentParser(description=__doc__, formatter_class=argparse.RawDescriptionHelpFormatter)
    parser.add_argument("folder", help="where plm-study wrote its files")
    parser.add_argument("--to", help="folder of the pictures (the same)")
    parser.add_argument("--dpi", type=int, default=80)
    arguments = parser.parse_args()
    study = Study(arguments.folder)
    to = pathlib.Path(arguments.to or arguments.folder)
    for name, draw in draw_all(study, to, arguments.dpi):
        draw(to / f"{name}.png")
        print(to / f"{name}.png")


if __name__ == "__main__":
    main()
