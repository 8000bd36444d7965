#!/usr/bin/env python3
"""links.py ROOT: every link of the pages leads somewhere: to a file or folder of the tree, and where it names a heading (#...), to one
that the page has. docs/index.md leads to every page of docs."""
import pathlib
import re
import sys

LINK = re.compile(r"!?\[(?:[^\[\]]|\[[^\]]*\])*\]\(([^)\s]+)\)")


def anchors(path):
    """Those of the headings, as Markdown viewers make them."""
    text = re.sub(r"^```.*?^```$", "", path.read_text(encoding="utf-8"), flags=re.M | re.S)
    headings = re.findall(r"^#+ (.*)$", text, re.M)
    plain = (re.sub(r"\[([^\]]*)\]\([^)]*\)", r"\1", heading) for heading in headings)
    return {re.sub(r"[^\w\- ]", "", heading).strip().lower().replace(" ", "-") for heading in plain}


def links(path):
    """(line, target); code is left out."""
    text = re.sub(r"^```.*?^```$", lambda m: "\n" * m.group().count("\n"), path.read_text(encoding="utf-8"), flags=re.M | re.S)
    text = re.sub(r"`[^`\n]*`", lambda m: "x" * len(m.group()), text)
    for found in LINK.finditer(text):
        yield text.count("\n", 0, found.start()) + 1, found[1]


def main():
    root = pathlib.Path(sys.argv[1]).resolve()
    docs = sorted((root / "docs").glob("*.md"))
    pages = [root / "README.md", root / "CONTRIBUTING.md", *docs, *sorted((root / "examples").rglob("*.md"))]
    wrong, count = [], 0
    for page in pages:
        for number, target in links(page):
            if re.match(r"[a-z]+:", target):
                continue
            count += 1
            file, _, heading = target.partition("#")
            at = (page.parent / file).resolve() if file else page
            where = f"{page.relative_to(root)}:{number}"
            if not at.exists() or root not in (at, *at.parents):
                wrong.append(f"{where}: {target} leads nowhere")
            elif heading and at.suffix == ".md" and heading not in anchors(at):
                wrong.append(f"{where}: {file or page.name} has no heading #{heading}")
    known = {target.partition("#")[0] for _, target in links(root / "docs/index.md")}
    wrong += [f"docs/index.md does not lead to {page.name}" for page in docs if page.name not in known | {"index.md"}]
    print("\n".join(wrong) or f"{count} links of {len(pages)} pages lead somewhere")
    return bool(wrong) or count < 100


sys.exit(main())
