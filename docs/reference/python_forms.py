"""The package plm: classes, methods and functions, from its sources (nothing is imported: the library need not be there)."""
import ast
import importlib.util

from forms import Form
from header import described
from plm_header import ROOT

PACKAGE = ROOT / "bindings/python/plm"


def what_help_adds():
    """The module of the package that has the meaning of arguments and the examples; it needs nothing of the rest."""
    found = importlib.util.spec_from_file_location("plm_help", PACKAGE / "_help.py")
    module = importlib.util.module_from_spec(found)
    found.loader.exec_module(module)
    return module


def argument_names(code):
    """Of a form's code: "hbm.solve(frequency_hz, start=None)"."""
    inner = code[code.index("(") + 1:-1] if "(" in code else ""
    return [argument.arg for argument in arguments_of(inner)] if inner else []


def arguments_of(inner):
    parsed = ast.parse(f"def f({inner}): pass").body[0].args
    return [*parsed.args, *parsed.kwonlyargs]


def signature(node, is_method):
    arguments = ast.unparse(node.args)
    if is_method and not is_static(node):
        arguments = arguments.partition(",")[2].strip() if "," in arguments else ""
    return arguments.removeprefix("/, ")


def is_static(node):
    return any(isinstance(d, ast.Name) and d.id == "staticmethod" for d in node.decorator_list)


def is_property(node):
    return any(isinstance(d, ast.Name) and d.id == "property" for d in node.decorator_list)


def noun_of(node):
    """Of a class of handles: class Hbm(..., noun="hbm")."""
    for keyword in node.keywords:
        if keyword.arg == "noun" and isinstance(keyword.value, ast.Constant):
            return keyword.value.value
    return {"Handle": "X", "Context": "context"}.get(node.name, node.name.removesuffix("Methods").lower())


def calls_of(node, noun, calls):
    """Texts that name a function of C, as "plm_hbm_sweep" or the verb "sweep" alone, and attributes of that name."""
    found = set()
    for part in ast.walk(node):
        if isinstance(part, ast.Constant) and isinstance(part.value, str):
            words = [part.value, f"plm_{noun}_{part.value}"]
        elif isinstance(part, ast.Attribute) and part.attr.startswith("plm_"):
            words = [part.attr]
        else:
            continue
        found |= {described(word) for word in words if word.isidentifier() and calls.fits(described(word))}
    return found


def helpers_of(node):
    return {part.attr for part in ast.walk(node) if isinstance(part, ast.Attribute) and part.attr.startswith("_")} - {"_call", "_work"}


def form_of(node, owner, noun, calls):
    words = (ast.get_docstring(node) or "").strip()
    name, handle = node.name, owner.lower() if owner else ""
    if name == "__init__":
        code = f"{handle} = plm.{owner}({signature(node, True)})"
    elif is_property(node):
        code = f"{handle}.{name}"
    else:
        code = f"{handle or 'plm'}.{name}({signature(node, bool(owner))})"
        if owner and any(ast.unparse(one) == "classmethod" for one in node.decorator_list):
            code = f"{handle} = plm.{owner}.{code.partition('.')[2]}"
    return Form(owner, name, code, words, not name.startswith("_") or name == "__init__", calls_of(node, noun, calls), helpers_of(node))


def class_forms(node, calls):
    noun = noun_of(node)
    owner = noun.capitalize() if node.name.endswith("Methods") else node.name
    forms = [form_of(part, owner, noun, calls) for part in node.body if isinstance(part, ast.FunctionDef)]
    for form in forms:
        if form.name == "__init__":
            form.words = (ast.get_docstring(node) or "").strip()
    return forms


def read(calls):
    """All forms of the package's own modules; those of the command, of plot and of fe have pages of their own."""
    forms = []
    for path in sorted(PACKAGE.glob("_*.py")):
        for node in ast.parse(path.read_text(encoding="utf-8")).body:
            if isinstance(node, ast.ClassDef):
                forms += class_forms(node, calls)
            elif isinstance(node, ast.FunctionDef):
                forms.append(form_of(node, "", "", calls))
    return forms
