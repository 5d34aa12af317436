"""The tables of docs/findings.md on made-up runs with known answers."""
import itertools
import math
import re
from pathlib import Path

import numpy as np
import pytest

from shaken.estimate import Estimate
from shaken.run import Arrays, Run
from shaken.study import beyond_paper, next_runs
from shaken.study.evidence import PACKING, SIDE, Evidence, Runs
from shaken.study.motion_checks import papers_diffusion
from shaken.study.report import sections
from shaken.study.statements import STATEMENTS, judged
from shaken.units import unit_of

_ids = itertools.count()


def run(sweep, numbers=None, arrays=None, *, length=2.5, packing=0.75, side=40.0, beads=9, gamma=7.0, frequency=200.0,
        n_rods=800, seconds=200.0, speed=400.0, S=0.2, step=1.6e-5, aspect=None, end=0.4):
    """A run of a set, with numbers (NAME -> (value, error)) and arrays."""
    scene = {"rods": {"length": length, "area_fraction": packing, "beads": beads, "end_diameter": end},
             "box": {"side": side, "gap": 1.2}, "plates": {"gamma": gamma, "frequency": frequency},
             "time": {"step": step, "seed": 1}}
    if aspect is not None:
        scene["box"]["aspect"] = aspect

    def measured(value, error):
        return {"value": value, "sem": error, "steady": True, "n_effective": 40.0,
                "drift": {"value": 0.0, "sem": error}}

    summary = {"run_id": f"{next(_ids):016x}", "n_rods": n_rods, "sim_seconds": seconds, "t_steady_s": 30.0,
               "steady": True, "order": {**measured(S, 0.01), "mean": S, "std": 0.05},
               "measured": {name: measured(*value) for name, value in (numbers or {}).items()},
               "rod_seconds_per_cpu_second": speed}
    contents = arrays or {}
    made = Run(scene, summary, Arrays(list(contents), lambda name: (np.asarray(contents[name], float), unit_of(name))))
    made.sweeps = [sweep + "-desk"]
    return made


def rows(text):
    """The cells of a table's rows, without its head."""
    return [line.strip("| ").split(" | ") for line in text.splitlines() if line.startswith("| ")][1:]


def diffusion(value, error):
    return {"diffusion_mm2_s": (value, error)}


def test_beads_are_compared_at_the_same_number_of_rods():
    # 9 beads: D = 1, 4, 16 at 0.5, 0.6, 0.7 rods/mm2, so that ln D is a line; 0.55 is half way: D = 2
    evidence = Evidence([
        run("beads", diffusion(3.0, 0.3), beads=21, n_rods=880), run("beads", diffusion(6.0, 0.9), beads=7, n_rods=960),
        run("beads", diffusion(4.0, 0.4), n_rods=960), run("density", diffusion(1.0, 0.1), packing=0.70, n_rods=800),
        run("density", diffusion(16.0, 1.6), packing=0.80, n_rods=1120)])
    text = beyond_paper.beads(evidence)
    fewest, usual, most = rows(text)
    assert fewest[0] == "7" and fewest[4] == "60.0" and fewest[7] == "4.0 ± 0.4" and fewest[8] == "1.5 ± 0.3"
    assert usual[8] == "–", "the reference is not compared with itself"
    # D of 9 beads at 0.55: 2, with error (1/2) sqrt((2 x 0.1)^2 + (2 x 0.1)^2) = 0.14
    assert most[7] == "2.00 ± 0.14" and most[8] == "1.50 ± 0.18"
    # 6 / 3, with relative errors 0.15 and 0.1: 2 x 0.18
    assert text.splitlines()[-1].endswith("at the same area fraction: 2.0 ± 0.4.")


def test_nothing_is_interpolated_outside():
    points = [(1.0, Estimate(2.0, 0.1)), (2.0, Estimate(8.0, 0.2))]
    assert beyond_paper.log_interpolated(points, 1.5).value == pytest.approx(4.0)
    assert beyond_paper.log_interpolated(points, 1.0).error == pytest.approx(0.1)
    assert not beyond_paper.log_interpolated(points, 0.9).is_known
    assert not beyond_paper.log_interpolated(points, 2.1).is_known


def test_state_points_are_split_in_rising_order():
    runs = Runs([run("a", packing=p, side=s) for p, s in ((0.8, 40.0), (0.7, 60.0), (0.8, 20.0), (0.8, 40.0))])
    assert [(here[0].key(PACKING), here[0].key(SIDE), len(here)) for here in beyond_paper.by(runs, PACKING, SIDE)] \
        == [(0.7, 60.0, 1), (0.8, 20.0, 1), (0.8, 40.0, 2)]


