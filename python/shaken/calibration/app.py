"""`shaken calibrate`: a noise for each species and each wanted D_r, with what was measured on the way."""
import argparse
import json
import math
import os
import sys
from pathlib import Path
from typing import Any, Sequence

from ..errors import ShakenError
from ..plots.save import SUFFIXES
from ..program import BAD_INPUT, FAILED, OK, Options, failed, run
from .. import text as texts
from .rods import Level, Measuring, NotDiffusive, Species, Unmet
from .search import Calibrated, noise_for


def parser() -> argparse.ArgumentParser:
    """The options that client/verbs/calibrate.cpp hands on, where they are described."""
    found = Options()
    found.add_argument("--species", required=True)  # the scenes of all species, JSON
    for name in ("rotational-diffusion", "of"):
        found.add_argument(f"--{name}", action="append", default=[])
    found.add_argument("--area-fraction", type=float)
    found.add_argument("--precision", type=float, default=0.05)
    found.add_argument("--threads", type=int, default=len(os.sched_getaffinity(0)))
    found.add_argument("--plot", type=Path)
    found.add_argument("--json", action="store_true")
    return found


def wanted_of(options: argparse.Namespace) -> list[float]:
    """The values of D_r, rising. Raises ShakenError for what is no positive number."""
    found = set()
    for text in options.rotational_diffusion:
        try:
            value = float(text)
        except ValueError:
            value = math.nan
        if not (math.isfinite(value) and value > 0):
            raise ShakenError(f"--rotational-diffusion takes a number above 0, in rad^2/s, not '{text}'")
        found.add(value)
    if not found:
        raise ShakenError("--rotational-diffusion D is missing: the D_r that rods are to have, in rad^2/s")
    return sorted(found)


def problems_of(options: argparse.Namespace, species: Sequence[Species]) -> list[str]:
    """All that is wrong with the options, a line each."""
    found = []
    try:
        wanted_of(options)
    except ShakenError as error:
        found.append(str(error))
    names = [one.name for one in species]
    for name in options.of:
        if name not in names:
            found.append(f"--of {name}: the scene has {', '.join(names)}")
        elif not species[names.index(name)].has_axis:
            found.append(f"--of {name}: these are spheres, which have no axis that could turn")
    if not options.of and not any(one.has_axis for one in species):
        found.append("all rods of the scene are spheres, which have no axis that could turn")
    for name, value, least, most in (("area-fraction", options.area_fraction, 0.01, 0.7),
                                     ("precision", options.precision, 0.005, 0.3),
                                     ("threads", options.threads, 1, 256)):
        if value is not None and not least <= value <= most:
            found.append(f"--{name} takes a number from {least:g} to {most:g}, not {value:g}")
    if options.plot is not None and options.plot.suffix not in SUFFIXES:
        found.append(f"--plot {options.plot}: a plot is a .png, .pdf or .svg")
    return found


def calibrated(one: Species, options: argparse.Namespace) -> tuple[list[Calibrated], list[Level], list[str]]:
    """What was found for a species, the levels that were measured, and why a wanted D_r was not met."""
    def say(line: str) -> None:
        print(line, file=sys.stderr, flush=True)

    measuring = Measuring(one, options.area_fraction, os.environ.get("SHAKEN_PROGRAM", "shaken"), options.threads, say)
    found, refused = [], []
    for wanted in wanted_of(options):
        try:
            found.append(noise_for(wanted, measuring.level, options.precision, list(measuring.levels.values())))
        except Unmet as error:
            hint = ""
            if isinstance(error, NotDiffusive) and options.area_fraction is None:
                hint = (": their plates do not slow rods that are alone, which then have no D_r; --area-fraction 0.3 "
                        "calibrates rods that meet each other")
            refused.append(f"{one.name}: {error}{hint}")
    return found, sorted(measuring.levels.values(), key=lambda level: level.noise), refused


def table(rows: Sequence[tuple[Species, Calibrated]]) -> str:
    """Of every species and wanted D_r the noise, D_r as measured with it and without noise, and the key to set."""
    lines = []
    for one, found in rows:
        digits = max(0, 1 - math.floor(math.log10(found.error))) if found.error > 0 else 4
        lines.append([one.name, f"{found.wanted:g}", number(found.level), number(found.own) if found.own else "-",
                      f"{found.noise:g} ± {found.error:.{digits}f}", f"{one.key} = {found.noise:g} rad/mm"])
    titles = ("SPECIES", "WANTED rad^2/s", "D_r rad^2/s", "WITHOUT NOISE", "NOISE rad/mm", "KEY")
    return texts.table([texts.Column(title, list(cells)) for title, cells in zip(titles, zip(*lines))], 0)[0]


def number(level: Level) -> str:
    return str(level.found.d_r).removesuffix(" rad2 s-1")


def draw(path: Path, rows: Sequence[tuple[Species, list[Calibrated], list[Level]]]) -> None:
    """D_r against the noise, of each species."""
    from ..plots.sheet import Sheet
    sheet = Sheet()
    panel = sheet[0].titles("noise (rad/mm)", r"rotational diffusion $D_\mathrm{r}$ (rad²/s)").scale("log", "log")
    for one, found, levels in rows:
        shown = [level for level in levels if level.noise > 0]
        panel.curve([level.noise for level in shown], [level.d_r for level in shown],
                    [level.error for level in shown], label=one.name, look="points")
        for each in found:
            panel.reference(y=each.wanted, label=f"{each.wanted:g}")
    sheet.save(path, {"Software": "shaken calibrate"})


def main(arguments: Sequence[str]) -> int:
    options = parser().parse_args(arguments)
    species = [Species(**one) for one in json.loads(options.species)]
    if problems := problems_of(options, species):
        return failed("\n".join(problems), BAD_INPUT, options.json)
    return run(lambda given: _run(given, species), options, options.json, code=FAILED)


def _run(options: argparse.Namespace, species: Sequence[Species]) -> int:
    chosen = [one for one in species if one.has_axis and (not options.of or one.name in options.of)]
    for one in species:
        if not one.has_axis:
            print(f"{one.name} are spheres, which have no axis that could turn", file=sys.stderr)
    every, refused = [], []
    for one in chosen:
        found, levels, why = calibrated(one, options)
        every.append((one, found, levels))
        refused += why
    rows = [(one, each) for one, found, _ in every for each in found]
    if options.json:
        print(texts.json_text(_as_json(options, every, refused)))
    elif rows:
        print(table(rows), end="")
    for one, each in rows:
        if not each.is_met:
            print(f"{one.name}: D_r = {each.wanted:g} rad^2/s was not met, or is not known within "
                  f"{options.precision:.0%}; the nearest is given", file=sys.stderr)
    if options.plot is not None and any(levels for _, _, levels in every):
        draw(options.plot, every)
        print(options.plot, file=sys.stderr)
    for line in refused:
        print(f"shaken: {line}", file=sys.stderr)
    return BAD_INPUT if refused else OK


def _as_json(options: argparse.Namespace, every: Sequence[tuple[Species, list[Calibrated], list[Level]]],
             refused: Sequence[str]) -> dict[str, Any]:
    return {"area_fraction": options.area_fraction, "precision": options.precision, "refused": list(refused),
            "species": [{"name": one.name, "key": one.key,
                         "calibrated": [{"wanted_rad2_s": each.wanted, "noise_sem_rad_per_mm": each.error,
                                         "is_met": each.is_met, **each.level.as_json()} for each in found],
                         "levels": [level.as_json() for level in levels]} for one, found, levels in every]}
