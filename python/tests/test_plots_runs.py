"""Figures of runs and sweeps: which curves there are, what they are called, and what is said of them."""
from __future__ import annotations

import csv
import io
from pathlib import Path
from typing import Any

import numpy as np
import pytest

pytest.importorskip("matplotlib")
from figures_whole import assert_whole  # noqa: E402

from shaken.estimate import Estimate, replica_mean  # noqa: E402
from shaken.plots import names, runs, series, sweeps  # noqa: E402
from shaken.rows import Row  # noqa: E402

NAN = float("nan")
TILT = {"/tilt/n_z": [-0.1, 0.1], "/tilt/v_along_mm_s": [1.0, 2.0]}


def run(arrays: dict[str, Any], steady: bool | None = True, version: str = "",
        **parameters: Any) -> runs.PlottedRun:
    return runs.PlottedRun(parameters, {name: np.array(values, dtype=float) for name, values in arrays.items()}, steady,
                           version)


def figures(*of: runs.PlottedRun) -> dict[str, Any]:
    return dict(runs.run_figures(of))


def rows_of(path: Path) -> list[dict[str, str]]:
    text = "".join(line for line in path.read_text().splitlines(True) if not line.startswith("#"))
    return list(csv.DictReader(io.StringIO(text)))


def labels(panel: Any) -> list[str]:
    return [names.plain(label) for _, label in panel.entries]


def test_only_what_was_measured_is_drawn() -> None:
    assert not figures(run({}))
    found = figures(run({"/order/time_s": [0, 1, 2], "/order/order": [1, 0.5]}), run({}, area_fraction=1))
    assert list(found) == ["order_time"]
    assert list(found["order_time"][0].drawn[0].x) == [0, 1]  # the time whose order is not on the disk yet is left out


def test_a_row_of_what_has_several_is_drawn() -> None:
    scattering = {"/scattering/q_per_mm": [1, 2], "/scattering/lag_s": [0.1, 0.2, 0.4],
                  "/scattering/f": [0.9, 0.8, 0.7, 0.6, 0.5, 0.4], "/scattering/f_sem": [1, 2, 3, 4, 5, 6],
                  "/scattering/alpha_2": [0.1, 0.2, 0.3]}
    van_hove = {"/van_hove/lag_s": [1, 4], "/van_hove/displacement_mm": [1, 3, 2, 6],
                "/van_hove/along_per_mm": [0.4, 0.1, 0.2, 0.05], "/van_hove/along_sem_per_mm": [1, 2, 3, 4]}
    found = figures(run({**scattering, **van_hove}), run({f"/rods_2{name}": of for name, of in scattering.items()}))
    for name in ("scattering", "rods_2_scattering"):  # the first row
        curve = found[name][0].drawn[0]
        assert (list(curve.x), list(curve.y), list(curve.error)) == ([0.1, 0.2, 0.4], [0.9, 0.8, 0.7], [1, 2, 3])
    assert list(found["non_gaussian"][0].drawn[0].y) == [0.1, 0.2, 0.3]
    curve = found["van_hove"][0].drawn[0]  # the last row, of x too
    assert (list(curve.x), list(curve.y), list(curve.error)) == ([2, 6], [0.2, 0.05], [3, 4])


def defect_maps(prefix: str = "", flow: float = -2.0) -> dict[str, Any]:
    """About ideal defects, whose rods all move along x'."""
    at = np.linspace(-4, 4, 17)
    x, y = np.meshgrid(at, at)
    r = np.hypot(x, y)
    known, r = r < 4, np.maximum(r, 1e-9)
    found = {f"{prefix}/defect_maps/{axis}_mm": at for axis in ("along", "across")}
    for charge, sign in (("plus", 1), ("minus", -1)):
        for name, values in (("density", 1 + 0.1 * x / r), ("cos_2theta", x / r), ("sin_2theta", sign * y / r),
                             ("v_along_mm_s", flow + 0 * x), ("v_across_mm_s", 0 * x), ("tilt_squared", 0 * x)):
            found[f"{prefix}/defect_maps/{charge}/{name}"] = np.where(known, values, NAN).ravel()
    return found


