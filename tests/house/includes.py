#!/usr/bin/env python3
"""includes.py SRC: who includes whom in src/. Rooms include downwards only, and no part of a room comes back to itself.

A part is a header with the source of the same name; its includes are those of both. Prints the offending lines.
"""
import pathlib
import re
import sys

# Each room may include those named, and what those may.
MAY_INCLUDE = {"linalg": [], "paths": ["linalg"], "structure": ["linalg"], "contact": ["linalg"],
               "space": ["structure", "contact"], "sampling": ["space"], "reduction": ["sampling"],
               "motions": ["paths", "reduction"], "orbits": ["motions"], "hbm": ["motions"], "searches": ["hbm", "orbits"], "study": ["searches"],
               "capi": ["study"]}


def below(room):
    """The rooms that this one may include."""
    found = set(MAY_INCLUDE.get(room, ()))
    return found.union(*(below(other) for other in found))


def parts_of(source):
    """{part: {part: one place of the include}}, parts as 'room/name'."""
    parts = {}
    for path in sorted(source.rglob("*.[ch]pp")):
        name = path.relative_to(source).with_suffix("").as_posix()
        included = parts.setdefault(name, {})
        for number, line in enumerate(path.read_text(encoding="utf-8").splitlines(), 1):
            match = re.match(r'#include "([^"]+)"', line)
            if not match or match.group(1).startswith("plm/"):
                continue
            beside = path.parent / match.group(1)
            target = beside.relative_to(source).as_posix() if beside.exists() else match.group(1)
            target = target.rsplit(".", 1)[0]
            if target != name:
                included.setdefault(target, f"{path.relative_to(source)}:{number}")
    return parts


def upward(parts):
    for part, included in parts.items():
        room = part.split("/")[0]
        for target, place in included.items():
            other = target.split("/")[0]
            if room != other and other not in below(room):
                yield f"{place}: {room} must not include {target}"


def loops(parts):
    """Tarjan's strongly connected components with more than one part."""
    index, low, stack, found = {}, {}, [], []

    def visit(part):
        index[part] = low[part] = len(index)
        stack.append(part)
        for target in parts.get(part, ()):
            if target not in index:
                visit(target)
                low[part] = min(low[part], low[target])
            elif target in stack:
                low[part] = min(low[part], index[target])
        if low[part] == index[part]:
            loop = []
            while not loop or loop[-1] != part:
                loop.append(stack.pop())
            if len(loop) > 1:
                found.append(sorted(loop))

    for part in sorted(parts):
        if part not in index:
            visit(part)
    for loop in found:
        places = [place for part in loop for target, place in sorted(parts[part].items()) if target in loop]
        yield f"{' '.join(loop)} include one another:\n    " + "\n    ".join(places)


def main():
    source = pathlib.Path(sys.argv[1]).resolve()
    sys.setrecursionlimit(10000)
    parts = parts_of(source)
    wrong = [*upward(parts), *loops(parts)]
    for line in wrong:
        print(line)
    if len(parts) < 100:
        wrong.append(f"{source}: only {len(parts)} parts were found")
        print(wrong[-1])
    print(f"{len(parts)} parts, {sum(len(p) for p in parts.values())} includes, {len(wrong)} wrong")
    sys.exit(1 if wrong else 0)


if __name__ == "__main__":
    main()
