#!/usr/bin/env python3
"""recipes.py README EMBEDDING PREFIX FOLDER: what the pages print is what runs. The programs of README.md and the files of
docs/embedding.md (<!-- file: NAME --> before a block) are written, then each recipe of the latter (<!-- run: NAME -->) is run in a
folder of its own with the installed library in $PREFIX. Every line the programs print must stand in README.md, and they must
print one each. With a stop that is out of reach they say so."""
import os
import pathlib
import re
import shutil
import subprocess
import sys

sys.path.insert(0, str(pathlib.Path(__file__).resolve().parents[1] / "docs"))
import page  # noqa: E402

readme = pathlib.Path(sys.argv[1]).read_text(encoding="utf-8")
prefix, folder = (pathlib.Path(argument).resolve() for argument in sys.argv[3:5])
files = {**page.named_blocks(sys.argv[1], "file"), **page.named_blocks(sys.argv[2], "file")}
files.pop("host.py", None)  # which needs no recipe; docs.programs_readme runs it
recipes = page.named_blocks(sys.argv[2], "run")
expected = {"host.c", "host.f90", "CMakeLists.txt", "Makefile"}, {"CMake", "pkg-config", "make"}
if (set(files), set(recipes)) != expected:
    sys.exit(f"{sys.argv[1]} and {sys.argv[2]} mark the files {sorted(files)} and the recipes {sorted(recipes)}, not {expected}")

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
FAR = {"host.c": ("stop, NULL", "stop, k"), "host.f90": ("[5000d0])", "[5000d0], [2d4])")}  # gaps of 20 km
far = {name: text.replace(*FAR[name]) if name in FAR else text for name, text in files.items()}
done = follow(folder / "far", recipes["pkg-config"], far)
looks = re.findall(r"(?m)^(?:libplm: )?plm_model_compute_response: no contact pair opens or closes", done.stdout)
print(f"a stop out of reach: {len(looks)} programs say so")
if done.returncode or any(far[name] == files[name] for name in FAR) or len(looks) != 3:
    failures.append(f"a stop out of reach: exit code {done.returncode}, {len(looks)} of 3 programs say so\n{done.stdout}")
print("\n".join(failures))
sys.exit(bool(failures))
