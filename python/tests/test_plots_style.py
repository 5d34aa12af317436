"""The style of figures: nothing is erased, cut or invented, and files say what they are made from."""
from __future__ import annotations

import csv
import io
import re
import zlib
from pathlib import Path

import numpy as np
import pytest

pytest.importorskip("matplotlib")
from conftest import NIGHT  # noqa: E402
from figures_whole import assert_whole  # noqa: E402

from shaken.errors import ShakenError  # noqa: E402
from shaken.plots import names, save, series, style  # noqa: E402
from shaken.plots import panel as panel_module  # noqa: E402

NAN = float("nan")
ORIGIN = {"Software": "shaken plot 0.1.0", "Sweep": "ℓ and φ", "Runs": "1f0c59d16ab8b7d7"}


def rows_of(path: Path) -> list[dict[str, str]]:
    text = "".join(line for line in path.read_text().splitlines(True) if not line.startswith("#"))
    return list(csv.DictReader(io.StringIO(text)))


def pixels(sheet: "object") -> np.ndarray:
    sheet.finish()
    sheet.figure.canvas.draw()
    return np.asarray(sheet.figure.canvas.buffer_rgba())[..., :3].astype(int)


def n_of(image: np.ndarray, colour: str, tolerance: int = 40) -> int:
    wanted = [int(colour[k:k + 2], 16) for k in (1, 3, 5)]
    return int(np.count_nonzero(np.all(np.abs(image - wanted) < tolerance, axis=-1)))


def test_the_csv_has_what_is_drawn_with_names_and_units(tmp_path: Path) -> None:
    sheet = style.sheet()
    sheet[0].titles(names.axis_title("rods.area_fraction"), names.axis_title("theta_m_deg"))
    sheet[0].curve([0.6, 0.7, 0.8, 0.9], [10, NAN, 20.5, 30], error=[1, 1, NAN, 2], steady=[True, True, False, None],
                   label=names.value_label("rods.length", 4.5))
    sheet.save(tmp_path / "tilt.png", ORIGIN)
    text = (tmp_path / "tilt.csv").read_text()
    assert "# Sweep: ℓ and φ" in text
    assert "# x is area fraction φ; y is tilt of the layers θ_m (°); error is one standard error" in text
    rows = rows_of(tmp_path / "tilt.csv")
    assert [row["x"] for row in rows] == ["0.6", "0.8", "0.9"]
    assert [row["error"] for row in rows] == ["1", "", "2"]
    assert [row["steady"] for row in rows] == ["yes", "no", "unknown"]
    assert rows[0]["curve"] == "ℓ = 4.5 mm"


@pytest.mark.parametrize("form", ["png", "pdf", "svg"])
def test_equal_figures_have_equal_bytes_that_say_what_they_are_made_from(tmp_path: Path, form: str) -> None:
    written = []
    for name in ("a", "b"):
        sheet = style.sheet()
        sheet[0].titles("time $t$ (s)", "$S$").curve([1, 2, 3], [1, 2, 3], error=0.1, label="$φ$ = 0.75")
        written.append(sheet.save(tmp_path / f"{name}.{form}", ORIGIN).read_bytes())
    assert written[0] == written[1]
    if form == "pdf":
        found = re.search(rb"/Subject \(\xfe\xff(.*?)\)\n", written[0], re.DOTALL)
        assert found is not None
        assert "Runs: 1f0c59d16ab8b7d7" in found[1].replace(b"\\", b"").decode("utf-16-be", "ignore")
        assert b"CreationDate" not in written[0]
    else:
        assert b"1f0c59d16ab8b7d7" in written[0]
        assert "ℓ and φ".encode() in written[0] or "ℓ and φ".encode() in zlib_text(written[0])


def zlib_text(png: bytes) -> bytes:
    """Compressed texts of a PNG."""
    found = b""
    for piece in png.split(b"zTXt")[1:]:
        try:
            found += zlib.decompressobj().decompress(piece.split(b"\0", 1)[1][1:])
        except zlib.error:
            continue
    return found


def test_what_has_no_value_draws_nothing() -> None:
    def drawn(y: list[float]) -> int:
        sheet = style.sheet()
        sheet[0].titles("x", "y").range(x=(0, 4), y=(0, 4)).curve([1, 2, 3], y, look="points", joined=False)
        return n_of(pixels(sheet), style.PALETTE[0])

    assert drawn([1, NAN, 3]) == pytest.approx(2 / 3 * drawn([1, 2, 3]), rel=0.1)
    assert drawn([NAN, NAN, NAN]) == 0


