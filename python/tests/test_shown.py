"""What a notebook shows, and what other packages get."""
import copy
import html.parser
import io
import pickle

import numpy as np
import pytest

import shaken
from conftest import PROGRAMS, made_up_run
from shaken.estimate import Estimate
from shaken.sweep import grouped


class Cells(html.parser.HTMLParser):
    """The texts of a table's cells, row by row; fails where tags do not match."""

    def __init__(self, text):
        super().__init__()
        self.rows, self.open = [], []
        self.feed(text)
        assert not self.open

    def handle_starttag(self, tag, attrs):
        self.open.append(tag)
        if tag == "tr":
            self.rows.append([])
        elif tag in ("td", "th"):
            self.rows[-1].append("")

    def handle_endtag(self, tag):
        assert self.open.pop() == tag

    def handle_data(self, data):
        if self.open[-1] in ("td", "th"):
            self.rows[-1][-1] += data


@pytest.fixture
def sweep(tmp_path):
    """Two lengths and two packings, one of which was not measured."""
    points = [(2.5, 0.6), (4.5, 0.6), (4.5, 0.8)]
    found = [shaken.open(made_up_run(tmp_path / str(k), run_id=f"{k:016x}", order=packing, sem=0.03, steady=steady))
             for k, ((_, packing), steady) in enumerate(zip(points, (True, False, None)))]
    return grouped([({"rods.length": length, "rods.area_fraction": packing}, run)
                    for (length, packing), run in zip(points, found)], "<made up>")


def test_tables_have_units_and_errors(sweep):
    rows = Cells(sweep._repr_html_()).rows
    assert rows[0] == ["rods.length [mm]", "rods.area_fraction", "done", "S", "S_std", "diffusion_mm2_s"]
    assert rows[1] == ["2.5", "0.6", "1 of 1", "0.60 ± 0.03", "0.05 ± ?", "2.00 ± 0.10 mm2 s-1"]
    assert len(rows) == 4 and "&lt;made up&gt;" in sweep._repr_html_()
    for numbers in (sweep[0], sweep[0].runs[0]):
        rows = Cells(numbers._repr_html_()).rows
        assert rows[:2] == [["number", "value ± error", "steady"], ["S", "0.60 ± 0.03", "yes"]]
    assert Estimate(2.0, 0.1, True, unit="mm2 s-1")._repr_html_() == "2.00 ± 0.10 mm2 s-1"
    assert Estimate(reason="a < b")._repr_html_() == "not known (a &lt; b)"


def test_a_sweep_as_a_grid(sweep):
    pytest.importorskip("xarray")
    grid = sweep.to_xarray()
    assert grid["S"].dims == ("rods.length", "rods.area_fraction") and grid["S"].shape == (2, 2)
    assert float(grid["S"].sel({"rods.length": 4.5, "rods.area_fraction": 0.8})) == 0.8
    assert np.isnan(grid["S"].values[0, 1]) and grid["S_error"].values[1, 0] == 0.03
    assert (grid["diffusion_mm2_s"].attrs["units"], grid["rods.length"].attrs["units"]) == ("mm2 s-1", "mm")
    twice = shaken.Sweep([*sweep, shaken.Point(sweep[0].parameters, sweep[0].runs)])
    with pytest.raises(shaken.ShakenError, match="several points"):
        twice.to_xarray()


def test_a_table_of_pandas_has_units_and_types(sweep):
    pandas = pytest.importorskip("pandas")
    table = sweep.to_frame()
    assert table.attrs["units"]["diffusion_mm2_s"] == table.attrs["units"]["diffusion_mm2_s:error"] == "mm2 s-1"
    assert table.attrs["units"]["rods.length"] == "mm" and str(table["S:steady"].dtype) == "boolean"
    assert table["S:steady"].tolist() == [True, False, pandas.NA] and table["S"].dtype == float


def test_numbers_for_uncertainties():
    pytest.importorskip("uncertainties")
    number = Estimate(2.0, 0.1).to_uncertainties()
    assert ((number * number).n, (number * number).s) == (4.0, pytest.approx(0.4))


def test_frames_are_drawn(tmp_path):
    if not (PROGRAMS / "shaken-render").exists():
        pytest.skip("no shaken-render")
    simulation = shaken.Simulation({"rods": {"length": "4.5 mm", "area_fraction": 0.6}, "box": {"side": "14 mm"}})
    simulation.advance("5 ms")
    first = simulation.snapshot
    drawn = first._repr_png_()
    assert drawn == simulation._repr_png_() and drawn[1:4] == b"PNG"
    image = pytest.importorskip("matplotlib.image").imread(io.BytesIO(drawn))
    assert image.shape[:2] == (640, 640) and image.std() > 0.05  # something is there
    simulation.advance("5 ms")
    assert first._repr_png_() is None and simulation._repr_png_() != drawn  # never a picture of other rods
    first = simulation.snapshot
    simulation.set("plates.gamma", 6)
    simulation.advance(ticks=first.tick)
    assert simulation.tick == first.tick and first._repr_png_() is None


def test_other_frames_know_no_picture():
    zero = np.zeros((1, 3))
    frame = shaken.Frame(0.0, 0, zero, zero, zero, zero, np.zeros(1), np.ones(3))
    assert frame._repr_png_() is None and copy.deepcopy(frame).tick == pickle.loads(pickle.dumps(frame)).tick == 0
