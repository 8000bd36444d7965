#!/usr/bin/env python3
"""citation.py ROOT VERSION: CITATION.cff is of this version, and names the paper by the DOI that README.md has."""
import pathlib
import re
import sys

root, version = pathlib.Path(sys.argv[1]), sys.argv[2]
citation, readme = ((root / name).read_text(encoding="utf-8") for name in ("CITATION.cff", "README.md"))
cited = re.search(r"^version: (\S+)$", citation, re.M)
doi = re.search(r"^  doi: (\S+)$", citation, re.M)
if not cited or cited[1] != version:
    sys.exit(f"CITATION.cff is of version {cited and cited[1]}, the project of {version}")
if not doi or f"https://doi.org/{doi[1]})" not in readme:
    sys.exit(f"CITATION.cff has the doi {doi and doi[1]}, which README.md does not link to")
print(f"version {version}, doi {doi[1]}")
