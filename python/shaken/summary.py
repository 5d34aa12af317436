# SPDX-License-Identifier: MIT
"""What a summary.json says of its run as a whole."""
from __future__ import annotations

from typing import Any, Mapping


def version_text(versions: Any) -> str:
    """"shaken 0.1.0, physics 3" of the member `versions`; empty where it is not known."""
    if not isinstance(versions, Mapping):
        return ""
    words = [f"{what} {versions[what]}" for what in ("shaken", "physics") if versions.get(what) is not None]
    return ", ".join(words)


def has_results(state: str, summary: Mapping[str, Any] | None) -> bool:
    """Whether a run is done, or was before it went on for longer. state: of its job"""
    ended = (summary or {}).get("exit") or {}
    return state == "done" or ended.get("state") == "done" or "done_before_s" in ended
