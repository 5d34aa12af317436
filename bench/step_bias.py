#!/usr/bin/python3
"""How far averages are off because of the time step, and what it costs, from the runs of configs/steps.json.

    shaken submit configs/steps.json; shaken wait
    bench/step_bias.py > steps.csv           the biases in per cent of the limit of short steps
    bench/step_bias.py steps.csv PICTURES    accuracy-bias.png and accuracy-cost.png of such a table

The limit of a vanishing step is that of a straight line through the steps up to 8 times the shortest, by weighted least
squares. docs/accuracy.md explains what is found.
"""
import csv
import math
import sys
from pathlib import Path

import numpy as np

import shaken
from shaken.plots import names, style

LINEAR = 8  # times the shortest step: as far as a line is taken to hold
# Name in the table -> the number of a run; those without one have been measured in another way (docs/accuracy.md).
QUANTITIES = {"T_in_plane": "temperature_horizontal_pJ", "T_upright": "temperature_vertical_pJ",
              "T_rotation": "temperature_rotation_pJ", "order_S": "S", "rms_n_z": "", "drift": "tilt_fastest_mm_s",
              "square_displacement_20.7_ms": "", "displacement_short": "diffusion_short_mm2_s", "just_hit": ""}
AVERAGES = ("T_in_plane", "T_upright", "T_rotation", "rms_n_z", "square_displacement_20.7_ms", "displacement_short")
COST, BIAS, ERROR = "cost_relative_to_4_us_at_tick_end", "{}_bias_percent", "{}_standard_error_percent"


def step_us(point):
    return round(1e6 * point.runs[0].scene["time"]["step"], 6)


def biases(steps, values):
    """Of each value in per cent of the limit of short steps, with an error that is also that of the limit."""
    fine = [(step, value) for step, value in zip(steps, values) if step <= LINEAR * min(steps) and value.error > 0]
    if len(fine) < 2:
        return [shaken.Estimate(reason="too few steps with an error")] * len(values)
    line, covariance = np.polyfit([step for step, _ in fine], [float(value) for _, value in fine], 1,
                                  w=[1 / value.error for _, value in fine], cov="unscaled")
    limit = shaken.Estimate(line[1], math.sqrt(covariance[1, 1]))
    return [100 * (value / limit - 1) for value in values]


def table(sweep):
    """A row for each rod, way to treat impacts, and step."""
    rows = []
    swept = [point for point in sweep if {"time.step", "time.impacts"} <= set(point.parameters) and point.runs]
    for length in sorted({point.key("rods.length") for point in swept}, reverse=True):
        of_rod = sorted((point for point in swept if point.key("rods.length") == length), key=step_us)
        cpu = {(point.key("time.impacts"), step_us(point)): np.mean([run.summary["cpu_seconds"] for run in point.runs])
               for point in of_rod}
        for impacts in ("tick_end", "at_instant"):
            points = [point for point in of_rod if point.key("time.impacts") == impacts]
            steps = [step_us(point) for point in points]
            found = {name: biases(steps, [point[number] for point in points])
                     for name, number in QUANTITIES.items() if number}
            for k, step in enumerate(steps):
                rows.append({"step_us": f"{step:g}", "rod_length_mm": f"{length:g}", "impacts": impacts,
                             COST: f"{cpu[impacts, step] / cpu['tick_end', 4.0]:.3g}"})
                for name, bias in found.items():
                    rows[-1] |= {BIAS.format(name): f"{bias[k].value:.2f}", ERROR.format(name): f"{bias[k].error:.2f}"}
    return rows


def column(rows, name):
    return np.array([float(row[name]) for row in rows])


def grouped(rows):
    """(rod, impacts) -> its rows."""
    groups = {}
    for row in rows:
        groups.setdefault((row["rod_length_mm"], row["impacts"]), []).append(row)
    return groups


def one_percent(panel):
    low, high = panel.axes.get_ylim()
    panel.axes.axhspan(max(low, -1), min(high, 1), color="#ececec", linewidth=0, zorder=0.5)
    panel.axes.set_ylim(low, high)


def finish(panel):
    panel.then(one_percent).explain("grey", "grey: below 1 %")


def bias_sheet(rows):
    """The bias of each quantity that is known to 1 % against the step."""
    shown = {name: [(key, group) for key, group in grouped(rows).items()
                    if np.median(column(group, ERROR.format(name))) < 1]
             for name in QUANTITIES if BIAS.format(name) in rows[0]}
    shown = {name: groups for name, groups in shown.items() if groups}
    sheet = style.sheet("183mm", -(-len(shown) // 4), min(4, len(shown)), panel_height=48).share_key()
    colours = {key: k for k, key in enumerate(grouped(rows))}
    for panel, (name, groups) in zip(sheet, shown.items()):
        panel.titles("step $Δt$ (µs)", "bias (%)", name.replace("_", " ")).scale(x="log").range(y=(-1.5, 1.5)).zero()
        for (length, impacts), group in groups:
            panel.curve(column(group, "step_us"), column(group, BIAS.format(name)), column(group, ERROR.format(name)),
                        label=f"ℓ = {length} mm, {impacts}", colour=colours[length, impacts], look="points")
        finish(panel)
    return sheet


def cost_sheet(rows):
    """The largest bias of the averages, and that of contacts where it is known, against the CPU time."""
    rods = list(dict.fromkeys(row["rod_length_mm"] for row in rows))
    kinds = [("averages", [name for name in AVERAGES if BIAS.format(name) in rows[0]])]
    kinds += [("just hit", ["just_hit"])] if BIAS.format("just_hit") in rows[0] else []
    sheet = style.sheet("183mm", len(kinds), len(rods), panel_height=58).share_key()
    for panel, (title, quantities, rod) in zip(sheet, [(*kind, rod) for kind in kinds for rod in rods]):
        panel.titles("CPU time, relative to 4 µs at the tick's end", "|bias| + 2 standard errors (%)",
                     f"{names.value_label('rods.length', float(rod))}: {title}").scale("log", "log")
        for k, impacts in enumerate(("tick_end", "at_instant")):
            group = grouped(rows)[rod, impacts]
            bound = np.max([np.abs(column(group, BIAS.format(name))) + 2 * column(group, ERROR.format(name))
                            for name in quantities], axis=0)
            panel.curve(column(group, COST), bound, label=impacts, colour=k, look="points")
            for row, x, y in zip(group, column(group, COST), bound):
                panel.axes.annotate(row["step_us"], (x, y), xytext=(0, 4 if k == 0 else -8), fontsize=5.5,
                                    textcoords="offset points", ha="center", color=style.PALETTE[k])
        panel.padding = 2.0
        panel.explain("line", "numbers: steps in µs")
        finish(panel)
    return sheet


def main(words):
    if not words:
        rows = table(shaken.results(sweep="steps"))
        writer = csv.DictWriter(sys.stdout, list(rows[0]), lineterminator="\n")
        writer.writeheader()
        writer.writerows(rows)
        return
    with open(words[0], newline="") as file:
        rows = list(csv.DictReader(file))
    for name, draw in (("bias", bias_sheet), ("cost", cost_sheet)):
        draw(rows).save(Path(words[1]) / f"accuracy-{name}.png", {}, data=False)


if __name__ == "__main__":
    main(sys.argv[1:])
