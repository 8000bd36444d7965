"""plm.hpp: classes, their methods and the comments above them."""
import re

from forms import Form
from header import described
from plm_header import ROOT

PATH = ROOT / "include/plm/plm.hpp"


def statements(text):
    """(words, signature, body, indent) of what is declared or defined at each level of a class or of the file."""
    lines, i = text.splitlines(), 0
    while i < len(lines):
        words = []
        while i < len(lines) and re.match(r"\s*///", lines[i]):
            words.append(re.sub(r"^\s*/// ?", "", lines[i]))
            i += 1
        if i >= len(lines):
            return
        line = lines[i]
        indent = len(line) - len(line.lstrip())
        starts = re.match(r"( {4})?[A-Za-z~][^#]*\(", line + (lines[i + 1] if i + 1 < len(lines) else ""))
        if not starts or re.match(r"\s*(class|struct|namespace|public|private|protected|using|#|//|return|if|for)\b", line) or "(" not in joined_head(lines, i):
            i += 1
            continue
        signature, body, i = statement(lines, i)
        yield " ".join(words), signature, body, indent


def joined_head(lines, i):
    return " ".join(lines[i:i + 3])


def statement(lines, i):
    """(signature, body, next line) of what begins at line i: up to ; or a block in braces."""
    text, depth, started = "", 0, False
    signature = None
    while i < len(lines):
        for at, c in enumerate(lines[i] + "\n"):
            if c in "([":
                depth += 1
            elif c in ")]":
                depth -= 1
            elif c == "{" and depth == 0 and signature is None:
                signature, started, braces = text, True, 0
            if started:
                braces += {"{": 1, "}": -1}.get(c, 0)
                if braces == 0 and c == "}":
                    return signature, text + c, i + 1
            elif c == ";" and depth == 0:
                return text, "", i + 1
            text += c
        i += 1
    return text, "", i


def tidy(signature):
    """Without the list of initializers, in one line."""
    text = " ".join(signature.split())
    depth = 0
    for at, c in enumerate(text):
        depth += {"(": 1, ")": -1}.get(c, 0)
        if c == ":" and depth == 0 and text[at - 1] == " " and text[at + 1] == " " and ")" in text[:at]:
            return text[:at].strip()
    return text.removeprefix("inline ").strip()


def calls_in(body, calls):
    found = {described(word) for word in re.findall(r"\bplm_\w+", body) if calls.fits(described(word))}
    for verb in re.findall(r"\bApi<\w+>::(\w+)", body):
        found |= {name for name in (f"plm_X_{verb}",) if calls.fits(name)}
    return found


def name_of(signature):
    found = re.search(r"((?:\w+::)?~?\w+)\s*\($|((?:\w+::)?~?[\w]+)\s*\(", re.sub(r"^template <[^(]*?> ?", "", signature))
    return (found[1] or found[2]) if found else ""


def class_texts(text):
    """(name, body) of every class."""
    for found in re.finditer(r"^(?:template <[^\n]*> )?(class|struct) (\w+)[^;{]*\{\n(.*?)^\};", text, re.S | re.M):
        yield found[2], found[3], found[1] == "class"


def read(calls):
    text = PATH.read_text(encoding="utf-8")
    forms, outside = [], {}
    for name, body, begins_private in class_texts(text):
        parts = re.split(r"^  (public|private|protected):\n", body, flags=re.M)
        access = "private" if begins_private else "public"
        for part in parts:
            if part in ("public", "private", "protected"):
                access = part
                continue
            for words, signature, code, _ in statements(part):
                method = name_of(tidy(signature))
                shown = access == "public" and name not in ("State", "View", "Indices")
                owner = {"WithOptions": "handle", "Handle": "handle"}.get(name, "" if name == "State" else name)
                forms.append(Form(owner, method, tidy(signature) + ";", words, shown, calls_in(code, calls),
                                  set(re.findall(r"\b\w+(?=\()", code))))
    for words, signature, code, indent in statements(re.sub(r"^(?:template <[^\n]*> )?(class|struct) \w+[^;{]*\{\n.*?^\};", "", text, flags=re.S | re.M)):
        name = name_of(tidy(signature))
        if "::" in name:
            owner, _, method = name.partition("::")
            outside.setdefault((owner, method), []).append((calls_in(code, calls), set(re.findall(r"\b\w+(?=\()", code))))
        elif "inline" in signature and name:
            forms.append(Form("", f"plm::{name}", tidy(signature) + ";", words, True, calls_in(code, calls), set()))
    for form in forms:
        for called, helpers in outside.get((form.owner, form.name), []):
            form.calls |= called
            form.helpers |= helpers
    return forms