def test_bars_of_one_curve_do_not_erase_another() -> None:
    def blue(others: bool) -> int:
        sheet = style.sheet()
        panel = sheet[0].titles("x", "y").range(x=(0, 10), y=(0, 10))
        panel.curve(range(1, 10), [5] * 9, error=1.0, colour=0)
        if others:
            for k in range(1, 5):
                panel.curve(np.arange(1, 10) + 0.12 * k, [5 + 0.3 * k] * 9, error=4.0, colour=k)
        return n_of(pixels(sheet), style.PALETTE[0])

    assert blue(True) > 0.75 * blue(False)


def test_marks_are_hollow_where_the_state_is_not_known_to_be_steady_and_the_key_says_so() -> None:
    def blue(steady: object) -> "tuple[int, object]":
        sheet = style.sheet()
        sheet[0].titles("x", "y").curve([1, 2, 3], [1, 2, 3], steady=steady, joined=False)
        return n_of(pixels(sheet), style.PALETTE[0]), sheet

    filled, sheet = blue(True)
    assert not sheet.figure.legends
    for unsure in (False, None, [False, None, False]):
        hollow, sheet = blue(unsure)
        assert hollow < 0.75 * filled
        assert [text.get_text() for text in sheet.figure.legends[0].get_texts()] == [
            "hollow: still relaxing, or not known to be steady"]


@pytest.mark.parametrize("width, columns", [("89mm", 1), ("120mm", 1), ("120mm", 2), ("183mm", 1), ("183mm", 3)])
def test_nothing_is_cut_and_no_key_covers_data(width: str, columns: int) -> None:
    sheet = style.sheet(width, rows=2, columns=columns, title="A figure with a title that is rather long for its width")
    scale = style.ColourScale(np.linspace(0.6, 0.8, 9), names.axis_title("rods.area_fraction"))
    for k, panel in enumerate(sheet):
        panel.titles(names.axis_title("order.std"), names.axis_title("measured.theta_m_deg.value"),
                     "a title that is longer than its panel").verdict("disagrees")
        if k % 2 == 0:
            for curve in range(7):
                panel.curve(np.arange(12), np.sin(np.arange(12) + curve + k), error=0.3, steady=curve % 2 == 0,
                            label=names.value_label("rods.length", 2.5 + curve + k))
            panel.reference(y=0.5, label="the paper's level")
        else:
            for value in scale.values:
                panel.curve(np.linspace(0, 5, 200), np.cos(np.linspace(0, 5, 200) * value), colour=scale(value))
            sheet.colourbar(scale, [panel])
    assert_whole(sheet)
    renderer = sheet.figure.canvas.get_renderer()
    for panel in sheet:
        key = panel.axes.get_legend()
        if key is None:
            continue
        box = key.get_window_extent(renderer)
        at = panel.obstacles()
        covered = (at[:, 0] > box.x0) & (at[:, 0] < box.x1) & (at[:, 1] > box.y0) & (at[:, 1] < box.y1)
        assert not np.any(covered)
        for other in sheet:
            for text in (other.axes._left_title, other.axes._right_title, other.axes.xaxis.label,
                         other.axes.yaxis.label):
                assert not text.get_text() or not box.overlaps(text.get_window_extent(renderer))


_TITLES = sorted({names.axis_title(path) for path in names.TABLE if path != "S"}, key=len)


@pytest.mark.parametrize("k", range(0, len(_TITLES), 4))
def test_titles_fit_into_small_panels(k: int) -> None:
    """Four titles a sheet, for drawing takes seconds: each along x and along y, of two panels. In the gate a fourth of
    them, with the longest."""
    if not NIGHT and k % 16 and k + 4 < len(_TITLES):
        pytest.skip("./dev test all")
    sheet, four = style.sheet("89mm", rows=2, columns=2), [*_TITLES[k:k + 4], *_TITLES[:4]][:4]
    for panel, along, across in zip(sheet, four, (*four[1:], four[0])):
        panel.titles(along, across, "its title").curve([0.5, 20], [0.5, 3000])
        panel.scale("log", "log")
    assert_whole(sheet)


