"""All that the reference knows: the functions in their sections, their arguments, and what they look like in each language."""
import re

import cpp_forms
import fortran_forms
import plm_api
import python_forms
from explained import Explained
from forms import Calls, by_function
from header import described, read
from plm_header import ROOT
from text import Linker

LANGUAGES = {"fortran": "Fortran", "fortran77": "FORTRAN 77", "cpp": "C++", "python": "Python"}
PAGES = {"status": "library", "keys": "by-key"}  # of sections whose page is not called as they are
OWNERS = {"plm_settable": "handle", "plm_readable": "handle", "Handle": "handle"}  # what all handles have

# What a language has in place of a function, in its own way.
DESTROYED = {"cpp": "By the destructor, in any order.", "python": "When the object is collected, in any order."}
INSTEAD = {("fortran", "plm_context_get_error_text"): "Every procedure gives the text in its argument `errmsg`.",
           ("fortran", "plm_status_text"): "Every procedure gives a whole sentence in its argument `errmsg`.",
           ("fortran", "plm_X_get_string"): "`call handle%get(key, text)` with a `character(len=:), allocatable :: text`.",
           ("fortran", "plm_X_get_array"): "`call handle%get(key, values)` with a `real(real64), allocatable :: values(:)`.",
           ("fortran", "plm_X_get_int_array"): "`call handle%get(key, values)` with an `integer, allocatable :: values(:)`.",
           ("cpp", "plm_context_get_error_text"): "`what()` of the `plm::Error` that is thrown; outcomes go to `Context::on_outcome`.",
           ("cpp", "plm_context_get_error_function"): "`function()` of `plm::Error`.",
           ("cpp", "plm_context_get_error_argument"): "`argument()` of `plm::Error`.",
           ("cpp", "plm_context_get_error_info"): "`status()`, `reason()`, `index()` and `library_code()` of `plm::Error`.",
           ("cpp", "plm_context_set_inertia"): "`Factorization::n_negative()` of the object that the solver returns.",
           ("python", "plm_context_set_progress"): "`context.progress = function`, or `progress=` of a single call.",
           ("python", "plm_context_set_log"): "`context.log = True`, or a function of (level, text).",
           ("python", "plm_context_get_error_text"): "`str(error)` of the `plm.PlmError` that is raised; outcomes are a `plm.PlmWarning`.",
           ("python", "plm_context_get_error_function"): "`error.function` of a `plm.PlmError`.",
           ("python", "plm_context_get_error_argument"): "`error.argument` of a `plm.PlmError`.",
           ("python", "plm_context_get_error_info"): "`error.status`, `.reason`, `.index` and `.library_code` of a `plm.PlmError`."}


def nice_owner(form):
    form.owner = OWNERS.get(form.owner, form.owner)
    form.code = re.sub(r"\b(settable|readable)%", "handle%", form.code)
    return form


def chosen(name, forms):
    """Of several forms those that are called as the function, else all but those that lead to something else first."""
    if "_X_" in name:
        return [form for form in forms if form.owner == "handle"] or forms
    noun, _, verb = name.removeprefix("plm_").partition("_")
    alike = {verb, verb.removeprefix("get_"), verb.removeprefix("find_")}
    same = [form for form in forms if form.name in alike and form.owner.lower().removeprefix("plm_") == noun]
    return same or forms


def keys():
    """[(noun, name, is option)] of docs/keys.md, in its order."""
    found, noun, is_option = [], "", False
    for line in (ROOT / "docs/keys.md").read_text(encoding="utf-8").splitlines():
        if heading := re.fullmatch(r"## `plm_(\w+)`", line):
            noun = heading[1]
        elif re.match(r"\| (option|result) \|", line):
            is_option = line.startswith("| option")
        elif row := re.match(r"\| `(\w+)` \|", line):
            found.append((noun, row[1], is_option))
    return found


