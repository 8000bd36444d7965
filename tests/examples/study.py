"""study.py CRACKED_PLATE_STUDY PLOT_STUDY: the study of every scene at quick size, its files and its errors."""
import csv
import math
import pathlib
import subprocess
import sys
import tempfile

# Measured at quick size with 4 samples, the worst of the four cases: 3e-8 in frequency and 7e-6 in amplitude (the plate
# with pre-load). The rest comes from modes above 1.1 H f, which the basis leaves out; ten times as much is a defect.
FREQUENCY_BOUND, AMPLITUDE_BOUND = 1e-6, 1e-4
# The full order is represented to the model's space_tolerance, 1e-7 of the contact receptances. These are quadratic in
# the error of the fields, so that the fields may be off by its root, 3e-4; measured: 5e-6 (plate), 1e-7 (cylinders).
FULL_RESIDUAL_BOUND = 1e-5

METHODS = ["plm_1", "plm_2", "plm_4", "plm_4_bands", "craig_bampton", "full_order"]
CASES = [("cracked_plate", []), ("cracked_plate", ["--no-preload"]), ("coaxial_cylinders", []),
         ("coaxial_cylinders", ["--no-preload"])]
failures = []


def require(condition, text):
    if not condition:
        failures.append(text)
        print("FAILED:", text)


def rows_of(path):
    with open(path, newline="", encoding="utf-8") as file:
        return list(csv.DictReader(file))


def check_curve(folder, method, name):
    curve = rows_of(folder / f"curves_{method}.csv")
    numbers = [{key: float(value) for key, value in row.items()} for row in curve]
    require(len(curve) > 20, f"{name}: {method} has a curve")
    require(all(math.isfinite(x) for row in numbers for x in row.values()), f"{name}: {method} has finite numbers")
    require(all(row["closed_min"] - 0.1 <= row["closed_mean"] <= row["closed_max"] + 0.1 for row in numbers),
            f"{name}: {method}: closed pairs, fewest <= mean <= most")
    require(all(row["residual"] < 1e-6 for row in numbers), f"{name}: {method} has converged points")
    cycle = rows_of(folder / f"contact_{method}.csv")
    require(all(0 <= float(row["closed_share"]) <= 1 for row in cycle), f"{name}: {method} has shares in [0, 1]")


def check_table(folder, name):
    table = {row["method"]: row for row in rows_of(folder / "table.csv")}
    require(list(table) == METHODS, f"{name}: one row per method, in order: {list(table)}")
    for method, row in table.items():
        require(row["error"] == "" and row["end"] == "reached the end of its range",
                f"{name}: {method} runs through: {row['error']} {row['end']}")
        require(float(row["setup_seconds"]) >= 0 and float(row["curve_seconds"]) > 0, f"{name}: {method} has times")
    reference, reduced = table["full_order"], table["plm_4"]
    require(float(reference["error_frequency"]) == 0 == float(reference["error_amplitude"]),
            f"{name}: the full order is the reference")
    print(name, *(f"{m} {table[m]['error_frequency']}/{table[m]['error_amplitude']}" for m in METHODS[:-1]),
          "residual", reference["full_residual"])
    require(float(reference["full_residual"]) < FULL_RESIDUAL_BOUND, f"{name}: the full order solves its equations")
    require(float(reduced["error_frequency"]) < FREQUENCY_BOUND, f"{name}: frequency with 4 samples")
    require(float(reduced["error_amplitude"]) < AMPLITUDE_BOUND, f"{name}: amplitude with 4 samples")
    require(int(reduced["basis_size"]) <= int(reference["basis_size"]), f"{name}: the basis is a reduction")


def python_with_matplotlib():
    for python in (sys.executable, "/usr/bin/python3"):
        try:
            if not subprocess.run([python, "-c", "import numpy, matplotlib"], stderr=subprocess.DEVNULL).returncode:
                return python
        except OSError:
            pass
    return None


def check_pictures(plot, folder, name):
    python = python_with_matplotlib()
    if not python:
        print("no Python with numpy and matplotlib: plot_study.py is not tried")
        return
    done = subprocess.run([python, plot, str(folder)], stdout=subprocess.DEVNULL)
    require(done.returncode == 0 and len(list(folder.glob("*.png"))) == 3, f"{name}: three pictures")


def run(program, scene, options, folder):
    name = " ".join([scene, *options])
    command = [program, "--size", "quick", "--samples", "1,2,4", "--scene", scene, "--output", str(folder), *options]
    done = subprocess.run(command, stdout=subprocess.PIPE, check=False)
    require(done.returncode == 0, f"{name}: exit code {done.returncode}\n{done.stdout.decode()}")
    if done.returncode == 0:
        for method in METHODS:
            check_curve(folder, method, name)
        check_table(folder, name)


def refuses_nonsense(program):
    for options in (["--samples", "1,,2"], ["--size", "huge"], ["--harmonics", "0"], ["--unknown"]):
        done = subprocess.run([program, *options], stderr=subprocess.DEVNULL, stdout=subprocess.DEVNULL)
        require(done.returncode == 2, f"exit code 2 for {options}")
    require(subprocess.run([program, "--help"], stdout=subprocess.DEVNULL).returncode == 0, "--help")


def main():
    program, plot = sys.argv[1:3]
    refuses_nonsense(program)
    with tempfile.TemporaryDirectory() as root:
        for number, (scene, options) in enumerate(CASES):
            folder = pathlib.Path(root) / str(number)
            run(program, scene, options, folder)
        if not failures:
            check_pictures(plot, pathlib.Path(root) / "0", CASES[0][0])
    sys.exit(bool(failures))


main()
