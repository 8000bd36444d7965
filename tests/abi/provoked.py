#!/usr/bin/env python3
"""provoked.py SOURCE BUILD FOLDER CC CXX NM LIBPLM_SO LIBPLM_A: every gate bites. Each is given a copy in which
something is wrong, must refuse it, and must say what. docs/gates.md tells which gate guards what.
(abi.abidiff, abi.consumers, abi.barrier, host.ilp64 and host.own_solver provoke themselves, too.)"""
import pathlib
import re
import shutil
import subprocess
import sys

source, build, folder = (pathlib.Path(a).resolve() for a in sys.argv[1:4])
cc, cxx, nm, library, archive = sys.argv[4:]
tests, python = source / "tests", sys.executable
header = source / "include/plm/plm.h"
failures, count = [], 0


def refused(gate, what, said, *command):
    """The command must fail and print a line that matches `said`."""
    global count
    count += 1
    done = subprocess.run([str(c) for c in command], stdout=subprocess.PIPE, stderr=subprocess.STDOUT, text=True, check=False)
    line = next((line.strip() for line in done.stdout.splitlines() if re.search(said, line)), None)
    if done.returncode in (0, 77) or line is None:
        failures.append(f"{gate}: {what} is NOT refused as it should (exit code {done.returncode}):\n{done.stdout}")
    else:
        print(f"{gate}: {what}\n    {line}")


def changed(path, old, new, name=None):
    """A copy of a file with one change."""
    text = pathlib.Path(path).read_text(encoding="utf-8")
    out = folder / (name or pathlib.Path(path).name)
    out.parent.mkdir(parents=True, exist_ok=True)
    if not re.search(old, text, re.M):
        sys.exit(f"{path}: nothing matches {old}")
    out.write_text(re.sub(old, new, text, count=1, flags=re.M), encoding="utf-8")
    return out


def shared_object(name, code, *flags):
    (folder / f"{name}.c").write_text(code, encoding="utf-8")
    out = folder / f"{name}.so"
    subprocess.run([cc, "-shared", "-fPIC", "-Wl,-soname,libplm.so.0,-z,now", folder / f"{name}.c", *flags, "-o", out], check=True)
    return out


shutil.rmtree(folder, ignore_errors=True)
folder.mkdir(parents=True)
NEW = r"PLM_API plm_status plm_model_forget(plm_model *model);\n"
FIRST = r"^(PLM_API plm_status plm_model_build)"
grown = changed(header, FIRST, NEW + r"\1", "grown/plm/plm.h")  # a function that nothing else knows

# ---- abi
ledger = [python, tests / "abi/ledger.py", nm, library, archive]
symbols = tests / "abi/symbols.txt"
refused("abi.ledger", "a function in the header alone", "plm_model_forget: in the header, not in the ledger",
        *ledger, grown, symbols)
refused("abi.ledger", "a function taken out of the ledger", "plm_hbm_sweep: in the shared object, not in the ledger",
        *ledger, header, changed(symbols, "^plm_hbm_sweep .*\n", ""))
refused("abi.ledger", "another version for a function", "plm_hbm_sweep: introduced in 9.9 says the ledger",
        *ledger, header, changed(symbols, "^plm_hbm_sweep .*", "plm_hbm_sweep 9.9"))
refused("abi.constants", "a constant with another value", "PLM_TRUNCATED: was 2, is 7", python, tests / "abi/constants.py",
        tests / "abi/baseline/plm/plm.h", changed(header, "PLM_TRUNCATED 2", "PLM_TRUNCATED 7"))
shutil.copytree(source / "src/capi", folder / "capi")
changed(source / "src/capi/context_calls.cpp", r'return call<Context>\("plm_context_set_log"', r"check(ctx); \g<0>", "capi/context_calls.cpp")
refused("abi.barrier", "work in front of the exception barrier", "plm_context_set_log works outside the barrier", python,
        tests / "abi/barrier.py", header, folder / "capi")
