#!/usr/bin/env python3
"""words.py ROOT PAGE... [--length PAGE...]: pages are made of plain sentences, none of more than 35 words. Of pages before --length,
those for new readers, more is asked: no words that say nothing, and no terms that only the glossary explains, unless the same
paragraph links to it. README.md has at most 200 lines. Code, tables' numbers and picture texts do not count."""
import pathlib
import re
import sys

LONGEST = 35  # words: more have to be read twice
EMPTY = ("simply", "obviously", "just", "utilize", "utilise", "leverage", "in order to", "it should be noted", "please note",
         "needless to say", "state-of-the-art", "powerful", "seamless", "robust", "very")
TERMS = ("LELSM", "AFT", "MAC", "POD", "monodromy", "Floquet", "Neimark-Sacker", "receptance", "Woodbury", "phase-resonant", "isola",
         "condensation", "augmentation", "chatter", "superelement")


def paragraphs(text):
    """(number of the first line, text) of paragraphs, list items, headings and cells of tables; code and pictures are left out."""
    text = re.sub(r"^```.*?^```$", lambda m: "\n" * m.group().count("\n"), text, flags=re.M | re.S)
    text = re.sub(r"<!--.*?-->", lambda m: "\n" * m.group().count("\n"), text, flags=re.S)
    found, begin, lines = [], 0, []
    for number, line in enumerate([*text.splitlines(), ""], 1):
        is_code = line.startswith("    ")
        starts = not line.strip() or is_code or re.match(r"\s*([-*|#]|\d+\.) ?|!\[", line)
        if starts and lines:
            found.append((begin, " ".join(lines)))
            lines = []
        if line.startswith("|"):
            found += [(number, cell.strip()) for cell in line.strip("|").split("|")]
        elif line.strip() and not is_code and not line.startswith("!["):
            begin = begin if lines else number
            lines.append(line.strip())
    return found


def sentences(paragraph):
    plain = re.sub(r"!?\[([^\]]*)\]\([^)]*\)", r"\1", paragraph)  # links: what is read
    plain = re.sub(r"`[^`]*`", "code", plain)
    return re.split(r"(?<=[.!?])\s+(?=[A-Z\"'*(])", plain)


def check(path, root, for_new_readers):
    text = path.read_text(encoding="utf-8")
    name, wrong = path.relative_to(root), []
    count = 0
    for number, paragraph in paragraphs(text):
        for sentence in sentences(paragraph):
            words = re.findall(r"[^\W_][\w'.,-]*", sentence)
            count += len(words) > 2
            if len(words) > LONGEST:
                wrong.append(f"{name}:{number}: {len(words)} words: {sentence}")
        if not for_new_readers:
            continue
        for word in EMPTY:
            if re.search(rf"\b{re.escape(word)}\b", paragraph, re.I):
                wrong.append(f"{name}:{number}: '{word}' says nothing: {paragraph[:80]}")
        for term in TERMS:
            if re.search(rf"\b{term}s?\b", paragraph) and "glossary.md" not in paragraph:
                wrong.append(f"{name}:{number}: '{term}' needs the glossary: {paragraph[:80]}")
    if name.name == "README.md" and len(text.splitlines()) > 200:
        wrong.append(f"{name} has {len(text.splitlines())} lines; it may have 200")
    if count < 15:
        wrong.append(f"{name}: only {count} sentences were found")
    return wrong


def main():
    root = pathlib.Path(sys.argv[1]).resolve()
    names = sys.argv[2:]
    first = names.index("--length") if "--length" in names else len(names)
    pages = [(pathlib.Path(name).resolve(), i < first) for i, name in enumerate(names) if i != first]
    wrong = [line for page, for_new_readers in pages for line in check(page, root, for_new_readers)]
    print("\n".join(wrong) or f"{len(pages)} pages of plain sentences")
    return bool(wrong) or not pages


sys.exit(main())
