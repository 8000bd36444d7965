"""index.py: writes README.md beside it, the overview of the reports, the table of docs/benchmarks.md, and table and picture of
the project's README, from the reports' own tables. With --check it compares the pages instead, and ends with 1 when one is not
what the reports say. The picture needs matplotlib and the package plm (PYTHONPATH=bindings/python, PLM_LIBRARY)."""
import pathlib
import re
import statistics
import sys

FOLDER = pathlib.Path(__file__).parent
SCENES = {"cracked_plate_preload": "Cracked plate with pre-load",
          "cracked_plate": "Cracked plate without pre-load",
          "coaxial_cylinders_preload": "Co-axial cylinders with pre-load",
          "coaxial_cylinders": "Co-axial cylinders without pre-load"}
METHODS = ("4 samples", "snapshots", "updated LELSM", "compressed to 8", "compressed to 10", "compressed to 12",
           "compressed to 18", "compressed to 24", "refined", "Craig-Bampton", "full order")
LEVELS = ("4 samples", "compressed to 12", "compressed to 24", "refined", "snapshots", "Craig-Bampton", "full order")
REACHED = ("1 sample", "2 samples", "4 samples", "8 samples", "4 samples, bands", "snapshots", "bilinear modes",
           "updated LELSM", "compressed to 10", "refined", "Craig-Bampton", "full order")
REACHED_COLUMNS = ("method", "r", "iteration (ms)", "curve (s)", "frequency", "peak", "curve, L2")
FRONT = {"1 sample": "libplm, coarsest basis", "2 samples": "libplm, coarse basis", "4 samples": "libplm, default basis",
         "refined": "libplm, basis made for 0.1 %", "Craig-Bampton": "Craig-Bampton, all contact points kept",
         "full order": "no reduction"}  # the README's table, in words that need no explanation
FRONT_HEAD = ("way to the curve", "equations", "first curve (s)", "each further one (s)", "error of frequency", "error of amplitude")
COLUMNS = ("method", "front", "r", "set-up (s)", "curve (s)", "frequency", "peak", "curve, L2", "effectivity")
LEFT = ("method", "front")  # columns of words

HEAD = """# Reports

What `plm-study` makes of the scenes of the paper at its size (H = 5): every method against the unreduced structure at the
same number of harmonics. Each report begins with the command that makes it; `sh examples/demo.sh` builds its `plm-study` in
`build/demo-release/examples/c`. Two or more ran at a time on a machine of two cores, so that differences of some tens of per cent
between times mean nothing. This page is made from them by `python3 examples/reports/index.py`.
"""
LEVELS_HEAD = """
## Ten force levels

Where a compressed basis pays: the same curve at ten forces, from a tenth to all of it; worst errors, times added up.
"""
REFINED_HEAD = """
## Bases for a tolerance of 1e-3

True errors of at most 1e-3 in peak, frequency and everywhere on the curve, from good starts and from those whose dominant mode is
not the one that responds. Effectivity is a method's own estimate of its error over the true one; medians of these bases and of all
methods of the scene.

| scene | bases that meet it | their effectivity | that of all methods |
|---|--:|--:|--:|"""
STIFF_HEAD = """
## Harmonics

Cracked plate with pre-load, contacts of ten times the local stiffness ([report](cracked_plate_stiff/report.md)): how far the peak
is from that with 20 harmonics.

| H | change of the peak | curve (s) |
|--:|--:|--:|"""
LEFT_OUT_HEAD = """
## What was left out

What each part of a basis, the choice of unknowns, harmonics, and the search for bifurcations cost and bring:
"""
TAIL = """
## Build sizes

[The library and a static host](build_sizes.md) with all components, and with the smallest set that runs PLM and HBM.
"""


def section(name, title):
    """The lines of a report below the heading `title`, up to the next one of its kind."""
    text = (FOLDER / name / "report.md").read_text(encoding="utf-8")
    mark = title.split(" ", 1)[0]
    lines = text[text.index("\n" + title) + 1:].split("\n")
    end = next((i for i, line in enumerate(lines) if i and line.startswith(mark + " ")), len(lines))
    return lines[:end]


def cells(line):
    return [cell.strip() for cell in line.strip("|").split("|")]


def tables(lines):
    """Rows of all tables, as dictionaries by the table's own headings."""
    rows, head = [], None
    for before, line in zip([""] + lines, lines):
        if line.startswith("|--"):
            head = cells(before)
        elif not line.startswith("|"):
            head = None
        elif head:
            rows.append(dict(zip(head, cells(line))))
    return rows


def mesh(name):
    """What to say when a report is not of the paper's size."""
    quick = "(quick size)" in (FOLDER / name / "report.md").read_text(encoding="utf-8")
    return ", on the quick mesh" if quick else ""


def part(name, suffix):
    """The folder of a part of a scene's report that was made apart from the rest, or the scene's."""
    return name + suffix if (FOLDER / (name + suffix)).is_dir() else name


def table(name, title, methods, columns=COLUMNS):
    rows = {row["method"]: row for row in tables(section(name, title))}
    yield "| " + " | ".join(columns) + " |"
    yield "|" + "|".join("---" if column in LEFT else "--:" for column in columns) + "|"
    for method in methods:
        if method in rows:
            yield "| " + " | ".join(rows[method][column] for column in columns) + " |"


