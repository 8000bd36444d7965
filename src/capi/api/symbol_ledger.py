"""tests/abi/symbols.txt: every exported function and the version that introduced it."""
import re

from plm_header import ROOT

PATH = "tests/abi/symbols.txt"
HEAD = "# Every exported function and the version of libplm that introduced it. A line is never removed while the SONAME stays.\n"


def present_version():
    """MAJOR.MINOR of the project, as the version nodes are named."""
    return re.search(r"VERSION (\d+\.\d+)", (ROOT / "CMakeLists.txt").read_text(encoding="utf-8").split("project(")[1])[1]


def written(api):
    """The ledger as it stands, with a line for each function that is new. It only grows: the gate abi.ledger refuses a
    line whose function is gone."""
    lines = (ROOT / PATH).read_text(encoding="utf-8").splitlines()
    ledger = dict(line.split() for line in lines if line and not line.startswith("#"))
    for function in api.functions:
        ledger.setdefault(function.name, present_version())
    return HEAD + "".join(f"{name} {version}\n" for name, version in sorted(ledger.items()))
