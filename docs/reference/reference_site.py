"""What docs/site.py adds to the site: the pages of the reference, the tables on the page reference.md, the page of keys."""
import re

import keys_page
import pages as written
from book import Book, keys
from header import described
from plm_header import ROOT

FUNCTIONS, RULES = "<!-- functions -->", "<!-- rules -->"


def basic_options(api):
    """{noun: names} as api.txt has them; each must be an option."""
    options = {(noun, name) for noun, name, is_option in keys() if is_option}
    for noun, names in api.description.basic.items():
        for name in names:
            if (noun, name) not in options:
                raise SystemExit(f"api.txt: basic: {noun} has no option '{name}'")
    return api.description.basic


def pages():
    """({path below docs: text}, {function: where it stands}): the reference, and reference.md and keys.md with what belongs on them."""
    book = Book()
    made = written.all_pages(book)
    page = (ROOT / "docs/reference.md").read_text(encoding="utf-8")
    made["reference.md"] = page.replace(FUNCTIONS, written.functions_table(book)).replace(RULES, written.rules_part(book))
    made["keys.md"] = keys_page.arranged((ROOT / "docs/keys.md").read_text(encoding="utf-8"), basic_options(book.api))
    return made, {name: f"reference/{place}" for name, place in book.linker.places.items()}


def linked(text, places, up):
    """Names of functions in code on any page lead to the reference; up: from the page's folder to docs."""
    def link(found):
        target = places.get(described(found[1]))
        return f"[`{found[1]}{found[2] or ''}`]({up}{target})" if target else found[0]
    return re.sub(r"(?<!\[)`(plm_\w+)(\(\))?`(?!\])", link, text)