changed(header, r"^(typedef int32_t plm_status;)", r"\1 // a comment of C99", "c99/plm/plm.h")
refused("abi.header", "a comment of C99 in the header", "error: C\\+\\+ style comments|error: // comments|plm.h.*error", "sh",
        tests / "abi/header.sh", cc, cxx, folder / "c99", folder / "header", library)
plain = "int plm_x(void); int plm_x(void) { return 0; }\n"
objects = ["sh", tests / "abi/object.sh"]
refused("abi.object", "another SONAME", "SONAME is not libplm.so.9", *objects, library, "libplm.so.9", "-")
refused("abi.object", "an executable stack", "executable stack", *objects,
        shared_object("stack", plain, "-Wl,-z,execstack"), "libplm.so.0", "-")
refused("abi.object", "a run path", "a run path of the build machine", *objects,
        shared_object("rpath", plain, "-Wl,-rpath,/home/me"), "libplm.so.0", "-")
refused("abi.object", "exported data", "exports data", *objects,
        shared_object("data", plain + "int plm_counter = 1;\n"), "libplm.so.0", "-")
refused("abi.object", "lazy binding", "lazy binding", *objects,
        shared_object("lazy", plain, "-Wl,-z,lazy"), "libplm.so.0", "-")
refused("abi.object", "a segment that stays writable", "no GNU_RELRO", *objects,
        shared_object("norelro", plain, "-Wl,-z,norelro"), "libplm.so.0", "-")
refused("abi.object", "a library more than is known", "also needs: libcholmod|also needs: libm|also needs", *objects,
        shared_object("needs", plain, "-Wl,--no-as-needed", "-lopenblas"), "libplm.so.0", "")
refused("install.symbols", "an export that is not plm_", "^helper|T helper", "sh", tests / "install/symbols.sh",
        shared_object("helper", "int helper(void); int helper(void) { return 0; }\n"), "libplm.so.0")

# ---- every function, in every layer
refused("capi.every_function", "a function no test calls", "plm_model_forget", python, tests / "capi/every_function.py", grown,
        tests)
layered = folder / "layered"  # the layers beside a header or a description in which something is wrong
for part in ("src/capi/api", "fortran", "include", "bindings/python/plm"):
    shutil.copytree(source / part, layered / part)
for part in ("tests/abi/symbols.txt", "CMakeLists.txt", "docs/keys.md"):
    (layered / part).parent.mkdir(parents=True, exist_ok=True)
    shutil.copy(source / part, layered / part)


def lay(new_header, old=None, new=None):
    """This header, and the description with one change, into the copy of the layers."""
    shutil.copy(new_header, layered / "include/plm/plm.h")
    changed(source / "src/capi/api.txt", old or "^", new or "", "layered/src/capi/api.txt")


def refused_by_generator(what, said, new_header, old=None, new=None):
    lay(new_header, old, new)
    refused("abi.generated", what, said, python, layered / "src/capi/api/generate.py", "--check")


DESCRIBED = ("^plm_model_build$", r"plm_model_forget\n    PLMMFO (HANDLE)\n        forget it\n\g<0>")
lay(grown, *DESCRIBED)
refused("parity.functions_cpp", "a function plm.hpp lacks", "plm_model_forget", python, tests / "parity/functions.py", cxx,
        layered / "include")
refused("fortran.covers_the_header", "a function the module lacks", "module plm: plm_model_forget", python,
        tests / "fortran/covers_the_header.py", layered)
refused_by_generator("files that lag behind", "not what plm.h and api.txt ask for: fortran/plm_c.f90, .*plmf.inc, .*symbols.txt",
                     grown, *DESCRIBED)
refused_by_generator("a function that nobody described", "plm_model_forget is not described: write its line in api.txt", grown)
refused_by_generator("a pointer that nobody described", r"plm_model_forget: double \* what is not described",
                     changed(header, FIRST, NEW.replace("*model", "*model, double *what") + r"\1"), *DESCRIBED)
