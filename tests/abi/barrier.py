#!/usr/bin/env python3
"""barrier.py PLM_H SRC_CAPI: every exported function does all its work inside the exception barrier.

The body of an exported function may check arguments by `if (...) return <status>;` and must then be one `return` of
call<>, search_call, call_free or destroy<> (or of a local function that is), or hold the environment and catch everything itself."""
import glob
import os
import pathlib
import re
import sys

sys.path.insert(0, str(pathlib.Path(__file__).resolve().parents[2] / "src/capi/api"))
import plm_header  # noqa: E402

BARRIER = r"(?:capi::|plm::capi::)?(?:call<[\w:]+>|call_free|search_call|destroy<[\w:]+>)\("


def cleaned(text):
    text = re.sub(r"//[^\n]*|/\*.*?\*/", " ", text, flags=re.S)
    return re.sub(r'"(?:\\.|[^"\\])*"', '""', text)


def expanded(text):
    """Macros that define functions, at their calls."""
    for name, parameters, body in re.findall(r"^#define (PLM_\w+)\(([^)]*)\)((?:.*\\\n)+.*\n)", text, re.M):
        def replace(call, parameters=parameters, body=body):
            out = body.replace("\\\n", "\n")
            for parameter, value in zip(parameters.split(","), call.group(1).split(",")):
                out = re.sub(rf"\b{parameter.strip()}\b(?!\w)|(?<=##){parameter.strip()}", value.strip(), out)
                out = re.sub(rf"_##{parameter.strip()}##_", f"_{value.strip()}_", out)
            return out.replace("##", "")
        text = re.sub(rf"^{name}\(([^)]*)\)[ \t]*$", replace, text, flags=re.M)
    return text


def bodies(text):
    """(name, body) of every function defined with the return type plm_status."""
    for match in re.finditer(r"\bplm_status (\w+)\(([^;{}()]|\([^()]*\))*\)(?: noexcept)? \{", text):
        depth, end = 1, match.end()
        while depth:
            depth += {"{": 1, "}": -1}.get(text[end], 0)
            end += 1
        yield match.group(1), text[match.end():end - 1]


def guarded(body, helpers):
    rest = body.strip()
    while True:
        shorter = re.sub(r"^if \((?:[^()]|\([^()]*\))*\) return \w+;\s*", "", rest)
        if shorter == rest:
            break
        rest = shorter
    entries = BARRIER + "".join(rf"|{h}(?:<[\w:]+>)?\(" for h in helpers)
    if re.match(rf"return (?:{entries})", rest):
        depth = 0  # the call must be the last statement
        for i, c in enumerate(rest):
            depth += {"(": 1, "{": 1, ")": -1, "}": -1}.get(c, 0)
            if c == ";" and depth == 0:
                return rest[i + 1:].strip() == ""
    return bool(re.match(r"HeldThread held;\s*try \{", rest) and
                re.search(r"\} catch \(\.\.\.\) \{\s*return record_failure\([^;]*\);\s*\}$", rest))


def unguarded(text):
    found = dict(bodies(text))
    helpers = [n for n, b in found.items() if not n.startswith("plm_") and guarded(b, [])]
    exported = {n: b for n, b in found.items() if n.startswith("plm_")}
    return set(exported), {n for n, b in exported.items() if not guarded(b, helpers)}


# the check itself: what it must refuse
for bad in ("plm_status plm_x(int a) {\n    return compute(a);\n}",
            "plm_status plm_x(int a) {\n    std::string s;\n    return call_free([&] { return 0; });\n}",
            "plm_status plm_x(int a) {\n    const int s = call_free([&] { return 0; });\n    work();\n    return s;\n}",
            "plm_status plm_x(int a) {\n    HeldThread held;\n    try { work(); } catch (int) { return 1; }\n}"):
    if unguarded(bad)[1] != {"plm_x"}:
        sys.exit(f"the check does not see this one:\n{bad}")

defined, failures = set(), []
for path in sorted(glob.glob(os.path.join(sys.argv[2], "*.cpp"))):
    exported, bad = unguarded(expanded(cleaned(open(path, encoding="utf-8").read())))
    defined |= exported
    failures += [f"{os.path.basename(path)}: {name} works outside the barrier" for name in sorted(bad)]
declared = {f.name for f in plm_header.read(sys.argv[1]).functions}
failures += [f"{name}: declared, its definition was not found" for name in sorted(declared - defined)]
failures += [f"{name}: defined, not declared" for name in sorted(defined - declared)]
print("\n".join(failures) or f"{len(defined)} exported bodies, each inside the barrier")
sys.exit(bool(failures))