class Book:
    def __init__(self):
        self.api = plm_api.read()
        self.top, self.sections = read()
        self.functions = {}  # described name: its functions, as plm_api has them
        for function in self.api.functions:
            self.functions.setdefault(described(function.name), []).append(function)
        calls = Calls(self.functions)
        sources = {"fortran": fortran_forms, "cpp": cpp_forms, "python": python_forms}
        self.all_forms = {language: [nice_owner(form) for form in source.read(calls)] for language, source in sources.items()}
        self.forms = {language: by_function(forms, self.functions) for language, forms in self.all_forms.items()}
        self.f77 = fortran_forms.f77_types()
        self.snippets = snippets()
        self.help = python_forms.what_help_adds()
        self.examples = self.help.examples()
        places = {item_name(item): f"{self.page_of(section)}.md#{item_name(item)}" for section, item in self.items("function")}
        places.update({item.names[0]: f"{self.page_of(section)}.md#{item.names[0]}" for section, item in self.items("callback")})
        self.linker = Linker(places, {name: f"{noun}-{name}" for noun, name, _ in reversed(keys())})
        self.explained = Explained(self.own_names())

    @staticmethod
    def page_of(section):
        return "library" if section.noun == "library" else PAGES.get(section.noun, section.noun)

    def by_page(self):
        """{page: its sections}"""
        found = {}
        for section in self.sections:
            found.setdefault(self.page_of(section), []).append(section)
        return found

    def items(self, kind):
        for section in self.sections:
            for item in section.items:
                if item.kind == kind:
                    yield section, item

    def in_language(self, language, name):
        """(forms, what is said where there are none)."""
        layer = {"fortran": "module plm", "python": "Python", "fortran77": "FORTRAN 77"}.get(language)
        reason = next((self.api.entry(function).left_out.get(layer) for function in self.functions[name]), None)
        if (language, name) in INSTEAD:
            return [], INSTEAD[language, name]
        if name.endswith("_destroy") and language in DESTROYED:
            return [], DESTROYED[language]
        if reason:
            return [], f"Not in this language: {reason}."
        return chosen(name, self.forms[language][name]), ""

    def subroutines(self, name):
        """Those of FORTRAN 77: (six letters, text), each kind of handle having its own for the functions by key."""
        entry = self.api.description.functions[name]
        nouns = [function.noun for function in self.functions[name]]
        for subroutine in entry.subroutines:
            for noun in nouns if "_X_" in name else nouns[:1]:
                letter = self.api.description.letters.get(noun, "")
                yield subroutine.name.replace("X", letter, 1) if "_X_" in name else subroutine.name, subroutine.text

    def arguments_of(self, six):
        """[(argument, type, is array, intent)] of a subroutine of FORTRAN 77."""
        if six not in self.f77:
            raise SystemExit(f"{six} is in none of fortran/plm_f77*.f90; run python3 src/capi/api/generate.py")
        return self.f77[six]

    def own_names(self):
        """{described name: method names that lead to it alone}."""
        used = {}
        for language in ("python", "cpp"):
            for name in self.functions:
                for form in chosen(name, self.forms[language][name]):
                    used.setdefault(form.name, set()).add(name)
        found = {}
        for method, names in used.items():
            if len(names) == 1 and "_" in method and not method.startswith("_"):
                found.setdefault(next(iter(names)), set()).add(method)
        return found


def item_name(item):
    return described(item.names[0])


def snippets():
    """{described name: its example in docs/examples}: what stands between two comments with its name in brackets."""
    found = {}
    for path in sorted((ROOT / "docs/examples").glob("*.c")):
        opened = {}
        for line in path.read_text(encoding="utf-8").splitlines():
            marks = re.findall(r"\[(plm_\w+)\]", line) if re.match(r"\s*/\* \[", line) else []
            for mark in marks:
                if mark in opened:
                    lines = opened.pop(mark)
                    found.setdefault(described(mark), "\n".join(lines))
                else:
                    opened[mark] = []
            for lines in opened.values():
                if not marks:
                    lines.append(line[4:] if line.startswith("    ") else line)
    return found
