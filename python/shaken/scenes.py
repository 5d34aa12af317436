"""Scenes and settings as callers give them, as text."""
import json
from pathlib import Path
from typing import Any, Mapping, Union

from .errors import ShakenError

#: A dict as docs/scene.md has it, the text of a file, or its path: a text without "{" is a path.
Scene = Union[Mapping[str, Any], str, Path]


def is_path(scene: Scene) -> bool:
    return isinstance(scene, Path) or (isinstance(scene, str) and "{" not in scene)


def text_of(scene: Scene) -> str:
    """The text of a scene. Raises ShakenError where there is no such file, or where JSON cannot say it."""
    if isinstance(scene, Mapping):
        return json.dumps(scene, default=_plain)
    if not is_path(scene):
        return str(scene)
    try:
        return Path(scene).read_text()
    except (OSError, ValueError) as error:
        raise ShakenError(f"{scene} is no text of a scene, and no file of one: {error}") from None


def as_settings(settings: Mapping[str, Any] | None) -> list[str]:
    """{"rods.length": [2.5, 4.5]} as after `-s`, ["rods.length=2.5,4.5"]."""
    return [f"{path}={_setting(value)}" for path, value in (settings or {}).items()]


def _plain(value: Any) -> Any:
    """For JSON: the numbers of numpy as Python's."""
    if hasattr(value, "tolist"):
        return value.tolist()
    raise ShakenError(f"a scene cannot have {value!r}: only what JSON can say")


def _setting(value: Any) -> str:
    """One value, or those of a sweep with commas between them."""
    if hasattr(value, "tolist"):
        value = value.tolist()
    if isinstance(value, (list, tuple)) and not any(isinstance(v, (list, tuple)) for v in value):
        return ",".join(map(_setting, value))
    return value if isinstance(value, str) else json.dumps(value, default=_plain)
