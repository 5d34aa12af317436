# SPDX-License-Identifier: MIT
"""What shaken-bench has measured, drawn from the JSON that it writes."""
from __future__ import annotations

import json
import math
import sys
from pathlib import Path
from typing import Callable, Iterator, Sequence

import numpy as np

from ..errors import ShakenError
from . import accuracy, names, style
from .panel import Panel
from .rows import Row, column, like, number, series_of
from .save import Origin
from .sheet import Sheet

Figures = Iterator[tuple[str, Sheet]]

#: The averages whose biases are known to much better than 1 %: what the cost of accuracy is read from.
_AVERAGES = ("T_xy", "T_z", "T_rot", "rms_n_z", "msd")
_LARGEST_ERROR = 0.5  # of a velocity that is shown [mm/s]
_RATE = "simulated rod-seconds per CPU-second"
_STEPS = (0.25, 1.0, 4.0, 16.0, 64.0)


def _step_axis(panel: Panel) -> None:
    """A logarithmic axis of steps [us], which are halved and doubled."""
    from matplotlib import ticker
    low, high = panel.axes.get_xlim()
    panel.axes.xaxis.set_major_locator(ticker.FixedLocator([step for step in _STEPS if low <= step <= high]))


def _one_percent(panel: Panel, below: bool = False) -> None:
    """The 1 % that is looked for, as a light band."""
    low, high = panel.axes.get_ylim()
    if high > -1 and low < 1:
        panel.axes.axhspan(low if below else max(low, -1), min(high, 1), color="#ececec", linewidth=0, zorder=0.5)
    panel.axes.set_ylim(low, high)


def _scene_text(row: Row, all_rows: Sequence[Row]) -> str:
    """"ℓ = 4.5 mm, φ = 0.75, instant", with the variant where there are several."""
    text = names.point_label({"rods.length": row["length_mm"], "rods.area_fraction": row["area_fraction"]})
    several = len({one["variant"] for one in all_rows}) > 1
    return f"{text}, {row['variant']}" if several else text


def _dots_height(n: int, n_series: int = 1) -> float:
    """Of a panel of so many categories [mm]."""
    return 16 + n * (3.6 + 1.2 * n_series)


def _shares_of(rows: Sequence[Row]) -> dict[str, np.ndarray]:
    """Shares of the phases in percent: the six that take most by name, the others together."""
    phases = [name for name in rows[0].get("phase_shares", {}) if name != "other"]
    shares = {name: np.nan_to_num(column(rows, f"phase_shares/{name}", 100)) for name in phases}
    largest = sorted(phases, key=lambda name: -float(np.max(shares[name])))[:6]
    found = {name.replace("_", " "): shares[name] for name in phases if name in largest}
    rest = [shares[name] for name in phases if name not in largest]
    return {**found, **({"other phases": np.sum(rest, axis=0)} if rest else {})}


def _speed_figure(rows: Sequence[Row], categories: Sequence[str], series: Sequence[tuple[str, str]],
                  width: str) -> Sheet:
    sheet = style.sheet(width, 1, 2, _dots_height(len(rows), len(series)))
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
    categories = [names.point_label({"rods.area_fraction": row["area_fraction"], "rods.length": row["length_mm"],
                                     "box.side": float(f"{row['side_mm']:.3g}")}) for row in rows]
    yield "speed", _speed_figure(rows, categories, [("scheduled", "scheduled/rod_s_per_cpu_s"),
                                                    ("reference", "reference/rod_s_per_cpu_s")], width or "183mm")


def kinds(report: Row, width: str | None) -> Figures:
    rows = report["rows"]
    yield "kinds", _speed_figure(rows, [row["scene"] for row in rows], [("", "scheduled/rod_s_per_cpu_s")],
                                 width or "183mm")


def scaling(report: Row, width: str | None) -> Figures:
    rows, of_rods = report["rows"], report["bench"] == "scaling n"
    x = column(rows, "n_rods") if of_rods else column(rows, "dt_s", 1e6)
    sheet = style.sheet(width or "89mm")
    first = "the smallest $N$" if of_rods else f"a step of {x[0]:g} µs"
    panel = sheet[0].titles("number of rods $N$" if of_rods else "step $Δt$ (µs)",
                            f"CPU time per rod-second,\nrelative to {first}")
    panel.scale(x="log").range(y=(0, None))
    rising = np.argsort(x)  # the row that the others are relative to stands first
    panel.curve(x[rising], column(rows, "relative_cost")[rising], label="scheduled stepper", look="points")
    law = np.geomspace(x.min(), x.max(), 60)
    panel.reference(law, np.ones_like(law) if of_rods else x[0] / law,
                    label="cost of a rod independent of $N$" if of_rods else "cost of a step independent of its length")
    yield "scaling_n" if of_rods else "scaling_dt", sheet


