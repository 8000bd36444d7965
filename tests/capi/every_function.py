"""Every function of plm.h is called in some test program: every_function.py plm.h tests/"""
import pathlib
import re
import sys

sys.path.insert(0, str(pathlib.Path(__file__).resolve().parents[2] / "src/capi/api"))
import plm_header  # noqa: E402

declared = [f.name for f in plm_header.read(sys.argv[1]).functions]
code = "".join(p.read_text() for p in pathlib.Path(sys.argv[2]).rglob("*") if p.suffix in (".c", ".cpp", ".h", ".hpp"))
code = re.sub(r"/\*.*?\*/|//[^\n]*", "", code, flags=re.S)
called = set(re.findall(r"\b(plm_\w+)\s*\(", code))
missing = [name for name in declared if name not in called]
print(f"{len(declared)} functions declared, {len(missing)} not called in any test")
for name in missing:
    print("  " + name)
sys.exit(1 if missing or not declared else 0)
