"""Packs the package into a wheel with the standard library alone (PEP 517), so that "pip install" needs no network.

setuptools would have to be fetched by pip for every build, even where the system has it.
"""
import base64
import hashlib
import pathlib
import re
import tarfile
import zipfile

ROOT = pathlib.Path(__file__).resolve().parent


def _project():
    """The few entries of pyproject.toml that go into a wheel (tomllib is younger than Python 3.9)."""
    text = (ROOT / "pyproject.toml").read_text(encoding="utf-8")
    entry = {key: re.search(rf'^{key} = "(.*)"$', text, re.M).group(1)
             for key in ("name", "version", "description", "requires-python")}
    needs = re.findall(r'"([^"]+)"', re.search(r"^dependencies = \[(.*)\]$", text, re.M).group(1))
    extras = re.findall(r'^(\w+) = \["([^"]+)"\]$', text.split("[project.optional-dependencies]")[1], re.M)
    lines = ["Metadata-Version: 2.1", f"Name: {entry['name']}", f"Version: {entry['version']}",
             f"Summary: {entry['description']}", f"Requires-Python: {entry['requires-python']}"]
    lines += [f"Requires-Dist: {need}" for need in needs]
    for extra, need in extras:
        lines += [f"Provides-Extra: {extra}", f'Requires-Dist: {need}; extra == "{extra}"']
    return f"{entry['name']}-{entry['version']}", "\n".join(lines) + "\n"


def _scripts():
    """The commands that pip makes."""
    text = (ROOT / "pyproject.toml").read_text(encoding="utf-8")
    section = text.split("[project.scripts]")[1].split("[")[0]
    return "[console_scripts]\n" + "".join(f"{name} = {target}\n" for name, target in re.findall(r'^(\w+) = "(.+)"$', section, re.M))


def _sources():
    return sorted(path for path in (ROOT / "plm").rglob("*.py"))


def build_wheel(wheel_directory, config_settings=None, metadata_directory=None):
    name, metadata = _project()
    files = {str(path.relative_to(ROOT)): path.read_bytes() for path in _sources()}
    info = f"{name}.dist-info"
    files[f"{name}.data/data/share/man/man1/plm.1"] = (ROOT / "plm.1").read_bytes()
    files[f"{info}/METADATA"] = metadata.encode()
    files[f"{info}/entry_points.txt"] = _scripts().encode()
    files[f"{info}/WHEEL"] = b"Wheel-Version: 1.0\nGenerator: libplm\nRoot-Is-Purelib: true\nTag: py3-none-any\n"
    record = [f"{path},sha256={base64.urlsafe_b64encode(hashlib.sha256(data).digest()).rstrip(b'=').decode()},{len(data)}"
              for path, data in files.items()]
    files[f"{info}/RECORD"] = ("\n".join(record) + f"\n{info}/RECORD,,\n").encode()
    wheel = f"{name}-py3-none-any.whl"
    with zipfile.ZipFile(pathlib.Path(wheel_directory) / wheel, "w", zipfile.ZIP_DEFLATED) as archive:
        for path, data in files.items():
            archive.writestr(path, data)
    return wheel


def build_sdist(sdist_directory, config_settings=None):
    name, metadata = _project()
    archive = f"{name}.tar.gz"
    with tarfile.open(pathlib.Path(sdist_directory) / archive, "w:gz") as tar:
        for path in [ROOT / "pyproject.toml", ROOT / "_build.py", ROOT / "plm.1", *_sources()]:
            tar.add(path, f"{name}/{path.relative_to(ROOT)}")
        info = pathlib.Path(sdist_directory) / "PKG-INFO"
        info.write_text(metadata, encoding="utf-8")
        tar.add(info, f"{name}/PKG-INFO")
        info.unlink()
    return archive
