#!/usr/bin/env python3
"""covers_the_header.py SOURCE_DIR: every function of plm.h is called by the module plm, but for those that api.txt leaves out
with a reason. (The FORTRAN 77 layer follows from api.txt: abi.generated and fortran.include_file.)"""
import pathlib
import re
import sys

sys.path.insert(0, str(pathlib.Path(__file__).resolve().parents[2] / "src/capi/api"))
import plm_api  # noqa: E402

root = pathlib.Path(sys.argv[1])
api = plm_api.read(root / "include/plm/plm.h", root / "src/capi/api.txt")
functions, left_out = {function.name for function in api.functions}, set(api.left_out_of("module plm"))

text = "\n".join(path.read_text() for path in (root / "fortran").glob("plm_*")
                 if path.stem != "plm_c" and not path.stem.startswith("plm_f77"))
called = set(re.findall(r"\b(plm_\w+)\s*\(", text))
called |= set(re.findall(r"\bcall \w+\(self, (plm_\w+),", text))  # handed to a procedure that calls it
called |= {name + kind for name in called for kind in ("_i32", "_i64")}

failures = [f"module plm: {name}" for name in sorted(functions - called - left_out)]
failures += [f"module plm: {name} is called, though api.txt says it is left out" for name in sorted(left_out & called)]
print("\n".join(failures) or f"{len(functions)} functions covered but for {len(left_out)}, left out with a reason")
sys.exit(bool(failures))
