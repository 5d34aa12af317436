"""Results as flat rows: swept keys by their path, the members of summary.json as "order.mean"."""
import json
import math
import re
from dataclasses import dataclass, field
from pathlib import Path
from typing import Any, Iterable, Mapping, Sequence

from .catalogue import KEYS, SUMMARY
from .daemon import Daemon, quoted
from .errors import NoDaemon, NotFound, ShakenError, nearest
from .estimate import Estimate, replica_mean
from .folder import flattened, jobs_in
from .units import leading_number

Fields = dict[str, Any]
_VERSIONS = ("versions.shaken", "versions.physics")
#: Fields that name a row rather than measure something; never averaged.
_NAMES = {"job", "sweep", "state", "label", "replica", "directory", *_VERSIONS}
_MEASURED = re.compile(r"measured\.(.*)\.value")
_AVERAGES = {f"{block}.{member}" for block, row in SUMMARY.items() for member in row.get("averages", ())}


def version_text(versions: Any) -> str:
    """"shaken 0.1.0, physics 3" of the member `versions`; empty where it is not known."""
    if not isinstance(versions, Mapping):
        return ""
    words = [f"{what} {versions[what]}" for what in ("shaken", "physics") if versions.get(what) is not None]
    return ", ".join(words)


def newness(version: Any) -> list[int]:
    """What versions, or texts of them, are sorted by: 0.10.0 is newer than 0.9.0."""
    return [int(number) for number in re.findall("[0-9]+", str(version))]


def has_results(state: str, summary: Mapping[str, Any] | None) -> bool:
    """Whether a run is done, or was before it went on for longer. state: of its job"""
    ended = (summary or {}).get("exit") or {}
    return state == "done" or ended.get("state") == "done" or "done_before_s" in ended


@dataclass
class Row:
    """A run, or the replicas of a point together.

    fields: everything by its name, parameters too; numbers, texts, booleans, and None of what has no value
    source: as the daemon sent it; scene: other keys of its scene, as far as they were asked for
    """

    parameters: Mapping[str, Any]
    state: str
    fields: Fields
    source: Mapping[str, Any] = field(default_factory=dict)
    scene: Fields = field(default_factory=dict)

    def number(self, name: str) -> float:
        """A number, or one at the beginning of a text ("4.5 mm"); NaN if there is none."""
        return leading_number(self.fields.get(name))

    @property
    def version(self) -> tuple[str, int]:
        """Program and physics that computed it, which both can change its numbers; ("", 0) where it is not done."""
        return str(self.fields.get(_VERSIONS[0]) or ""), int(self.fields.get(_VERSIONS[1]) or 0)

    @property
    def made_by(self) -> str:
        """The same in words, "shaken 0.1.0, physics 3"; "" where it is not known."""
        return version_text(dict(zip(("shaken", "physics"), self.version))) if any(self.version) else ""

    @property
    def key(self) -> str:
        """Its parameters, as text."""
        return json.dumps(self.parameters)

    def steady(self, name: str) -> bool | None:
        """Whether an average is one of a steady state: its own flag, else the run's; True of what is no average."""
        is_average = name in _AVERAGES or _MEASURED.fullmatch(name)
        if not is_average or math.isnan(self.number(name)) or isinstance(self.fields[name], str):
            return True
        flags = [self.fields[of] for of in (name.rpartition(".")[0] + ".steady", "steady") if of in self.fields]
        return next((flag for flag in flags if flag is not None), None if flags else True)


def row_of(answer: Mapping[str, Any]) -> Row:
    """From one element of "rows" of GET /v1/results."""
    fields = {key: answer.get(key) or "" for key in ("job", "sweep", "state", "label")} | dict(answer["parameters"])
    fields["replica"] = answer.get("replica", 0)
    if "directory" in answer:
        fields["directory"] = answer["directory"]
    return Row(answer["parameters"], answer["state"], fields | dict(flattened(answer.get("summary") or {})), answer)


@dataclass
class Target:
    """What an ID stands for: a sweep or a job, its jobs, and their rows."""

    id: str
    name: str
    is_sweep: bool
    jobs: list[dict[str, Any]]
    rows: list[Row]

    @property
    def title(self) -> str:
        """"sweep s1 (phases)" or "job 1f0c..."."""
        shown = f" ({self.name})" if self.name not in ("", self.id) else ""
        return f"{'sweep' if self.is_sweep else 'job'} {self.id}{shown if self.is_sweep else ''}"


