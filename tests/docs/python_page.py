#!/usr/bin/env python3
"""python_page.py PAGE [--write]: every block of Python of a page is run, in order and in one program; what a block prints is what the
block marked <!-- output --> below it shows. A warning that the page does not catch is a failure. --write fills those blocks in.
Ends with 77 where NumPy or SciPy is missing."""
import contextlib
import io
import pathlib
import sys
import time
import traceback
import warnings

import page as pages


def run(block, path, scope):
    """What it prints; an exception ends the page."""
    printed = io.StringIO()
    code = compile("\n" * (block.line - 1) + block.text, str(path), "exec")  # lines are counted as on the page
    with contextlib.redirect_stdout(printed), warnings.catch_warnings():
        warnings.simplefilter("error")
        exec(code, scope)  # noqa: S102 - the page is ours
    return printed.getvalue()


def check(path):
    """(failures, {line of an output block: what it should show}, number of blocks run)."""
    listed = pages.blocks(path)
    scope, failures, shown, count = {"__name__": "__main__"}, [], {}, 0
    for place, block in enumerate(listed):
        if block.language != "python" or block.mark:
            continue
        begin = time.process_time()
        try:
            printed = run(block, path, scope)
        except Exception:  # noqa: BLE001 - of any kind: it is reported with its line on the page
            return [*failures, f"{path.name}:{block.line}:\n{traceback.format_exc()}"], shown, count
        count += 1
        print(f"{path.name}:{block.line}: {time.process_time() - begin:.1f} s")
        below = listed[place + 1] if place + 1 < len(listed) else None
        if below and below.mark == "output":
            shown[below.line] = printed
            wrong = pages.difference(below.text, printed)
            failures += [f"{path.name}:{below.line}: {wrong}"] if wrong else []
        elif printed:
            failures.append(f"{path.name}:{block.line}: prints what the page does not show:\n{printed}")
    outputs = [block.line for block in listed if block.mark == "output"]
    failures += [f"{path.name}:{line}: output of no block" for line in outputs if line not in shown]
    return failures, shown, count


def write(path, shown):
    """The page with its output blocks filled in."""
    lines = path.read_text(encoding="utf-8").splitlines(keepends=True)
    for line in sorted(shown, reverse=True):
        end = next(i for i in range(line - 1, len(lines)) if lines[i].startswith("```"))
        lines[line - 1:end] = [shown[line]]
    path.write_text("".join(lines), encoding="utf-8")


def main():
    try:
        import numpy, scipy  # noqa: F401, E401
    except ImportError as missing:
        print(f"skipped: {missing}")
        return 77
    path = pathlib.Path(sys.argv[1])
    failures, shown, count = check(path)
    if "--write" in sys.argv:
        write(path, shown)
    print("\n".join(failures) or f"{count} blocks of {path.name} do what it says")
    return bool(failures) or count == 0


sys.exit(main())
