"""plm.h as data: its functions, callback types and constants. Used by the gates here and in tests/host."""
import re
from collections import namedtuple

Function = namedtuple("Function", "returns name arguments")  # arguments: list of (type, name)


def without_comments(text):
    return re.sub(r"/\*.*?\*/", " ", text, flags=re.S)


def argument(text):
    match = re.fullmatch(r"(.*?)(\w+)", " ".join(text.split()))
    return match.group(1).strip(), match.group(2)


def functions(path):
    """Every declaration of the header, in its order."""
    text = without_comments(open(path, encoding="utf-8").read())
    found = []
    for returns, name, arguments in re.findall(r"PLM_API\s+(\w+)\s+(plm_\w+)\s*\(([^;]*?)\)\s*;", text, re.S):
        found.append(Function(returns, name, [argument(a) for a in arguments.split(",")]))
    if len(found) != text.count("PLM_API plm_status"):
        raise SystemExit(f"{path}: a declaration could not be read")
    return found


def constants(path):
    """Every object-like macro with a value: {name: text}."""
    text = without_comments(open(path, encoding="utf-8").read())
    pairs = re.findall(r"^#define[ \t]+(PLM_\w+)[ \t]+(\S.*?)[ \t]*$", text, re.M)
    return {name: value for name, value in pairs if name != "PLM_API"}
