"""The module plm and the FORTRAN 77 layer: procedures, their arguments and the words above them, from their sources."""
import re

from forms import Form
from header import described
from plm_header import ROOT

FOLDER = ROOT / "fortran"
HIDDEN = ("self", "stat", "errmsg")
FILES = ("plm_context", "plm_model", "plm_methods", "plm_reduction", "plm_branch", "plm_response", "plm_motion", "plm_study", "plm_keys", "plm_facts")


def joined(text):
    """Continued lines in one."""
    return re.sub(r"[ \t]*&[ \t]*\n[ \t]*", " ", text)


def procedures(text):
    """(name, words above, dummies, text of the body) of every subroutine and function of a file."""
    pattern = r"((?:^ *![^\n]*\n)*)^( *)(?:pure )?(?:[\w()]+ )?(subroutine|function) (\w+)\(([^)]*)\)[^\n]*\n(.*?)^\2end \3 \4"
    for found in re.finditer(pattern, joined(text), re.S | re.M):
        words = " ".join(re.sub(r"^ *! ?", "", line) for line in found[1].splitlines())
        yield found[4], words.strip(), [word.strip() for word in found[5].split(",") if word.strip()], found[6]


def declarations(body, dummies):
    """[(names, type)] of the dummy arguments, in their order of declaration."""
    found = []
    for kind, names in re.findall(r"^ *((?:type|class|integer|real|complex|logical|character|procedure)\b[^:\n]*?) *:: *([^\n!]*)", body, re.M):
        names = [name.strip() for name in re.findall(r"\w+(?:\([^)]*\))?", names)]
        names = [name for name in names if name.partition("(")[0].lower() in dummies]
        if names:
            found.append((names, kind))
    found += [([name], "external") for name in re.findall(r"^ *external +:: +(\w+)", body, re.M) if name in dummies]
    return found


def types_of(text):
    """{implementing procedure: [(type, method)]} of the file's derived types."""
    bound = {}
    for name, body in re.findall(r"^ *type(?:, [^:\n]*)? :: (\w+)\n(.*?)^ *end type", joined(text), re.S | re.M):
        name = name.removesuffix("_methods")
        generic = {}
        for method, parts in re.findall(r"generic :: (\w+) => ([\w, ]+)", body):
            generic.update({part.strip(): method for part in parts.split(",")})
        for line in re.findall(r"procedure(?:, \w+)? :: ([^\n]+)", body):
            for part in line.split(","):
                method, _, made_by = (word.strip() for word in part.partition("=>"))
                bound.setdefault(made_by or method, []).append((name, generic.get(method, method)))
    return bound


def code_of(owner, method, dummies, body, is_function):
    shown = [name for name in dummies if name != "self"]
    declared = declarations(body, set(dummies))
    optional = {name.partition("(")[0] for names, kind in declared if "optional" in kind for name in names}
    arguments = ", ".join(f"[{name}]" if name in optional else name for name in shown)
    target = f"{owner.removeprefix('plm_')}%{method}" if owner else method
    call = f"{target}({arguments})" if is_function else f"call {target}({arguments})"
    lines = [f"    {kind} :: {', '.join(names)}" for names, kind in declared if not set(HIDDEN) & set(names)]
    return "\n".join([call, *lines])


def read(calls):
    forms, seen = [], set()
    for file in FILES:
        text = (FOLDER / f"{file}.f90").read_text(encoding="utf-8")
        bound = types_of(text)
        public = re.sub(r"\s", "", " ".join(re.findall(r"^ *public :: ([^\n]*)", joined(text), re.M))).split(",")
        for name, words, dummies, body in procedures(text):
            called = {described(word) for word in re.findall(r"\bplm_\w+(?= *\(|, self| *,)", body) if calls.fits(described(word))}
            called |= {f"plm_X_{kind}" for kind in re.findall(r"\bplm_[a-z]+_((?:set|get)_(?:int|double|string)|get_array|get_int_array)\b", body)}
            helpers = set(re.findall(r"\b\w+(?=\()", body))
            is_function = not re.search(rf"^ *subroutine {name}\b", joined(text), re.M)
            for owner, method in bound.get(name, [("", name)] if name in public else []):
                code = code_of(owner, method, dummies, body, is_function)
                if (owner, method) in seen and not called:
                    continue
                seen.add((owner, method))
                forms.append(Form(owner, method, code, words, True, called, helpers))
            if name not in bound and name not in public:
                forms.append(Form("", name, "", words, False, called, helpers))
    return forms


F77_TYPES = {"integer(int64)": "INTEGER*8", "integer": "INTEGER", "real(real64)": "DOUBLE PRECISION", "character(len=*)": "CHARACTER*(*)"}


def f77_types():
    """{six letters: [(argument, type of FORTRAN 77, "in" or "out")]} of every subroutine of the layer."""
    found = {}
    for path in sorted(FOLDER.glob("plm_f77*.f90")):
        text = path.read_text(encoding="utf-8")
        for name, _, dummies, body in procedures(text):
            if re.fullmatch(r"plm\w{3}", name):
                declared = {}
                for names, kind in declarations(body, set(dummies)):
                    kind, _, intent = kind.partition(", intent(")
                    for one in names:
                        declared[one.partition("(")[0]] = (F77_TYPES.get(kind, "EXTERNAL"), bool("(" in one), intent.rstrip(") "))
                found[name.upper()] = [(dummy.upper(), *declared.get(dummy, ("EXTERNAL", False, "in"))) for dummy in dummies]
    return found
