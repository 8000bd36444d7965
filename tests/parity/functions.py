#!/usr/bin/env python3
"""functions.py CXX INCLUDE_DIR: plm.hpp uses every function of plm.h. Lists those it lacks."""
import pathlib
import re
import subprocess
import sys

sys.path.insert(0, str(pathlib.Path(__file__).resolve().parents[2] / "src/capi/api"))
import plm_header  # noqa: E402

cxx, include = sys.argv[1], pathlib.Path(sys.argv[2])
declared = {f.name for f in plm_header.read(include / "plm/plm.h").functions}
# plm.hpp after its macros, without plm.h
text = subprocess.run([cxx, "-std=c++17", "-E", "-P", "-DPLM_PLM_H", f"-I{include}", include / "plm/plm.hpp"],
                      check=True, capture_output=True, text=True).stdout
missing = sorted(declared - set(re.findall(r"\bplm_\w+", text)))
print("\n".join(["plm.hpp lacks:", *missing]) if missing else f"plm.hpp uses all {len(declared)} functions of plm.h")
sys.exit(bool(missing))
