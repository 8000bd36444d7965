"""docs/keys.md for the site: the options that most users need first, the others marked as advanced, and every key with an anchor."""
import re

from text import table

INTRODUCTION = ("The options that most users need come first in each table. Those marked *advanced* have defaults that hold for nearly every model; "
                "[choosing](choosing.md) tells when to touch them.")


def row_of(line, noun, is_basic, is_option):
    name = re.match(r"\| `(\w+)` \|", line)[1]
    marked = line.replace(f"| `{name}` |", f'| <a id="{noun}-{name}"></a>`{name}` |', 1)
    return marked if is_basic or not is_option else marked.replace("` |", "` *advanced* |", 1)


def arranged(text, basic):
    """basic: {noun: names}. Rows of options change their order, nothing is added or lost."""
    out, rows, noun, is_option = [], [], "", False

    def flush():
        names = [re.match(r"\| `(\w+)` \|", row)[1] for row in rows]
        chosen = basic.get(noun, [])
        order = sorted(range(len(rows)), key=lambda i: (chosen.index(names[i]) if names[i] in chosen else len(chosen) + i)) if is_option else range(len(rows))
        out.extend(row_of(rows[i], noun, names[i] in chosen, is_option) for i in order)
        rows.clear()

    for line in text.splitlines():
        if re.match(r"\| `\w+` \|", line):
            rows.append(line)
            continue
        flush()
        if heading := re.fullmatch(r"## `plm_(\w+)`", line):
            noun = heading[1]
        elif line.startswith(("| option", "| result")):
            is_option = line.startswith("| option")
        out.append(line)
        if heading:
            out += ["", f"Set and read by the functions of [`plm_{noun}`](reference/{noun}.md); as attributes in [Python](reference/python.md#by-key), by "
                    f"[`set` and `get` in Fortran](reference/fortran.md#by-key)."]
    flush()
    title, _, rest = "\n".join(out).partition("\n")
    return f"{title}\n\n{INTRODUCTION}\n{rest}\n"