def target_of(daemon: Daemon, word: str) -> Target:
    """A sweep by its id or name, else a job by the beginning of its id, else a folder of runs (no daemon is asked where
    its name has a slash); the newest sweep if there is no word. Raises ShakenError where there is none."""
    if "/" not in word and word != ".":
        try:
            return _target_at(daemon, word)
        except (NoDaemon, NotFound):
            if not word or not Path(word).is_dir():
                raise
    rows = jobs_in(word)
    name = Path(word).resolve().name
    return Target(name, name, True, rows, [row_of(row) for row in rows])


def _target_at(daemon: Daemon, word: str) -> Target:
    if not word:
        sweeps = daemon.sweeps()
        if not sweeps:
            raise ShakenError("nothing has been submitted yet: `shaken submit FILE` does")
        word = sweeps[-1]["id"]
    hint = ""
    for kind in ("sweep", "job"):
        try:
            answer = daemon.ask("GET", f"/v1/{kind}s/{quoted(word)}")
        except NotFound as refusal:
            hint = hint or "; did you mean".join(["", *str(refusal).split("; did you mean")[1:]])
            continue
        found, is_sweep = answer[kind], kind == "sweep"
        rows = daemon.rows(found["id"] if is_sweep else found["sweep"])
        return Target(found["id"], found.get("name") or "", is_sweep, answer["jobs"] if is_sweep else [found],
                      [row_of(row) for row in rows if is_sweep or row["job"] == found["id"]])
    raise NotFound(f"no sweep or job is called '{word}'{hint}: `shaken status` lists them")


def add_from_scenes(target: Target, names: Iterable[str]) -> None:
    """What the scenes of the rows' runs say of keys that these lack: a row has the swept ones only. A run that has not
    begun has no scene."""
    wanted = [name for name in names if name in KEYS]
    directories = {job["id"]: job.get("directory") for job in target.jobs}
    for row in target.rows:
        lacking = [name for name in wanted if name not in row.fields]
        directory = directories.get(row.fields["job"])
        if not lacking or not directory or not Path(directory, "scene.json").is_file():
            continue
        known = dict(flattened(json.loads(Path(directory, "scene.json").read_text())))
        said = {name: known.get(name, KEYS[name]["default"]) for name in lacking}
        row.scene |= {name: value for name, value in said.items() if isinstance(value, (int, float, str))}
        row.fields |= row.scene


def own_error(name: str) -> str:
    """The field of a run's own standard error of `name`: "order.sem" of "order.mean", "measured.X.sem" of
    "measured.X.value"; "" if there is none."""
    return "order.sem" if name == "order.mean" else name[:-len("value")] + "sem" if name.endswith(".value") else ""


def error_field(name: str) -> str:
    """The field of the standard error of `name`, in rows of runs and of points."""
    return own_error(name) or name + ":sem"


def field_names(rows: Iterable[Row]) -> list[str]:
    """The fields of all rows, in the order met."""
    return list(dict.fromkeys(name for row in rows for name in row.fields))


def short_name(name: str) -> str:
    """"dip" of "measured.dip.value", as options take it."""
    found = _MEASURED.fullmatch(name)
    return found[1] if found else name


def swept(points: Iterable[Mapping[str, Any]]) -> list[str]:
    """The keys in which the parameters of points differ."""
    values: dict[str, set[str]] = {}
    for parameters in points:
        for path, value in parameters.items():
            values.setdefault(path, set()).add(json.dumps(value))
    return [path for path, found in values.items() if len(found) > 1]


def axes_of(rows: Sequence[Row]) -> list[str]:
    """The axes of a diagram of a sweep: the first two swept keys that are numbers, of which the second is more than
    another name of the first, as the number of rods is of their length. Raises ShakenError where there is none."""
    axes: list[str] = []
    for path in swept(row.parameters for row in rows):
        values = [tuple(row.number(name) for name in (*axes[:1], path)) for row in rows]
        if all(map(math.isfinite, (value[-1] for value in values))) and (
                not axes or len(set(values)) > len({first for first, _ in values})):
            axes.append(path)
    if not axes:
        raise ShakenError("no number is swept, so there is no diagram of it")
    return axes[:2]