refused_by_generator("a description of no function", r"api.txt:\d+: plm.h has no function plm_model_forget", header, *DESCRIBED)
refused_by_generator("a description of no argument", r"plm_model_fix_dofs_i32 has no argument 'dofs'", header,
                     "^plm_model_fix_dofs: dof", "plm_model_fix_dofs: dofs")
refused_by_generator("a size in terms of nothing", r"q\[m\]: 'm' is neither an argument nor one of the dimensions", header,
                     r"^plm_branch_get_field: q\[n\]", "plm_branch_get_field: q[m]")
refused_by_generator("a function described twice", "plm_model_fix_dofs is described a second time", header,
                     "^plm_model_fix_dofs: .*", r"\g<0>\n\g<0>")
refused_by_generator("a line that cannot be read", "'dof of n' cannot be read", header, r"^plm_model_fix_dofs: dof\[n\]",
                     "plm_model_fix_dofs: dof of n")
refused_by_generator("a constant that nobody described", "PLM_OFTEN is not described: give it six letters",
                     changed(header, "^#define PLM_TRUNCATED 2", r"#define PLM_OFTEN 2\n\g<0>"))
refused_by_generator("six letters for two functions", "PLMMBU is plm_model_fix_dofs already", header, "PLMMFX", "PLMMBU")
refused_by_generator("a function without six letters", "plm_hbm_sweep needs six letters, or a reason", header,
                     "^    PLMHSW .*\n.*\n", "")
refused_by_generator("a subroutine that lacks an argument", "PLMHSW has 1 arguments, plm_hbm_sweep needs 2: hbm, branch", header,
                     r"PLMHSW \(HANDLE, BRANCH\)", "PLMHSW (HANDLE)")
refused_by_generator("a name of two types", r"PLMHSW: COUNT is INTEGER\*8 here and INTEGER elsewhere", header,
                     r"PLMHSW \(HANDLE, BRANCH\)", "PLMHSW (HANDLE, COUNT)")
refused_by_generator("a subroutine that must be by hand", r"no rule passes int32_t \* ?closed from FORTRAN 77", header,
                     "^(    PLMRCT .*) by hand", r"\1")
refused_by_generator("a procedure of the module that is not by rule", r"plm_branch_get_energy: no rule for double \* ?energy in the",
                     header, "^plm_branch_get_energy: .*", r"\g<0>\n    by rule in module plm")
refused_by_generator("a method of Python that is not by rule", r"plm_branch_get_field: no rule for double \* ?q in Python",
                     header, "^(plm_branch_get_field: .*\n    by rule in )module plm", r"\1Python")
refused_by_generator("a method of what is no handle", "plm_version is no function of a handle with letters", header,
                     "^plm_version: .*", r"\g<0>\n    by rule in Python")
changed(source / "docs/keys.md", r"^\| `n_free` \|", "| `estimate_memory` |", "layered/docs/keys.md")
refused_by_generator("a method named like a key", 'plm_model_estimate_memory: model has the key "estimate_memory" already', header)
shutil.copy(source / "docs/keys.md", layered / "docs/keys.md")
lay(header)
changed(source / "fortran/plm_model.f90", r"plm_model_fix_dofs\(", "plm_model_fix_dofs_i32(", "layered/fortran/plm_model.f90")
refused("abi.generated", "twins that lag behind", "not what plm.h and api.txt ask for: fortran/plm_model_int64.inc", python,
        layered / "src/capi/api/generate.py", "--check")
layer = [source / "fortran" / name for name in ("plm_f77.f90", "plm_f77_calls.f90", "plm_f77_keys.f90", "plm_f77_bytes.f90")]
refused("fortran.include_file", "a handle named like an INTEGER", r"PLMHSO: ISTART is INTEGER by the rule .*INTEGER\*8 in", python,
        tests / "fortran/include_file.py", changed(source / "fortran/plmf.inc", "FREQ, START, IPOINT", "FREQ, ISTART, IPOINT"), *layer)
refused("docs.every_function_has_an_example", "a function without an example", "plm_model_forget: no example", python,
        tests / "docs/every_function.py", source, grown)

