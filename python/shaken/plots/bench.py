"""What shaken-bench has measured, drawn from the JSON that it writes."""
import json
import sys
from pathlib import Path
from typing import Any, Callable, Iterator, Sequence

import numpy as np
from numpy.typing import NDArray

from ..errors import ShakenError
from . import accuracy, style
from .panel import Panel
from .accuracy import Row, column, like, series_of
from .save import Origin
from .series import label_of
from .sheet import Sheet

Figures = Iterator[tuple[str, Sheet]]

_RATE = "simulated rod-seconds per CPU-second"
_STEPS = (0.25, 1.0, 4.0, 16.0, 64.0)  # [us], which are halved and doubled


def _dots_height(n: int, n_series: int = 1) -> float:
    """Of a panel of so many categories [mm]."""
    return 16 + n * (3.6 + 1.2 * n_series)


def _dots(width: str | None, title: str, n: int, n_series: int = 1) -> Sheet:
    """An empty figure of so many categories, on a logarithmic axis with this title."""
    sheet = style.sheet(width or "120mm", panel_height=_dots_height(n, n_series))
    sheet[0].titles(x=title).scale(x="log")
    return sheet


def _shares_of(rows: Sequence[Row]) -> dict[str, NDArray[Any]]:
    """Shares of the phases in percent: the six that take most by name, the others together."""
    phases = [name for name in rows[0].get("phase_shares", {}) if name != "other"]
    shares = {name: np.nan_to_num(column(rows, f"phase_shares/{name}", 100)) for name in phases}
    largest = sorted(phases, key=lambda name: -float(np.max(shares[name])))[:6]
    found = {name.replace("_", " "): shares[name] for name in phases if name in largest}
    rest = [shares[name] for name in phases if name not in largest]
    return {**found, **({"other phases": np.sum(rest, axis=0)} if rest else {})}


def _speed_figure(rows: Sequence[Row], categories: Sequence[str], series: Sequence[tuple[str, str]],
                  width: str | None) -> Sheet:
    sheet = style.sheet(width or "183mm", 1, 2, _dots_height(len(rows), len(series)))
    rates, phases = sheet.panels
    rates.titles(x=_RATE).scale(x="log")
    for k, (label, path) in enumerate(series):
        rates.dots(categories, column(rows, path), label=label, colour=k,
                   shift=0.18 * (len(series) - 1 - 2 * k))
    phases.titles(x="CPU time of the scheduled stepper (%)").shares(categories, _shares_of(rows))
    phases.axes.tick_params(labelleft=False)
    return sheet


def speed(report: Row, width: str | None) -> Figures:
    rows = report["rows"]
    categories = [label_of({"rods.area_fraction": row["area_fraction"], "rods.length": row["length_mm"],
                            "box.side": float(f"{row['side_mm']:.3g}")}) for row in rows]
    yield "speed", _speed_figure(rows, categories, [("scheduled", "scheduled/rod_s_per_cpu_s"),
                                                    ("reference", "reference/rod_s_per_cpu_s")], width)


def kinds(report: Row, width: str | None) -> Figures:
    rows = report["rows"]
    yield "kinds", _speed_figure(rows, [row["scene"] for row in rows], [("", "scheduled/rod_s_per_cpu_s")], width)


def hard(report: Row, width: str | None) -> Figures:
    """The smallest margin of each case that has more than yes and no."""
    least: dict[str, Row] = {}
    for row in report["rows"]:
        if row["limit"] is None or row["limit"] <= 0 or row["limit_is"] == "least" or row["margin"] is None:
            continue
        if row["case"] not in least or row["margin"] < least[row["case"]]["margin"]:
            least[row["case"]] = row
    if not least:
        return
    sheet = _dots(width, "smallest margin: limit over the worst value seen", len(least))
    sheet[0].dots(list(least), [row["margin"] for row in least.values()], digits=2).reference(x=1.0)
    yield "hard", sheet


def hard_history(report: Row, width: str | None) -> Figures:
    """Order, deepest overlap and energy unaccounted for of each case against time."""
    sheet = style.sheet(width or "183mm", 1, 3, panel_height=60).share_key()
    shown = (("order $S$", "S", 1.0, "linear"),
             ("deepest overlap so far (% of a radius)", "max_overlap", 100.0, "linear"),
             ("energy unaccounted for / turnover", "energy_unaccounted", 1.0, "log"))
    for panel, (title, name, factor, scale) in zip(sheet, shown):
        panel.titles("simulated time (s)", title).scale(y=scale)
        if scale == "linear":
            panel.range(y=(0, None))
        for k, rows in enumerate(series_of(report["rows"], "case")[:7]):
            values = column(rows, name, factor)
            panel.curve(column(rows, "time_s"), np.where(values > 0, values, np.nan), label=rows[0]["case"], colour=k)
    yield "hard_history", sheet


def effects(report: Row, width: str | None) -> Figures:
    rows = report["rows"]
    sheet = _dots(width, "CPU time without the effect (% of everything on)", len(rows), 2)
    for k, (label, of) in enumerate((("from the same state", "same_state"), ("from its own state", "own_state"))):
        sheet[0].dots([row["without"].replace("_", " ") for row in rows], column(rows, f"{of}/cpu_ratio", 100),
                      column(rows, f"{of}/cpu_ratio_error", 100), label=label, colour=k, shift=0.18 - 0.36 * k)
    sheet[0].reference(x=100.0)
    yield "effects", sheet