def threads(report: Row, width: str | None) -> Figures:
    sheet = style.sheet(width or "89mm")
    panel = sheet[0].titles("number of threads", "speed-up over one thread").range(x=(1, None), y=(0, None))
    panel.axes.set_xticks(sorted({row["threads"] for row in report["rows"]}))
    for k, rows in enumerate(series_of(report["rows"], "length_mm", "area_fraction", "side_mm")):
        if k >= len(style.PALETTE):
            break
        label = names.point_label({"rods.area_fraction": rows[0]["area_fraction"],
                                   "rods.length": rows[0]["length_mm"], "box.side": rows[0]["side_mm"]})
        panel.curve(column(rows, "threads"), column(rows, "speed_up"), label=label, colour=k, look="points")
        panel.reference(column(rows, "threads"), column(rows, "limit"), colour=style.PALETTE[k],
                        label="what the serial part leaves" if k == 0 else "")
    yield "threads", sheet


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
    sheet = style.sheet(width or "120mm", panel_height=_dots_height(len(least)))
    sheet[0].titles(x="smallest margin: limit over the worst value seen").scale(x="log")
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
    sheet = style.sheet(width or "120mm", panel_height=_dots_height(len(rows), 2))
    panel = sheet[0].titles(x="CPU time without the effect (% of everything on)").scale(x="log")
    for k, (label, of) in enumerate((("from the same state", "same_state"), ("from its own state", "own_state"))):
        panel.dots([row["without"].replace("_", " ") for row in rows], column(rows, f"{of}/cpu_ratio", 100),
                   column(rows, f"{of}/cpu_ratio_error", 100), label=label, colour=k, shift=0.18 - 0.36 * k)
    panel.reference(x=100.0)
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


def deterministic(report: Row, width: str | None) -> Figures:
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
        panel.scale("log", "log")
        cost.scale("log", "log")
    for sheet in (errors, work):
        for panel in sheet:
            if panel.is_used and sheet is errors:
                panel.then(_step_axis)
    yield "convergence", errors
    yield "work_precision", work


def _bias(rows: Sequence[Row], name: str) -> tuple[np.ndarray, np.ndarray]:
    return column(rows, f"{name}/bias", 100), column(rows, f"{name}/bias_error", 100)


