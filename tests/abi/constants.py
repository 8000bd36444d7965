#!/usr/bin/env python3
"""constants.py BASELINE_PLM_H PLM_H: the numbers compiled into old hosts keep their meaning (abidiff does not see macros)."""
import sys

from plm_header import constants

old, new = constants(sys.argv[1]), constants(sys.argv[2])
changed = [f"{name}: was {value}, is {new.get(name, 'gone')}" for name, value in old.items() if new.get(name) != value]
print("\n".join(changed) or f"{len(old)} constants as they were, {len(new) - len(old)} new")
sys.exit(bool(changed) or len(old) < 50)
