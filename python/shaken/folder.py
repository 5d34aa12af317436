"""A folder of runs as a sweep: what differs between their scenes are its parameters."""
import json
from pathlib import Path
from typing import Any, Iterator, Mapping, Sequence

from .catalogue import KEYS
from .errors import ShakenError

#: What tells no points apart: replicas have other seeds, and a longer run is the same run.
_OF_RUNS = ("time.seed", "time.measure")


def flattened(members: Mapping[str, Any], prefix: str = "") -> Iterator[tuple[str, Any]]:
    """What a scene or a summary says, by paths: ("order.mean", 0.9)."""
    for key, value in members.items():
        if isinstance(value, Mapping):
            if prefix or key != "why_null":  # words about other fields
                yield from flattened(value, f"{prefix}{key}.")
        elif not isinstance(value, list) and (value is not None or prefix or key == "steady"):
            yield prefix + key, value  # None too, but of a whole block that was not measured


def parameters_of(scenes: Sequence[Mapping[str, Any]]) -> list[dict[str, Any]]:
    """Of each scene the keys that tell it from others, but seed and length of the run. A key that says no more than
    those before it, as a number of rods behind the area fraction, is left out."""
    flat = [{name: value for name, value in flattened(scene) if name in KEYS} for scene in scenes]
    found: list[dict[str, Any]] = [{} for _ in scenes]
    for key in dict.fromkeys(key for scene in flat for key in scene):
        if key in _OF_RUNS:
            continue
        with_key = [{**known, key: scene.get(key)} for known, scene in zip(found, flat)]
        if len({json.dumps(each) for each in with_key}) > len({json.dumps(each) for each in found}):
            found = with_key
    return found


def run_directories(folder: str | Path) -> list[Path]:
    """Those in a folder, at any depth, that have ended. Raises ShakenError where there are none."""
    found = sorted(summary.parent for summary in Path(folder).glob("**/summary.json")
                   if (summary.parent / "scene.json").exists())
    if not found:
        raise ShakenError(f"there are no runs in {folder} that have ended: none of its folders has a scene.json and a "
                          "summary.json")
    return found


def jobs_in(folder: str | Path) -> list[dict[str, Any]]:
    """The runs of a folder as the daemon describes jobs with their summaries (ROW of docs/protocol.md). Replicas are
    numbered by their seeds."""
    directories, scenes, summaries, problems = run_directories(folder), [], [], []
    for directory in directories:
        try:
            scene, summary = (json.loads((directory / name).read_text()) for name in ("scene.json", "summary.json"))
            if not (isinstance(scene, dict) and isinstance(summary["exit"]["state"], str) and summary["run_id"]):
                raise TypeError("the scene or the summary is none")
            scenes.append(scene)
            summaries.append(summary)
        except (OSError, ValueError, TypeError, KeyError) as problem:
            problems.append(f"{directory}: its scene.json or summary.json is damaged ({problem!r})")
    if problems:
        raise ShakenError("\n".join(problems))
    rows: list[dict[str, Any]] = []
    for directory, scene, summary, parameters in zip(directories, scenes, summaries, parameters_of(scenes)):
        rows.append({"id": summary["run_id"], "job": summary["run_id"], "sweep": Path(folder).name,
                     "name": directory.name, "state": summary["exit"]["state"], "label": directory.name,
                     "parameters": parameters, "directory": str(directory), "summary": summary,
                     "seed": (scene.get("time") or {}).get("seed", 0)})
    rows.sort(key=lambda row: (json.dumps(row["parameters"]), row.pop("seed")))
    for k, row in enumerate(rows):
        row["replica"] = rows[k - 1]["replica"] + 1 if k and rows[k - 1]["parameters"] == row["parameters"] else 1
    return rows
