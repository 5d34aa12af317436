"""Runs and curves over each other."""
import numpy as np
import pytest
import shaken
from conftest import made_up_run
from shaken.plots.beside import agreement, read_beside

R = np.array([1.0, 2.0, 3.0, 4.0])


def with_g2(folder, g2, error=0.1):
    made_up_run(folder, arrays={"/g2/r_mm": (R, "mm"), "/g2/g2": (g2, "1"), "/g2/g2_sem": (np.full(4, error), "1")})
    return str(folder)


def test_chi2_is_that_of_the_differences_in_their_errors(tmp_path):
    (tmp_path / "paper.csv").write_text("# digitised\nr_mm,g2,g2_sem\n9,0.5,0.1\n2.5,0.6,0.2\n1.5,0.8,0.1\n3,,0.1\n")
    (tmp_path / "exact.csv").write_text("g2,r_mm\n0.8,1\n")
    runs = read_beside([with_g2(tmp_path / "sim", [0.9, 0.8, 0.6, 0.4]),
                        with_g2(tmp_path / "seen", [0.9, 0.9, 0.6, 0.2]),
                        str(tmp_path / "paper.csv"), str(tmp_path / "exact.csv")])
    assert [list(run.parameters.values()) for run in runs] == [["sim"], ["seen"], ["paper"], ["exact"]]
    assert list(agreement(runs)) == [
        "g2: seen against sim: chi2 = 2.5 at 4 places",     # (0.1^2 + 0.2^2) / (2 * 0.1^2)
        "g2: paper against sim: chi2 = 0.325 at 2 places",  # 0.05^2 / 0.02 + 0.1^2 / 0.05; not beyond 4 mm
        "g2: exact against sim: chi2 = 1 at 1 places"]      # 0.1^2 / 0.1^2


def test_all_that_is_no_curve_is_said(tmp_path):
    (tmp_path / "other.csv").write_text("a,b\n1,2\n")
    (tmp_path / "words.csv").write_text("r_mm,g2\none,2\n")
    with pytest.raises(shaken.ShakenError) as said:
        read_beside([str(tmp_path / "other.csv"), str(tmp_path / "words.csv"), str(tmp_path / "nowhere")])
    lines = str(said.value).splitlines()
    assert len(lines) == 3 and "no figure has two of its columns (a, b)" in lines[0]
    assert "neither a run directory nor a table of numbers" in lines[1] and "nowhere" in lines[2]


def test_they_are_drawn_with_their_names(tmp_path, capsys):
    from shaken.tables.app import main
    paths = [with_g2(tmp_path / "sim", [0.9, 0.8, 0.6, 0.4]), with_g2(tmp_path / "seen", [0.9, 0.9, 0.6, 0.2])]
    assert main(["plot", f"--out={tmp_path / 'out'}", *paths]) == 0
    captured = capsys.readouterr()
    assert "chi2 = 2.5 at 4 places" in captured.err
    rows = [line.split(",") for line in (tmp_path / "out" / "g2.csv").read_text().splitlines()]
    assert {row[1] for row in rows if len(row) == 6 and row[1] != "curve"} == {"sim", "seen"}
    assert main(["plot", "--x=rods.length", *paths]) == 2

    assert main(["plot", f"--out={tmp_path / 'one.svg'}", *paths]) == 0
    assert (tmp_path / "one.svg").is_file() and not list(tmp_path.glob("g2*"))
    rows = [line.split(",") for line in (tmp_path / "one.csv").read_text().splitlines()]
    assert {row[1] for row in rows if len(row) == 6 and row[1] != "curve"} == {"sim", "seen"}
    many = [with_g2(tmp_path / f"of{k}", [0.9, 0.8, 0.6, 0.4]) for k in range(9)]
    assert main(["plot", f"--out={tmp_path / 'many.svg'}", *many]) == 2
    assert "9 curves in each panel are too many" in capsys.readouterr().err
    assert main(["plot", f"--out={tmp_path / 'alone.svg'}", paths[0]]) == 0 and (tmp_path / "alone.svg").is_file()