def test_maps_about_defects_show_director_and_flow(tmp_path: Path) -> None:
    found = figures(run({**defect_maps(flow=-2), **defect_maps("/rods_2")}), run(defect_maps(flow=-4)))
    assert list(found) == ["defect_maps", "rods_2_defect_maps"]
    sheet = found["defect_maps"]
    assert [names.plain(panel.title) for panel in sheet] == ["about +1/2 defects", "about −1/2 defects"] * 2
    angle = {k: next(one for one in sheet[k].drawn if one.curve.startswith("angle")) for k in (0, 1)}
    for k, sign in ((0, 1), (1, -1)):
        drawn = angle[k]
        phi = np.arctan2(drawn.y, drawn.x)
        there = np.isfinite(drawn.z) & (np.hypot(drawn.x, drawn.y) > 1)
        assert np.allclose(np.exp(2j * np.array(drawn.z))[there], np.exp(1j * sign * phi)[there])
    flow = np.array(sheet[2].drawn[0].z)
    assert np.nanmin(flow) == np.nanmax(flow) == -3  # of replicas the mean
    assert_whole(sheet.finish())
    sheet.save(tmp_path / "maps.png")
    several = figures(run(defect_maps(), length=2.5), run(defect_maps(), length=3), run({}, length=4))
    assert list(several) == ["defect_maps_1", "defect_maps_2"]
    assert "3" in several["defect_maps_2"].title
    nothing = {name: (values if name.endswith("_mm") else NAN * values) for name, values in defect_maps().items()}
    assert not figures(run(nothing))


def test_maps_of_the_density_in_time(tmp_path: Path) -> None:
    maps = np.arange(5 * 6, dtype=float)
    maps[::6] = NAN  # a cell beyond walls
    density = {"/density/time_s": [1, 2, 3, 4, 5], "/density/x_mm": [1, 3, 5], "/density/y_mm": [1, 3],
               "/density/area_fraction": maps[:-2], "/density/mean_area_fraction": [NAN, 1, 2, 3, 4, 5],
               "/density/memory/lag_s": [0, 1], "/density/memory/correlation": [1, 0.5]}
    found = figures(run(density))
    assert list(found) == ["density_memory", "density_maps"]
    panels = [panel for panel in found["density_maps"] if panel.is_used]
    assert [names.plain(panel.title) for panel in panels] == ["t = 1 s", "t = 3 s", "t = 4 s", "mean"]
    assert list(panels[1].drawn[0].z[1:]) == [13, 14, 15, 16, 17]  # the fifth is not on the disk yet
    assert_whole(found["density_maps"].finish())


def test_a_map_has_the_first_run_of_each_point_at_its_place(tmp_path: Path) -> None:
    from PIL import Image
    renderer = tmp_path / "renderer"
    renderer.write_text('#!/bin/sh\ncp "$2/rods.png" "$8" 2>/dev/null || { echo torn; exit 1; }\n')
    renderer.chmod(0o755)
    sweep = []
    for k, (phi, length) in enumerate([(0.8, "2.5 mm"), (0.4, "2.5 mm"), (0.4, "2.5 mm"), (0.4, "4.5 mm"),
                                       (0.6, "2.5 mm"), (0.6, "4.5 mm")]):
        folder = tmp_path / str(k)
        folder.mkdir()
        if k != 3:
            (folder / "trajectory.h5").touch()
        if k != 4:
            Image.new("RGB", (9, 9), (40 * k, 0, 0)).save(folder / "rods.png")
        sweep.append((str(folder), {"wall": "rough", "rods.area_fraction": phi, "rods.length": length}))
    sheet, missing = sweeps.picture_map(sweep, ["rods.area_fraction", "rods.length"], str(renderer))
    assert missing == ["nothing was recorded", "torn"]
    red = [round(float(panel.axes.images[0].get_array()[4, 4, 0]) * 255) if panel.has_picture else panel.absent
           for panel in sheet]
    assert red == ["no frame", 200, "no data", 40, "no frame", 0]  # long rods above; two of (0.4, 2.5 mm)
    assert names.plain(sheet[1].title) == "φ = 0.6, ℓ = 4.5 mm" and not sheet[2].is_used
    assert_whole(sheet.finish())
    row, _ = sweeps.picture_map([one for one in sweep if one[1]["rods.length"] == "2.5 mm"], ["rods.area_fraction"],
                                  str(renderer))
    assert [panel.has_picture for panel in row] == [True, False, True]


def test_replicas_are_a_mean_with_its_error() -> None:
    one = {**TILT, "/tilt/v_along_sem_mm_s": [9, 9], "/order/time_s": [0, 1], "/order/order": [1, 0.5]}
    two = {**one, "/tilt/v_along_mm_s": [3, NAN], "/order/order": [1, 0.7]}
    short, long = {"rods.length": 2.5}, {"rods.length": 4.5}
    found = figures(run(one, **short), run(two, **short), run(one, **long))
    tilt = found["tilt"][0].drawn
    assert len(tilt) == 2
    assert list(tilt[0].y) == [2, 2]  # the mean of 1 and 3; of 2 alone
    # of two the errors of both together, which is more than their scatter; of one its own
    assert list(tilt[0].error) == pytest.approx([np.sqrt(2 * 81) / 2, 9])
    assert list(tilt[1].error) == [9, 9]
    order = found["order_time"][0].drawn
    assert list(order[0].y) == pytest.approx([1, 0.6])
    assert order[0].error is not None and order[0].error[1] > 0  # a band for S(t) too
    assert labels(found["tilt"][0]) == ["ℓ = 2.5 mm", "ℓ = 4.5 mm"]


