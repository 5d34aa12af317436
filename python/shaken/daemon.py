"""The daemon: what `shaken submit`, `wait` and `cancel` do, from Python."""
import http.client
import json
import os
import re
import socket
import sys
import time
import urllib.parse
from pathlib import Path
from typing import Any, Callable, Mapping

from .errors import DaemonFailed, NoDaemon, NotFound, ShakenError
from .scenes import Scene, as_settings, is_path, text_of
from .units import seconds

#: Wall time for which `wait` waits for a daemon that is away, as while it is restarted [s]; `shaken wait` as long.
_MAY_BE_AWAY = 10.0


def root_folder(root: str | Path | None = None) -> Path:
    """`root`; if that is None, $SHAKEN_ROOT, else $XDG_DATA_HOME/shaken, else ~/.local/share/shaken. Relative paths in
    the last two are ignored, as the XDG base directory specification has it: they would be another root in every
    folder."""
    if root is not None:
        return Path(root)
    if os.environ.get("SHAKEN_ROOT"):
        return Path(os.environ["SHAKEN_ROOT"])
    data = os.environ.get("XDG_DATA_HOME", "")
    if os.path.isabs(data):
        return Path(data) / "shaken"
    home = os.environ.get("HOME", "")
    if not os.path.isabs(home):
        raise ShakenError("no root directory: set SHAKEN_ROOT, or HOME to an absolute path")
    return Path(home) / ".local" / "share" / "shaken"


class _Connection(http.client.HTTPConnection):
    """HTTP on a Unix socket."""

    def __init__(self, path: Path, timeout: float) -> None:
        super().__init__("shaken", timeout=timeout)
        self._path = path

    def connect(self) -> None:
        self.sock = socket.socket(socket.AF_UNIX, socket.SOCK_STREAM)
        self.sock.settimeout(self.timeout)
        self.sock.connect(str(self._path))


