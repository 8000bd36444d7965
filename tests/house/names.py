#!/usr/bin/env python3
"""names.py SRC: no two files of a room give one name to two things, as several of them may be compiled at once (PLM_UNITY) in batches
that change with every file. Looks at types, constants and functions of anonymous namespaces, and whether a header of the room has the
name, too. Prints those that stand twice. Of the room capi keys_*.cpp are each compiled alone: they name the
handle they speak of alike.
"""
import collections
import pathlib
import re
import sys

ANONYMOUS = re.compile(r"^namespace \{\n(.*?)^\} // namespace\n", re.S | re.M)
TYPE = re.compile(r"^(?:template <[^>]*>\s*)?(?:class|struct) (\w+)(?: final)?(?: :[^{;]*)? ?\{", re.M)
CONSTANT = re.compile(r"^(?:static )?(?:inline )?constexpr [^;({]*;", re.M)
FUNCTION = re.compile(r"^(?:template <[^>]*>\s*)?[A-Za-z_][\w:<>*&, ]*?[ &*](\w+)\(([^;{]*)\)(?: const)?(?: noexcept)? \{", re.M)


def names_of(text):
    """Things by name; a function by its arguments' types, too: others may be overloaded."""
    yield from TYPE.findall(text)
    for statement in CONSTANT.findall(text):
        yield from re.findall(r"(\w+)(?:\[\])? =", statement)
    for name, arguments in FUNCTION.findall(text):
        types = [re.sub(r"\s*\b\w+$", "", one.split("=")[0].strip()) for one in re.sub(r"\s+", " ", arguments).split(",")]
        yield f"{name}({', '.join(types)})"


def main():
    source = pathlib.Path(sys.argv[1])
    wrong, n = [], 0
    for room in sorted(path for path in source.iterdir() if path.is_dir()):
        files = collections.defaultdict(set)
        for path in room.rglob("*.cpp"):
            if room.name == "capi" and path.name.startswith("keys_"):
                continue
            for text in ANONYMOUS.findall(path.read_text(encoding="utf-8")):
                for name in names_of(text):
                    files[name].add(path.relative_to(source))
        of_headers = {name: path.relative_to(source) for path in room.rglob("*.hpp") for name in TYPE.findall(path.read_text(encoding="utf-8"))}
        for name in of_headers.keys() & files.keys():
            files[name].add(of_headers[name])
        n += len(files)
        wrong += [f"{name} stands in {' and '.join(map(str, sorted(places)))}" for name, places in files.items() if len(places) > 1]
    if n < 1000:
        wrong.append(f"{source}: only {n} names were found")
    print("\n".join([*wrong, f"{n} names, {len(wrong)} wrong"]))
    sys.exit(1 if wrong else 0)


if __name__ == "__main__":
    main()
