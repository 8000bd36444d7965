#!/usr/bin/env python3
"""warning_words.py ROOT: every warning of the library, every sentence a curve ends with, and every finding of the audit that is more than a
fact has words on docs/warnings.md by which a user finds it; all words there are of such a text; every status has its row.

A text is found where it is handed over: the literals of the call; else those of the variables of this file that it names; else those
of functions.
"""
import pathlib
import re
import sys

SAID = re.compile(r"(?<!\w)(?:(?:warn|warnings\.add)\s*\(\s*(?=reason::|PLM_REASON_)|warn_of_\w+\()")
FINDING = re.compile(r"(?<![\w.])add\((?!\s*0\s*,)(?!int )")
LITERALS = re.compile(r'"(?:[^"\\\n]|\\.)*"(?:\s*"(?:[^"\\\n]|\\.)*")*')
LEAST, LONG = 4, 12  # words: fewer than the one are names, as many as the other are a sentence with a meaning of its own


def without_comments(code):
    return re.sub(r'("(?:[^"\\\n]|\\.)*")|//[^\n]*', lambda m: m.group(1) or "", code)


def closed(code, start, pair="()"):
    """What stands between the bracket at `start` and its partner."""
    depth, inside = 0, False
    for i in range(start, len(code)):
        c = code[i]
        if inside:
            inside = c != '"' or code[i - 1] == "\\"
        elif c == '"':
            inside = True
        elif c in pair:
            depth += 1 if c == pair[0] else -1
            if depth == 0:
                return code[start + 1:i]
    raise ValueError("a bracket is not closed")


def n_words(text):
    return len(re.findall(r"[a-z]+", text))


def literals(code):
    return [re.sub(r'"\s*"', "", found)[1:-1].replace('\\"', "'") for found in LITERALS.findall(code)]


def texts(code):
    return [text for text in literals(code) if n_words(text) >= LEAST]


def in_variables(argument, code):
    names = re.findall(r"\b([a-z]\w*)\b(?!\s*\()", argument)
    assigned = [m.group() for name in names for m in re.finditer(rf'\b{name} =(?:"(?:[^"\\\n]|\\.)*"|[^;"])*;', code)]
    return [text for one in assigned for text in texts(one)]


def in_functions(argument, code, sources):
    found = []
    for name in re.findall(r"\b([a-z]\w*)\s*\(", argument):
        start = re.compile(rf"^std::string (?:\w+::)?{name}\([^;{{]*\{{", re.M)
        for other in [code] if start.search(code) else sources.values():
            found += [text for m in start.finditer(other) for text in texts(closed(other, m.end() - 1, "{}"))]
    return found


def said(sources):
    """[(place, texts of which one has words on the page)] of all that is to be explained, and all texts by which it is said."""
    groups, everything = [], []
    for path, code in sources.items():
        for m in (FINDING if path.name.endswith("audit.cpp") else SAID).finditer(code):
            argument = closed(code, code.index("(", m.start()))
            place = f"{path}:{code.count(chr(10), 0, m.start()) + 1}"
            found = texts(argument), in_variables(argument, code), in_functions(argument, code, sources)
            everything += sum(found, [])
            first = next((some for some in found if some), [])
            if first:
                groups += [(place, [text]) for text in first if n_words(text) >= LONG] + [(place, first)]
            elif not argument.endswith((".text", ".what()")) and not m.group().startswith("warn_of"):
                groups.append((place, []))  # the others hand on what is said elsewhere
    ends = next(code for path, code in sources.items() if path.parts[-2:] == ("motions", "branch.cpp"))
    body = closed(ends, ends.index("{", ends.index("std::string end_text(")), "{}")
    sentences = [text for text in literals(body) if "%" not in text]
    return groups + [("end_text", [text]) for text in sentences], everything + sentences


def said_by_python(root):
    groups = []
    for path in sorted((root / "bindings/python").rglob("*.py")):
        code = path.read_text(encoding="utf-8")
        for m in re.finditer(r"warnings\.warn\(", code):
            found = texts(re.sub(r'f"', '"', closed(code, m.end() - 1)))
            if found:
                groups.append((f"{path}:{code.count(chr(10), 0, m.start()) + 1}", found))
    return groups


def main():
    root = pathlib.Path(sys.argv[1])
    page = pathlib.Path(sys.argv[2] if len(sys.argv) > 2 else root / "docs/warnings.md").read_text(encoding="utf-8")
    sources = {path: without_comments(path.read_text(encoding="utf-8")) for path in sorted((root / "src").rglob("*.cpp"))}
    groups, everything = said(sources)
    by_python = said_by_python(root)
    groups += by_python
    everything += [text for _, found in by_python for text in found]
    rows = re.findall(r'^\| "([^"]+)" \| ([^|]+) \| ([^|]+) \|$', page, re.M)
    words = [row[0] for row in rows]
    failures = [f"two rows for '{w}'" for w in sorted(set(words)) if words.count(w) > 1]
    for place, found in groups:
        if not found:
            failures.append(f"{place}: what is said here cannot be told from the source; hand over its literal, or what names it")
        elif not any(w in text for w in words for text in found):
            failures.append(f"{place}: no words of docs/warnings.md are in '{found[0]}'")
    failures += [f"docs/warnings.md: no warning has the words '{w}'" for w in words if not any(w in text for text in everything)]
    statuses = re.findall(r"^#define (PLM_(?:OK|NOT_CONVERGED|TRUNCATED|CANCELLED|WARNING|ERR_\w+)) ",
                          (root / "include/plm/plm.h").read_text(encoding="utf-8"), re.M)
    failures += [f"docs/warnings.md: no row for {name}" for name in statuses if f"| `{name}` |" not in page]
    print("\n".join(failures) or f"{len(groups)} texts, {len(rows)} rows, {len(statuses)} statuses")
    sys.exit(bool(failures) or len(groups) < 90 or len(statuses) < 15)


main()
