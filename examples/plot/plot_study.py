#!/usr/bin/env python3
"""Pictures of what cracked_plate_study computed: plot_study.py FOLDER [--to FOLDER] [--dpi N].

Reads study.csv, table.csv, curves_<method>.csv and contact_<method>.csv; writes curves.png, error_against_time.png and
contact_over_cycle.png.
"""
import argparse
import csv
import pathlib

import matplotlib

matplotlib.use("Agg")
import matplotlib.pyplot as plt  # noqa: E402
import matplotlib.ticker as ticker  # noqa: E402
import numpy as np  # noqa: E402

REFERENCE = "full_order"
GREY = "0.35"


def label_of(method):
    """Words for a method's name in the files."""
    words = {REFERENCE: "full order", "craig_bampton": "Craig-Bampton"}
    if method in words:
        return words[method]
    parts = method.split("_")
    text = f"{parts[1]} sample" + ("" if parts[1] == "1" else "s")
    return text + (", bands rule" if parts[-1] == "bands" else "")


class Study:
    """The files of one folder."""

    def __init__(self, folder):
        self.folder = pathlib.Path(folder)
        with open(self.folder / "study.csv", newline="") as file:
            self.facts = {row["key"]: row["value"] for row in csv.DictReader(file)}
        with open(self.folder / "table.csv", newline="") as file:
            rows = [row for row in csv.DictReader(file) if not row["error"]]
        self.table = {row["method"]: row for row in rows}
        self.curves = {m: self.read(f"curves_{m}.csv") for m in self.table}
        self.cycles = {m: self.read(f"contact_{m}.csv") for m in self.table}
        self.n_pairs = int(self.facts["n_pairs"])
        oscillator = self.facts["scene"] == "bilinear_oscillator"  # the one scene without units
        self.unit, self.length = ("", 1.0) if oscillator else (" in µm", 1e3)

    def amplitude(self, method):
        return self.length * self.curves[method]["amplitude"]

    def read(self, name):
        return np.atleast_1d(np.genfromtxt(self.folder / name, delimiter=",", names=True))

    def number(self, method, column):
        return float(self.table[method][column])

    def title(self):
        f = self.facts
        scene = f["scene"].replace("_", " ")
        load = "with" if f["preload"] == "1" else "without"
        return (f"{scene[0].upper()}{scene[1:]}, {int(f['n_dof']):,} DOFs, {self.n_pairs} contact pairs, "
                f"{load} pre-load, H = {f['harmonics']}")

    def styles(self):
        """Line and marker of every method, the reference first so that it lies beneath."""
        result = {REFERENCE: dict(color="0.72", linewidth=5, zorder=1)} if REFERENCE in self.table else {}
        plain = [m for m in self.table if m.startswith("plm_") and not m.endswith("_bands")]
        for i, m in enumerate(plain):
            color = plt.cm.viridis(0.9 * i / max(1, len(plain) - 1))
            result[m] = dict(color=color, linewidth=1.3, zorder=3, marker="osDv^<>ph"[i % 9])
        for m in self.table:
            if m.endswith("_bands"):
                result[m] = dict(color="tab:orange", linewidth=1.3, linestyle=(0, (4, 2)), zorder=4, marker="X")
        if "craig_bampton" in self.table:
            result["craig_bampton"] = dict(color="tab:red", linewidth=1.3, linestyle=(0, (1, 1)), zorder=2, marker="P")
        return result


def line(style):
    return {k: v for k, v in style.items() if k != "marker"}


def names_columns(axes, handles_from=None, columns=4):
    handles, labels = (handles_from or axes).get_legend_handles_labels()
    axes.figure.legend(handles, labels, loc="lower center", ncol=columns, frameon=False)


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
    for method, style in study.styles().items():
        curve = study.curves[method]
        size = int(study.number(method, "basis_size"))
        axes.plot(curve["frequency_hz"], study.amplitude(method), label=f"{label_of(method)}, r = {size}",
                  **line(style))