def test_diffusion_at_the_rival_frequency_is_compared_with_itself():
    evidence = Evidence([run("frequency", {**diffusion(1.25, 0.05), "diffusion_short_mm2_s": (0.5, 0.02)}, packing=0.60,
                             frequency=f) for f in (200.0, 280.0)])
    (row,) = rows(beyond_paper.rival_frequency(evidence))
    assert row[3] == "2.50 ± 0.14", "relative errors 0.04 and 0.04"
    assert [row[0] for row in rows(beyond_paper.frequency(evidence))] == ["200", "280"]


def test_plates_at_rest_are_no_shaking():
    evidence = Evidence([run("shaking", gamma=gamma) for gamma in (0.0, 7.0, 3.0)])
    assert [row[1] for row in rows(beyond_paper.shaking(evidence))] == ["3", "7"]


def msd(along, relative):
    lag = [50.0, 100.0]
    return {"/msd/lag_s": lag, "/msd/along_mm2": [1.0, along], "/msd/along_sem_mm2": [0.1, 0.1 * along],
            "/msd/total_mm2": [2.0, 1.25 * along], "/msd/relative_total_mm2": [2.0, relative]}


def test_ways_are_in_boxes_and_their_common_drift_is_named():
    # 6400 mm2 in a box of 40 mm: two boxes, with half the relative error; 6000 of 8000 without the common drift
    evidence = Evidence([run("long-rods", {"diffusion_along_mm2_s": (10.0, 1.0)}, msd(6400.0, 6000.0), packing=0.85),
                         run("long-rods", {}, msd(100.0, 100.0), packing=0.55)])
    (row,) = rows(beyond_paper.streaming(evidence))
    assert row[3:6] == ["–", "10.0 ± 1.0", "–"], "one run without long octaves has its own D"
    assert row[8:] == ["100", "2.00 ± 0.10", "25.0 %"], "and what is not dense is no stream"


def lasting(along, density, error=0.1):
    return {"lasting_defect_speed_plus_along_mm_s": (along, error), "lasting_defect_density_per_mm2": (density, 0.0001),
            "lasting_defect_speed_minus_mm_s": (2.0, 0.1)}


def test_defects_swim_head_first_where_they_move_against_their_tail():
    evidence = Evidence([
        *(run("short-rods", lasting(-3.0, 0.006), packing=0.8) for _ in range(2)),
        run("short-rods", lasting(-4.0, 0.006), packing=0.8, step=4e-6),
        run("short-rods", lasting(-3.0, 0.0001), packing=0.85),
        run("phases", lasting(2.0, 0.004), {"/defects/tracks/span_s": [0.2, 0.4, 0.8],
                                            "/defects/tracks/lasting/speed_plus_along_mm_s": [1.8, 1.9, 2.0],
                                            "/defects/tracks/lasting/speed_plus_along_sem_mm_s": [0.1, 0.2, 0.3]},
            length=3.0, packing=0.7)])
    control, first, second = rows(beyond_paper.defects(evidence))
    assert first[1:5] == ["0.8", "40 mm", "16 µs", "2 × 200 s"] and first[6] == "0.600 ± 0.007"
    assert first[8] == "3.00 ± 0.07" and second[0] == "3 mm" and second[8] == "−2.00 ± 0.10"
    assert first[9] == "–" and second[9] == "−1.80 ± 0.10", "over one sample"
    assert control[3] == "4 µs" and control[8] == "4.00 ± 0.10", "another step is another row"
    unknown = Runs([run("short-rods", {**lasting(-3.0, 0.006), "lasting_defect_speed_plus_along_mm_s": (-3.0, None)})])
    assert beyond_paper.swimming_defects(unknown) == [], "without an error there is no swimming"


def test_tilt_is_compared_at_the_same_packing():
    evidence = Evidence([run("short-rods", packing=0.6), run("short-rods", packing=0.7),
                         run("mechanism", {"n_z_switching_time_s": (0.02, 0.001)}, packing=0.6, side=25.0)])
    assert [(row[0], row[1], row[-1]) for row in rows(beyond_paper.diffusion_minimum(evidence))] == [
        ("0.6", "25 mm", "20.0 ± 1.0"), ("0.6", "40 mm", "20.0 ± 1.0"), ("0.7", "40 mm", "–")]


