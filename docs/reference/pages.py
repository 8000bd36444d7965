"""The pages of the reference, as Markdown: C by kind of handle, with what the functions mean, and one page for each other language."""
import re

from book import LANGUAGES, item_name
from fortran77 import visible
from header import described
from modules import parts_of_modules
from python_forms import argument_names
from text import cell, code, first_sentence, table

TITLES = {"library": "The library", "by-key": "Options and results by key"}


def names_in_headings(item):
    """plm_model_fix_dofs (_i32, _i64), or all kinds of handle that have an option."""
    return f"`{item_name(item).replace('_X_', '_<handle>_')}`"


def anchors(item):
    extra = [name for name in item.names if name != item_name(item)]
    return "".join(f'<a id="{name}"></a>' for name in [item_name(item), *extra])


def declared(item):
    """As in plm.h, without the mark of what is exported."""
    return "\n".join(re.sub(r"^PLM_API ", "", part).replace("\n        ", "\n") if part.startswith("PLM_API") else part for part in item.code)


def types_table(book, function):
    """Arguments in their order: type, shape, direction."""
    rows, of_all = [], "_X_" in described(function.name)
    for argument in function.arguments:
        shape = cell(argument.size) if argument.size else ""
        way = {"in": "in", "out": "out", "inout": "in and out"}[argument.intent]
        if book.api.is_callback(argument):
            kind = book.linker.of_function(argument.base, "")
        else:
            kind = f"`{argument.type}`"
        notes = [note for note, holds in (("or NULL", argument.optional), ("counts from 0", argument.is_position)) if holds]
        name = argument.name
        if of_all and argument is function.arguments[0]:
            name, kind = "handle", "`plm_<handle> *`"
        rows.append([f"`{name}`", kind.replace("](#", f"]({book_page(book, argument)}#"), shape, way, ", ".join(notes)])
    return table(["argument", "type", "size", "", ""], rows)


def book_page(book, argument):
    return book.linker.places.get(argument.base, "#").partition("#")[0]


def in_other_languages(book, name):
    """A line of links."""
    parts = []
    for language, title in LANGUAGES.items():
        if language == "fortran77":
            six = [letters for letters, _ in book.subroutines(name)]
            shown = ", ".join(f"`{one}`" for one in six[:3]) + (" ..." if len(six) > 3 else "")
        else:
            forms, _ = book.in_language(language, name)
            sign = {"fortran": "%", "cpp": "::", "python": "."}[language]
            shown = ", ".join(dict.fromkeys(f"`{call_name(form, sign)}`" for form in forms[:3]))
        parts.append(f"[{title}]({language}.md#{name}){': ' if shown else ''}{shown}")
    return "**In other languages**: " + " · ".join(parts)


def call_name(form, sign):
    if form.name == "__init__" or form.name == form.owner:
        return form.owner
    return f"{form.owner.removeprefix('plm_')}{sign}{form.name}" if form.owner else form.name


def function_part(book, section, item, page):
    name, function = item_name(item), book.functions[item_name(item)][0]
    parts = [f"{anchors(item)}\n\n## {names_in_headings(item)}", code("c", declared(item)),
             book.linker.prose(item.words, page), types_table(book, function)]
    if name in book.snippets:
        parts += ["Example:", code("c", book.snippets[name])]
    parts.append(in_other_languages(book, name))
    links = [book.explained.link(*one) for one in book.explained.of(name, section.noun)]
    parts.append("**Explained in**: " + " · ".join(links))
    return "\n\n".join(parts)


def constants_part(book, item, page):
    rows = [[f'<a id="{name}"></a>`{name}`', f"`{value}`", cell(book.linker.prose(words, page)) if words else ""] for name, value, words in item.rows]
    return "\n\n".join(filter(None, [book.linker.prose(item.words, page), table(["constant", "value", ""], rows)]))


def item_part(book, section, item, page):
    if item.kind == "text":
        return "---\n\n" + book.linker.prose(item.words, page)
    if item.kind == "constants":
        return constants_part(book, item, page)
    if item.kind == "callback":
        return "\n\n".join([f"{anchors(item)}\n\n## {names_in_headings(item)}", code("c", declared(item)), book.linker.prose(item.words, page)])
    return function_part(book, section, item, page)


def c_page(book, sections, page):
    """One kind of handle: what it is, a list of its functions, and each with its arguments, an example and its other languages."""
    title = TITLES.get(page, f"`plm_{page}`")
    parts = [f"# C: {title}", "[All functions](../reference.md#functions) · " + " · ".join(
        f"[{name}]({language}.md#{page})" for language, name in LANGUAGES.items()) + " · [keys](../keys.md)"]
    for section in sections:
        parts.append(book.linker.prose(section.words, f"{page}.md"))
    rows = [[book.linker.of_function(item_name(item), f"{page}.md"), cell(book.linker.prose(first_sentence(item.words), f"{page}.md"))]
            for section in sections for item in section.items if item.kind == "function"]
    parts.append(table(["function", ""], rows))
    parts += [item_part(book, section, item, f"{page}.md") for section in sections for item in section.items]
    return "\n\n".join(filter(None, parts)) + "\n"


