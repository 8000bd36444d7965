"""The other files of a model: what one finds beside the stiffness matrix by its name."""
import os
import re

from ..errors import FileError
from .dof_list import read_dof_list
from .found import KINDS

# What the names of the three matrices differ in, by the habits of codes and people.
STYLES = [("stiffness", "mass", "damping"), ("stiff", "mass", "damp"), ("stif", "mass", "damp"), ("kmatrix", "mmatrix", "cmatrix"),
          ("kmat", "mmat", "cmat"), ("kaa", "maa", "baa"), ("k", "m", "c"), ("k", "m", "b")]
DOF_SUFFIXES = (".mapping", ".dof", ".dofs", ".map")


def beside(folder):
    """Name in small letters -> name, of the files of a folder."""
    return {name.lower(): name for name in sorted(os.listdir(folder or ".")) if os.path.isfile(os.path.join(folder, name))}


def with_word(stem, old, new):
    """The stem with its first or last word `old` changed to `new`; None where it has no such word."""
    pattern = rf"^{old}(?![a-z])|(?<![a-z]){old}$" if len(old) < 4 else rf"^{old}|{old}$"
    changed, count = re.subn(pattern, new, stem, count=1)
    return changed if count else None


def by_name(path):
    """{kind: path} of the matrices that go with one of them; the path itself is stiffness where its name tells nothing."""
    folder, name = os.path.split(os.fspath(path))
    stem, suffix = os.path.splitext(name.lower())
    files = beside(folder)
    for style in STYLES:
        for own, word in zip(KINDS, style):
            if with_word(stem, word, word) is None:
                continue
            others = {kind: files.get((with_word(stem, word, other) or "") + suffix) for kind, other in zip(KINDS, style)}
            others[own] = name
            found = {kind: os.path.join(folder, other) for kind, other in others.items() if other}
            if len(found) > 1:
                return found
    return {"stiffness": os.fspath(path)}


def dof_list(path):
    """The file that lists the DOFs of a matrix, by its name: x.mapping, x.dof, ... beside x.matrix or x_K.mtx. None: no file."""
    folder, name = os.path.split(os.fspath(path))
    stem = os.path.splitext(name.lower())[0]
    files = beside(folder)
    words = sorted({word for style in STYLES for word in style}, key=len, reverse=True)
    without = [(with_word(stem, word, "") or "").strip("_.- ") for word in words]
    stems = [stem, re.sub(r"_(stif|mass|dmpv|dmps)\d+$", "", stem)] + [rest for rest in without if rest]
    for candidate in stems:
        for suffix in DOF_SUFFIXES:
            if candidate + suffix in files and candidate + suffix != name.lower():
                return os.path.join(folder, files[candidate + suffix])
    return None


def chosen(path, request, guess):
    """{kind: path}: what the request names, and for the rest what the guess found beside it."""
    paths = {kind: p for kind, p in guess.items() if kind not in request.paths}
    paths.update(request.paths)
    if "stiffness" not in paths:
        raise FileError(path, 0, "is no stiffness matrix, and none was found beside it: hand its path over")
    if "mass" in paths and os.path.realpath(paths["mass"]) == os.path.realpath(paths["stiffness"]):
        # M and K in this order: the name M leads to K beside it
        raise FileError(paths["mass"], 0, "would be stiffness and mass: give the file of the stiffness first, then that of the mass")
    return paths


def read_dofs_beside(path, request, found):
    """The list of DOFs that lies beside a stiffness matrix whose file has none, unless the caller handed one over."""
    listed = dof_list(path)
    if request.dofs is None and listed:
        found.listed, notes = read_dof_list(listed)
        n = found.matrices["stiffness"].shape[0]
        if len(found.listed) != n:
            raise FileError(listed, 0, f"lists {len(found.listed)} DOFs for a matrix of {n} rows")
        found.notes += notes
        found.read_from(listed)