def wanderer(rng, *, tau, kinetic, pull, n_rods, seconds=400.0, step=0.01):
    """Way of the centre of mass of rods that are pulled along x and lose their momentum within tau, as measured."""
    n = round(seconds / step)
    keep, speed = math.exp(-step / tau), math.sqrt(kinetic / n_rods)
    v, way = np.zeros((n, 2)), np.array([pull * tau, 0.0])
    for k in range(1, n):
        v[k] = keep * v[k - 1] + speed * math.sqrt(1 - keep**2) * rng.standard_normal(2)
    x, y = (np.cumsum((v + way) * step, axis=0)).T
    return {"/drift/time_s": np.arange(n) * step, "/drift/x_mm": x, "/drift/y_mm": y}


def test_pulled_rods_lose_their_momentum_as_they_wander():
    rng, made = np.random.default_rng(3), []
    for degrees in (0.1, 0.1, 0.1, 0.25, 0.25, 0.25):
        pull = 9810 * math.sin(math.radians(degrees))
        way = wanderer(rng, tau=0.3, kinetic=150.0, pull=pull, n_rods=400)
        drift = [float((way[name][-1] - way[name][3000]) / 370) for name in ("/drift/x_mm", "/drift/y_mm")]
        rms = math.sqrt(2 * 150 + drift[0] ** 2 + drift[1] ** 2)
        made.append(run("response", {"drift_x_mm_s": (drift[0], 0.05), "drift_y_mm_s": (drift[1], 0.05),
                                     "speed_rms_mm_s": (rms, 0.01)}, way, n_rods=400, seconds=400.0))
        made[-1].scene.update(gravity=9810.0)
        made[-1].scene["plates"]["inclination"] = degrees
    short = run("short-rods", diffusion(9.0, 0.1))
    (row,) = rows(beyond_paper.linear_response(Evidence([*made, short])))
    assert row[:4] == ["2.5 mm", "0.75", "either way", "6 × 400 s"]
    value = [float(cell.split(" ± ")[0]) for cell in row[4:]]
    assert value[:2] == pytest.approx([0.3, 0.3], rel=0.05), "the same at both angles: the response is linear"
    assert value[2] == pytest.approx(1.0, abs=0.05) and value[3] == pytest.approx(150, rel=0.01)
    assert value[4] == pytest.approx(45, rel=0.2) and value[5] == pytest.approx(1.0, rel=0.2), "Einstein: tau T/m = 45"
    assert value[6:] == [9.0, pytest.approx(0.2, rel=0.05)]


def test_long_rods_are_pulled_along_and_across():
    made = []
    for angle, drift in ((0.0, (4.0, 0.3)), (90.0, (0.3, 8.0))):
        made.append(run("response", {"drift_x_mm_s": (drift[0], 0.1), "drift_y_mm_s": (drift[1], 0.1)}, length=4.5))
        made[-1].scene.update(gravity=9810.0)
        made[-1].scene["plates"].update(inclination=0.1, inclination_angle=angle)
    found = rows(beyond_paper.linear_response(Evidence(made)))
    assert [row[2] for row in found] == ["along the director", "across the director"]
    assert [row[4] for row in found] == ["0.234 ± 0.006", "0.467 ± 0.006"], "4 and 8 mm/s over 17.1 mm/s2"


def test_motion_of_neighbours_stands_beside_the_persistence_of_ways():
    numbers = {"flow_of_neighbours": (0.6, 0.02), "flow_length_mm": (2.9, 0.1), "persistence_time_s": (1.4, 0.1)}
    assert rows(beyond_paper.neighbours(Evidence([run("neighbours", numbers)]))) == [
        ["0.75", "40 mm", "1 × 200 s", "0.60 ± 0.02", "2.90 ± 0.10", "1.40 ± 0.10", "–"]]


def test_rods_in_the_core_of_a_defect_stand_beside_it():
    evidence = Evidence([run("defect-flow", {**lasting(-2.1, 0.01), "core_flow_along_mm_s": (-2.0, 0.1),
                                             "core_density_plus": (0.91, 0.02), "core_flow_across_mm_s": (0.1, 0.1)})])
    assert rows(beyond_paper.carried(evidence)) == [
        ["2.5 mm", "0.75", "40 mm", "1 × 200 s", "0.91 ± 0.02", "2.00 ± 0.10", "2.10 ± 0.10", "0.10 ± 0.10"]]


def test_beads_added_up_stand_beside_the_solid():
    evidence = Evidence([run("short-rods", diffusion(4.0, 0.2)), run("inertia", diffusion(5.0, 0.2))])
    (row,) = rows(beyond_paper.inertia(evidence))
    assert row[3:6] == ["4.0 ± 0.2", "5.0 ± 0.2", "1.25 ± 0.08"], "1.25 (0.05^2 + 0.04^2)^(1/2)"