def test_curves_with_other_places_are_no_replicas() -> None:
    found = figures(run(TILT), run({**TILT, "/tilt/n_z": [-0.2, 0.2]}))
    assert [list(drawn.x) for drawn in found["tilt"][0].drawn] == [[-0.1, 0.1], [-0.2, 0.2]]


def test_means_of_curves_are_those_of_estimates() -> None:
    rng = np.random.default_rng(3)
    for n in (1, 2, 3, 5):
        values, errors = rng.normal(size=(n, 40)), 10 ** rng.uniform(-2, 1, size=(n, 40))
        values[rng.random((n, 40)) < 0.2] = NAN
        errors[rng.random((n, 40)) < 0.2] = NAN
        mean, error = series.mean_curve(list(values), list(errors))
        assert error is not None
        for k in range(40):
            known = [Estimate(v, e) for v, e in zip(values[:, k], errors[:, k]) if np.isfinite(v)]
            wanted = replica_mean(known)
            assert mean[k] == pytest.approx(wanted.value, nan_ok=True)
            assert error[k] == pytest.approx(wanted.error, nan_ok=True) or not known


def test_what_is_not_known_to_be_steady_says_so(tmp_path: Path) -> None:
    for steady, word in ((False, "no"), (None, "unknown"), (True, "yes")):
        sheet = figures(run(TILT, steady))["tilt"]
        sheet.save(tmp_path / "tilt.png")
        assert [row["steady"] for row in rows_of(tmp_path / "tilt.csv")] == [word, word]
        told = [text.get_text() for legend in sheet.figure.legends for text in legend.get_texts()]
        assert ("hollow: still relaxing, or not known to be steady" in told) == (steady is not True)
    both = figures(run(TILT, True), run(TILT, None))["tilt"][0].drawn[0]
    assert list(both.steady) == [None, None]


def test_versions_are_no_replicas_of_each_other() -> None:
    found = figures(run(TILT, version="shaken 0.1.0, physics 3"), run(TILT, version="shaken 0.1.0, physics 4"))
    assert labels(found["tilt"][0]) == ["shaken 0.1.0, physics 3", "shaken 0.1.0, physics 4"]


def test_angles_are_in_degrees_and_zero_lag_has_no_place() -> None:
    found = figures(run({"/angles/theta_rad": [-np.pi / 4, np.pi / 4], "/angles/density_per_rad": [1.0, 2.0],
                         "/msd/lag_s": [0, 1, 2], "/msd/total_mm2": [0, 2, 4]}))
    angles = found["angles"][0].drawn[0]
    assert list(angles.x) == pytest.approx([-45, 45])
    assert list(angles.y) == pytest.approx([np.pi / 180, 2 * np.pi / 180])
    assert np.isnan(found["msd"][0].drawn[0].y[0])


def row(parameters: dict[str, Any], order: float, error: float = 0.02, **more: Any) -> Row:
    return Row(parameters, "done", {"order.mean": order, "order.sem": error, **more})


def point(length: float, fraction: float, order: float, error: float = 0.02, **more: Any) -> Row:
    return row({"rods.length": length, "rods.area_fraction": fraction}, order, error, **more)


def test_the_longest_parameter_is_the_axis_and_others_are_curves() -> None:
    found = sweeps.sweep_figure([point(2.5, 0.7, 0.3, 0.03), point(2.5, 0.6, 0.2), point(2.5, 0.5, 0.1, NAN),
                                 point(4.5, 0.6, 0.8, steady=None)])
    assert found is not None
    name, sheet = found
    assert name == "order_rods_area_fraction"
    curves = [drawn for drawn in sheet[0].drawn if not drawn.curve.startswith("reference")]
    assert [names.plain(drawn.curve) for drawn in curves] == ["ℓ = 2.5 mm", "ℓ = 4.5 mm"]
    assert list(curves[0].x) == [0.5, 0.6, 0.7] and list(curves[0].y) == [0.1, 0.2, 0.3]
    assert np.isnan(curves[0].error[0]), "no error is not an error of zero"
    assert names.plain(sheet[0].x_title) == "area fraction φ" and names.plain(sheet[0].y_title) == "nematic order ⟨S⟩"


def test_any_field_against_any_other() -> None:
    theta = "measured.theta_m_deg.value"
    points = [point(2.5, 0.5, 0.1, **{theta: 8.5}), point(2.5, 0.7, 0.3, **{theta: 9.5}), point(2.5, 0.9, 0.5)]
    found = sweeps.sweep_figure(points, x="order.mean", y=theta)
    assert found is not None and found[0] == "theta_m_deg_order"
    assert [list(drawn.x) for drawn in found[1][0].drawn] == [[0.1], [0.3]]  # a curve for each area fraction
    assert names.plain(found[1][0].y_title) == "tilt of the layers θ_m (°)"


