#!/usr/bin/env python3
"""recipes.py README PREFIX FOLDER: what README.md prints is what runs. Its files (<!-- file: NAME --> before a block) are
written, then each of its recipes (<!-- run: NAME -->) is run in a folder of its own with the installed library in $PREFIX.
Every line the programs print must stand in README.md, and they must print one each. With a curve that is cut off after a
few points they say so."""
import os
import pathlib
import re
import shutil
import subprocess
import sys

readme = pathlib.Path(sys.argv[1]).read_text(encoding="utf-8")
prefix, folder = (pathlib.Path(argument).resolve() for argument in sys.argv[2:4])
BLOCK = r"<!-- {}: (\S+) -->\n```\w+\n(.*?)```"
files = dict(re.findall(BLOCK.format("file"), readme, re.S))
recipes = dict(re.findall(BLOCK.format("run"), readme, re.S))
expected = {"host.c", "host.f90", "CMakeLists.txt", "Makefile"}, {"CMake", "pkg-config", "make"}
if (set(files), set(recipes)) != expected:
    sys.exit(f"{sys.argv[1]} marks the files {sorted(files)} and the recipes {sorted(recipes)}, not {expected}")

failures = []
for name in ("host.c", "host.f90"):
    lines = sum(bool(line.strip()) for line in files[name].splitlines())
    if lines > 24:
        failures.append(f"{name} has {lines} lines; it is meant to be read at a glance, in about 20")


def follow(work, script, written):
    """Runs a recipe in a fresh folder that has these files."""
    shutil.rmtree(work, ignore_errors=True)
    work.mkdir(parents=True)
    for file, text in written.items():
        (work / file).write_text(text, encoding="utf-8")
    return subprocess.run(["sh", "-ec", script], cwd=work, env={**os.environ, "PREFIX": str(prefix)}, text=True,
                          stdout=subprocess.PIPE, stderr=subprocess.STDOUT, check=False)


for name, script in recipes.items():
    work = folder / name
    done = follow(work, script, files)
    said = re.findall(r"^peak: .*$", done.stdout, re.M)
    programs = len(re.findall(r"^(?:\./|build/)host\w*$", script, re.M))
    print(f"{name}: {len(said)} programs say {set(said)}")
    if done.returncode or len(said) != programs or programs < 3:
        failures.append(f"{name}: exit code {done.returncode}, {len(said)} of {programs} programs spoke\n{done.stdout}")
    failures += [f"{name}: '{line}' is not in the README" for line in said if f"    {line}\n" not in readme]
    failures += [f"{name}: {warning}" for warning in re.findall(r"^.*\bwarning: .*$", done.stdout, re.M | re.I)]
    for program in work.rglob("host_static"):
        if "libplm.so" in subprocess.run(["readelf", "-d", program], stdout=subprocess.PIPE, text=True, check=True).stdout:
            failures.append(f"{name}: host_static needs libplm.so")
SHORT = {"host.c": ("OK(plm_hbm_sweep", 'OK(plm_hbm_set_int(hbm, "max_points", 5)) && OK(plm_hbm_sweep'),
         "host.f90": ("call hbm%sweep", "call hbm%set('max_points', 5); call hbm%sweep")}
short = {name: text.replace(*SHORT[name]) if name in SHORT else text for name, text in files.items()}
done = follow(folder / "short", recipes["pkg-config"], short)
looks = re.findall(r"(?m)^(?:libplm: )?plm_hbm_find_peak: .*max_points reached; raise it", done.stdout)
print(f"cut off after five points: {len(looks)} programs say so")
if done.returncode or any(short[name] == files[name] for name in SHORT) or len(looks) != 3:
    failures.append(f"a curve cut off: exit code {done.returncode}, {len(looks)} of 3 programs say so\n{done.stdout}")
print("\n".join(failures))
sys.exit(bool(failures))