def field_named(names: Sequence[str], word: str) -> str | None:
    """The field that a word means: itself, "measured.WORD.value", "order.mean" where it is "S", or the error of such a
    one where it is "WORD.sem" or "WORD:sem"; None if there is none."""
    for name in (word, f"measured.{word}.value", "order.mean" if word == "S" else word):
        if name in names:
            return name
    if word.endswith((".sem", ":sem")):
        of = field_named(names, word[:-len(".sem")])
        return error_field(of) if of and error_field(of) in names else None
    return None


def resolved(rows: Sequence[Row], word: str) -> str:
    """The field that a word means. Raises ShakenError, with the nearest name, if no row has it."""
    names = field_names(rows)
    found = field_named(names, word)
    if found is None:
        short = [short_name(name) for name in names]
        begins = [name for name in short if len(word) > 2 and name.startswith(word)]
        raise ShakenError(f"no row has a field '{word}'{nearest(word, short, begins)}")
    return found


def has_several_versions(rows: Iterable[Row]) -> bool:
    return len({row.version for row in rows if any(row.version)}) > 1


def aggregated(rows: Sequence[Row]) -> list[Row]:
    """One row per point and version: what different versions computed is never averaged, nor what a version computed
    that is not known; a run that is not done yet belongs to the newest, and a run counts once.

    Fields: the parameters, "state" ("done" if all are, else "partial"), the versions, "n_replicas", "n_done", and of
    done replicas for each number F its mean as F and the standard error of that (replica_mean) as error_field(F); "F:n"
    where only so many of them have a value; of "n_effective" the sum; of "steady" whether all are.
    """
    newest: dict[str, tuple[str, int]] = {}
    groups: dict[tuple[str, tuple[str, int]], dict[str, Row]] = {}
    for row in rows:
        newest[row.key] = max(newest.get(row.key, row.version), row.version, key=newness)
    for row in rows:
        version = row.version if any(row.version) or row.state == "done" else newest[row.key]
        groups.setdefault((row.key, version), {}).setdefault(row.fields.get("job") or str(id(row)), row)
    return [_point(list(group.values())) for group in groups.values()]


def _point(group: list[Row]) -> Row:
    done = [row for row in group if has_results(row.state, row.source.get("summary"))]
    fields: Fields = {**group[0].parameters, "n_replicas": len(group), "n_done": len(done)}
    fields |= {name: done[0].fields[name] for name in _VERSIONS if done and name in done[0].fields}
    fields["state"] = "done" if all(row.state == "done" for row in group) else "partial"
    scene = done[0].scene if done else {}  # of which those that differ (time.seed) are nothing to average either
    alike = {name: value for name, value in scene.items() if all(row.scene.get(name) == value for row in done)}
    names = field_names(done)
    left_out = _NAMES | set(scene) | set(group[0].parameters) | {own_error(name) for name in names}
    fields |= alike
    for name in names:
        if name not in left_out and name.rpartition(".")[2] != "sem_if_steady":
            fields |= _mean(name, done)
    return Row(group[0].parameters, fields["state"], fields, scene=alike)


def _mean(name: str, done: Sequence[Row]) -> Fields:
    """The fields of a point that tell a number of its runs."""
    last, known = name.rpartition(".")[2], [row for row in done if row.fields.get(name) is not None]
    if last == "steady":
        relaxes = any(row.fields[name] is False for row in known)
        return {name: False if relaxes else True if len(known) == len(done) else None}
    found = [Estimate(row.number(name), row.number(error_field(name))) for row in known
             if not isinstance(row.fields[name], (str, bool))]
    if not found:
        return {} if known else {name: None}
    if last == "over_s":  # a setting, which replicas share
        return {name: found[0].value}
    some = {name + ":n": len(found)} if len(found) < len(done) else {}
    if last == "n_effective":
        return {**some, name: sum(estimate.value for estimate in found)}
    mean = replica_mean(found)
    return {**some, name: mean.value, **({error_field(name): mean.error} if math.isfinite(mean.error) else {})}
