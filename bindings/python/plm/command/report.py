"""Results in words, for the terminal and for report.md."""
from ..fe.replacing import replacing


def number_text(value):
    """Six digits."""
    return f"{float(value):.6g}"


class Report:
    """Sections of facts, each a name and a text."""

    def __init__(self, title):
        self.title = title
        self._sections = []

    def add(self, title, facts):
        """facts: a list of (name, text)."""
        self._sections.append((title, [(str(name), str(text)) for name, text in facts]))

    def summary(self, without):
        """Lines for a terminal, of all sections but one."""
        return [f"{name:13s} {text}" for title, facts in self._sections if title != without for name, text in facts]

    def write(self, path, console, unread=(), files=()):
        """As Markdown, with every warning, note, place of a deck that was not taken, and what the library logged."""
        with replacing(path) as beside, open(beside, "w", encoding="utf-8") as file:
            file.write(f"# {self.title}\n")
            for title, facts in self._sections:
                file.write(f"\n## {title}\n\n| | |\n|---|---|\n")
                file.writelines(f"| {name} | {_escaped(text)} |\n" for name, text in facts)
            for title, texts in (("Warnings", console.warnings), ("Notes", console.notes), ("Not taken from the deck", unread),
                                 ("Log", [("warning: " if level > 1 else "") + text for level, text in console.log if level])):
                file.write(f"\n## {title}\n\n" + ("".join(f"* {text}\n" for text in texts) or "None.\n"))
            if files:
                file.write("\n## Files\n\n" + "".join(f"* [{name}]({name})\n" for name in files))


def _escaped(text):
    return text.replace("|", "\\|").replace("\n", " ")
