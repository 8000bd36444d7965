#!/usr/bin/env python3
"""programs.py PAGE FOLDER ROOT LIBRARY [FORTRAN_ARCHIVE FORTRAN_MODULES]: the programs of a page are compiled and run as they stand.

A block marked <!-- file: NAME --> is a program; its page shows what it prints in a block marked <!-- output: NAME NAME ... -->, or,
where there is none, as an indented line for each. Without the Fortran interfaces, Fortran is left out and said. Ends with 77
when a Python program cannot run because NumPy or SciPy is missing.
"""
import os
import pathlib
import shutil
import subprocess
import sys

import page as pages

page, folder, root, library = (pathlib.Path(a).absolute() for a in sys.argv[1:5])
fortran = [pathlib.Path(a).absolute() for a in sys.argv[5:7]]
LINK = [str(library), f"-Wl,-rpath,{library.parent}"]
STRICT = ["-Wall", "-Wextra", "-Werror"]


def command_for(name):
    """How a program is compiled, None: not at all (Python)."""
    include, out = f"-I{root / 'include'}", ["-o", name + ".program"]
    if name.endswith(".c"):
        return [os.environ.get("CC", "cc"), "-std=c99", "-pedantic", *STRICT, include, name, *LINK, *out]
    if name.endswith(".cpp"):
        return [os.environ.get("CXX", "c++"), "-std=c++17", "-pedantic", *STRICT, include, name, *LINK, *out]
    compiler = os.environ.get("FC", "gfortran")
    if name.endswith(".f90"):
        return [compiler, "-std=f2008", *STRICT, f"-I{fortran[1]}", name, str(fortran[0]), *LINK, *out]
    if name.endswith(".f"):  # unused PARAMETERs come with the include file
        return [compiler, "-std=legacy", "-Wall", "-Wno-unused-parameter", "-Werror", f"-I{root / 'fortran'}", name, str(fortran[0]),
                *LINK, *out]
    return None


def run(name):
    """(what was printed, failure or None)."""
    command = command_for(name)
    if command:
        done = subprocess.run(command, cwd=folder, text=True, stdout=subprocess.PIPE, stderr=subprocess.STDOUT, check=False)
        if done.returncode:
            return "", f"{name} does not compile:\n{' '.join(command)}\n{done.stdout}"
    environment = {**os.environ, "PLM_LIBRARY": str(library), "PYTHONPATH": str(root / "bindings/python"), "OPENBLAS_NUM_THREADS": "1"}
    program = [f"./{name}.program"] if command else [sys.executable, name]
    done = subprocess.run(program, cwd=folder, env=environment, text=True, stdout=subprocess.PIPE, stderr=subprocess.PIPE, check=False)
    if done.returncode or done.stderr:
        return done.stdout, f"{name} ends with {done.returncode} and says:\n{done.stderr}"
    return done.stdout, None


def shown_by_the_page():
    """{NAME: text} of the blocks marked output, each of which may name several programs."""
    shown = {}
    for names, text in pages.named_blocks(page, "output").items():
        shown.update({name: text for name in names.split()})
    return shown


def check(name, shown, text):
    """Failures of one program."""
    printed, failure = run(name)
    print(f"{name}: {printed.strip()}")
    if failure:
        return [failure]
    if name in shown:
        wrong = pages.difference(shown[name], printed)
        return [f"{name}: {wrong}"] if wrong else []
    return [f"{page.name} does not show what {name} prints: {line}" for line in printed.splitlines() if f"    {line}\n" not in text]


def main():
    programs = pages.named_blocks(page, "file")
    programs = {name: text for name, text in programs.items() if pathlib.Path(name).suffix in (".c", ".cpp", ".f90", ".f", ".py")}
    left_out = [] if fortran else [name for name in programs if name.endswith((".f90", ".f"))]
    shutil.rmtree(folder, ignore_errors=True)
    folder.mkdir(parents=True)
    for name, text in programs.items():
        (folder / name).write_text(text, encoding="utf-8")
    try:
        import numpy, scipy  # noqa: F401, E401
    except ImportError as missing:
        print(f"skipped: {missing}")
        return 77
    shown, text = shown_by_the_page(), page.read_text(encoding="utf-8")
    failures = [f"{page.name}: output of {name}, which is no program of the page" for name in shown if name not in programs]
    ran = [name for name in programs if name not in left_out]
    for name in ran:
        failures += check(name, shown, text)
    if len(ran) < 2:
        failures.append(f"{page.name}: only {len(ran)} programs were found")
    print("\n".join([*(f"{name}: left out, the library has no Fortran interfaces" for name in left_out), *failures]))
    return bool(failures)


sys.exit(main())
