#!/usr/bin/env python3
"""counts.py SRC: in how many files a thing is known that one room should know alone. Prints each count and its files, and fails where
there are more than its rule allows; and how large rooms may be.

What counts is the code: comments, texts in quotes and names of included files are left out. A file knows a thing when one of its
identifiers has one of the rule's words in it (`n_closed`, `PairState::open`), unless that identifier means something else there: such
senses stand in the rule, each with its reason, and one that no longer occurs is wrong, too.
"""
import pathlib
import re
import sys

# sense: a pattern of code, where (a pattern of the file's path), what it means there
LINEAR_SYSTEMS = "of the two linear systems, open and sliding, by name: what they are in states of pairs stands in sampling/dominant_mode.cpp"
RULES = [
    {
        "what": "files outside contact know the states of a pair",
        # The names of the states and their verbs, and the law. A PairStates that is handed on is no knowledge, nor is what a pair
        # has in whatever states there may be: a force, a spring, whether it acts at all, whether its tangent varies.
        "words": r"closed|closing|open|opened|opening|switching|PairState|ContactLaw",
        "outside": "contact",
        "limit": 32,  # with what bytes and tables hand on of a point: how many pairs switch
        "other_senses": [
            (r"\bLinearSystem::open\b", r".*", LINEAR_SYSTEMS),
            (r"\bopen = 0, sliding = 1\b", r"sampling/sampler_options\.hpp", LINEAR_SYSTEMS),
            (r"\b(open|open_)\b", r"reduction/lelsm\.cpp", LINEAR_SYSTEMS),
            (r"\bleast_open_modes\b", r"reduction/basis\.cpp", LINEAR_SYSTEMS),
            (r"\bloop_closed\b", r".*", "a curve that returns to its start, by the name of its reason"),
            (r"\bno_switching\b", r".*", "the name of a reason"),
            (r"\brequire_open\b", r"capi/.*", "a handle whose model is not built yet"),
            (r"\bclosed\b", r"searches/isolated\.[ch]pp", "a curve that returns to its start"),
            (r"\b(closed|n_closed)\b", r"capi/model_surfaces\.cpp", "gaps of a mesh so small that they count as none"),
        ],
    },
    {
        "what": "files outside structure use full-size matrices, their factors or the columns of a Field",
        # What has as many rows as the structure has DOFs goes through Structure, Field and GapRows.
        "words": r"SparseMatrix|Factor|in_core|matrices|make_factor|lowest_eigenpairs",
        "outside": "structure",
        "limit": 0,
        "other_senses": [],
    },
    {
        "what": "files outside contact solve a system with springs by their compliance",
        "pattern": r"\+= 1 / \w*(?:spring|stiffness)\w*\[",
        "outside": "contact",
        "limit": 1,
        "other_senses": [],
    },
    {
        "what": "files outside paths solve for the tangent of a path, or correct across it: a corrector of their own",
        "pattern": r"parameter_derivative\([^;]*;(?:\s*\w+(?:\.|->)linearize\(\);)?\s*\w+(?:\.|->)solve\(",
        "outside": "paths",
        "limit": 0,
        "other_senses": [],
    },
    {
        "what": "files make the record of a branch's point from a solution",
        "pattern": r"\bpoint\.(?:residual|iterations|n_switching) [+]?= ",
        "outside": "capi",
        "limit": 1,
        "other_senses": [],
    },
    {
        "what": "files give std::polar a size: of a negative one, such as a force turned round, it makes what it likes",
        "pattern": r"std::polar\((?!1\.0,)",
        "outside": "capi",
        "limit": 0,
        "other_senses": [],
    },
    {
        "what": "files take a share of an accuracy: motions/error_budget.hpp divides it",
        # A study asks for a better reference, which divides nothing.
        "pattern": r"\* (?:\w+(?:\.|->))*accuracy_?\b|\baccuracy_? [*/]",
        "outside": "study",
        "limit": 1,
        "other_senses": [],
    },
]

# How large a room may be: lines of its files, and numbers by which it is tuned (constants that are given as numbers). A room that
# takes in what others could hold grows in both. Where one gets smaller its limit follows.
SIZES = {"searches": {"lines": 4475, "tuning constants": 57}}


def code_of(path):
    """The code of a file, without comments, texts and includes."""
    text = path.read_text(encoding="utf-8")
    text = re.sub(r'^#include.*$', "", text, flags=re.M)
    literal = r'"(?:\\.|[^"\\\n])*"|\'(?:\\.|[^\'\\\n])+\''
    return re.sub(rf"({literal})|//[^\n]*|/\*.*?\*/", lambda m: '""' if m.group(1) else " ", text, flags=re.S)


def knows(code, words):
    """The identifiers of which one part, between underscores, is one of the words."""
    part = re.compile(rf"(?:.*_)?(?:{words})(?:_.*)?")
    return sorted({i for i in re.findall(r"[A-Za-z_]\w*", code) if part.fullmatch(i)})


def count(source, rule):
    """{file: identifiers} of the files that know, and the senses that were met."""
    found, met = {}, set()
    for path in sorted(source.rglob("*.[ch]pp")):
        name = path.relative_to(source).as_posix()
        if name.startswith(rule["outside"] + "/"):
            continue
        code = code_of(path)
        for sense in rule["other_senses"]:
            if re.fullmatch(sense[1], name):
                code, times = re.subn(sense[0], " ", code)
                met.update([sense] if times else [])
        identifiers = knows(code, rule["words"]) if "words" in rule else sorted(set(re.findall(rule["pattern"], code)))
        if identifiers:
            found[name] = identifiers
    return found, met


def tuning_constants(code):
    """The names of constants that are given as numbers, one or several to a line."""
    names = []
    for declared in re.findall(r"\bconstexpr\s+(?:double|int|std::\w+)\s+([^;]*);", code):
        of_lists = re.sub(r"\{[^}]*\}", "0", declared)
        names += re.findall(r"(?:^|,)\s*(\w+)(?:\[\])?\s*=\s*-?[\d.]", of_lists)
    return names


def check_sizes(source):
    """What is wrong with the sizes of rooms."""
    wrong = []
    for room, limits in SIZES.items():
        files = sorted((source / room).glob("*.[ch]pp"))
        sizes = {
            "lines": sum(len(path.read_text(encoding="utf-8").splitlines()) for path in files),
            "tuning constants": sum(len(tuning_constants(code_of(path))) for path in files),
        }
        for what, size in sizes.items():
            print(f"{size} {what} in {room} (at most {limits[what]})")
            if size > limits[what] or size == 0:
                wrong.append(f"{size} {what} in {room}: none, or more than {limits[what]}")
    return wrong


def main():
    source = pathlib.Path(sys.argv[1]).resolve()
    n_files = len(list(source.rglob("*.[ch]pp")))
    wrong = [] if n_files > 200 else [f"{source}: only {n_files} files were found"]
    for rule in RULES:
        found, met = count(source, rule)
        print(f"{len(found)} {rule['what']} (at most {rule['limit']}):")
        for name, identifiers in found.items():
            print(f"    {name}: {' '.join(identifiers)}")
        if len(found) > rule["limit"]:
            wrong.append(f"{len(found)} {rule['what']}: more than {rule['limit']}")
        wrong += [f"'{sense[0]}' has no other sense in {sense[1]} any more" for sense in rule["other_senses"] if sense not in met]
    wrong += check_sizes(source)
    print("\n".join(wrong))
    sys.exit(1 if wrong else 0)


if __name__ == "__main__":
    main()