# ---- pages and numbers
scenario = build / "tests/parity/scenario.txt"
refused("parity.*", "the last bit of one number in one language", "line 90 .*in the reference", python,
        tests / "parity/compare.py", scenario, "--", "awk",
        r'NR == 90 { printf "%.17g\n", $0 * (1 + 2.3e-16); next } { print }', scenario)
refused("install.readme", "a recipe that lost its mark", "mark the files", python, tests / "install/recipes.py",
        source / "README.md", changed(source / "docs/embedding.md", "<!-- run: make -->", ""), folder, folder)
lister = build / "examples/c/list_keys"
if lister.exists():
    refused("examples.keys", "a page of keys that lags behind", "out of date; renew it", python, tests / "examples/keys.py",
            lister, changed(source / "docs/keys.md", "`n_samples`", "`samples`"))
shutil.copytree(source / "examples/reports", folder / "pages/examples/reports")
shutil.copy(source / "README.md", folder / "pages")
(folder / "pages/docs").mkdir()
shutil.copy(source / "docs/benchmarks.md", folder / "pages/docs")
changed(source / "examples/reports/README.md", r"^\| refined .*", "| refined | yes | 1 |", "pages/examples/reports/README.md")
refused("docs.reports", "figures that are in no report", "README.md is not what the reports say", python,
        folder / "pages/examples/reports/index.py", "--check")
tree = folder / "tree"  # pages beside the files that they lead to
for name in ("docs", "examples", "include", "src", "fortran", "tests", "bindings"):
    shutil.copytree(source / name, tree / name, ignore=shutil.ignore_patterns("__pycache__"))
for path in [*source.glob("*.md"), source / "LICENSE", source / "CITATION.cff"]:
    shutil.copy(path, tree)
changed(source / "docs/tutorial.md", r"\(choosing\.md#contact-stiffness\)", "(choosing.md#stiffness)", "tree/docs/tutorial.md")
refused("docs.links", "a link to a heading that was renamed", "tutorial.md:.*choosing.md has no heading #stiffness", python,
        tests / "docs/links.py", tree)
changed(source / "docs/choosing.md", r"^\| `PLM_REASON_TIE`.*\n", "", "tree/docs/choosing.md")
refused("docs.reasons", "a reason without a row", "PLM_REASON_TIE: no row", python, tests / "docs/reasons.py", tree)
changed(source / "docs/choosing.md", "may be on another branch", "may lie on another branch", "tree/docs/choosing.md")
refused("docs.reasons", "words that no text has", "no text of the library says 'may lie on another branch'", python,
        tests / "docs/reasons.py", tree)
changed(source / "docs/warnings.md", r'^\| "join component".*\n', "", "tree/docs/warnings.md")
refused("docs.warnings", "a text without a row", "no words of docs/warnings.md are in '.*join component", python, tests / "docs/warning_words.py",
        tree)
changed(source / "docs/warnings.md", '"join component"', '"couple component"', "tree/docs/warnings.md")
refused("docs.warnings", "words that no text has", "no warning has the words 'couple component'", python, tests / "docs/warning_words.py", tree)
(tree / "src/space/rest.hpp").unlink()
refused("docs.sources", "a source file that moved", "Rest: space/rest.hpp is not at src/space/rest.hpp", python,
        tests / "docs/sources.py", tree)
changed(source / "README.md", "^Both want Debian", "Both " + "and both " * 30 + "want Debian", "tree/README.md")
refused("docs.words", "a sentence of more than 35 words", r"README.md:\d+: \d+ words: Both and", python, tests / "docs/words.py", tree,
        tree / "README.md")
refused("docs.citation", "a version that went on", "CITATION.cff is of version .*, the project of 99.0.0", python,
        tests / "docs/citation.py", tree, "99.0.0")
for name in ("reference", "examples"):
    shutil.copytree(source / "docs" / name, layered / "docs" / name)
