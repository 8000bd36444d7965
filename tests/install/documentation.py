#!/usr/bin/env python3
"""documentation.py PREFIX: an install has README.md, CHANGELOG.md, LICENSE and the documentation: as a site whose front page, reference
and search are there, or, where there was no MkDocs, as the same pages in Markdown; and a manual page that man can read."""
import pathlib
import shutil
import subprocess
import sys

prefix = pathlib.Path(sys.argv[1])
folder = prefix / "share/doc/plm"
failures = [f"no {name}" for name in ("README.md", "CHANGELOG.md", "LICENSE", "CITATION.cff") if not (folder / name).is_file()]
is_site = (folder / "html").is_dir()
pages, end = (folder / "html", ".html") if is_site else (folder / "docs", ".md")
for name in ("index", "getting-started", "tutorial", "theory", "choosing", "keys", "reference", "reference/model", "reference/fortran",
             "reference/fortran77", "reference/cpp", "reference/python"):
    path = pages / f"{name}{end}"
    if not path.is_file() or len(path.read_text(encoding="utf-8")) < 2000:
        failures.append(f"no page {path.relative_to(prefix)}, or an empty one")
if is_site and "plm_model_build" not in (pages / "search/index.js").read_text(encoding="utf-8"):
    failures.append("the search does not know plm_model_build")
manual = prefix / "share/man/man1/plm.1"
if not manual.is_file():
    failures.append("no manual page of the command plm")
elif shutil.which("man"):
    shown = subprocess.run(["man", "-M", str(manual.parents[1]), "plm"], text=True, capture_output=True, check=False)
    if "exit status" not in shown.stdout.lower().replace("\x08", "") and "EXIT STATUS" not in shown.stdout:
        failures.append(f"man shows no page: {shown.stderr}")
print("\n".join(failures) or f"{len(list(pages.rglob('*' + end)))} pages and a manual page")
sys.exit(bool(failures))