def test_elastic_constants_are_those_of_boxes_that_hold_waves():
    evidence = Evidence([run("size", {"frank_ratio": (4.0, 0.5), "frank_chi2": (1.0, 0.2)}, length=4.5, packing=0.55,
                             side=side) for side in (16.0, 67.0)])
    assert [row[1:2] + row[4:] for row in rows(beyond_paper.elastic(evidence))] == [
        ["67 mm", "–", "–", "–", "4.0 ± 0.5", "1.0 ± 0.2"]]


def test_order_falls_with_the_box_by_a_power():
    evidence = Evidence([run("size", {"S": (1.6 * side ** -0.25, 0.01)}, length=4.5, packing=0.55, side=side)
                         for side in (16.0, 32.0, 64.0)] + [run("dilute", length=4.5, packing=0.45, side=67.0)])
    found = rows(beyond_paper.sizes(evidence))
    assert [row[1] for row in found] == ["16 mm", "32 mm", "64 mm"], "one box says nothing about boxes"
    assert found[0][4] == "–" and all(row[4].startswith("−0.25 ± 0.0") for row in found[1:])


def test_runs_are_priced_by_the_speed_of_those_at_hand():
    # 0.5 rods/mm2 at 0.75, hence 600 of them at 0.75 in 1200 mm2; 400 rod seconds a second: 2 x 600 x 300 / 400 s
    evidence = Evidence([run("short-rods", n_rods=800), run("shaking", gamma=0.0, speed=1.0)])
    wanted = next_runs.Batch(2.5, 0.75, math.sqrt(1200), 300, 2)
    assert next_runs.hours(evidence, wanted) == pytest.approx(2 * 600 * 300 / 400 / 3600)
    assert math.isnan(next_runs.hours(evidence, next_runs.Batch(4.5, 0.75, 40, 300, 2)))
    assert "| – |" in next_runs.open_questions(evidence)
    assert len(rows(next_runs.open_questions(evidence))) == len(next_runs.QUESTIONS)


def test_open_statements_have_a_reason_and_a_price():
    # no runs of some, and of the angle against packing one packing only
    evidence = Evidence([run("strip", length=4.5, packing=0.8, n_rods=900, side=52.0)])
    found = {row[0]: row[1:] for row in rows(next_runs.open_statements(evidence, judged(evidence)))}
    says = {statement.id: statement.says for statement in STATEMENTS}
    assert set(next_runs.DECIDING) <= set(says)
    assert found[says["angle-end"]] == ["no runs yet", next_runs.BLUNT[0], "–"]
    assert float(found[says["long-range"]][2]) > 0, "rods of 4.5 mm have a speed"
    assert set(found) == {v.statement.says for v in judged(evidence) if v.finding.verdict in ("open", "no data")}


def test_an_archive_without_these_sets_has_empty_tables():
    evidence = Evidence([run("movies")])
    for name, make in beyond_paper.SECTIONS.items():
        assert rows(make(evidence)) == [], name


def test_the_page_has_each_table_once():
    page = (Path(__file__).resolve().parents[2] / "docs" / "findings.md").read_text()
    begun = re.findall(r"<!-- (.+?): begin -->", page)
    assert sorted(begun) == sorted([*beyond_paper.SECTIONS, "next runs"]), "each table stands on the page, and is known"
    assert set(beyond_paper.SECTIONS) <= set(sections(Evidence([])))


def test_both_readings_stand_beside_the_fit():
    # MSD = 4Dt gives half of the paper's fit everywhere, so MSD = 2Dt all of it; with more rods all of it
    packings = (0.60, 0.65, 0.70, 0.75, 0.80, 0.85)
    evidence = Evidence([*(run("short-rods", diffusion(papers_diffusion(at) / 2, 0.05), packing=at) for at in packings),
                         run("density", diffusion(6.5, 0.2), packing=0.74 * 1.033, side=60.0),
                         run("frequency", diffusion(1.7, 0.1), packing=0.65, frequency=280.0)])
    found = [row for row in rows(beyond_paper.readings(evidence)) if row[0] != "of"]
    (first, second), (more, paper, once, twice) = found[:2], found[-4:]
    assert first[:5] == ["0.6", "N", "2.5", "1.23 ± 0.05", "0.50 ± 0.02"]
    assert second[5:] == ["1.75 ± 0.10", "1.00 ± 0.06", "3.4 ± 0.2", "1.95 ± 0.11"], "1.7 + 480 x 0.01^2 = 1.748"
    assert more[:5] == ["0.74", "1.033 N", "6.5", "6.5 ± 0.2", "1.00 ± 0.03"] and more[7:] == ["–", "–"]
    assert paper == ["the paper", "1.7", "480", "0.64", "–"]
    assert once[0] == "N rods, MSD = 4Dt" and twice[0] == "N rods, MSD = 2Dt"
    for row, law in ((once, [0.85, 240, 0.64]), (twice, [1.7, 480, 0.64])):
        assert [float(cell.split(" ± ")[0]) for cell in row[1:4]] == pytest.approx(law, rel=0.01)


