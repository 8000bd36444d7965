"""Mutations of src, each met by the tests or not: mutate.py [--count N] [--seed S] [--room ROOM] [--named] [--minutes M] [--work FOLDER] [--markdown FILE]

Each mutation changes one place of one line: a sign, a comparison, a constant, the larger for the smaller, a condition, a statement
that is dropped. First come those of named.txt, then places drawn by the seed, the same number in each room. The line is changed in a
copy of the tree (--work) with checked indices, never here; the tests of its room that are quick are built and run, those of the C
API after them where they see nothing. What comes of each is kept in results.json of that folder, so that a run goes on where it was
stopped. A mutation that survives is a test that is missing, or changes nothing that may be relied on: which of the two, and why, is
written in judged.txt. Ends with 1 where one survived that is not judged.
"""
import argparse
import collections
import json
import os
import pathlib
import random
import re
import resource
import shutil
import subprocess
import sys
import time

HERE = pathlib.Path(__file__).resolve().parent
ROOT = HERE.parents[1]
# The quick tests of each room, another's with its name; those that include the header of the file come before them.
ROOMS = {"linalg": "lapack general lu dft lanes parallel", "paths": "continuation passed_points", "structure": "sparse combination rigid_modes gap_rows",
         "contact": "contact contact_force contact_sweep pair_states piece_penetrations polynomial",
         "space": "model rest linear_contact space_vectors ritz_vectors memory_estimate", "sampling": "window offset selection clusters",
         "reduction": "conditioning basis pair_sampling projection", "motions": "branch free_motion",
         "orbits": "settling flow monodromy orbit_equations exact_equations", "hbm": "systems formulation harmonic_choice longer_period",
         "searches": "response bifurcations point_harmonics capi.search", "study": "curve_distance plane_curve recipe capi.study",
         "capi": "handles scales arguments models keys branch search search_calls"}
OF_ALL = ("test_capi_models", "test_capi_superelement", "test_capi_scales")  # for what the tests of a room do not see
QUICK, MOST_DIRECT = 10.0, 3  # seconds of the processor a program may take; how many that include the header
PATIENCE = 20  # times as long as it takes without a mutation: no end

OPERATORS = [(re.compile(old), new) for old, new in (
    (r" \+ ", " - "), (r" - ", " + "), (r" \* ", " / "), (r" / ", " * "), (r" \+= ", " -= "), (r" -= ", " += "),
    (r" < ", " <= "), (r" <= ", " < "), (r" > ", " >= "), (r" >= ", " > "), (r" < ", " > "), (r" > ", " < "),
    (r" == ", " != "), (r" != ", " == "), (r" && ", " || "), (r" \|\| ", " && "), (r"std::max\(", "std::min("),
    (r"std::min\(", "std::max("), (r"std::abs\(", "("), (r"\bif \(!", "if ("), (r"\bif \((?=[^!;]+\) [a-z+-])", "if (!"),
    (r"return true;", "return false;"), (r"return false;", "return true;"), (r"\b0\.5\b", "0.6"), (r"(?<= )2 \*", "3 *"),
    (r"\+ 1\b", "+ 2"), (r"- 1\b", "- 2"), (r"= 0;", "= 1;"), (r"= 1;", "= 2;"), (r"\b1e-(\d+)\b", r"1e-1\1"),
    (r"^(\s+)(?:[a-z_]+(?:\.|->))?[a-z_]+\([^;{}]*\);$", r"\1;"), (r"^(\s+)[a-z_.\[\]>-]+ [+*-]?= [^;{}]+;$", r"\1;"))]

Mutation = collections.namedtuple("Mutation", "file line old new")


def code_of(line):
    """The line where nothing but code is: empty for comments, texts, directives and declarations that no operator should touch."""
    if re.match(r"\s*(//|#|\*|template|using|static_assert)", line) or '"' in line or "format(" in line:
        return ""
    return line.split(" //")[0].rstrip()


def candidates(file):
    """Every mutation of a file."""
    lines = (ROOT / file).read_text(encoding="utf-8").splitlines()
    for number, line in enumerate(lines):
        code = code_of(line)
        for pattern, new in OPERATORS:
            for at in pattern.finditer(code):
                changed = code[:at.start()] + at.expand(new) + code[at.end():]
                if changed != code:
                    yield Mutation(file, number, line, changed)


