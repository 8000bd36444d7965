#!/usr/bin/env python3
"""covers_the_header.py SOURCE_DIR: every function of plm.h is called by the module plm and by the FORTRAN 77 layer, but for
those listed here with their reason; every FORTRAN 77 subroutine stands in plmf.inc."""
import pathlib
import re
import sys

sys.path.insert(0, str(pathlib.Path(__file__).resolve().parents[2] / "api"))
import plm_header  # noqa: E402

root = pathlib.Path(sys.argv[1])
fortran = root / "fortran"
functions = {f.name for f in plm_header.read(root / "include/plm/plm.h").functions}
# the host's own memory and solver are C pointers by nature: called through the module plm_c
C_ONLY = {"plm_context_create_with_allocator", "plm_context_set_solver",
          "plm_context_set_inertia"}
# the module reads the whole text, which begins with the function and names the argument
MODULE_NOT = C_ONLY | {"plm_context_get_error_function", "plm_context_get_error_argument"}


def called(names):
    text = "\n".join((fortran / name).read_text() for name in names)
    found = set(re.findall(r"\b(plm_\w+)\s*\(", text))
    found |= set(re.findall(r"\bcall \w+\(self, (plm_\w+),", text))  # handed to a procedure that calls it
    return found | {name + kind for name in found for kind in ("_i32", "_i64")}


module = called(path.name for path in fortran.glob("plm*.f90") if path.name not in
                ("plm_c.f90", "plm_f77.f90", "plm_f77_keys.f90"))
f77 = called(["plm_f77.f90", "plm_f77_keys.f90"])
missing = [f"module plm: {name}" for name in sorted(functions - module - MODULE_NOT)]
missing += [f"FORTRAN 77: {name}" for name in sorted(functions - f77 - C_ONLY)]
include = (fortran / "plmf.inc").read_text()
names = re.findall(r"^subroutine (plm\w+)\(", (fortran / "plm_f77.f90").read_text(), flags=re.M)
missing += [f"plmf.inc: {name.upper()}" for name in names if f"{name.upper()} (" not in include]
if missing:
    sys.exit("\n".join(missing))
print(f"{len(functions)} functions covered, {len(C_ONLY)} by plm_c alone; {len(names)} subroutines documented")
