#!/usr/bin/env python3
"""ledger.py NM LIBPLM_SO LIBPLM_A PLM_H SYMBOLS_TXT: what the shared object exports, what the archive offers, what the
header declares and what the ledger lists are the same names; the version node of each is the ledger's version."""
import pathlib
import re
import subprocess
import sys

sys.path.insert(0, str(pathlib.Path(__file__).resolve().parents[2] / "src/capi/api"))
import plm_header  # noqa: E402

nm, shared, archive, header, ledger_path = sys.argv[1:]
failures = []


def expect_equal(one, other, one_name, other_name):
    for name in sorted(one - other):
        failures.append(f"{name}: in {one_name}, not in {other_name}")
    for name in sorted(other - one):
        failures.append(f"{name}: in {other_name}, not in {one_name}")


ledger = {}
for line in open(ledger_path, encoding="utf-8"):
    if line.strip() and not line.startswith("#"):
        name, version = line.split()
        ledger[name] = version

exported = {}
for line in subprocess.run([nm, "-D", "--defined-only", shared], check=True, capture_output=True, text=True).stdout.splitlines():
    kind, name = line.split()[-2:]
    if kind != "A":  # the version nodes themselves
        name, _, node = name.partition("@@")
        exported[name] = node

members = subprocess.run([nm, "-g", "--defined-only", archive], check=True, capture_output=True, text=True).stdout
offered = set(re.findall(r" T (plm_\w+)$", members, re.M))

declared = [f.name for f in plm_header.read(header).functions]
if len(declared) != len(set(declared)):
    failures.append("the header declares a function twice")
expect_equal(set(exported), set(ledger), "the shared object", "the ledger")
expect_equal(set(declared), set(ledger), "the header", "the ledger")
expect_equal(offered, set(ledger), "the archive", "the ledger")
for name, version in ledger.items():
    if name in exported and exported[name] != f"PLM_{version}":
        failures.append(f"{name}: introduced in {version} says the ledger, its version node is {exported[name] or 'missing'}")

print("\n".join(failures) or f"{len(ledger)} functions, the same in shared object, archive, header and ledger")
sys.exit(bool(failures))
