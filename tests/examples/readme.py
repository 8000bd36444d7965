"""readme.py MINIMAL ROOT: README.md says what minimal prints, and its links lead somewhere."""
import pathlib
import re
import subprocess
import sys

program, root = sys.argv[1], pathlib.Path(sys.argv[2])
readme = (root / "README.md").read_text(encoding="utf-8")
failures = []

said = subprocess.run([program], stdout=subprocess.PIPE, check=True).stdout.decode()
if said not in readme:
    failures.append(f"README.md does not show what minimal prints: {said}")

for target in re.findall(r"\]\(([^)#]+)[^)]*\)", readme):
    if "://" not in target and not (root / target).exists():
        failures.append(f"README.md links to {target}, which does not exist")

print("\n".join(failures) or "README.md agrees")
sys.exit(bool(failures))