INTRODUCTIONS = {
    "fortran": "The module `plm` of Fortran 2008. Arguments in brackets are optional; every procedure ends with `stat` and `errmsg`, which are. Without "
               "`stat` a failure ends the program with its text. DOFs, points, pairs and columns count from 1, and 0 stands for \"no DOF\". Arrays of "
               "integers may be of either kind, `int32` or `int64`. The module `plm_c` has every function of C as it is, to be called with `bind(c)` types.",
    "fortran77": "Subroutines of six letters for FORTRAN 77 and later, with the include file `plmf.inc`, which has the constants. Handles are `INTEGER*8`. The "
                 "last argument is `IERR`: 0 done, positive an outcome, negative a failure. Arrays are by columns; DOFs, points and pairs count from 1.",
    "cpp": "`plm/plm.hpp`, C++17, header only. `Reals` and `Indices` take any contiguous container, `std::vector` among them; `Dense` are matrices by columns. "
           "A failure throws `plm::Error`; an outcome is returned, or kept as `status()` of a branch. DOFs and pairs count from 0.",
    "python": "The package `plm`, on NumPy and SciPy. Options and results of a handle are attributes: `hbm.n_harmonics = 7`. A failure raises "
              "`plm.PlmError`; an outcome is a `plm.PlmWarning`. DOFs, points and pairs count from 0; a point of a branch may count from its end, -1 the last."}


def form_part(book, language, form):
    highlighted = {"fortran": "fortran", "cpp": "cpp", "python": "python"}[language]
    parts = [code(highlighted, form.code)]
    if form.words:
        plain = re.match(r"[a-z]+[ ,]", form.words)  # "mean mechanical energy ...", and not "value(n_points): ..."
        words = form.words[0].upper() + form.words[1:] if plain else form.words
        parts.append(code("text", words) if "\n\n" in words else book.linker.prose(words, f"{language}.md"))
    return "\n\n".join(parts + (python_parts(book, form) if language == "python" else []))


def python_parts(book, form):
    """What help() adds: the arguments, and an example."""
    rows = [[f"`{name}`", cell(book.linker.prose(book.help.meaning(form.owner, form.name, name), "python.md"))] for name in argument_names(form.code)]
    known = form.owner if form.name == "__init__" else form.title
    example = book.examples.get(known) or book.examples.get(f"Handle.{form.name}")
    parts = [table(["argument", ""], rows)] if rows else []
    return parts + (["Example:", code("python", example)] if example else [])


def sizes_line(book, name, shown):
    """The shapes that api.txt states, of arguments that the language has, too; shown: {argument of C: what it is called}."""
    sizes = [f"`{shown[argument.name]}`: {in_words(argument.size, shown)}" for argument in book.functions[name][0].arguments
             if argument.size not in ("", "capacity") and argument.name in shown]
    return "Shapes: " + "; ".join(sizes) + "." if sizes else ""


def in_words(size, shown):
    """3 * n, in the names of the language where it has them."""
    return re.sub(r"[A-Za-z_]\w*", lambda word: shown.get(word[0], word[0]), size).replace("*", "\\*").replace("_", "\\_")


def f77_call(book, six):
    arguments = book.arguments_of(six)
    rows = [f"      {kind:<17} {argument}{'(*)' if is_array else ''}" for argument, kind, is_array, _ in arguments if argument != "IERR"]
    return code("fortran", "\n".join(rows + ["      INTEGER           IERR", f"      CALL {six} ({', '.join(argument for argument, *_ in arguments)})"]))


def f77_names(book, name):
    """{argument of C: dummy} of a subroutine that has those of C in their order."""
    subroutine = book.api.description.functions[name].subroutines[0]
    arguments = visible(book.functions[name][0])
    same = len(arguments) == len(subroutine.arguments)
    return {argument.name: dummy for argument, dummy in zip(arguments, subroutine.arguments)} if same else {}


def sentence(text):
    """A remark of api.txt; a name at its beginning stays as it is."""
    first = text.split()[0]
    return (text if not first.isalpha() or first.isupper() else text[0].upper() + text[1:]).rstrip(".") + "."


