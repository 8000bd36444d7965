#!/usr/bin/env python3
"""make.py FOLDER: writes the pages of the reference, reference.md and keys.md among them, as Markdown: for an install without MkDocs."""
import pathlib
import sys

sys.path[:0] = [str(pathlib.Path(__file__).resolve().parent), str(pathlib.Path(__file__).resolve().parents[2] / "src/capi/api")]
import reference_site  # noqa: E402

for name, text in reference_site.pages()[0].items():
    path = pathlib.Path(sys.argv[1]) / name
    path.parent.mkdir(parents=True, exist_ok=True)
    path.write_text(text, encoding="utf-8")
