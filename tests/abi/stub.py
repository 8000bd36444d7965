#!/usr/bin/env python3
"""stub.py PLM_H OUT_C: a C file that defines every function of the header and does nothing. Compiled with -g it holds
all that the header promises to a linker and a debugger: what abidiff compares, and what an old host was linked with."""
import pathlib
import sys

sys.path.insert(0, str(pathlib.Path(__file__).resolve().parents[2] / "src/capi/api"))
import plm_header  # noqa: E402

with open(sys.argv[2], "w", encoding="utf-8") as out:
    out.write(f'#include "{sys.argv[1]}"\n')
    for f in plm_header.read(sys.argv[1]).functions:
        arguments = ", ".join(f"{a.type} {a.name}" for a in f.arguments)
        unused = " ".join(f"(void){a.name};" for a in f.arguments)
        out.write(f"{f.returns} {f.name}({arguments}) {{ {unused} return PLM_ERR_NOT_BUILT; }}\n")