def test_a_parabola_is_known_as_well_as_its_points_are():
    rng = np.random.default_rng(5)
    at, error = np.array([0.65, 0.70, 0.75, 0.80, 0.85]), np.array([0.03, 0.1, 0.2, 0.15, 0.8])
    law = 1.6 + 400 * (at - 0.67) ** 2
    pulls, chi2 = [], []
    for _ in range(400):
        points = [(x, Estimate(y, e)) for x, y, e in zip(at, law + error * rng.standard_normal(5), error)]
        found, of = beyond_paper.parabola(points)
        pulls.append([(e.value - true) / e.error for e, true in zip(found, (1.6, 400, 0.67))])
        chi2.append(of)
    # errors grow where chi square is above 1, so that pulls are a little below 1
    assert np.mean(chi2) == pytest.approx(1.0, abs=0.15)
    assert np.abs(np.mean(pulls, axis=0)).max() < 0.15 and np.all((np.std(pulls, axis=0) > 0.7) &
                                                                    (np.std(pulls, axis=0) < 1.05))
    assert beyond_paper.parabola([(0.65, Estimate(1.0, 0.1))] * 3) is None


def test_layers_of_a_strip_stand_beside_those_of_the_square_box():
    def layers(sweep, wavelength, **more):
        return run(sweep, {"theta_m_deg": (9.0, 0.5), "wavelength_mm": (wavelength, 0.1), "layer_order": (0.3, 0.02),
                           "dip": (0.7, 0.02)},
                   length=4.5, packing=0.80, S=0.9, **more)

    square = layers("layers", 14.0, side=42.0)
    assert beyond_paper.strip(Evidence([square])) == "", "nothing is shown before there are runs"
    strips = [layers("strip", value, side=21.0, aspect=6, n_rods=850) for value in (14.0, 14.0, 14.0)]
    first, second = rows(beyond_paper.strip(Evidence([square, *strips])))
    # three waves of 14 mm fit into 42 mm, nine into 126: the next are 42 / 4 and 126 / 10
    assert first[:4] == ["4.5 mm", "0.8", "42 mm", "rows"] and second[2] == "21 × 126 mm" and second[4] == "3 × 200 s"
    assert first[8] == "3.5" and second[8] == "1.4"
    # a uniform error over the step, 42 / 2.5 - 42 / 3.5 and 126 / 8.5 - 126 / 9.5, besides that of the mean
    for cell, step, runs_ in ((first[7], 4.8, 1), (second[7], 1.56, 3)):
        error = math.hypot(step / math.sqrt(12), 0.1 / math.sqrt(runs_))
        assert float(cell.split(" ± ")[1]) == pytest.approx(error, rel=0.15)


def test_blunt_rods_from_rows_stand_beside_those_from_a_fluid():
    def rods(sweep, end, psi_6, packing=0.85):
        made = run(sweep, {"psi_6": (psi_6, 0.01)}, length=4.0, packing=packing, end=end)
        if sweep == "fluid-start":
            made.summary["start"] = {"run": "0123456789abcdef", "time": 30.0}
        return made

    made = [rods("layer-trends", 0.4, 0.03), rods("layer-trends", 0.5, 0.76), rods("fluid-start", 0.5, 0.5),
            rods("fluid-start", 0.5, 0.02, 0.70)]
    found = rows(beyond_paper.blunt(Evidence(made)))
    states = [["0.4 mm", "0.85", "40 mm", "rows"], ["0.5 mm", "0.85", "40 mm", "rows"],
              ["0.5 mm", "0.85", "40 mm", "a fluid"]]
    assert [row[:4] for row in found] == states, "the melt is a stage, no state of its own"
    assert [row[6] for row in found] == ["0.030 ± 0.010", "0.760 ± 0.010", "0.500 ± 0.010"]


def test_rods_are_counted_in_the_area_of_a_box_that_is_not_square():
    evidence = Evidence([run("strip", length=4.5, packing=0.8, side=20.0, aspect=2, n_rods=320)])
    batch = next_runs.Batch(4.5, 0.8, 40.0, 100.0, 1)
    assert next_runs.hours(evidence, batch) == pytest.approx(0.4 * 1600 * 100 / 400 / 3600)
