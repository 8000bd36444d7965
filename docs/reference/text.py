"""Words of plm.h as Markdown: what would be markup there stays as it is, names of functions and keys become links."""
import re

from header import described

TOKEN = re.compile(r"(?P<function>\bplm_[a-z]\w*\b(?:\(\))?)|(?P<constant>\bPLM_[A-Z][A-Z0-9_]*\b)|\"(?P<key>[a-z][a-z0-9_]+)\"|`(?P<code>[^`\n]+)`"
                   r"|(?P<special>[\\*_\[\]<>&#|~])")
ENDS = re.compile(r"(?<!\beq\.)(?<!\be\.g\.)(?<!\bi\.e\.)(?<!\bcf\.)(?<=[^\s.]\.)\s+(?=[A-Z(\"])")


def first_sentence(words):
    """What a list says of a function: the sentence to its end, "eq. (10)" included."""
    sentence = ENDS.split(" ".join(words.split()))[0]
    return sentence.rstrip(".")


class Linker:
    """place: where each function stands, {described name: page#anchor}, keys: {key: anchor on the page of keys}."""

    def __init__(self, places, keys):
        self.places, self.keys = places, keys

    def of_function(self, name, page):
        """A link, or the name in code where it is no function (plm_X_set_int, plm_context)."""
        target = self.places.get(described(name.removesuffix("()")))
        if not target:
            return f"`{name}`"
        file, _, anchor = target.partition("#")
        name = name.replace("_X_", "_<handle>_")
        return f"[`{name}`]({'' if file == page else file}#{anchor})"

    def prose(self, words, page):
        """Paragraphs and lists of a comment; page: the one that they stand on, beside the others of the reference."""
        def token(found):
            if found["function"]:
                return self.of_function(found["function"], page)
            if found["constant"] or found["code"]:
                return f"`{found['constant'] or found['code']}`"
            if found["key"]:
                shown = f"`\"{found['key']}\"`"
                return f"[{shown}](../keys.md#{self.keys[found['key']]})" if found["key"] in self.keys else shown
            return {"<": "&lt;", ">": "&gt;", "&": "&amp;"}.get(found["special"], "\\" + found["special"])
        paragraphs = []
        for block in re.split(r"\n[ \t]*\n", words):
            if block.startswith("    "):
                paragraphs.append("```text\n" + block + "\n```")
            elif re.search(r"^ *- ", block, re.M):
                head, *items = re.split(r"^ *- ", block, flags=re.M)
                listed = "\n".join("* " + TOKEN.sub(token, " ".join(item.split())) for item in items)
                paragraphs.append("\n\n".join(filter(None, [TOKEN.sub(token, " ".join(head.split())), listed])))
            elif block.strip():
                paragraphs.append(TOKEN.sub(token, " ".join(block.split())))
        return "\n\n".join(paragraphs)


def cell(text):
    """In a table."""
    return text.replace("|", "\\|").replace("\n", " ")


def table(head, rows):
    lines = ["| " + " | ".join(head) + " |", "|" + "---|" * len(head)]
    return "\n".join(lines + ["| " + " | ".join(row) + " |" for row in rows])


def code(language, lines):
    return f"```{language}\n{lines.rstrip()}\n```"