def test_marks_and_bars_keep_off_the_axes() -> None:
    sheet = style.sheet()
    sheet[0].titles("x", "y").range(y=(0, 1)).curve([1, 2, 3], [0, 0.5, 0.98], error=0.05)
    sheet.finish()
    (left, right), (low, high) = sheet[0].axes.get_xlim(), sheet[0].axes.get_ylim()
    assert left < 1 and right > 3 and low < -0.05 and high > 1.03
    assert not sheet[0].axes.yaxis.get_major_formatter().get_useMathText(), "plain numbers, which are drawn soon"
    for highest, keeps_off in ((0.97, False), (0.99, True)):
        line = style.sheet()
        line[0].titles("x", "y").range(y=(0, 1)).curve([0, 1], [0, highest], look="line")
        assert (line.finish()[0].axes.get_ylim()[1] > 1) == keeps_off
    sheet = style.sheet(columns=2)
    sheet[0].titles("x", "y").dots(["a"], [2.0], error=[0.0])
    sheet[1].titles("x", "y").curve([2.0], [3.0])
    sheet.finish()
    assert sheet[1].axes.get_xlim() == pytest.approx((1.8, 2.2)), "axes around one point"
    assert sheet[0].axes.lines[0].get_zorder() > sheet[0].axes.collections[0].get_zorder(), "marks lie on their bars"


def test_an_eighth_named_curve_is_refused() -> None:
    panel = style.sheet()[0]
    for k in range(7):
        panel.curve([1, 2], [k, k], label=str(k))
    with pytest.raises(ShakenError, match="ColourScale"):
        panel.curve([1, 2], [8, 8], label="8")


def test_the_caller_s_settings_stay_as_they_are() -> None:
    import matplotlib
    before = dict(matplotlib.rcParams)
    sheet = style.sheet()
    sheet[0].titles("x", "y").curve([1, 2], [1, 2])
    sheet.finish()
    assert dict(matplotlib.rcParams) == before


@pytest.mark.parametrize("path, title", [
    ("rods.length", "rod length ℓ (mm)"), ("box.gap", "gap between the plates w (mm)"),
    ("order.mean", "nematic order ⟨S⟩"), ("measured.theta_m_deg.value", "tilt of the layers θ_m (°)"),
    ("diffusion_mm2_s", "diffusion coefficient D (mm²/s)"), ("/g2/g2", "orientational correlation G_2(r)"),
    ("rods_2.diffusion_mm2_s", "diffusion coefficient of rods_2 D (mm²/s)"),
    ("measured.rods_3.P.value", "polar order of rods_3 ⟨P⟩"), ("/rods_2/polar/order", "polar order of rods_2 P"),
    ("measured.some_new_speed_mm_s.value", "some new speed (mm/s)"), ("rods.a_new_key", "rods.a new key")])
def test_titles_of_axes(path: str, title: str) -> None:
    assert names.plain(names.axis_title(path)) == title


@pytest.mark.parametrize("over, title", [
    ((), "rms speed of displacements (mm/s)"), ((0.4,), "rms speed of displacements over 0.4 s (mm/s)"),
    ((0.4, 0.1, 0.2), "rms speed of displacements over 0.1 to 0.4 s (mm/s)")])
def test_titles_of_axes_say_the_time_that_a_number_is_taken_over(over: tuple[float, ...], title: str) -> None:
    assert names.plain(names.axis_title("measured.velocity_rms_mm_s.value", over=over)) == title


def test_labels_of_points() -> None:
    assert names.plain(series.label_of({"rods.area_fraction": 0.6, "rods.length": 2.5})) == "φ = 0.6, ℓ = 2.5 mm"
    assert names.plain(series.label_of({"plates.gamma": -3e-7})) == "Γ = −3·10⁻⁷"


def test_titles_break_between_quantities() -> None:
    """A symbol stays with its value, and a number with its unit."""
    sheet = style.sheet("89mm", columns=2)
    for panel in sheet:
        panel.titles("x", "y", "ℓ = 2.5 mm, φ = 0.85, w = 1.2 mm")
    sheet.finish()
    lines = sheet[0].axes.get_title(loc="left").split("\n")
    assert len(lines) > 1
    for line in lines:
        assert line.count("=") == len(line.rstrip(",").split(",")), lines
        assert not line.rstrip(",").endswith("="), lines


@pytest.mark.parametrize("shades, keeps_all", [("", False), ("map", True), ("scale", True), ("picture", True)])
def test_pictures_keep_all_colours_where_colours_are_numbers(shades: str, keeps_all: bool) -> None:
    sheet = style.sheet("89mm")
    panel = sheet[0].titles("x", "y").curve([0, 1], [1, 2])
    values = np.random.default_rng(1).normal(size=(40, 40))
    if shades == "map":
        panel.map(np.arange(40), np.arange(40), values, "z")
    elif shades == "scale":
        sheet.colourbar(style.ColourScale([0.1, 0.5, 0.9], "z"))
    elif shades == "picture":
        panel.picture(np.clip(np.stack([values] * 3, axis=-1), 0, 1))
    from PIL import Image
    picture = Image.open(io.BytesIO(save._picture(sheet.finish().figure, "png", {})))
    assert (picture.mode != "P") == keeps_all


