"""What the catalogue lists stands in no second list."""
import re
from pathlib import Path

import pytest

from shaken.catalogue import JOB_STATES

_ROOT = Path(__file__).resolve().parents[2]
_STATE = f"(?:{'|'.join(JOB_STATES)})"
#: Three states behind one another: "failed", "held" or "done"; failed, held and done; failed | held | done.
_IN_A_ROW = re.compile(rf"\b{_STATE}\b(?:[\s\"'`,|/]*(?:or|and)?[\s\"'`]*\b{_STATE}\b){{2,}}")
_QUOTED = re.compile(rf"[\"'`]({_STATE})[\"'`]")
_GENERATED = re.compile("(?s): begin.*?: end")
_FOLDERS = ("base", "bench", "client", "docs", "proto", "python/shaken", "render", "run", "scene", "server", "web")


@pytest.mark.parametrize("folder", _FOLDERS)
def test_the_states_of_jobs_are_listed_once(folder):
    found = []
    for file in sorted((_ROOT / folder).glob("*.md" if folder == "docs" else "**/*.*")):
        if file.suffix not in (".cpp", ".h", ".html", ".js", ".lcm", ".md", ".py") or file.name == "job_state.h":
            continue
        text = _GENERATED.sub("", file.read_text())
        lines = text.splitlines() if file.suffix != ".md" else []
        found += [f"{file}: {match[0]}" for match in _IN_A_ROW.finditer(text)]
        found += [f"{file}: {pair}" for pair in map("\n".join, zip(lines, lines[1:]))
                  if len(set(_QUOTED.findall(pair))) > 2]
    assert not found, "base/job_state.h has what they are"
