"""readme.py MINIMAL ROOT: README.md shows minimal.c as it is and what it prints, and its links lead somewhere."""
import pathlib
import re
import subprocess
import sys

program, root = sys.argv[1], pathlib.Path(sys.argv[2])
readme = (root / "README.md").read_text(encoding="utf-8")
failures = []

blocks = re.findall(r"```c\n(.*?)```", readme, re.DOTALL)
if (root / "examples/c/minimal.c").read_text(encoding="utf-8") not in blocks:
    failures.append("no C block of README.md is examples/c/minimal.c, verbatim")

said = subprocess.run([program], stdout=subprocess.PIPE, check=True).stdout.decode()
if said not in readme:
    failures.append(f"README.md does not show what minimal prints: {said}")

for target in re.findall(r"\]\(([^)#]+)[^)]*\)", readme):
    if "://" not in target and not (root / target).exists():
        failures.append(f"README.md links to {target}, which does not exist")

print("\n".join(failures) or "README.md agrees")
sys.exit(bool(failures))
