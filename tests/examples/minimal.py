"""minimal.py MINIMAL EMBEDDING: docs/embedding.md says what minimal prints. (Links of all pages: docs.links.)"""
import pathlib
import subprocess
import sys

program, page = sys.argv[1], pathlib.Path(sys.argv[2])
said = subprocess.run([program], stdout=subprocess.PIPE, check=True).stdout.decode()
if f"    {said}" not in page.read_text(encoding="utf-8"):
    sys.exit(f"{page} does not show what minimal prints: {said}")
print(f"{page.name} agrees")
