#!/usr/bin/env python3
"""constants.py BASELINE_PLM_H PLM_H: the numbers compiled into old hosts keep their meaning (abidiff does not see macros)."""
import pathlib
import sys

sys.path.insert(0, str(pathlib.Path(__file__).resolve().parents[2] / "src/capi/api"))
import plm_header  # noqa: E402

old, new = (plm_header.read(path).constants for path in sys.argv[1:3])
changed = [f"{name}: was {value}, is {new.get(name, 'gone')}" for name, value in old.items() if new.get(name) != value]
print("\n".join(changed) or f"{len(old)} constants as they were, {len(new) - len(old)} new")
sys.exit(bool(changed) or len(old) < 50)
