#!/usr/bin/env python3
"""reference.py ROOT: the reference tells of every function of plm.h in every language: by the name that it has there, in another way
that is said, or with the reason why not; leads from C to all languages, to an example and to theory, choosing or embedding, and back;
shows every constant, callback and key; and cuts no sentence at an abbreviation."""
import pathlib
import re
import sys

root = pathlib.Path(sys.argv[1]).resolve()
sys.path[:0] = [str(root / "docs/reference"), str(root / "src/capi/api")]
import book as books  # noqa: E402
import plm_header  # noqa: E402
import reference_site  # noqa: E402
from text import first_sentence  # noqa: E402

header = plm_header.read()
pages, places = reference_site.pages()
book = books.Book()
failures = []


def parts(text):
    """{anchor: what stands from it to the next entry}."""
    found = {}
    for piece in re.split(r"(?=^<a id=)", text, flags=re.M):
        for anchor in re.findall(r'<a id="(\w+)"></a>', piece.partition("\n")[0]):
            found[anchor] = piece
    return found


def wanted(condition, text):
    if not condition:
        failures.append(text)


of_language = {language: parts(pages[f"reference/{language}.md"]) for language in books.LANGUAGES}
of_c = {}
for name, text in pages.items():
    if name.startswith("reference/") and name[10:-3] not in books.LANGUAGES:
        of_c.update(parts(text))
for function in header.functions:
    entry = of_c.get(function.name, "")
    shown = books.described(function.name)
    wanted(f"{function.name}(" in entry, f"{function.name}: the pages of C do not declare it")
    for argument in function.arguments:
        name = "handle" if "_X_" in shown and argument is function.arguments[0] else argument.name
        wanted(f"| `{name}` |" in entry, f"{function.name}: argument {name} is in no table")
    wanted("Example:" in entry, f"{function.name}: no example on its page")
    wanted(re.search(r"\*\*Explained in\*\*.*\.\./(?:theory|choosing|embedding)\.md#", entry), f"{function.name}: no link to theory, choosing or embedding")
    for language, title in books.LANGUAGES.items():
        there = of_language[language].get(function.name, "")
        wanted(f"]({language}.md#{shown})" in entry, f"{function.name}: C does not lead to {title}")
        wanted(f"]({book.linker.places[shown]})" in there, f"{function.name}: {title} does not lead to C")
        body = re.sub(r"^(<a.*|### .*|What it computes.*|\* \[.*)$", "", there, flags=re.M).strip()
        wanted(len(body) > 10, f"{function.name}: {title} has neither a call nor a reason")
    wanted(f"reference/{places[shown].removeprefix('reference/')}" in pages["reference.md"], f"{function.name}: not in the table of all functions")
everything = "\n".join(pages.values())
failures += [f"{name}: the reference does not show it" for name in [*header.constants, *(one.name for one in header.callbacks)]
             if f'<a id="{name}"></a>' not in everything]
keys = books.keys()
failures += [f"{noun}: {name} is not on the page of keys" for noun, name, _ in keys if f'<a id="{noun}-{name}"></a>' not in pages["keys.md"]]
failures += [f"api.txt: {noun} has no basic options" for noun in book.api.description.letters
             if noun != "branch" and not book.api.description.basic.get(noun)]
for words, first in (("As in the paper, eq. (10) of it. More.", "As in the paper, eq. (10) of it"), ("A set, e.g. The one. B.", "A set, e.g. The one"),
                     ("u = normal . (q - p) of a pair. Then.", "u = normal . (q - p) of a pair")):
    wanted(first_sentence(words) == first, f"a sentence is cut: {first_sentence(words)}")
print("\n".join(failures) or f"{len(header.functions)} functions in {1 + len(books.LANGUAGES)} languages, {len(header.constants)} constants, {len(keys)} keys")
sys.exit(bool(failures) or len(keys) < 200)
