#!/usr/bin/env python3
"""include_file.py PLMF_INC SOURCE...: every subroutine that plmf.inc lists has in the sources the arguments listed, of the
types its own rule gives them (the paragraph that begins with "Handles (...)"), and none is left out."""
import re
import sys

include = open(sys.argv[1], encoding="utf-8").read()
sources = "\n".join(open(name, encoding="utf-8").read() for name in sys.argv[2:])
words = " ".join(line[1:].strip() for line in include.splitlines() if line.startswith("C"))

rule = re.search(r"Handles \(([\w, ]+)\) are INTEGER\*8.*?; names beginning with I to N, ([\w, ]+?) are INTEGER, "
                 r"texts \(([\w, ]+)\) CHARACTER\*\(\*\), HOST is EXTERNAL, the rest DOUBLE PRECISION", words)
if not rule:
    sys.exit("plmf.inc: the paragraph that gives the arguments their types is not as this check reads it")
handles, integers, texts = (set(re.findall(r"\w+", part)) - {"and"} for part in rule.groups())


def by_rule(name):
    if name in handles:
        return "INTEGER*8"
    if name in texts:
        return "CHARACTER*(*)"
    if name == "HOST":
        return "EXTERNAL"
    return "INTEGER" if name in integers or name[0] in "IJKLMN" else "DOUBLE PRECISION"


TYPES = {"integer(int64)": "INTEGER*8", "integer": "INTEGER", "real(real64)": "DOUBLE PRECISION",
         "character(len=*)": "CHARACTER*(*)", "procedure(log_subroutine)": "EXTERNAL",
         "procedure(progress_subroutine)": "EXTERNAL", "procedure(recover_subroutine)": "EXTERNAL",
         "procedure(write_subroutine)": "EXTERNAL"}


def declared(body, name):
    """The type of a dummy argument, or what stands there instead."""
    for line in body.splitlines():
        if "::" in line and re.search(rf"\b{name}\b", line.split("::")[1]):
            return TYPES.get(line.split("::")[0].strip().split(", ")[0], line.strip())
    return "no type at all"


layer = {name.upper(): ([a.strip() for a in arguments.replace("&", " ").split(",")], body)
         for name, arguments, body in re.findall(r"^subroutine (plm\w{3})\(([^)]*)\)(.*?)^end subroutine", sources, re.M | re.S)}
listed = [(name, arguments.replace("\nC", " ")) for name, arguments in
          re.findall(r"^C       (PLM\w{3}) \(([\w, ]+(?:\nC[\w, ]+)*)\)", include, re.M)]
listed += [(name.replace("PLMX", "PLM" + kind, 1), arguments) for name, arguments in listed if name.startswith("PLMX")
           for kind in "MSBHRTY" if "PLM" + kind + name[4:] in layer]
listed = {name: [a.strip() for a in arguments.split(",")] for name, arguments in listed if not name.startswith("PLMX")}

failures = [f"plmf.inc does not list {name}" for name in sorted(layer.keys() - listed.keys())]
for name, arguments in listed.items():
    if name not in layer:
        failures.append(f"plmf.inc lists {name}, which is no subroutine of the layer")
        continue
    dummies, body = layer[name]
    if len(dummies) != len(arguments):
        failures.append(f"{name}: {len(arguments)} arguments in plmf.inc, {len(dummies)} in the layer")
    failures += [f"{name}: {argument} is {by_rule(argument)} by the rule of plmf.inc, {declared(body, dummy)} in the layer"
                 for argument, dummy in zip(arguments, dummies) if by_rule(argument) != declared(body, dummy)]
print("\n".join(failures) or f"{len(listed)} subroutines of plmf.inc are as the layer declares them")
sys.exit(bool(failures) or len(listed) < 100)