def plot_curves(study, path, dpi):
    figure, axes = plt.subplots(figsize=(9, 5.8))
    draw_curves(axes, study)
    axes.set(xlabel="excitation frequency in Hz", ylabel=f"half peak-to-peak displacement{study.unit}")
    axes.set_title(study.title(), fontsize=11)
    axes.grid(alpha=0.3)
    axes.set_ylim(bottom=0, top=1.08 * axes.get_ylim()[1])
    shown = REFERENCE if REFERENCE in study.curves else next(iter(study.curves))
    f_low, f_high, a_low, a_high = region_of_peak(study.curves[shown]["frequency_hz"], study.amplitude(shown))
    x0, x1 = axes.get_xlim()
    left = 0.5 * (f_low + f_high) > 0.5 * (x0 + x1)  # the emptier side
    inset = axes.inset_axes([0.1 if left else 0.66, 0.5, 0.31, 0.44])
    draw_curves(inset, study)
    inset.set(xlim=(f_low, f_high), ylim=(a_low, a_high))
    inset.set_title("around the peak", fontsize=9)
    inset.tick_params(labelsize=8)
    inset.xaxis.set_major_locator(ticker.MaxNLocator(4))
    inset.grid(alpha=0.3)
    axes.indicate_inset_zoom(inset, edgecolor=GREY)
    figure.tight_layout(rect=(0, 0.13, 1, 1))
    names_columns(axes)
    figure.savefig(path, dpi=dpi)


class Labels:
    """Short texts beside points of a log-log plot, each in the first free place around its point."""

    places = [(7, 6), (7, -14), (-7, 6), (-7, -14), (0, 11), (0, -19), (14, -4), (-14, -4), (18, 16), (18, -24)]

    def __init__(self, axes):
        self.axes = axes
        self.points, self.texts, self.lines = [], [], []

    def add(self, x, y, text, color):
        self.points.append((x, y))
        self.texts.append((x, y, text, color))

    def place(self):
        renderer = self.axes.figure.canvas.get_renderer()
        dots = self.axes.transData.transform(self.points) if self.points else []
        taken = [matplotlib.transforms.Bbox.from_bounds(x - 6, y - 6, 12, 12) for x, y in dots]
        frame = self.axes.get_window_extent(renderer)
        for x in self.lines:
            across = self.axes.transData.transform((x, 1))[0]
            taken.append(matplotlib.transforms.Bbox.from_extents(across - 3, frame.y0, across + 3, frame.y1))
        for x, y, text, color in self.texts:
            for place in self.places:
                side = "left" if place[0] > 0 else "right" if place[0] < 0 else "center"
                note = self.axes.annotate(text, (x, y), xytext=place, textcoords="offset points", fontsize=8,
                                          ha=side, color=color)
                box = note.get_window_extent(renderer)
                inside = frame.x0 < box.x0 and box.x1 < frame.x1 and frame.y0 < box.y0 and box.y1 < frame.y1
                if inside and not any(box.overlaps(other) for other in taken):
                    taken.append(box)
                    break
                note.remove()


def seconds_of(study, method, whole):
    """Time of the curve; whole: with the set-up and, where it is used, the contact space all methods share."""
    seconds = study.number(method, "curve_seconds")
    if whole:
        seconds += study.number(method, "setup_seconds")
        if method != "craig_bampton":
            seconds += float(study.facts["contact_space_seconds"])
    return seconds


def set_time_ticks(axes):
    """Round numbers, also where the axis spans less than a decade."""
    low, high = axes.get_xlim()
    if high / low < 8:
        ticks = ticker.MaxNLocator(6, steps=[1, 2, 5, 10]).tick_values(low, high)
    else:
        ticks = [m * 10.0 ** e for e in range(-6, 6) for m in ((1, 2, 5) if high / low < 200 else (1,))]
    axes.xaxis.set_major_locator(ticker.FixedLocator([t for t in ticks if low <= t <= high]))
    axes.xaxis.set_minor_locator(ticker.NullLocator())
    axes.xaxis.set_major_formatter(ticker.FuncFormatter(lambda v, _: f"{v:g}"))


