#!/usr/bin/env python3
"""paper_model.py PAGE [--check]: what the set-up of larger blocks would take, computed from the row of one rank in the table that
measure_team.py made for the page. With --check: whether the page shows just this.

Nested dissection of a block in three directions: entries of the factor grow as n^(4/3), its operations as n^2; solutions, products and
vectors as the entries they read. Pairs grow as the section, n^(2/3), and with them the solutions for contact. What ranks lose to each
other is assumed, not measured, beyond four of them."""
import re
import sys

page, check = sys.argv[1], "--check" in sys.argv[2:]
text = open(page, encoding="utf-8").read()
dofs = int(re.search(r"^(\d+) DOFs$", text, re.MULTILINE).group(1))
row = re.search(r"^\| team \| 1 \|(.*)\|$", text, re.MULTILINE).group(1).split("|")
_, _, modes, count, contact, _, _, mib = (float(x) for x in row[:8])
share = {1: (1, 1), 64: (0.5, 0.3), 1000: (0.25, 0.1)}  # of the ranks' power that is left in the factorization, in solutions


def duration(s):
    return f"{s:.0f} s" if s < 600 else f"{s / 60:.0f} min" if s < 36000 else f"{s / 3600:.0f} h"


lines = ["| DOFs | ranks | GiB, a rank | count | 30 modes | samples, basis |", "|--:|--:|--:|--:|--:|--:|"]
for n in (1e6, 1e7, 1e8):
    for p, (in_factor, in_solutions) in share.items():
        g = n / dofs
        cells = (f"{mib / 1024 * g ** (4 / 3) / p * (1 if p == 1 else 1.4):.1f}", duration(count * g**2 / (p * in_factor)),
                 duration(modes * g ** (4 / 3) / (p * in_solutions)), duration(contact * g**2 / (p * in_solutions)))
        lines.append(f"| {n:.0e} | {p} | {' | '.join(cells)} |")
table = "\n".join(lines)
print(table)
if check and table not in text:
    sys.exit(f"{page} does not show this")