for page in (source / "docs").glob("*.md"):
    shutil.copy(page, layered / "docs" / page.name)
lay(grown, *DESCRIBED)
refused("docs.reference", "a function that no language has", "PLMMFO is in none of fortran/plm_f77", python,
        tests / "docs/reference.py", layered)

# ---- the house
rooms = folder / "rooms"
shutil.copytree(source / "src", rooms)
with (rooms / "linalg/dense.hpp").open("a", encoding="utf-8") as file:
    file.write('#include "space/space.hpp"\n')
refused("house.includes", "a room that looks upwards", "dense.hpp:[0-9]+: linalg must not include space/space", python,
        tests / "house/includes.py", rooms)
refused("house.includes", "parts that include one another", "linalg/dense .*space/space .*include one another", python,
        tests / "house/includes.py", rooms)
changed(source / "src/structure/tall_by_host.cpp", r"\bFactorByHost\b", "HostFactor", "rooms/structure/tall_by_host.cpp")
refused("house.names", "one name for two things", "HostFactor stands in structure/solver/factor_host.cpp and structure/tall_by_host.cpp", python,
        tests / "house/names.py", rooms)
changed(source / "src/space/audit.cpp", "Fix DOFs; ", "Call plm_model_fix_dofs; ", "rooms/space/audit.cpp")
refused("house.texts", "a text for C alone", r"space/audit\.cpp:[0-9]+: a text names a C function: .*plm_model_fix_dofs", python,
        tests / "house/texts.py", rooms)
changed(source / "src/capi/sampler.cpp", "; run it first", "; \"\n    \"call plm_sampler_run first", "rooms/capi/sampler.cpp")
refused("house.texts", "the same in capi", r"capi/sampler\.cpp:[0-9]+: a text names a C function: .*plm_sampler_run", python,
        tests / "house/texts.py", rooms)
for n in range(31):
    (rooms / f"space/knows_{n}.cpp").write_text("bool all() { return states.n_closed() == z; }\n", encoding="utf-8")
refused("house.counts", "states of a pair known in 31 more files", "[0-9]+ files outside contact know the states of a pair: more than 32",
        python, tests / "house/counts.py", rooms)
(rooms / "hbm/tall.cpp").write_text("SparseMatrix k;\n", encoding="utf-8")
refused("house.counts", "a full-size matrix outside structure", "1 files outside structure use full-size matrices", python,
        tests / "house/counts.py", rooms)
(rooms / "hbm/share.cpp").write_text("double mine(double accuracy) { return 0.3 * accuracy; }\n", encoding="utf-8")
refused("house.counts", "an accuracy divided elsewhere", "2 files take a share of an accuracy", python, tests / "house/counts.py", rooms)
(rooms / "searches/large.cpp").write_text("constexpr double one = 1, two = 2;\n" + "\n" * 500, encoding="utf-8")
refused("house.counts", "a room that grows", "[0-9]+ lines in searches: none, or more", python, tests / "house/counts.py", rooms)
refused("house.counts", "constants that tune it", "[0-9]+ tuning constants in searches: none, or more", python, tests / "house/counts.py",
        rooms)
refused("house.counts", "a sense that no longer occurs", "has no other sense in reduction/lelsm", python, tests / "house/counts.py",
        changed(source / "src/reduction/lelsm.cpp", "(?s).*", "", "rooms/reduction/lelsm.cpp").parents[1])

# ---- hosts
if shutil.which("valgrind"):
    (folder / "leak.c").write_text("#include <stdlib.h>\nvoid *volatile p;\nint main(void) { p = malloc(8); p = 0; return 0; }\n",
                                   encoding="utf-8")
    subprocess.run([cc, folder / "leak.c", "-o", folder / "leak"], check=True)
    refused("host.valgrind", "eight bytes lost", "definitely lost: 8 bytes|8 bytes in 1 blocks", "sh",
            tests / "host/valgrind.sh", folder / "leak")

print("\n".join(failures) or f"{count} provocations, each refused")
sys.exit(bool(failures))
