#!/usr/bin/env python3
"""doxygen_filter.py PLM_H: plm.h as Doxygen wants it. The header itself stays plain C to read.

Its sections "/* ---- Title ---- */" become groups, one page per handle; a comment belongs to the declarations right below
it; what has none is one of the functions that every handle has, and gets their text. Every function gets its example from
docs/examples."""
import pathlib
import re
import sys

sys.path.insert(0, str(pathlib.Path(__file__).resolve().parents[1] / "src/capi/api"))
import plm_header  # noqa: E402

GENERIC = [
    (r"_create$", "Makes a {noun}; destroy it by plm_{noun}_destroy, or let the context do it."),
    (r"_destroy$", "Destroys the {noun}; NULL and *{noun} == NULL are accepted; *{noun} becomes NULL."),
    (r"_set_(int|double|string)$", "Sets an option of the {noun} by its key, see \\ref keys."),
    (r"_get_(int|double|string)$", "Reads an option or a result of the {noun} by its key, see \\ref keys."),
    (r"_get_(int_)?array$", "Copies an array result of the {noun} by its key, see \\ref keys."),
    (r"^plm_version$", "The version of the library that runs."),
    (r"^plm_key_count$", "How many keys a kind of handle has."),
]
HANDLES = plm_header.read(sys.argv[1]).handles
NAMES = {"Options and results by key": "keys"}


def example(declaration):
    """The snippet of a function. The test docs.every_function_has_an_example tells what is missing in docs/examples."""
    name = re.match(r"PLM_API\s+plm_status\s+(plm_\w+)", declaration)
    if not name:
        return ""
    noun = name.group(1).split("_")[1]
    file = noun if f"plm_{noun}" in HANDLES else "library"
    return f"\n * \\par Example\n * \\snippet {file}.c {name.group(1)}\n"


def escaped(text):
    return re.sub(r"([<>@\\#%&])", r"\\\1", text)


def inside(comment):
    """The words of a comment, without its frame."""
    lines = [re.sub(r"^\s*\* ?", "", line) for line in comment[2:-2].strip().split("\n")]
    return "\n".join(lines).strip()


def balanced(text):
    return text[:-1] if text.count(")") > text.count("(") else text


def front_page(words):
    """The comment at the top of the header. Its chain of handles is a drawing, its rules become a section of their own."""
    title, rest = words.split("\n", 1)
    out = ["\\mainpage " + escaped(title.split(": ", 1)[1])]
    for block in re.split(r"\n[ \t]*\n", rest):
        lines = block.split("\n")
        if lines[0].startswith("    "):
            out.append("\\verbatim\n" + block + "\n\\endverbatim")
        elif len(lines) > 1 and lines[1].startswith("  - "):
            out.append("\\section rules " + escaped(lines[0]) + "\n" + escaped("\n".join(lines[1:])))
        else:
            out.append(escaped(block))
    return "/** " + "\n\n".join(out) + " */"


def generic(declaration):
    name = re.search(r"plm_status (plm_\w+)\(", declaration)
    for pattern, text in GENERIC if name else []:
        if re.search(pattern, name.group(1)):
            return text.format(noun=name.group(1).split("_")[1])
    if declaration.startswith("typedef int32_t plm_status"):
        return "What every function returns: 0 done, positive an outcome, negative a failure."
    if declaration.startswith("#define PLM_API"):
        return "Marks what the library exports."
    typedef = re.search(r"typedef struct (plm_(\w+)) ", declaration)
    return f"Handle of a {typedef.group(2)}, see \\ref {typedef.group(2)}." if typedef else None


text = open(sys.argv[1], encoding="utf-8").read()
out, doc, group, first = [], None, None, True
for item in re.findall(r"/\*.*?\*/|\n[ \t]*\n|[^\n]+?(?=/\*|\n|$)|\n", text, re.S):
    if item.startswith("/* clang-format"):
        continue
    if item.startswith("/*"):
        words = inside(item)
        section = re.match(r"-{4} ([\w ,+-]+?)(?:[:(](.*?))? ?-*$(.*)", words, re.S | re.M)
        if first:  # what stands at the top is the front page
            out.append("/** \\file\n * \\brief The whole C API of libplm. */\n" + front_page(words))
            first = False
        elif section:
            title, more, rest = section.group(1).strip(), section.group(2) or "", section.group(3)
            name = NAMES.get(title, title.split()[0].lower())
            out.append(("/** \\} */\n" if group else "") + f"/** \\defgroup {name} {title}\n * " +
                       escaped(balanced(more.rstrip(" -")) + "\n\n" + rest.strip()) + "\n * \\{ */")
            group, doc = name, None
        elif out and out[-1].strip() and not out[-1].startswith("/*") and "\n" not in out[-1]:
            out.append("/**< " + escaped(words) + " */")  # behind a declaration
        else:
            doc = words
            out.append("")
    elif re.fullmatch(r"\n[ \t]*\n", item):
        doc = None
        out.append(item)
    elif re.match(r"PLM_API|typedef|#define PLM_(?!PLM_H)", item):
        words = doc or generic(item)
        one_of_many = item.startswith("#define") and not re.match(r"#define PLM_(API|PLM_H)\b", item)
        if words:
            out.append(f"/** {words if not doc else escaped(words)}{example(item)} */\n")
        elif one_of_many:
            out.append("/** " + item.split()[1].lower().replace("plm_", "").replace("_", " ") + " */\n")
        out.append(item)
    else:
        if item.startswith("#ifdef __cplusplus") and group and len(out) > 50:
            out.append("/** \\} */\n")
            group = None
        out.append(item)
sys.stdout.write("".join(out))
