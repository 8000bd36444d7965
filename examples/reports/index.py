"""index.py: writes README.md beside it, the overview of the reports, and the table of the project's README, from the
reports' own tables. With --check it compares instead, and ends with 1 when a page is not what the reports say."""
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


def project(page):
    """The project's README with the table between its two marks."""
    rows = "\n".join(table("cracked_plate_preload", "## The methods", REACHED, REACHED_COLUMNS))
    return re.sub("(<!-- index.py -->\n).*?(\n<!-- end -->)", lambda m: m[1] + rows + m[2], page, flags=re.S)


def main():
    for path, make in ((FOLDER / "README.md", overview), (FOLDER.parent.parent / "README.md", project)):
        now = path.read_text(encoding="utf-8") if path.exists() else ""
        wanted = make(now)
        if sys.argv[1:] != ["--check"]:
            path.write_text(wanted, encoding="utf-8")
        elif now != wanted:
            sys.exit(f"{path} is not what the reports say; run {__file__}")


main()