def drawn(seed, count, rooms):
    """As many of each room, room by room in turn; files and lines by chance."""
    chosen = []
    for room in rooms:
        rng = random.Random(f"{seed} {room}")
        files = sorted(str(f.relative_to(ROOT)) for f in (ROOT / "src" / room).rglob("*.cpp")
                       if f.parent.name != "carried")  # those are in no build of the preset
        of = [list(candidates(rng.choice(files))) for _ in range(4 * -(-count // len(rooms)))]
        chosen.append([rng.choice(places) for places in of if places][:-(-count // len(rooms))])
    return [m for turn in zip(*chosen) for m in turn]


def table_of(name, columns):
    """Lines of a text file, columns parted by ' | '."""
    rows = []
    for line in (HERE / name).read_text(encoding="utf-8").splitlines():
        if line.strip() and not line.startswith("#"):
            row = [part.strip() for part in line.split(" | ")]
            if len(row) != columns:
                sys.exit(f"{name}: {len(row)} columns for {columns}: {line}")
            rows.append(row)
    return rows


def named():
    """The list of named.txt: file | what stands there | what shall stand there; it must stand there once."""
    for file, old, new in table_of("named.txt", 3):
        lines = (ROOT / file).read_text(encoding="utf-8").splitlines()
        at = [k for k, line in enumerate(lines) if old in line]
        if len(at) != 1:
            sys.exit(f"named.txt: {len(at)} lines of {file} have: {old}")
        yield Mutation(file, at[0], lines[at[0]], lines[at[0]].replace(old, new))


class Tree:
    """A copy of the tree with its build."""

    def __init__(self, work):
        self.top = work / "tree"
        self.build_folder = self.top / "build" / "dev"
        names = subprocess.run(["git", "ls-files", "-z"], cwd=ROOT, capture_output=True, check=True).stdout.decode().split("\0")
        for name in filter(None, names):
            source, copy = ROOT / name, self.top / name
            if source.is_file() and not (copy.is_file() and copy.read_bytes() == source.read_bytes()):
                copy.parent.mkdir(parents=True, exist_ok=True)
                shutil.copy(source, copy)
        subprocess.run(["cmake", "--preset", "dev", "-DPLM_UNITY=OFF", "-DPLM_CHECKED=ON"], cwd=self.top, check=True, stdout=subprocess.DEVNULL)
        targets = subprocess.run(["cmake", "--build", "--preset", "dev", "--target", "help"], cwd=self.top, capture_output=True,
                                 text=True, check=True).stdout
        self.programs = set(re.findall(r"\b(test_\w+)(?::|$)", targets, re.M))

    def build(self, targets):
        done = subprocess.run(["cmake", "--build", "--preset", "dev", "--parallel", "2", "--target", *targets], cwd=self.top,
                              stdout=subprocess.DEVNULL, stderr=subprocess.DEVNULL)
        return done.returncode == 0

    def run(self, program, limit):
        """None: passed; else how it failed."""
        path = next(self.build_folder.glob(f"tests/*/{program}"))
        try:
            # in the folder of the build, as by ctest
            done = subprocess.run([str(path)], cwd=path.parent, timeout=limit, stdout=subprocess.DEVNULL,
                                  stderr=subprocess.DEVNULL)
        except subprocess.TimeoutExpired:
            return "no end"
        return None if done.returncode == 0 else "failed" if done.returncode > 0 else f"signal {-done.returncode}"

    def tests_of(self, file):
        """Two rounds: those that include its header and the quick ones of its room, then some of the C API."""
        room, header = file.split("/")[1], file[4:].replace(".cpp", ".hpp")
        direct = [f"test_{path.parent.name}_{path.stem[5:]}" for path in sorted((ROOT / "tests").glob("*/test_*.cpp"))
                  if f'"{header}"' in path.read_text(encoding="utf-8")]
        direct.sort(key=lambda program: (file.split("/")[-1][:-4] not in program, f"_{room}_" not in program))
        room_tests = [f"test_{name.replace('.', '_')}" if "." in name else f"test_{room}_{name}" for name in ROOMS[room].split()]
        first = [p for p in dict.fromkeys(direct[:MOST_DIRECT] + room_tests) if p in self.programs]
        return first, [p for p in OF_ALL if p in self.programs and p not in first]

    def quick(self, programs, remember):
        """Those that pass without a mutation and take little."""
        new = [p for p in programs if p not in remember]
        if new and not self.build(new):
            sys.exit(f"the tree does not build: {' '.join(new)}")
        for program in new:
            before, begin = resource.getrusage(resource.RUSAGE_CHILDREN).ru_utime, time.time()
            failed = self.run(program, 8 * QUICK)
            spent = resource.getrusage(resource.RUSAGE_CHILDREN).ru_utime - before
            remember[program] = {"seconds": spent, "waited": time.time() - begin, "failed": failed}
        return [p for p in programs if not remember[p]["failed"] and remember[p]["seconds"] < QUICK]

    def outcome(self, mutation, known):
        """(caught, survived or nothing built, by what)."""
        rounds = [self.quick(programs, known) for programs in self.tests_of(mutation.file)]
        file = self.top / mutation.file
        whole = file.read_text(encoding="utf-8")
        lines = whole.split("\n")
        lines[mutation.line] = mutation.new
        file.write_text("\n".join(lines), encoding="utf-8")
        try:
            for programs in rounds:
                if not self.build(programs):
                    return "does not compile", ""
                for program in programs:
                    failed = self.run(program, 5 + PATIENCE * known[program]["seconds"] + 2 * known[program]["waited"])
                    if failed:
                        return "caught", program[5:].replace("_", ".", 1) + ("" if failed == "failed" else f" ({failed})")
            return "survived", ""
        finally:
            file.write_text(whole, encoding="utf-8")


def judgements():
    """{(file, changed line): reason}"""
    return {(file, new): reason for file, new, reason in table_of("judged.txt", 3)}


def page(results, left, command):
    """Markdown: a row for each room and one for all, then what survived."""
    judged = judgements()
    reason = lambda r: judged.get((r["file"], r["new"].strip()), "")
    text = ["# Mutations", "", f"    {command}", "", __doc__.split("\n\n")[1], "",
            *([f"{left} of those drawn have not been run yet: the same command goes on with them.", ""] if left else []),
            "| room | mutations | caught | survived | of these judged |", "|---|---|---|---|---|"]
    for room in (*ROOMS, "all"):
        of = [r for r in results if room in (r["file"].split("/")[1], "all")]
        alive = [r for r in of if r["outcome"] == "survived"]
        text.append(f"| {room} | {len(of)} | {len(of) - len(alive)} | {len(alive)} | {sum(bool(reason(r)) for r in alive)} |")
    text += ["", "What survived:", "", "| where | instead of | stands | judgement |", "|---|---|---|---|"]
    cell = lambda line: "`" + line.strip().replace("|", "\\|") + "`"
    text += [f"| {r['file'][4:]} | {cell(r['old'])} | {cell(r['new'])} | {reason(r) or 'not judged'} |" for r in results
             if r["outcome"] == "survived"]
    return "\n".join(text + [""])


def main():
    parser = argparse.ArgumentParser(description=__doc__.splitlines()[0])
    parser.add_argument("--count", type=int, default=120, help="drawn by chance, beside those of named.txt")
    parser.add_argument("--seed", type=int, default=1)
    parser.add_argument("--room", choices=ROOMS)
    parser.add_argument("--named", action="store_true", help="those of named.txt alone")
    parser.add_argument("--minutes", type=float, default=float("inf"), help="begin no further one after so many; the table says what there is")
    parser.add_argument("--work", type=pathlib.Path, default=ROOT / "build" / "mutation")
    parser.add_argument("--markdown", default="", metavar="FILE")
    a = parser.parse_args()
    rooms = (a.room,) if a.room else tuple(ROOMS)
    mutations = [m for m in named() if m.file.split("/")[1] in rooms] + ([] if a.named else drawn(a.seed, a.count, rooms))
    mutations = list(dict.fromkeys(mutations))
    a.work.mkdir(parents=True, exist_ok=True)
    memory = a.work / "results.json"
    kept = json.loads(memory.read_text()) if memory.is_file() else {"times": {}, "outcomes": {}}
    tree = Tree(a.work.resolve())
    results, left, begin = [], 0, time.time()
    for m in mutations:
        key = f"{m.file} | {m.old} | {m.new}"
        if key not in kept["outcomes"]:
            if time.time() - begin > 60 * a.minutes:
                left += 1
                continue
            kept["outcomes"][key] = tree.outcome(m, kept["times"])
            memory.write_text(json.dumps(kept, indent=1))
        outcome, by = kept["outcomes"][key]
        print(f"{outcome:16s} {m.file}:{m.line + 1}: {m.old.strip()}  ->  {m.new.strip()}  [{by}]", flush=True)
        if outcome != "does not compile":
            results.append(dict(file=m.file, old=m.old, new=m.new, outcome=outcome, by=by))
    text = page(results, left, "nice python3 tests/mutation/mutate.py " + " ".join(sys.argv[1:]))
    print(text)
    if a.markdown:
        pathlib.Path(a.markdown).write_text(text, encoding="utf-8")
    judged = judgements()
    sys.exit(any(r["outcome"] == "survived" and (r["file"], r["new"].strip()) not in judged for r in results))


if __name__ == "__main__":
    main()
