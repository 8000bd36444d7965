"""What MkDocs does not do by itself. The reference is made from plm.h, api.txt and the sources of the languages (docs/reference), and
every function that a page names leads there. The pages are read in two ways: in the source tree, where links lead to files beside docs, and as a
site, which has docs alone. So files that a page links to go to source/ of the site, pages of Markdown among them as pages, and
links lead there; links to folders become their text. Lists may follow a paragraph without an empty line, as other viewers
of Markdown take them."""
import pathlib
import posixpath
import re
import shutil
import sys
import tempfile

from mkdocs.structure.files import File

ROOT = pathlib.Path(__file__).resolve().parents[1]
DOCS = ROOT / "docs"
sys.path[:0] = [str(DOCS / "reference"), str(ROOT / "src/capi/api")]
import reference_site  # noqa: E402

MADE = {}  # path below docs: text, of pages that are made here
PLACES = {}  # function: where the reference tells of it
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


def on_config(config):
    """MkDocs takes pages from files: those that are made here are for the time of the build."""
    made, places = reference_site.pages()
    MADE.update(made)
    PLACES.update(places)
    config["made_pages"] = tempfile.mkdtemp(prefix="plm_pages_")
    return config


def on_post_build(config):
    """The search of MkDocs asks for its index from a worker, which a browser refuses to pages read from a folder: it is a script here."""
    shutil.rmtree(config["made_pages"])
    search = pathlib.Path(config["site_dir"]) / "search"
    index = (search / "search_index.json").read_text(encoding="utf-8")
    (search / "index.js").write_text(f"var plm_search_index = {index};\n", encoding="utf-8")
    shutil.copyfile(DOCS / "search.js", search / "main.js")
    for name in ("worker.js", "search_index.json"):
        (search / name).unlink()


def add_file(files, config, name, path):
    file = File(name, config["docs_dir"], config["site_dir"], False)
    file.abs_src_path = str(path)
    files.append(file)


def on_files(files, config):
    """Programs of the reference in docs, and what makes it, are no part of the site unless a page leads there."""
    for file in list(files):
        of_docs = DOCS in pathlib.Path(file.abs_src_path).parents  # and not of the theme
        if of_docs and not file.src_path.endswith((".md", ".png", ".css")):
            files.remove(file)
    for path in linked_files():
        if files.get_file_from_path(in_site(path)) is None:
            add_file(files, config, in_site(path), path)
    for name, text in MADE.items():
        if files.get_file_from_path(name) is None:  # reference.md and keys.md are there
            path = pathlib.Path(config["made_pages"]) / name
            path.parent.mkdir(exist_ok=True)
            path.write_text(text, encoding="utf-8")
            add_file(files, config, name, path)
    return files


def on_page_markdown(markdown, page, config, files):
    name = page.file.src_path
    if name.startswith("reference/"):
        return markdown
    markdown = MADE.get(name, markdown)
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
        parts[i] = reference_site.linked(LINK.sub(moved, parts[i]), PLACES, posixpath.relpath(".", posixpath.dirname(name)) + "/")
    text = "".join(parts)
    return re.sub(r"^((?![*|#`]|\s|<!--).+)\n(\* )", r"\1\n\n\2", text, flags=re.M)