class Daemon:
    """A running shakend, asked over its socket (docs/protocol.md).

    `root` is its folder: $SHAKEN_ROOT, else ~/.local/share/shaken, if left out. All methods raise ShakenError with the
    daemon's own words where it refuses, and NoDaemon where none answers within `patience` [s].
    """

    def __init__(self, root: str | Path | None = None, patience: float = 0.0) -> None:
        self.root, self.patience = root_folder(root), patience

    def ask(self, method: str, path: str, body: Mapping[str, Any] | None = None) -> dict[str, Any]:
        """The answer to a request of docs/protocol.md: `ask("GET", "/v1/status")`."""
        end = time.monotonic() + self.patience
        while True:
            try:
                return self._ask(method, path, body)
            except NoDaemon:
                if time.monotonic() >= end:
                    raise
                time.sleep(0.2)

    def _ask(self, method: str, path: str, body: Mapping[str, Any] | None) -> dict[str, Any]:
        connection = _Connection(self.root / "shakend.sock", timeout=130)
        try:
            text = None if body is None else json.dumps(body)
            connection.request(method, path, text, {} if text is None else {"Content-Type": "application/json"})
            response = connection.getresponse()
            answer = json.loads(response.read())
        except (FileNotFoundError, ConnectionRefusedError):
            raise NoDaemon(f"no daemon runs at {self.root}: start one with `shakend --root {self.root}`") from None
        except (ConnectionResetError, BrokenPipeError, http.client.IncompleteRead) as error:
            # it has ended meanwhile; whatever can be asked may be asked twice
            raise NoDaemon(f"the daemon at {self.root} gave no answer: {error}") from None
        except (OSError, ValueError, http.client.HTTPException) as error:
            raise DaemonFailed(f"the daemon at {self.root} gave no answer: {error}") from None
        finally:
            connection.close()
        if response.status >= 400:
            problems = [_problem_text(problem) for problem in answer.get("problems", [])]
            refusal = (DaemonFailed if response.status >= 500 else NotFound if response.status == 404 else
                       ShakenError)
            raise refusal("\n".join(problems or [answer.get("error", f"HTTP {response.status}")]))
        return answer

    def status(self) -> dict[str, Any]:
        """STATUS of docs/protocol.md: version, slots, counts of jobs."""
        return self.ask("GET", "/v1/status")

    def sweeps(self) -> list[dict[str, Any]]:
        """All sweeps, the newest last."""
        return self.ask("GET", "/v1/sweeps")["sweeps"]

    def jobs(self, sweep: str) -> list[dict[str, Any]]:
        """The jobs of a sweep, by its id ("s1") or its name, in the order of its points."""
        return self.ask("GET", "/v1/sweeps/" + quoted(sweep))["jobs"]

    def rows(self, sweep: str) -> list[dict[str, Any]]:
        """The jobs of a sweep with the summaries of those that have ended (ROW of docs/protocol.md)."""
        return self.ask("GET", "/v1/results?sweep=" + quoted(sweep))["rows"]

    def submit(self, scene: Scene, *, replicas: int | None = None, name: str | None = None,
               settings: Mapping[str, Any] | None = None, priority: int = 0, **terms: Any) -> str:
        """Queues a scene (docs/scene.md) or a sweep (docs/sweeps.md), a dict, the text of a file or its path, and
        returns the id of its sweep. Points that are done already are not done again. A text without "{" is a path.

        settings: keys that are set, or swept by several values: {"rods.length": [2.5, 4.5]}; a value is a text as on
                  the command line, or what JSON can say
        terms:    soft_limit_s, time_limit_s, at_most, after, stop_if, as in SUBMISSION of docs/protocol.md

        Raises ShakenError with all problems of the scene; nothing is queued then.
        """
        request: dict[str, Any] = {"priority": priority, **terms}
        if is_path(scene):
            request["file"] = str(scene)
        request["text"] = text_of(scene)
        if settings:
            request["settings"] = as_settings(settings)
        for key, value in (("replicas", replicas), ("name", name)):
            if value is not None:
                request[key] = value
        return self.ask("POST", "/v1/sweeps", request)["sweep"]["id"]

    def wait(self, sweep: str, *, timeout: float | str | None = None,
             progress: Callable[[dict[str, Any]], None] | bool = True, every: float = 1.0) -> dict[str, int]:
        """Waits until all jobs of a sweep have ended, as `shaken wait` does, and returns how many are in which state.
        What is held has not ended. A daemon that is restarted meanwhile is waited for.

        timeout:  [s] or "10 min"; raises ShakenError when it is over
        progress: True prints a line with the time left where stderr is a terminal; a function gets the SWEEP of
                  docs/protocol.md at each look
        """
        end = None if timeout is None else time.monotonic() + seconds(timeout)
        show = progress if callable(progress) else (_print_progress if progress and sys.stderr.isatty() else None)
        daemon = self
        while True:
            found = daemon.ask("GET", "/v1/sweeps/" + quoted(sweep))["sweep"]
            daemon = Daemon(self.root, max(self.patience, _MAY_BE_AWAY))  # it has been there
            if show:
                show(found)
            counts = {state: n for state, n in found["counts"].items() if n}
            if found["n_ended"] == found["n_jobs"]:
                return counts
            if end is not None and time.monotonic() >= end:
                raise ShakenError(f"sweep {sweep} has not ended after {timeout}: {counts}")
            time.sleep(every)

    def cancel(self, sweep_or_job: str) -> int:
        """Cancels a sweep ("s1") or a job; returns how many jobs were changed. Their checkpoints stay."""
        is_job = re.fullmatch("[0-9a-f]{4,16}", sweep_or_job) and sweep_or_job not in {s["name"] for s in self.sweeps()}
        kind = "jobs" if is_job else "sweeps"
        return self.ask("POST", f"/v1/{kind}/{quoted(sweep_or_job)}/cancel")["cancelled"]


def quoted(word: str) -> str:
    """A name in the path of a request; it may have bytes that are no UTF-8, as `os.fsdecode` has them."""
    return urllib.parse.quote(word, safe="", errors="surrogateescape")


def _problem_text(problem: Mapping[str, Any]) -> str:
    """"scene.json:3:5: /rods/lenght: unknown key; did you mean rods.length?"."""
    place = f":{problem['line']}:{problem['column']}" if problem.get("line") else ""
    return ": ".join(filter(None, (f"{problem.get('file', '')}{place}", problem.get("path"), problem.get("message"))))


def _print_progress(sweep: Mapping[str, Any]) -> None:
    eta = sweep["eta_s"]
    left = f", {eta:.0f} s left" if eta is not None and eta >= 0 else ""
    done = sweep["counts"].get("done", 0)
    print(f"\r{sweep['name']}: {100 * sweep['progress']:.0f} %, {done} of {sweep['n_jobs']} done{left}   ", end="",
          file=sys.stderr, flush=True)
