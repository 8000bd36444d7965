"""What a function of plm.h looks like in another language: found in the sources of that language, by the calls in their bodies."""
import re
from dataclasses import dataclass, field


@dataclass
class Form:
    """owner: class or type, "" for a free procedure; code: how it is declared, words: what is said of it there; calls: functions of C
    (described names) that its body names; helpers: other procedures that it names."""
    owner: str
    name: str
    code: str
    words: str = ""
    is_public: bool = True
    calls: set = field(default_factory=set)
    helpers: set = field(default_factory=set)

    @property
    def title(self):
        return f"{self.owner}.{self.name}" if self.owner else self.name


class Calls:
    """Which functions of plm.h a piece of source names."""

    def __init__(self, names):
        self.names = set(names)  # described ones

    def fits(self, name):
        return name if name in self.names else None

    def in_text(self, text, described):
        return {described(word) for word in re.findall(r"\bplm_\w+", text) if self.fits(described(word))}


def by_function(forms, names):
    """{described name: public forms that lead to it}. Those whose body names it, or else those that reach it by way of helpers."""
    found = {}
    for name in names:
        direct = [form for form in forms if form.is_public and name in form.calls]
        found[name] = (direct or [form for form in forms if form.is_public and name in reached(form, forms)]
                       or [form for form in forms if form.is_public and is_called_alike(form, name)])
    return found


def is_called_alike(form, name):
    """A method of the same name, whose body puts the name of C's function together."""
    noun, _, verb = name.removeprefix("plm_").partition("_")
    return form.owner.lower() == noun and form.name in (verb, {"write": "to_bytes"}.get(verb))


def reached(form, forms):
    """What a form calls through helpers that are not public."""
    seen, pending, calls = set(), [form], set()
    while pending:
        one = pending.pop()
        calls |= one.calls
        for helper in forms:
            same = helper.owner in (one.owner, "")
            if helper.name in one.helpers and same and not helper.is_public and id(helper) not in seen:
                seen.add(id(helper))
                pending.append(helper)
    return calls
