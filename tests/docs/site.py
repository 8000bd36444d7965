#!/usr/bin/env python3
"""site.py MKDOCS ROOT FOLDER: the site is made without a warning, every link of its pages leads to a file and a heading that is there,
nothing is loaded from elsewhere, and the search knows a word of each page of docs. Ends with 77 without MkDocs."""
import html.parser
import json
import pathlib
import shutil
import subprocess
import sys
import urllib.parse

mkdocs, root, folder = sys.argv[1], *(pathlib.Path(a).resolve() for a in sys.argv[2:4])
if not shutil.which(mkdocs):
    print("skipped: needs mkdocs")
    sys.exit(77)
shutil.rmtree(folder, ignore_errors=True)
done = subprocess.run([mkdocs, "build", "--quiet", "--config-file", root / "mkdocs.yml", "--site-dir", folder], text=True,
                      stdout=subprocess.PIPE, stderr=subprocess.STDOUT, check=False)
if done.returncode:
    sys.exit(f"mkdocs ends with {done.returncode}:\n{done.stdout}")


class Page(html.parser.HTMLParser):
    """Its anchors, links, and what a viewer loads with it."""

    def __init__(self, path):
        super().__init__()
        self.anchors, self.links, self.loads = set(), [], []
        self.feed(path.read_text(encoding="utf-8"))

    def handle_starttag(self, tag, attributes):
        given = dict(attributes)
        self.anchors |= {given[k] for k in ("id", "name") if given.get(k)}
        if tag == "a" and given.get("href"):
            self.links.append(given["href"])
        if tag in ("img", "script") and given.get("src"):
            self.loads.append(given["src"])
        if tag == "link" and given.get("href") and given.get("rel") in ("stylesheet", "shortcut icon"):
            self.loads.append(given["href"])


pages = {path: Page(path) for path in sorted(folder.rglob("*.html")) if path.name != "404.html"}
failures, count = [], 0
for path, page in pages.items():
    for target in page.links + page.loads:
        parts = urllib.parse.urlsplit(target)
        if parts.scheme or parts.netloc:
            if target in page.loads:
                failures.append(f"{path.relative_to(folder)} loads {target}")
            continue
        count += 1
        at = (path.parent / urllib.parse.unquote(parts.path)).resolve() if parts.path else path
        at = at / "index.html" if at.is_dir() else at
        if not at.is_file():
            failures.append(f"{path.relative_to(folder)}: {target} leads nowhere")
        elif parts.fragment and at in pages and parts.fragment not in pages[at].anchors:
            failures.append(f"{path.relative_to(folder)}: {target}: no such heading")
script = (folder / "search/index.js").read_text(encoding="utf-8")
words = json.loads(script.partition("=")[2].rstrip().rstrip(";"))["docs"]
found = {entry["location"].partition("#")[0] for entry in words}
failures += [f"the search does not know {page.name}" for page in sorted((root / "docs").glob("*.md"))
             if page.with_suffix(".html").name not in found]
print("\n".join(failures) or f"{len(pages)} pages, {count} links")
sys.exit(bool(failures) or count < 500)