def draw_errors(axes, study, column, whole):
    labels = Labels(axes)
    for method, style in study.styles().items():
        seconds = seconds_of(study, method, whole)
        if method == REFERENCE:
            axes.axvline(seconds, color="0.72", linewidth=3, label="full order (error 0)")
            labels.lines.append(seconds)
            continue
        error = max(study.number(method, column), 1e-12)
        size = int(study.number(method, "basis_size"))
        axes.plot([seconds], [error], linestyle="none", marker=style["marker"], markersize=8, color=style["color"],
                  label=label_of(method))
        labels.add(seconds, error, f"r = {size}", GREY)
    axes.set(xscale="log", yscale="log")
    axes.margins(0.18)
    axes.autoscale_view()
    set_time_ticks(axes)
    axes.grid(alpha=0.3)
    return labels


def plot_errors(study, path, dpi):
    figure, axes = plt.subplots(2, 2, figsize=(10, 7.6), sharey="row")
    rows = [("error_frequency", "relative error of the\nresonance frequency"),
            ("error_amplitude", "relative error of the\npeak amplitude")]
    columns = ["time of the curve in s", "time of contact space, basis and curve in s"]
    labels = []
    for i, (column, name) in enumerate(rows):
        for j in (0, 1):
            labels.append(draw_errors(axes[i, j], study, column, whole=j == 1))
            if i == 1:
                axes[i, j].set_xlabel(columns[j])
        axes[i, 0].set_ylabel(name)
    figure.suptitle(study.title() + "\nerrors against the full order at the same H; r: size of the basis", fontsize=11)
    figure.tight_layout(rect=(0, 0.08, 1, 1))
    names_columns(axes[0, 0])
    figure.canvas.draw()
    for group in labels:
        group.place()
    figure.savefig(path, dpi=dpi)


def draw_cycle(axes, study):
    for method, style in study.styles().items():
        cycle = study.cycles[method]
        axes.step(cycle["time_fraction"], 100 * cycle["closed_share"], where="post", label=label_of(method),
                  **line(style))
    axes.set(xlabel="time in periods", ylabel="closed pairs in %", ylim=(-3, 103), xlim=(0, 1))
    axes.set_title("over the cycle at the peak", fontsize=10)


def draw_share(axes, study):
    scale = 100 / study.n_pairs
    for method, style in study.styles().items():
        curve = study.curves[method]
        axes.plot(curve["frequency_hz"], scale * curve["closed_mean"], **line(style))
        if method == REFERENCE:
            for column in ("closed_min", "closed_max"):
                axes.plot(curve["frequency_hz"], scale * curve[column], color="0.55", linewidth=1, zorder=1)
            note = dict(color=GREY, fontsize=8, ha="center", xycoords=("axes fraction", "axes fraction"))
            axes.annotate("thin grey: most and fewest in the cycle, full order", (0.5, 0.955), **note)
    axes.set(xlabel="excitation frequency in Hz", ylabel="closed pairs in %", ylim=(-3, 112))
    axes.set_yticks(range(0, 101, 20))
    axes.set_title("mean over the cycle, along the curve", fontsize=10)


def plot_contact(study, path, dpi):
    figure, (left, right) = plt.subplots(1, 2, figsize=(10, 5.2))
    draw_cycle(left, study)
    draw_share(right, study)
    for axes in (left, right):
        axes.grid(alpha=0.3)
    figure.suptitle(study.title(), fontsize=11)
    figure.tight_layout(rect=(0, 0.1, 1, 1))
    names_columns(left)
    figure.savefig(path, dpi=dpi)


def main():
    parser = argparse.ArgumentParser(description=__doc__, formatter_class=argparse.RawDescriptionHelpFormatter)
    parser.add_argument("folder", help="where cracked_plate_study wrote its files")
    parser.add_argument("--to", help="folder of the pictures (the same)")
    parser.add_argument("--dpi", type=int, default=110)
    arguments = parser.parse_args()
    study = Study(arguments.folder)
    to = pathlib.Path(arguments.to or arguments.folder)
    pictures = {"curves": plot_curves, "error_against_time": plot_errors, "contact_over_cycle": plot_contact}
    for name, draw in pictures.items():
        draw(study, to / f"{name}.png", arguments.dpi)
        print(to / f"{name}.png")


if __name__ == "__main__":
    main()
