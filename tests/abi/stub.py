#!/usr/bin/env python3
"""stub.py PLM_H OUT_C: a C file that defines every function of the header and does nothing. Compiled with -g it holds
all that the header promises to a linker and a debugger: what abidiff compares, and what an old host was linked with."""
import sys

from plm_header import functions

with open(sys.argv[2], "w", encoding="utf-8") as out:
    out.write(f'#include "{sys.argv[1]}"\n')
    for f in functions(sys.argv[1]):
        arguments = ", ".join(f"{t} {n}" if not t.endswith("*") else t + n for t, n in f.arguments)
        unused = " ".join(f"(void){n};" for _, n in f.arguments)
        out.write(f"{f.returns} {f.name}({arguments}) {{ {unused} return PLM_ERR_NOT_BUILT; }}\n")
