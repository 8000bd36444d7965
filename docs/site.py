"""What MkDocs does not do by itself. The pages are read in two ways: in the source tree, where links lead to files beside docs, and as a
site, which has docs alone. So files that a page links to go to source/ of the site, pages of Markdown among them as pages, and
links lead there; links to folders become their text. Lists may follow a paragraph without an empty line, as other viewers
of Markdown take them."""
import pathlib
import posixpath
import re

from mkdocs.structure.files import File

ROOT = pathlib.Path(__file__).resolve().parents[1]
DOCS = ROOT / "docs"
LINK = re.compile(r"(?P<text>!?\[(?:[^\[\]]|!?\[[^\]]*\](?:\([^)]*\))?)*\])\((?P<target>[^)\s]+)\)")
FENCE = re.compile(r"(^```.*?^```$)", re.M | re.S)


def in_site(path):
    """Where a file of the tree stands in the site's folder of sources."""
    return path.relative_to(DOCS).as_posix() if DOCS in path.parents else f"source/{path.relative_to(ROOT).as_posix()}"


def target_of(match, page):
    """(file of the tree, #heading) of a link on a page of the tree; None: it leads elsewhere."""
    file, hash_mark, heading = match["target"].partition("#")
    if re.match(r"[a-z]+:", match["target"]) or not file:
        return None
    return (page.parent / file).resolve(), hash_mark + heading


def linked_files():
    """All that the pages of docs lead to, and what pages among that lead to."""
    pages, found = sorted(DOCS.glob("*.md")), []
    known = set(pages)
    while pages:
        page = pages.pop()
        for match in LINK.finditer(page.read_text(encoding="utf-8")):
            target = target_of(match, page)
            if target and target[0].is_file() and target[0] not in known:
                known.add(target[0])
                found.append(target[0])
                pages += [target[0]] if target[0].suffix == ".md" else []
    return found


def on_files(files, config):
    """Programs of the reference in docs, and what makes it, are no part of the site unless a page leads there."""
    for file in list(files):
        of_docs = DOCS in pathlib.Path(file.abs_src_path).parents  # and not of the theme
        if of_docs and not file.src_path.endswith((".md", ".png")):
            files.remove(file)
    for path in linked_files():
        if files.get_file_from_path(in_site(path)) is None:
            file = File(in_site(path), config["docs_dir"], config["site_dir"], False)
            file.abs_src_path = str(path)
            files.append(file)
    return files


def on_page_markdown(markdown, page, config, files):
    here = pathlib.Path(page.file.abs_src_path).resolve()

    def moved(match):
        target = target_of(match, here)
        if target is None:
            return match[0]
        if target[0].is_dir():
            return match["text"][1:-1]
        return f"{match['text']}({posixpath.relpath(in_site(target[0]), posixpath.dirname(in_site(here)))}{target[1]})"

    parts = FENCE.split(markdown)
    for i in range(0, len(parts), 2):  # what is not code
        parts[i] = LINK.sub(moved, parts[i])
    text = "".join(parts)
    return re.sub(r"^((?![*|#`]|\s|<!--).+)\n(\* )", r"\1\n\n\2", text, flags=re.M)
