#!/usr/bin/env python3
"""calls.py PLM_H OUT_C: a table of every function of the header as a call on a handle, all other arguments zero or NULL."""
import pathlib
import sys

sys.path.insert(0, str(pathlib.Path(__file__).resolve().parents[2] / "src/capi/api"))
import plm_header  # noqa: E402

header = plm_header.read(sys.argv[1])
HANDLES = {f"{handle} *": handle[len("plm_"):] for handle in header.handles}


def nothing(type_):
    return "NULL" if type_.endswith("*") or type_.endswith("_fn") else "0"


with open(sys.argv[2], "w", encoding="utf-8") as out:
    out.write('/* made by tests/host/calls.py from plm.h */\n#include "calls.h"\n#include <stddef.h>\n\n')
    table = []
    for f in header.functions:
        types = [a.type for a in f.arguments]
        rest = ", ".join(nothing(t) for t in types[1:])
        rest = f", {rest}" if rest else ""
        if types[0] in HANDLES:
            kind, how, cast = HANDLES[types[0]], "TAKES", types[0]
        elif f.name.endswith("_destroy"):
            kind, how, cast = HANDLES[types[0][:-1]], "DESTROYS", types[0]
        else:
            kind, how, cast = "context", "FREE", None
        if cast:
            out.write(f"static plm_status call_{f.name}(void *h) {{ return {f.name}(({cast})h{rest}); }}\n")
        else:
            out.write(f"static plm_status call_{f.name}(void *h) {{ (void)h; return {f.name}({nothing(types[0])}{rest}); }}\n")
        table.append(f'    {{"{f.name}", KIND_{kind.upper()}, {how}, call_{f.name}, NULL}},')
        second = next((i for i, t in enumerate(types) if i and t in HANDLES), None)
        if how == "TAKES" and second:
            arguments = [f"({types[0]})h"] + [nothing(t) for t in types[1:]]
            arguments[second] = f"({types[second]})other"
            out.write(f"static plm_status second_{f.name}(void *h, void *other) "
                      f"{{ return {f.name}({', '.join(arguments)}); }}\n")
            table[-1] = table[-1].replace(", NULL}", f", second_{f.name}}}")
    out.write("\nconst api_call api_calls[] = {\n" + "\n".join(table) + "\n};\n")
    out.write(f"const int n_api_calls = {len(table)};\n")
