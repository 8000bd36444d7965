"""keys.py LIST_KEYS PAGE: the page of keys is what the library says today."""
import difflib
import subprocess
import sys

program, page = sys.argv[1:3]
said = subprocess.run([program], stdout=subprocess.PIPE, check=True).stdout.decode().splitlines()
with open(page, encoding="utf-8") as file:
    written = file.read().splitlines()
difference = list(difflib.unified_diff(written, said, page, program, n=0, lineterm=""))
print("\n".join(difference) or f"{len(said)} lines agree")
if difference:
    sys.exit(f"out of date; renew it: {program} > {page}")