def refined(name):
    folder = part(name, "_refine")
    facts = [line for line in section(folder, "## Bases for a tolerance") if line.startswith("* ")]
    met = facts[0].split(" refined")[0].strip("* ")
    values = [row["effectivity"] for row in tables(section(name, "## The methods"))]
    median = statistics.median(float(value) for value in values if value != "-")
    return folder, met, facts[1].split("effectivity ")[1].split(",")[0], f"{median:.2g}"


def harmonics():
    rows = tables(section("cracked_plate_stiff", "### Harmonics"))
    peak = {row["H"]: float(row["amplitude"]) for row in rows}
    for row in rows:
        yield f"| {row['H']} | {abs(float(row['amplitude']) / peak['20'] - 1):.1e} | {row['curve (s)']} |"


def lines():
    yield HEAD
    for name, title in SCENES.items():
        yield f"## [{title}]({name}/report.md)\n\n![Error against time]({name}/error_against_time.png)\n"
        yield from table(name, "## The methods", METHODS)
        yield ""
    yield LEVELS_HEAD.strip("\n")
    for name, title in SCENES.items():
        if not (FOLDER / f"{name}_levels").is_dir():
            continue
        yield f"\n[{title}]({name}_levels/report.md){mesh(name + '_levels')}\n"
        yield from table(name + "_levels", "## A sweep of", LEVELS)
    yield REFINED_HEAD
    for name, title in SCENES.items():
        yield "| [{}]({}/report.md) | {} | {} | {} |".format(title, *refined(name))
    yield LEFT_OUT_HEAD.rstrip("\n") + "\n"
    for name, title in SCENES.items():
        folder = part(name, "_left_out")
        yield f"* [{title}]({folder}/report.md#what-was-left-out-and-what-it-saved){mesh(folder)}"
    yield STIFF_HEAD
    yield from harmonics()
    yield TAIL.rstrip("\n")


def overview(_):
    return "\n".join(lines()) + "\n"


def between(page, mark, rows):
    """The page with these rows between its two marks."""
    return re.sub(f"(<!-- {mark} -->\n).*?(<!-- end -->)", lambda m: m[1] + "\n".join(rows) + "\n" + m[2], page, flags=re.S)


def benchmarks(page):
    return between(page, "index.py", table("cracked_plate_preload", "## The methods", REACHED, REACHED_COLUMNS))


def percent(text):
    """1.6e-02 as 1.6 %, two digits."""
    value = 100 * float(text)
    return "0" if value == 0 else f"{float(f'{value:.1e}'):.7f}".rstrip("0").rstrip(".") + " %"


def front_rows():
    """Of the README's table: words, and the numbers as the report has them."""
    rows = {row["method"]: row for row in tables(section("cracked_plate_preload", "## The methods"))}
    return [(words, rows[method]) for method, words in FRONT.items()]


def project(page):
    """The project's README with its table."""
    lines = ["| " + " | ".join(FRONT_HEAD) + " |", "|---|" + "--:|" * (len(FRONT_HEAD) - 1)]
    for words, row in front_rows():
        numbers = (row["r"], row["both (s)"], row["curve (s)"], percent(row["frequency"]), percent(row["peak"]))
        lines.append("| " + " | ".join((words, *numbers)) + " |")
    return between(page, "index.py: front", lines)


def draw(path):
    """The README's picture: error of the peak over time, a point for each row of its table."""
    from plm import plot
    from plm.plot.errors import stairs
    from plm.plot.style import COLOURS, FAINT, round_ticks
    rows = [(words, float(row["both (s)"]), 100 * float(row["peak"])) for words, row in front_rows()]
    figure, ax = plot.figure(width=1.4 * plot.COLUMN, height=2.8, window=False)
    with plot.style():
        front = stairs([(seconds, error) for words, seconds, error in rows if words.startswith("libplm")])
        ax.loglog(*front, color=COLOURS[0], lw=1)
        ax.plot([], [], "o-", color=COLOURS[0], lw=1, label="libplm: none faster and better")
        for words, seconds, error in rows:
            own = words.startswith("libplm")
            if error == 0:  # what the others are compared with has no place on the axis
                ax.axvline(seconds, color=FAINT, ls="--", lw=1, label=f"{words}, the reference: {seconds:.2f} s")
                reference = ([seconds, seconds], [5e-4, 4])
            else:
                ax.loglog(seconds, error, "o" if own else "s", color=COLOURS[0 if own else 1], mfc=None if own else "white", ls="")
        ax.set_xlim(1, 5)
        ax.set_ylim(5e-4, 4)
        round_ticks(ax.xaxis, 1, 5)
        ax.set_yticks([0.001, 0.01, 0.1, 1], ["0.001", "0.01", "0.1", "1"])
        ax.minorticks_off()
        ax.set_xlabel("time of the first curve, set-up included (s)")
        ax.set_ylabel("error of the peak's amplitude (%)")
        ax.grid(True)
        plot.legend_above(ax)
        plot.name_points(ax, [(seconds, error, words.removeprefix("libplm, ").replace(", all", ",\nall")) for words, seconds, error in rows if error], [front, reference])
    plot.save(figure, path, ["png"])


def main():
    root = FOLDER.parent.parent
    for path, make in ((FOLDER / "README.md", overview), (root / "docs/benchmarks.md", benchmarks), (root / "README.md", project)):
        now = path.read_text(encoding="utf-8") if path.exists() else ""
        wanted = make(now)
        if sys.argv[1:] != ["--check"]:
            path.write_text(wanted, encoding="utf-8")
        elif now != wanted:
            sys.exit(f"{path} is not what the reports say; run {__file__}")
    if sys.argv[1:] != ["--check"]:
        draw(root / "docs/images/error_against_time.png")


main()
