"""What plm response says in words: report.md."""
from ..fe.replacing import replacing


def number_text(value):
    """Six digits."""
    return f"{float(value):.6g}"


def write_report(path, asked, page, console, unread=(), files=()):
    """As Markdown: what was asked for (names and values), the page of the library, then every warning, note, place of a deck that
    was not taken, and what the library logged."""
    with replacing(path) as beside, open(beside, "w", encoding="utf-8") as file:
        file.write("# Forced response\n\n## Asked for\n\n| | |\n|---|---|\n")
        file.writelines(f"| {name} | {_escaped(str(text))} |\n" for name, text in asked)
        file.write(f"\n## Result\n\n```text\n{page}```\n")
        for title, texts in (("Warnings", console.warnings), ("Notes", console.notes), ("Not taken from the deck", unread),
                             ("Log", [("warning: " if level > 1 else "") + text for level, text in console.log if level])):
            file.write(f"\n## {title}\n\n" + ("".join(f"* {text}\n" for text in texts) or "None.\n"))
        file.write("\n## Files\n\n" + "".join(f"* [{name}]({name})\n" for name in files))


def _escaped(text):
    return text.replace("|", "\\|").replace("\n", " ")
