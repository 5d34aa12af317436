"""Packs the package into a wheel (PEP 517, PEP 427) with Python's own library, so that `pip install ./python` fetches
nothing: Debian's machines may have no way to an index, and there is nothing to compile."""
from __future__ import annotations

import base64
import hashlib
import re
import zipfile
from pathlib import Path
from typing import Any

_HERE = Path(__file__).resolve().parent


def _field(name: str) -> str:
    match = re.search(rf'^{name} = "(.*)"$', (_HERE / "pyproject.toml").read_text(), flags=re.M)
    assert match, f"pyproject.toml has no {name}"
    return match[1]


def _metadata() -> str:
    needs = re.search(r"^dependencies = \[(.*)\]$", (_HERE / "pyproject.toml").read_text(), flags=re.M)
    assert needs
    lines = ["Metadata-Version: 2.1", f"Name: {_field('name')}", f"Version: {_field('version')}",
             f"Summary: {_field('description')}", f"Requires-Python: {_field('requires-python')}", "License: MIT"]
    lines += [f"Requires-Dist: {name}" for name in re.findall(r'"([^"]+)"', needs[1])]
    return "\n".join(lines) + "\n"


def _wheel(folder: str, content: dict[str, bytes]) -> str:
    name = f"{_field('name')}-{_field('version')}"
    info = f"{name}.dist-info"
    files = {**content, f"{info}/METADATA": _metadata().encode(),
             f"{info}/WHEEL": b"Wheel-Version: 1.0\nGenerator: shaken\nRoot-Is-Purelib: true\nTag: py3-none-any\n"}

    def hash_of(data: bytes) -> str:
        return base64.urlsafe_b64encode(hashlib.sha256(data).digest()).rstrip(b"=").decode()

    record = [f"{path},sha256={hash_of(data)},{len(data)}"
              for path, data in files.items()]
    files[f"{info}/RECORD"] = ("\n".join([*record, f"{info}/RECORD,,"]) + "\n").encode()
    wheel = Path(folder) / f"{name}-py3-none-any.whl"
    with zipfile.ZipFile(wheel, "w", zipfile.ZIP_DEFLATED) as archive:
        for path, data in files.items():
            archive.writestr(zipfile.ZipInfo(path, (2024, 1, 1, 0, 0, 0)), data)
    return wheel.name


def build_wheel(wheel_directory: str, config_settings: Any = None, metadata_directory: Any = None) -> str:
    """Called by pip: makes the wheel in that folder and returns its name."""
    sources = sorted(path for path in (_HERE / "shaken").rglob("*") if path.is_file() and path.suffix != ".pyc")
    return _wheel(wheel_directory, {str(path.relative_to(_HERE)): path.read_bytes() for path in sources})


def build_editable(wheel_directory: str, config_settings: Any = None, metadata_directory: Any = None) -> str:
    """Called by `pip install -e`: a wheel that points here."""
    return _wheel(wheel_directory, {"shaken.pth": f"{_HERE}\n".encode()})


def get_requires_for_build_wheel(config_settings: Any = None) -> list[str]:
    return []


get_requires_for_build_editable = get_requires_for_build_wheel
