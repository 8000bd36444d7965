#!/usr/bin/env python3
"""Writes what follows from include/plm/plm.h and src/capi/api.txt.

    python3 src/capi/api/generate.py            renews the files
    python3 src/capi/api/generate.py --check    compares them with what the two ask for; exit code 1 if they differ
"""
import sys

import fortran77
import fortran77_include
import fortran_c
import fortran_methods
import fortran_twins
import plm_api
import python_methods
import python_table
import symbol_ledger

WRITERS = {"fortran/plm_c.f90": fortran_c.written,
           "fortran/plm_methods.f90": fortran_methods.written,
           "fortran/plm_f77_calls.f90": fortran77.written_calls,
           "fortran/plm_f77_keys.f90": fortran77.written_keys,
           "fortran/plmf.inc": fortran77_include.written,
           "bindings/python/plm/_functions.py": python_table.written,
           "bindings/python/plm/_methods.py": python_methods.written,
           symbol_ledger.PATH: symbol_ledger.written}


def main():
    api = plm_api.read()
    made = {path: write(api) for path, write in WRITERS.items()}
    made.update({f"fortran/{file}": fortran_twins.written(file) for file in fortran_twins.FILES})
    stale = [path for path, text in made.items()
             if not (plm_api.ROOT / path).exists() or (plm_api.ROOT / path).read_text(encoding="utf-8") != text]
    if "--check" in sys.argv[1:]:
        if stale:
            sys.exit(f"not what plm.h and api.txt ask for: {', '.join(stale)}; run python3 src/capi/api/generate.py")
        print(f"{len(api.functions)} functions, {len(api.callbacks)} callbacks, {len(api.constants)} constants: "
              f"{len(made)} files as generated")
        return
    for path in stale:
        (plm_api.ROOT / path).write_text(made[path], encoding="utf-8")
        print(f"wrote {path}")


main()
