"""Packs the package into a wheel (PEP 517, PEP 427) with Python's own library, so that `pip install ./python` fetches
nothing: Debian's machines may have no way to an index. Nothing is compiled here: packaging/wheel packs what was built
as well."""
from __future__ import annotations

import base64
import hashlib
import tomllib
import zipfile
from pathlib import Path
from typing import Any, Mapping

_HERE = Path(__file__).resolve().parent
PROJECT = tomllib.loads((_HERE / "pyproject.toml").read_text())["project"]


def _metadata() -> str:
    lines = ["Metadata-Version: 2.1", f"Name: {PROJECT['name']}", f"Version: {PROJECT['version']}",
             f"Summary: {PROJECT['description']}", f"Requires-Python: {PROJECT['requires-python']}",
             f"License: {PROJECT['license']['text']}"]
    lines += [f"Classifier: {name}" for name in PROJECT["classifiers"]]
    lines += [f"Project-URL: {name}, {url}" for name, url in PROJECT.get("urls", {}).items()]
    lines += [f"Requires-Dist: {name}" for name in PROJECT["dependencies"]]
    for extra, needs in PROJECT["optional-dependencies"].items():
        lines += [f"Provides-Extra: {extra}", *(f'Requires-Dist: {name}; extra == "{extra}"' for name in needs)]
    return "\n".join(lines) + "\n"


def package() -> dict[str, bytes]:
    """The files of the package, by their paths in a wheel."""
    sources = sorted(path for path in (_HERE / "shaken").rglob("*") if path.suffix in (".py", ".json", ".typed"))
    return {str(path.relative_to(_HERE)): path.read_bytes() for path in sources}


def write_wheel(folder: str | Path, content: Mapping[str, bytes], tag: str = "py3-none-any",
                executable: tuple[str, ...] = ()) -> str:
    """A wheel in that folder, of the same bytes each time; returns its name. `executable`: what of it is run."""
    name = f"{PROJECT['name']}-{PROJECT['version']}"
    info = f"{name}.dist-info"
    is_pure = str(not executable).lower()
    files = {**content, f"{info}/METADATA": _metadata().encode(),
             f"{info}/WHEEL": f"Wheel-Version: 1.0\nGenerator: shaken\nRoot-Is-Purelib: {is_pure}\n"
                              f"Tag: {tag}\n".encode()}
    if executable:
        scripts = "".join(f"{Path(path).name} = shaken.__main__:main\n" for path in executable
                          if not path.endswith("-wide"))  # as which others go on by themselves
        files[f"{info}/entry_points.txt"] = f"[console_scripts]\n{scripts}".encode()

    def hash_of(data: bytes) -> str:
        return base64.urlsafe_b64encode(hashlib.sha256(data).digest()).rstrip(b"=").decode()

    record = [f"{path},sha256={hash_of(data)},{len(data)}" for path, data in files.items()]
    files[f"{info}/RECORD"] = ("\n".join([*record, f"{info}/RECORD,,"]) + "\n").encode()
    wheel = Path(folder) / f"{name}-{tag}.whl"
    with zipfile.ZipFile(wheel, "w", zipfile.ZIP_DEFLATED) as archive:
        for path, data in files.items():
            entry = zipfile.ZipInfo(path, (2024, 1, 1, 0, 0, 0))
            entry.compress_type = zipfile.ZIP_DEFLATED
            entry.external_attr = (0o100755 if path in executable else 0o100644) << 16
            archive.writestr(entry, data)
    return wheel.name


def build_wheel(wheel_directory: str, config_settings: Any = None, metadata_directory: Any = None) -> str:
    """Called by pip: makes the wheel in that folder and returns its name."""
    return write_wheel(wheel_directory, package())


def build_editable(wheel_directory: str, config_settings: Any = None, metadata_directory: Any = None) -> str:
    """Called by `pip install -e`: a wheel that points here."""
    return write_wheel(wheel_directory, {"shaken.pth": f"{_HERE}\n".encode()})


def get_requires_for_build_wheel(config_settings: Any = None) -> list[str]:
    return []


get_requires_for_build_editable = get_requires_for_build_wheel