def test_of_many_colours_those_of_the_bars_are_kept(monkeypatch: pytest.MonkeyPatch) -> None:
    """Noise in all colours leaves the bar its own."""
    sheet = style.sheet("89mm")
    panel = sheet[0].titles("x", "y")
    panel.picture(np.random.default_rng(1).uniform(size=(90, 90, 3)), (0, 1, 0, 1))
    monkeypatch.setattr(save, "_MANY_BYTES", 50_000)
    sheet.colourbar(style.ColourScale([0.1, 0.5, 0.9], "z"))
    from PIL import Image
    figure = sheet.finish().figure
    few = save._picture(figure, "png", {})
    picture, whole = Image.open(io.BytesIO(few)), np.asarray(figure.canvas.buffer_rgba())[..., :3].astype(int)
    assert picture.mode == "P" and len(few) < 1.5 * save._MANY_BYTES
    bar = next(axes for axes in figure.axes if hasattr(axes, "_colorbar")).get_window_extent()
    middle, low, high = int((bar.x0 + bar.x1) / 2), int(len(whole) - bar.y1) + 4, int(len(whole) - bar.y0) - 4
    off = np.abs(np.asarray(picture.convert("RGB")).astype(int) - whole)
    assert off[low:high, middle].max() <= 12 and off.max() > 30
    assert off[0, 0].max() == 0, "paper is white"


def drawn_markers(panel: panel_module.Panel) -> list[str]:
    return [line.get_marker() for line in panel.axes.lines if line.get_marker() not in ("None", None)]


@pytest.mark.parametrize("look", ["points", "line"])
def test_what_has_no_error_is_crossed_and_what_has_a_small_one_is_not(look: str) -> None:
    """An error that is shorter than the mark is known all the same."""
    known = style.sheet("89mm")
    known[0].curve([0, 1, 2], [1, 2, 3], error=[1e-9, 1e-9, 0.5], look=look)
    assert "x" not in drawn_markers(known[0]) and panel_module.NO_ERROR not in known[0].explained
    unknown = style.sheet("89mm")
    unknown[0].curve([0, 1, 2], [1, 2, 3], error=[np.nan, 0.1, np.nan], look=look)
    crosses = [line for line in unknown[0].axes.lines if line.get_marker() == "x"]
    assert len(crosses) == 1 and crosses[0].get_xdata().tolist() == [0, 2]
    legend = unknown.finish().figure.legends[0]
    assert "crossed: no error known" in [text.get_text() for text in legend.get_texts()]
    none = style.sheet("89mm")
    none[0].curve([0, 1, 2], [1, 2, 3], look=look)
    assert not none[0].explained, "where there are none to be known nothing is said"


def test_keys_show_the_marks_that_are_drawn() -> None:
    sheet = style.sheet("89mm")
    panel = sheet[0].curve([0, 1], [1, 2], steady=[False, None], label="relaxing", look="points")
    panel.curve([0, 1], [2, 3], steady=True, label="steady", look="points")
    panel.curve([0, 1], [np.nan, np.nan], label="nothing", look="points")
    panel.dots(["a"], [np.nan], label="no dots")
    assert [label for _, label in panel.entries] == ["relaxing", "steady"]
    hollow, filled = (handle.get_markerfacecolor() for handle, _ in panel.entries)
    assert hollow == "white" and filled != "white"
    for steady in (False, True):
        panel.curve([0, 1], [3, 4], steady=steady, label="line", look="line")
        assert panel.entries[-1][0].is_dashed() != steady


def test_lines_do_not_pass_over_what_has_no_logarithm() -> None:
    sheet = style.sheet("89mm")
    panel = sheet[0].titles("x", "y").scale("log", "log")
    for look in ("points", "line"):
        panel.curve([0, 1, 2, 3], [1, 2, -1, 4], look=look)
    sheet.finish()
    joined = [line for line in panel.axes.lines if line.get_linestyle() != "None"]
    assert len(joined) == 2
    for line in joined:
        assert np.isnan(line.get_xdata()[0]) and np.isnan(line.get_ydata()[2]) and line.get_ydata()[3] == 4


def test_a_panel_without_data_says_why() -> None:
    sheet = style.sheet("89mm", columns=2)
    sheet[0].curve([0, 1], [1, 2])
    sheet[1].titles(title="larger").absent = "no runs yet"
    sheet.finish()
    assert [text.get_text() for text in sheet[1].axes.texts] == ["no runs yet"]