def f77_parts(book, name):
    """One of the kinds of handle stands for all where they differ in a letter alone."""
    subroutines, by_key = list(book.subroutines(name)), "_X_" in name
    parts = []
    for six, text in subroutines[:1] if by_key else subroutines:
        outputs = [f"`{argument}`" for argument, _, _, way in book.arguments_of(six) if way in ("inout", "out") and argument != "IERR"]
        note = f"Written: {', '.join(outputs)}, and `IERR`." if outputs else ""
        said = book.linker.prose(sentence(text), "fortran77.md") if text else ""
        parts += [f77_call(book, six), " ".join(filter(None, [said, note]))]
    if by_key:
        parts.append("The same for the other kinds of handle: " + ", ".join(f"`{six}`" for six, _ in subroutines[1:]) + ".")
    if not subroutines:
        return [book.in_language("fortran77", name)[1]]
    return [*parts, sizes_line(book, name, f77_names(book, name))]


def form_parts(book, name, language):
    forms, instead = book.in_language(language, name)
    words = set(re.findall(r"\w+", " ".join(form.code for form in forms)))
    shown = {argument.name: argument.name for argument in book.functions[name][0].arguments if argument.name in words}
    shapes = sizes_line(book, name, shown) if language in ("fortran", "cpp") else ""
    return [*(form_part(book, language, form) for form in forms), instead, shapes]


def language_entry(book, section, items, language):
    """What one procedure of the language does, which may stand for several functions of C."""
    name = item_name(items[0])
    head = f"{''.join(anchors(item) for item in items)}\n\n### {heading_of(book, name, language)}"
    body = f77_parts(book, name) if language == "fortran77" else form_parts(book, name, language)
    meaning = [f"{book.linker.of_function(item_name(item), language + '.md')}: {book.linker.prose(first_sentence(item.words), language + '.md')}."
               for item in items]
    means = f"What it computes: {meaning[0]}" if len(meaning) == 1 else "What it computes:\n\n" + "\n".join(f"* {line}" for line in meaning)
    return "\n\n".join(filter(None, [head, *body, means]))


def heading_of(book, name, language):
    if language == "fortran77":
        six = [subroutine.name for subroutine in book.api.description.functions[name].subroutines]
        return ", ".join(f"`{one[:3]}x{one[4:]}`" if "_X_" in name else f"`{one}`" for one in six) or f"`{name}`"
    forms, _ = book.in_language(language, name)
    sign = {"fortran": "%", "cpp": "::", "python": "."}[language]
    return ", ".join(dict.fromkeys(f"`{call_name(form, sign)}`" for form in forms)) or f"`{name.replace('_X_', '_<handle>_')}`"


def alike(book, items, language):
    """Functions that one procedure of the language stands for, as set for an integer, a real number and a text, are one entry."""
    groups = []
    for item in items:
        forms, _ = ([], "") if language == "fortran77" else book.in_language(language, item_name(item))
        titles = [form.title for form in forms]
        if groups and titles and groups[-1][0] == titles:
            groups[-1][1].append(item)
        else:
            groups.append((titles, [item]))
    return [items for _, items in groups]


def language_page(book, language):
    """Every function in one language, by kinds of handle."""
    parts = [f"# {LANGUAGES[language]}", INTRODUCTIONS[language],
             "A whole program: [getting started](../getting-started.md). All languages side by side: [reference](../reference.md#functions)."]
    for page, sections in book.by_page().items():
        title = TITLES.get(page, page.capitalize())
        parts.append(f'<a id="{page}"></a>\n\n## {title}')
        items = [item for section in sections for item in section.items if item.kind == "function"]
        parts += [language_entry(book, sections[0], group, language) for group in alike(book, items, language)]
    return "\n\n".join(parts + (parts_of_modules(book) if language == "python" else [])) + "\n"


def functions_table(book):
    """Every function in all languages; for the page reference.md of docs."""
    parts = []
    for page, sections in book.by_page().items():
        rows = []
        for item in (item for section in sections for item in section.items if item.kind == "function"):
            name = item_name(item)
            row = [f"[`{name.replace('_X_', '_<handle>_')}`](reference/{book.linker.places[name]})"]
            row += [f"[{heading_of(book, name, language) if language_has(book, language, name) else 'another way'}](reference/{language}.md#{name})"
                    for language in LANGUAGES]
            rows.append(row)
        title = TITLES.get(page, f"`plm_{page}`")
        parts.append(f"### {title}\n\n" + table(["C", *LANGUAGES.values()], rows))
    return "\n\n".join(parts)


def language_has(book, language, name):
    return bool(list(book.subroutines(name)) if language == "fortran77" else book.in_language(language, name)[0])


def rules_part(book):
    """What plm.h says at its top."""
    text = "\n\n".join(book.top.split("\n\n")[1:])
    return book.linker.prose(text, "").replace("](", "](reference/").replace("](reference/../", "](").replace("](reference/#", "](#")


def all_pages(book):
    """{path below docs: text}."""
    made = {f"reference/{page}.md": c_page(book, sections, page) for page, sections in book.by_page().items()}
    made.update({f"reference/{language}.md": language_page(book, language) for language in LANGUAGES})
    return made