def _bias_sheet(report: Row, steps: Sequence[Sequence[Row]], shown: Sequence[Row], width: str) -> Sheet:
    sheet = style.sheet(width, -(-len(shown) // 4), min(4, len(shown)), panel_height=48).share_key()
    all_rows = [row for rows in steps for row in rows]
    for panel, of in zip(sheet, shown):
        panel.titles("step $Δt$ (µs)", "bias (%)", of["title"].replace("n_z", "$n_z$"))
        panel.scale(x="log").range(y=(-1.5, 1.5)).zero()
        for k, rows in enumerate(steps[:7]):
            limit = like(report["limits"], {**rows[0], "observable": of["name"]}, "length_mm", "variant", "observable")
            if limit is None or not limit["at_zero_error"] < 0.25 * abs(limit["at_zero"]):
                continue  # a bias relative to what is not known means nothing
            x = column(rows, "value")
            slope = limit["slope"] / limit["at_zero"]
            line = np.linspace(0, accuracy.LINEAR * x[0], 40)[1:]
            line = line[line >= x.min()]
            panel.reference(line, 100 * slope * line, colour=style.PALETTE[k])
            panel.curve(x, *_bias(rows, of["name"]), label=_scene_text(rows[0], all_rows), colour=k, look="points",
                        joined=False)
        panel.explain("line", "dashed: the line through the finest steps, which gives the limit of none")
        panel.then(_one_percent).then(_step_axis).explain("grey", "grey: below 1 %")
    return sheet


def _bound_of(row: Row, observables: Sequence[str]) -> float:
    """The bound that all are below: their largest |bias| with two standard errors to spare [%]."""
    return max(100 * (abs(number(row, f"{name}/bias")) + 2 * number(row, f"{name}/bias_error"))
               for name in observables)


def _cost_sheet(rows: Sequence[Row], width: str) -> Sheet:
    rods = series_of(rows, "length_mm")
    sheet = style.sheet(width, 2, len(rods), panel_height=58).share_key()
    for k, panel in enumerate(sheet):
        rod, hit = rods[k % len(rods)], k >= len(rods)
        panel.titles("CPU time (ms per rod and simulated second)", "|bias| + 2 standard errors (%)",
                     names.point_label({"rods.length": rod[0]["length_mm"],
                                        "rods.area_fraction": rod[0]["area_fraction"]}) +
                     (": rods just hit" if hit else ": temperatures, tilt, displacement")).scale("log", "log")
        for colour, of_variant in enumerate(series_of(rod, "variant")[:7]):
            x = column(of_variant, "cpu_s_per_rod_s", 1e3)
            y = [_bound_of(row, ("hit",) if hit else _AVERAGES) for row in of_variant]
            panel.curve(x, y, label=of_variant[0]["variant"], colour=colour, look="points")
            for row, at, bound in zip(of_variant, x, y):
                panel.axes.annotate(f"{row['value']:g}", (at, bound), xytext=(0, 4 if colour == 0 else -8),
                                    fontsize=5.5, textcoords="offset points", ha="center", color=style.PALETTE[colour])
        panel.explain("line", "numbers: steps in µs")
        panel.padding = 2.0
        panel.then(lambda one: _one_percent(one, below=True)).explain("grey", "grey: below 1 %")
    return sheet


def _tilt_sheet(report: Row, steps: Sequence[Sequence[Row]], width: str) -> Sheet:
    sheet = style.sheet(width, -(-len(steps) // 2), min(2, len(steps)), panel_height=58).share_key()
    all_rows = [row for rows in steps for row in rows]
    for panel, rows in zip(sheet, steps):
        panel.titles(names.axis_title("/tilt/n_z"), names.axis_title("/tilt/v_along_mm_s"),
                     _scene_text(rows[0], all_rows)).range(x=(-0.4, 0.4), exactly=True).zero()
        for k, row in enumerate(rows[::2][:7]):
            of = like(report["tilt"], row, "length_mm", "variant", "knob", "value")
            if of is None:
                continue
            errors = np.array([math.nan if e is None else e for e in of["v_along_sem"]], dtype=float)
            # those met so seldom that they hide the others are left out
            velocity = np.where(errors < _LARGEST_ERROR, np.array([math.nan if v is None else v for v in of["v_along"]],
                                                                  dtype=float), np.nan)
            panel.curve(of["n_z"], velocity, errors, label=f"{row['value']:g} µs", colour=k, look="points")
    return sheet


def _model_sheet(model: Sequence[Sequence[Row]], shown: Sequence[Row], width: str) -> Sheet:
    """Differences from the most accurate value, for what changes the model."""
    sheet = style.sheet(width, -(-len(model) // 2), min(2, len(model)), panel_height=62).share_key()
    all_rows = [row for rows in model for row in rows]
    for panel, rows in zip(sheet, model):
        pitch = rows[0]["knob"] == "bead pitch"
        panel.titles("bead pitch (mm)" if pitch else "passes over the contacts of a tick", "difference (%)",
                     f"{_scene_text(rows[0], all_rows)}, against {rows[0]['value']:g}{' mm' if pitch else ' passes'}")
        panel.scale(x="log").zero()
        for k, of in enumerate([one for one in shown if one["name"] != "drift"][:7]):  # drift is too noisy beside them
            panel.curve(column(rows, "value"), *_bias(rows, of["name"]), label=of["title"].replace("n_z", "$n_z$"),
                        colour=k, look="points")
    return sheet


def statistical(report: Row, width: str | None) -> Figures:
    width = width or "183mm"
    shown = [of for of in report["observables"] if of["has_limit"]]
    series = series_of(report["rows"], "length_mm", "variant", "knob")
    steps = [rows for rows in series if rows[0]["knob"] == "step"]
    model = [rows for rows in series if rows[0]["knob"] != "step"]
    if steps:
        yield "bias", _bias_sheet(report, steps, shown, width)
        yield "tilt", _tilt_sheet(report, steps, width)
        rows = [row for one in steps for row in one]
        if report["limits"] and len(series_of(rows, "variant")) > 1:  # one step alone has no bias
            yield "cost", _cost_sheet(rows, width)
    if model:
        yield "model", _model_sheet(model, shown, width)


def peers(report: Row, width: str | None) -> Figures:
    rows = [row for row in report["rows"] if row["rod_s_per_cpu_s_best"]]
    sheet = style.sheet(width or "120mm", panel_height=_dots_height(len(rows)))
    categories = [f"{row['program']}, {row['dt_us']} µs" for row in rows]
    sheet[0].titles(x=f"{_RATE}, one thread").scale(x="log")
    sheet[0].dots(categories, [float(row["rod_s_per_cpu_s_best"]) for row in rows])
    yield "peers", sheet


#: "bench" of a report -> what draws it; others have no pictures.
DRAWERS: dict[str, Callable[[Row, str | None], Figures]] = {
    "speed": speed, "kinds": kinds, "scaling n": scaling, "scaling dt": scaling, "threads": threads,
    "hard": hard, "hard history": hard_history, "effects": effects,
    "accuracy deterministic": deterministic, "accuracy statistical": statistical,
    "peers": peers,
}


def figures_of(report: Row, width: str | None = None) -> Figures:
    """(name, figure) of everything that a report has."""
    drawer = DRAWERS.get(report.get("bench", ""))
    if drawer is not None and report.get("rows"):
        yield from drawer(accuracy.fitted(report), width)


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