def test_nothing_swept_nothing_drawn() -> None:
    assert sweeps.sweep_figure([point(2.5, 0.7, 0.3)]) is None
    assert sweeps.sweep_figure([]) is None
    assert sweeps.sweep_figure([point(2.5, 0.6, NAN), point(2.5, 0.7, NAN)]) is None


def test_the_ways_up_and_down_of_a_protocol_are_curves() -> None:
    def stage(number: int, fraction: float, gap: float = 1.2) -> Row:
        return row({"box.gap": gap, "stage": number, "rods.area_fraction": fraction, "time.measure": 1 + number},
                   fraction + 0.01 * number, 0.1)

    fractions = [0.4, 0.5, 0.6, 0.5, 0.5, 0.4]
    points = [stage(number, fraction) for number, fraction in enumerate(fractions, 1)]
    found = sweeps.sweep_figure(points[::-1])
    assert found is not None and found[0] == "order_rods_area_fraction"
    curves = [drawn for drawn in found[1][0].drawn if not drawn.curve.startswith("reference")]
    assert [drawn.curve for drawn in curves] == ["up", "down"]
    assert list(curves[0].x) == [0.4, 0.5, 0.6] and list(curves[1].x) == [0.4, 0.5, 0.5]
    assert list(curves[1].y) == pytest.approx([0.46, 0.54, 0.55]), "the last stage but one stays where it is"
    # what differs within a stage is a sweep around the protocol
    found = sweeps.sweep_figure(points + [stage(number, fraction, 1.4) for number, fraction in enumerate(fractions, 1)])
    assert found is not None
    curves = [drawn for drawn in found[1][0].drawn if not drawn.curve.startswith("reference")]
    assert [names.plain(drawn.curve) for drawn in curves] == ["w = 1.2 mm, up", "w = 1.2 mm, down", "w = 1.4 mm, up",
                                                              "w = 1.4 mm, down"]
    assert sweeps.ways_of([3, 3, 2, 2, 4]) == ["down", "down", "down", "down", "up"]
    assert sweeps.sweep_figure(points, x="stage") is not None


def test_texts_with_units_are_numbers() -> None:
    found = sweeps.sweep_figure([row({"box.gap": gap}, y) for gap, y in (("1.2 mm", 0.5), ("0.9 mm", 0.4))])
    assert found is not None and list(found[1][0].drawn[0].x) == [0.9, 1.2]


@pytest.mark.parametrize("n_fractions, n_lengths", [(5, 3), (9, 2), (3, 12), (7, 1), (12, 1)])
@pytest.mark.parametrize("width", ["89mm", "183mm"])
def test_many_points_can_be_told_apart(n_fractions: int, n_lengths: int, width: str) -> None:
    x = np.linspace(0, 10, 60)
    made = [run({"/g2/r_mm": x, "/g2/g2": np.exp(-x / (1 + k + j + replica))}, True,
                **{"rods.area_fraction": 0.5 + k / 50, "rods.length": 2.5 + j})
            for k in range(n_fractions) for j in range(n_lengths) for replica in range(2)]
    (_, sheet), = runs.run_figures(made, width)
    sheet.finish()
    renderer = sheet.figure.canvas.get_renderer()
    named = [text.get_text() for legend in sheet.figure.legends for text in legend.get_texts()]
    named = [text for text in named if "=" in text] + [label for panel in sheet for _, label in panel.entries]
    has_bar = len(sheet.figure.axes) > len(sheet.panels)
    assert len(set(named)) <= 7
    assert has_bar == (not named and n_fractions * n_lengths > 1)
    assert sum(len(panel.drawn) for panel in sheet) == n_fractions * n_lengths
    assert_whole(sheet)
    assert all(panel.axes.get_window_extent(renderer).width > 8 / 25.4 * sheet.figure.dpi for panel in sheet)



def test_curves_of_shorter_runs_look_as_those_of_longer_ones() -> None:
    def msd(n: int) -> dict[str, Any]:
        lag = np.arange(1, n + 1)
        return {"/msd/lag_s": lag, "/msd/total_mm2": 4.0 * lag}

    found = figures(run(msd(60), area_fraction=0.5), run(msd(20), area_fraction=0.8))
    assert {handle.get_marker() for handle, _ in found["msd"][0].entries} == {"none"}
    found = figures(run(msd(20), area_fraction=0.5), run(msd(20), area_fraction=0.8))
    assert "none" not in {handle.get_marker() for handle, _ in found["msd"][0].entries}
