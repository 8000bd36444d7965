"""The functions of plm.h with one letter per argument, as bindings/python/plm/_c.py writes them."""
import re

LETTERS = {"int32_t": "i", "plm_status": "i", "int64_t": "q", "double": "d", "const char *": "s"}


def letter(argument):
    """i q d: numbers; s: text in; p: any other pointer (all of them travel as addresses)."""
    argument = re.sub(r"\s+", " ", argument.strip())
    kind = re.sub(r"\w+$", "", argument).strip()  # without the name
    if kind in LETTERS:
        return LETTERS[kind]
    if kind.endswith("*") or kind.endswith("_fn"):
        return "p"
    raise ValueError(f"unknown type of argument: {argument}")


def functions(path):
    with open(path, encoding="utf-8") as file:
        text = re.sub(r"/\*.*?\*/", "", file.read(), flags=re.S)
    found = {}
    for name, arguments in re.findall(r"PLM_API\s+plm_status\s+(plm_\w+)\s*\(([^;]*?)\)\s*;", text, flags=re.S):
        found[name] = "".join(letter(a) for a in arguments.split(","))
    return found


def constants(path):
    with open(path, encoding="utf-8") as file:
        pairs = re.findall(r"#define PLM_(\w+) \(?(-?[0-9.]+)\)?", file.read())
    return {name: float(value) if "." in value else int(value) for name, value in pairs}
