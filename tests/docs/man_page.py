#!/usr/bin/env python3
"""man_page.py ROOT [--check]: writes bindings/python/plm.1, the manual page of the command plm, from the command's own parser; with
--check it is compared, and read by man where there is one."""
import argparse
import pathlib
import re
import shutil
import subprocess
import sys

from plm.command.arguments import COMMANDS, make_parser

ROOT = pathlib.Path(sys.argv[1])
PATH = ROOT / "bindings/python/plm.1"
VERSION = re.search(r'^version = "(.*)"$', (ROOT / "bindings/python/pyproject.toml").read_text(encoding="utf-8"), re.M)[1]
FILES = """A deck of CalculiX or Abaqus (.inp), what meshio reads, matrices of other codes (.mtx, .mat, .npz, .rb, .op4 and others), or a case
file (.toml) that has every option as a key."""


def troff(text):
    """As roff has it: hyphens are minus signs, a line must not begin with a dot."""
    text = text.replace("\\", "\\e").replace("-", "\\-")
    return re.sub(r"^([.'])", r"\\&\1", text, flags=re.M)


def option_lines(action):
    names = ", ".join(f"\\fB{troff(name)}\\fR" for name in action.option_strings) or f"\\fI{troff(str(action.metavar))}\\fR"
    values = action.metavar if isinstance(action.metavar, tuple) else (action.metavar,) if action.option_strings and action.nargs != 0 else ()
    shown = " ".join(f"\\fI{troff(value)}\\fR" for value in values if value)
    return [".TP", f"{names} {shown}".rstrip(), troff((action.help or "").replace("%%", "%"))]


def written():
    main, parsers = make_parser()
    lines = [f'.TH PLM 1 "" "libplm {VERSION}" "User commands"', ".SH NAME", "plm \\- forced vibration of structures whose parts touch and separate",
             ".SH SYNOPSIS"]
    for name in parsers:
        lines += [".B plm", f"\\fB{name}\\fR \\fIFILE\\fR ... [\\fIoptions\\fR]", ".br"]
    lines += [".SH DESCRIPTION", troff(main.description), ".SH FILES", troff(" ".join(FILES.split())), ".SH COMMANDS"]
    for name, (text, _) in COMMANDS.items():
        lines += [".TP", f"\\fBplm {name}\\fR", troff(text[0].upper() + text[1:] + ".")]
    for name, parser in parsers.items():
        lines += [f".SH PLM {name.upper()}", troff(parser.description)]
        for action in parser._actions:
            if action.help != argparse.SUPPRESS and "--help" not in action.option_strings:
                lines += option_lines(action)
        lines += [".PP", "Example:", ".PP", ".nf", "    " + troff(COMMANDS[name][1]), ".fi"]
    status = main.epilog.partition("\n\n")[2]
    lines += [".SH EXIT STATUS", troff(" ".join(status.removeprefix("exit status: ").split())), ".SH SEE ALSO",
              "The pages of the documentation in share/doc/plm, among them the command plm with a whole example."]
    return "\n".join(lines) + "\n"


def check(text):
    if not PATH.exists() or PATH.read_text(encoding="utf-8") != text:
        sys.exit(f"{PATH.name} is not what the command says; run PLM_LIBRARY=... PYTHONPATH=bindings/python python3 tests/docs/man_page.py .")
    options = text.count("\\fB\\-\\-")
    if shutil.which("man"):
        shown = subprocess.run(["man", "--warnings", "-l", PATH], text=True, capture_output=True, check=False)
        if shown.returncode or shown.stderr or "PLM RESPONSE" not in re.sub(".\x08", "", shown.stdout):
            sys.exit(f"man says: {shown.stderr or shown.stdout[:500]}")
    print(f"{len(COMMANDS)} commands, {options} options")
    sys.exit(options < 100)


if "--check" in sys.argv:
    check(written())
PATH.write_text(written(), encoding="utf-8")