def _add_errors(panel: Panel, rows: Sequence[Row], order: Row | None, norm: str, label: str, colour: int) -> None:
    """The medians of one norm with their quartiles, and the power law that they follow."""
    steps = column(rows, "dt_s", 1e6)
    fit = (order or {}).get(norm)
    found = "no order"
    if fit is not None:
        found = f"order {fit['order']:.2f} ± {fit['order_error']:.2f}"
        panel.reference(steps, fit["coefficient"] * (1e-6 * steps) ** fit["order"], dashed=False,
                        colour=style.PALETTE[colour])
    lower, upper = column(rows, f"error/{norm}/lower"), column(rows, f"error/{norm}/upper")
    panel.axes.fill_between(steps, lower, upper, color=style.PALETTE[colour], alpha=0.22, linewidth=0)
    panel.record(f"{label}, lower quartile", steps, lower)
    panel.record(f"{label}, upper quartile", steps, upper)
    panel.explain("band", "bands: quartiles").explain("line", "lines: power laws through the medians")
    panel.curve(steps, column(rows, f"error/{norm}/median"), colour=colour, look="points", joined=False,
                label=f"{label}: {found}")


def convergence(report: Row, width: str | None) -> Figures:
    report = accuracy.with_orders(report)
    cases = series_of(report["rows"], "case")
    n_columns = min(3, len(cases))
    width = width or ("183mm" if n_columns > 1 else "89mm")
    shape = (width, -(-len(cases) // n_columns), n_columns)
    errors, work = style.sheet(*shape, panel_height=52), style.sheet(*shape, panel_height=52)
    for panel, cost, of_case in zip(errors, work, cases):
        variants = series_of(of_case, "variant")
        one = len(variants) == 1
        panel.titles("step $Δt$ (µs)", "error" if one else "error of position (mm)", of_case[0]["case"])
        cost.titles("CPU time (µs)", "error of position (mm)",
                    f"{of_case[0]['case']}, {1e3 * of_case[0]['duration_s']:.3g} ms")
        n = 0
        for k, rows in enumerate(variants[:7]):
            order = like(report["orders"], rows[0], "case", "variant")
            if one:
                for colour, (norm, label) in enumerate((("position", "position (mm)"), ("director", "director (rad)"),
                                                        ("energy", "kinetic energy"))):
                    _add_errors(panel, rows, order, norm, label, colour)
            else:
                _add_errors(panel, rows, order, "position", rows[0]["variant"], k)
            # one variant shows how much the stepper matters
            for stepper in ("scheduled", "reference") if k == 0 else ("scheduled",):
                if n < len(style.PALETTE):
                    cost.curve(column(rows, f"{stepper}_cpu_s", 1e6), column(rows, "error/position/median"),
                               look="points", label=stepper if one else f"{rows[0]['variant']}, {stepper}")
                    n += 1
        panel.scale("log", "log").axes.set_xticks(_STEPS)
        cost.scale("log", "log")
    yield "convergence", errors
    yield "work_precision", work


def peers(report: Row, width: str | None) -> Figures:
    rows = [row for row in report["rows"] if row["rod_s_per_cpu_s_best"]]
    sheet = _dots(width, f"{_RATE}, one thread", len(rows))
    sheet[0].dots([f"{row['program']}, {row['dt_us']} µs" for row in rows],
                  [float(row["rod_s_per_cpu_s_best"]) for row in rows])
    yield "peers", sheet


#: "bench" of a report -> what draws it; others have no pictures.
DRAWERS: dict[str, Callable[[Row, str | None], Figures]] = {
    "speed": speed, "kinds": kinds, "hard": hard, "hard history": hard_history, "effects": effects,
    "accuracy": convergence, "peers": peers,
}


def figures_of(report: Row, width: str | None = None) -> Figures:
    """(name, figure) of everything that a report has."""
    drawer = DRAWERS.get(report.get("bench", ""))
    if drawer is not None and report.get("rows"):
        yield from drawer(report, width)


def read_report(path: Path) -> Row:
    try:
        return json.loads(path.read_text() if str(path) != "-" else sys.stdin.read())
    except (OSError, ValueError) as error:
        raise ShakenError(f"{path}: {error}") from None


def draw_report(path: Path, folder: Path, width: str | None = None, form: str = "png") -> Iterator[Path]:
    """Draws all figures of a report into a folder; yields their paths."""
    report = read_report(path)
    machine = report.get("machine") or {}
    origin: Origin = {key: text for key, text in {
        "Software": f"shaken-bench {report.get('version', '')}", "Bench": str(report.get("bench", "")),
        "Machine": ", ".join(str(machine[key]) for key in ("cpu", "cores", "compiler", "flags") if key in machine),
    }.items() if text}
    for name, sheet in figures_of(report, width):
        # NAME.csv with the rows of the report is there already
        yield sheet.save(folder / f"{name}.{form}", origin, data=name != path.stem)
