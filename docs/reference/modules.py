"""What Python has beyond the functions of C: results with names, pictures, files."""
import ast

from python_forms import PACKAGE, signature
from text import code

MODULES = ("plot", "fe")


def named_functions(path):
    """Public functions of a file, or those that a package takes from its files."""
    tree = ast.parse(path.read_text(encoding="utf-8"))
    for node in tree.body:
        if isinstance(node, ast.FunctionDef) and not node.name.startswith("_"):
            yield node
        elif isinstance(node, ast.ImportFrom) and node.level == 1 and node.module:
            source = path.parent / (node.module.replace(".", "/") + ".py")
            wanted = {alias.name for alias in node.names}
            for part in ast.parse(source.read_text(encoding="utf-8")).body if source.exists() else []:
                if isinstance(part, ast.FunctionDef) and part.name in wanted:
                    yield part


def parts_of_modules(book):
    parts = []
    for name in MODULES:
        alone, module = PACKAGE / f"{name}.py", f"plm.{name}"
        parts.append(f"## {module}")
        for node in named_functions(alone if alone.exists() else PACKAGE / name / "__init__.py"):
            parts += [f"### `{module}.{node.name}`", code("python", f"{module}.{node.name}({signature(node, False)})")]
            words = ast.get_docstring(node) or ""
            parts.append(code("text", words) if "\n\n" in words else book.linker.prose(words, "python.md"))
    parts.append("## Results with names")
    for path in sorted(PACKAGE.glob("_*.py")):
        for node in ast.parse(path.read_text(encoding="utf-8")).body:
            if isinstance(node, ast.ClassDef) and any(isinstance(base, ast.Name) and base.id == "NamedTuple" for base in node.bases):
                fields = "\n".join(f"    {part.target.id}: {ast.unparse(part.annotation)}" for part in node.body if isinstance(part, ast.AnnAssign))
                parts += [f"### `plm.{node.name}`", code("python", f"class {node.name}(NamedTuple):\n{fields}"), book.linker.prose(ast.get_docstring(node) or "", "python.md")]
    return parts
