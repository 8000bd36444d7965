"""plm.h read from top to bottom, as the reference shows it: sections, each with its words, constants, types of callbacks and functions."""
import re
from dataclasses import dataclass, field

from plm_header import PATH

GENERIC = [  # of functions that every handle has, which plm.h does not comment one by one
    (r"_create$", "Makes {article} {noun}; destroy it by plm_{noun}_destroy, or let the context do it."),
    (r"_destroy$", "Destroys the {noun}; NULL and *{noun} == NULL are accepted; *{noun} becomes NULL."),
    (r"_set_(int|double|string)$", "Sets an option of a handle by its key. plm_<handle> stands for each kind of handle that has options."),
    (r"_get_(int|double|string)$", "Reads an option or a result of a handle by its key."),
    (r"_get_(int_)?array$", "Copies an array result of a handle by its key; with capacity 0 only its length is asked."),
    (r"^plm_version$", "The version of the library that runs."),
    (r"^plm_key_count$", "How many keys a kind of handle has."),
    (r"^plm_context_get_error_(function|argument)$", "The {noun_of_error} that the text of plm_context_get_error_text is about."),
]


@dataclass
class Item:
    """kind: "text" (words), "constants" (rows of name, value, words), "callback" or "function" (names, words, declarations)."""
    kind: str
    words: str = ""
    names: list = field(default_factory=list)
    rows: list = field(default_factory=list)
    code: list = field(default_factory=list)


@dataclass
class Section:
    noun: str
    title: str
    words: str
    items: list = field(default_factory=list)


def inside(comment):
    """The words of a comment, without its frame; empty lines part paragraphs."""
    lines = [re.sub(r"^\s*\* ?", "", line) for line in comment[2:-2].strip().split("\n")]
    return "\n".join(line.rstrip() for line in lines).strip()


def described(name):
    """The name that stands for a function and its twins: plm_x for plm_x_i32 and _i64, plm_X_set_int for that of every handle."""
    name = re.sub(r"_i(32|64)$", "", name)
    return re.sub(r"^plm_[a-z]+_((?:set|get)_(?:int|double|string)|get_array|get_int_array)$", r"plm_X_\1", name)


def generic(name):
    for pattern, words in GENERIC:
        if re.search(pattern, name):
            noun = "handle" if "_X_" in name else name.split("_")[1]
            return words.format(noun=noun, noun_of_error=name.rsplit("_", 1)[1], article="an" if noun == "hbm" else "a")
    return ""


class Reader:
    """Builds sections from the pieces of the header: comments, empty lines, and lines of code."""

    def __init__(self, text):
        self.top, self.sections, self.doc = "", [], ""
        self.known = {}  # described name: Item
        for piece in re.findall(r"/\*.*?\*/|\n[ \t]*\n|[^\n]+?(?=/\*|\n|$)|\n", text, re.S):
            if piece.startswith("/* clang-format"):
                continue
            if piece.startswith("/*"):
                self.comment(inside(piece))
            elif re.fullmatch(r"\n[ \t]*\n", piece):
                self.loose_words()
            elif piece.strip():
                self.code(piece)

    @property
    def items(self):
        return self.sections[-1].items

    def comment(self, words):
        title = re.match(r"-{4} ([\w ,+-]+?)(?:[:(](.*?))? ?-*$(.*)", words, re.S | re.M)
        last = self.items[-1] if self.sections and self.items else None
        if not self.top:
            self.top = words
        elif title:
            name, more, rest = title[1].strip(), (title[2] or "").rstrip(" -"), title[3].strip()
            more = more[:-1] if more.count(")") > more.count("(") else more
            noun = "keys" if name.startswith("Options") else name.split()[0].lower()
            self.sections.append(Section(noun, name, "\n\n".join(filter(None, [more.strip(), rest]))))
            self.doc = ""
        elif last and last.kind == "constants" and self.behind:
            last.rows[-1][2] = " ".join(words.split())
        else:
            self.doc, self.used = words, False
        self.behind = False

    def loose_words(self):
        """A comment with nothing right below it speaks of all that follows."""
        if self.doc and self.sections and not self.used:
            self.items.append(Item("text", self.doc))
        self.doc, self.used, self.behind = "", False, False

    used = behind = False

    def code(self, line):
        constant = re.match(r"#define[ \t]+(PLM_\w+)[ \t]+\(?(\S.*?)\)?[ \t]*$", line)
        self.behind = False
        if constant and constant[1] not in ("PLM_API", "PLM_PLM_H"):
            if not self.sections:
                self.sections.append(Section("library", "The library", ""))
            if not self.items or self.items[-1].kind != "constants" or self.doc and not self.used:
                self.items.append(Item("constants", self.doc))
            self.used = self.behind = True
            self.items[-1].rows.append([constant[1], constant[2], ""])
            return
        begins = re.match(r"PLM_API\s+plm_status\s+(plm_\w+)\(|typedef\s+\w+\s*\*?\(\*(plm_\w+)\)\(", line)
        if begins:
            self.declaration(begins[1] or begins[2], "function" if begins[1] else "callback", line)
        elif self.sections and self.items and self.items[-1].code and not self.complete:
            self.current.code[-1] += "\n" + line
        self.complete = line.rstrip().endswith(";")

    complete = True

    def declaration(self, name, kind, line):
        shown = described(name)
        if shown not in self.known:
            words = self.doc if self.doc and not name.endswith("_destroy") else generic(shown)
            if self.items and self.items[-1].kind == "constants" and self.items[-1].words == words:
                self.items[-1].words = ""  # they belong to this function
            self.known[shown] = Item(kind, words)
            of_all = "_X_" in shown
            items = next(section.items for section in self.sections if section.noun == "keys") if of_all else self.items
            items.append(self.known[shown])
        self.current = self.known[shown]
        self.current.names.append(name)
        self.current.code.append(line)
        self.used = True


def read(path=PATH):
    """(words at the top, sections)."""
    text = path.read_text(encoding="utf-8")
    text = re.sub(r"^#(?:if|ifdef|endif|elif|else|include|define PLM_API\b)[^\n]*\n|^extern \"C\" \{\n|^\}\n", "", text, flags=re.M)
    reader = Reader(text)
    return reader.top, [section for section in reader.sections if section.items]
