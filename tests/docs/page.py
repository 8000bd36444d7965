"""What the tests of the documents share: the fenced blocks of a page, and a comparison of what a program prints with what the page
says it prints."""
import pathlib
import re
from typing import NamedTuple, Optional

FENCE = re.compile(r"(?:<!-- (?P<mark>[^>]*?) -->\n)?^```(?P<language>[\w-]*)\n(?P<text>.*?)^```$", re.M | re.S)
NUMBER = re.compile(r"-?(?:\d+\.?\d*|\.\d+)(?:[eE][-+]?\d+)?")


class Block(NamedTuple):
    """A fenced block. mark: what stands in a comment on the line above it, as "file: host.c", or None; line: of its first line."""
    mark: Optional[str]
    language: str
    text: str
    line: int

    def named(self, kind):
        """NAME of the mark "kind: NAME", or None."""
        return self.mark[len(kind) + 2:].strip() if self.mark and self.mark.startswith(kind + ": ") else None


def blocks(path):
    page = pathlib.Path(path).read_text(encoding="utf-8")
    return [Block(m["mark"], m["language"], m["text"], page.count("\n", 0, m.start("text")) + 1) for m in FENCE.finditer(page)]


def named_blocks(path, kind):
    """{NAME: text} of the blocks marked "kind: NAME"; a name that comes twice is an error."""
    found = {}
    for block in blocks(path):
        name = block.named(kind)
        if name in found:
            raise SystemExit(f"{path}:{block.line}: a second block is marked {kind}: {name}")
        if name:
            found[name] = block.text
    return found


def last_place(number):
    """One unit of the last digit that is printed: 1e-3 of 11.366; 0 of an integer, which must be the same."""
    mantissa, _, exponent = number.lower().partition("e")
    if "." not in mantissa and not exponent:
        return 0.0
    return 10.0 ** (int(exponent or 0) - len(mantissa.partition(".")[2]))


def difference(shown, printed):
    """What a page shows against what was printed: None where words and integers are the same, and every other number to one and a
    half units of its last digit (a rounding may fall to either side, by another BLAS); else a text."""
    a, b = shown.strip().splitlines(), printed.strip().splitlines()
    if len(a) != len(b):
        return f"the page shows {len(a)} lines, {len(b)} were printed:\n{printed}"
    for one, other in zip(a, b):
        numbers = NUMBER.findall(one), NUMBER.findall(other)
        same_words = NUMBER.sub("#", one).split() == NUMBER.sub("#", other).split() and len(numbers[0]) == len(numbers[1])
        if not same_words or any(abs(float(x) - float(y)) > 1.5 * last_place(x) for x, y in zip(*numbers)):
            return f"the page shows\n    {one}\nprinted was\n    {other}"
    return None
