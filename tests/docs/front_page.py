#!/usr/bin/env python3
"""front_page.py PLM_H INDEX_HTML: the reference begins with what plm.h begins with: its title, the chain of handles, and each
of the rules that hold for every function, as a list."""
import html
import re
import sys

header, page = (open(name, encoding="utf-8").read() for name in sys.argv[1:3])
top = next(comment for comment in re.findall(r"/\*(.*?)\*/", header, re.S) if "plm.h - " in comment)
top = re.sub(r"^ \* ?", "", top, flags=re.M)


def words(text):
    return " ".join(html.unescape(re.sub(r"<[^>]*>", " ", text)).split())


def letters(text):
    """Doxygen makes links and quotes of its own: compare letters and digits."""
    return re.sub(r"[^a-z0-9]", "", text.lower())


title = words(re.search(r'<div class="title">(.*?)</div>', page, re.S).group(1))
items = {letters(words(item)) for item in re.findall(r"<li>(.*?)</li>", page, re.S)}
rules = [" ".join(rule.split()) for rule in re.findall(r"^  - (.*?)(?=^  - |^\s*$|\Z)", top, re.M | re.S)]
failures = [f"the list of rules lacks: {rule}" for rule in rules if letters(rule) not in items]
if title.rstrip(".") not in " ".join(top.split()):
    failures.append(f"the title is '{title}'")
for heading in (r"Rules that hold for every function", "plm_context  -> plm_model"):
    if heading not in html.unescape(page):
        failures.append(f"lost: {heading}")
print("\n".join(failures) or f"'{title}' and {len(rules)} rules")
sys.exit(bool(failures) or len(rules) < 8)
