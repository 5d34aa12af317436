"""Rows of results, conditions on them, and their tables."""
import itertools
import json
import math
import random
import subprocess
import sys
from pathlib import Path

import pytest

from shaken import rows, text
from shaken.catalogue import STEADINESS
from shaken.errors import NotFound, ShakenError, nearest
from shaken.estimate import student_factor
from shaken.units import quantity
from shaken.tables import app, conditions, results
from shaken.tables.conditions import Condition, marked

VECTORS = Path(__file__).resolve().parents[2] / "tests/vectors"


def row_with(**fields):
    return rows.Row({}, fields.get("state", ""), {name.replace("__", "."): value for name, value in fields.items()})


DONE = row_with(job="1f0c000000000001", state="done", label="rods.length=2.5 replica=1", versions__shaken="0.1.0",
                steady=True, rods__length=2.5, time__step=4e-6, order__mean=0.75, measured__theta_m_deg__value=8.5)
QUEUED = row_with(job="1f0c000000000002", state="queued", rods__length=4.5)


def holds(words, row=DONE):
    condition = Condition(words)
    problems = condition.problems or condition.bind([DONE, QUEUED])
    assert not problems, marked(words, problems)
    return condition(row)


def problems_of(words):
    condition = Condition(words)
    return marked(words, condition.problems or condition.bind([DONE, QUEUED]))


@pytest.mark.parametrize("words, expected", [
    ("rods.length>2", True), ("rods.length>2.5", False), ("rods.length>=2.5", True), ("rods.length<3", True),
    ("rods.length<2.5", False), ("rods.length<=2.5", True), ("rods.length=2.50", True), ("rods.length==2.4", False),
    ("rods.length!=2.4", True), (" order.mean  >= 0.5", True), ("order.mean>-1e3", True), ("state=done", True),
    ("state!=done", False), ("state='done'", True), ("steady=true", True), ("steady!=true", False),
    ("\"order.mean\">.5", True), ("label='rods.length=2.5 replica=1'", True), ("versions.shaken=0.1.0", True),
    ("versions.shaken=0.1", False), ("job=1f0c000000000001", True), ("theta_m_deg>8", True),
    # in the units of their keys
    ("rods.length=2.5mm", True), ("rods.length=2.5 mm", True), ("rods.length=2500um", True), ("rods.length<1 cm", True),
    ("time.step=4us", True), ("time.step=4 us", True), ("time.step<=0.004ms", True), ("rods.length=2.5 cm", False),
    # `not` binds most, `or` least
    ("state=done and rods.length>3", False), ("state=done or rods.length>3", True),
    ("state=done or state=queued and rods.length>3", True), ("(state=done or state=queued) and rods.length>3", False),
    ("not state=done or rods.length=2.5", True), ("not (state=done or rods.length=2.5)", False),
    ("not not state=done", True), ("not state=done and state=done", False), ("(((state=done)))", True)])
def test_conditions(words, expected):
    assert holds(words) is expected


def test_a_comparison_is_false_for_a_row_without_the_field():
    for words in ("order.mean=0.75", "order.mean!=0.75", "order.mean<2", "order.mean>=-2"):
        assert not holds(words, QUEUED)
    assert holds("not order.mean>0.5", QUEUED)
    asked = conditions.read(["theta_m_deg>1 or order.mean>1 or order.mean<0.5 or rods.length>1"])
    kept, lacking = conditions.matching([DONE, QUEUED, QUEUED], asked, True)
    assert len(kept) == 3 and lacking == {"measured.theta_m_deg.value": 2, "order.mean": 2}


def test_keys_of_scenes_and_unknown_summaries_are_no_mistake():
    condition = Condition("box.gap>1 or measured.d_mm2_s.value>1")
    assert len(condition.bind([QUEUED])) == 1
    assert not condition.bind([QUEUED], all_known=False) and not condition(QUEUED)


def test_every_problem_of_a_condition_is_marked_at_its_place():
    assert problems_of("order.maen>0.5 and rods.length<4kg or state>done") == (
        "  order.maen>0.5 and rods.length<4kg or state>done\n"
        "  ^ no row has a field 'order.maen'; did you mean order.mean?\n"
        "                                 ^ \"kg\" is not a unit of length; use mm, m, cm, um\n"
        "                                             ^ state is a text: only = and != compare it")
    assert problems_of("rods.length and order.mean=> 3 or (state=done") == (
        "  rods.length and order.mean=> 3 or (state=done\n"
        "              ^ a comparison is missing behind 'rods.length': rods.length>0.5, or rods.length=true\n"
        "                            ^ '=>' compares nothing; one of = != < <= > >= does\n"
        "                                    ^ this ( is never closed")
    # one that a terminal would obey: the caret stands below what is printed
    assert problems_of("länge='\x1b' or )") == (
        "  länge='\\u001b' or )\n"
        "                    ^ a comparison is missing before ')': FIELD OP VALUE, for example order.mean>0.5\n"
        "                    ^ this ) closes nothing")
    assert problems_of("rods.length>(3)") == (
        "  rods.length>(3)\n"
        "              ^ a value is missing before '('\n"
        "                ^ this ) closes nothing")


@pytest.mark.parametrize("words, message", [
    ("", "a comparison is missing before the end"), ("()", "a comparison is missing before ')'"),
    ("and state=done", "a comparison is missing before 'and'"),
    ("state=done and", "a comparison is missing before the end"), ("not", "a comparison is missing before the end"),
    (">3", "a comparison is missing before '>'"), ("rods.length>", "a value is missing before the end"),
    ("rods.length> and state=done", "a value is missing before 'and'"),
    ("1<rods.length<3", "'<' follows a whole comparison"),
    ("rods.length ! 3", "'!' compares nothing"), ("rods.length<>3", "'<>' compares nothing"),
    ("state=done order.mean>0.5", "'order.mean' follows a whole comparison: join them by and, or"),
    ("state=done && order.mean>0.5", "did you mean and?"), ("state=done || order.mean>0.5", "did you mean or?"),
    ("state=done AND order.mean>0.5", "did you mean and?"),
    ("(state=done not steady=true)", "'not' follows a whole comparison"), ("state='done", "this quote is never closed"),
    ("state=done)", "this ) closes nothing"), ("order.mean=high", "\"high\" is not a number"),
    ("order.mean='0.5'", "order.mean is a number: without quotes"),
    ("order.mean<0.5 mm", "a plain number takes no unit"), ("rods.lenght>2", "did you mean rods.length?"),
    ("box.gpa>2", "did you mean box.gap?"), ("steady=yes", "steady is true or false"),
    ("steady<true", "only = and != compare it"), ("rods.length=2.5s", "\"s\" is a unit of time, not of length"),
    ("rods.length<2,5", "a decimal comma; write 2.5"), ("order.mean<1e400", "1e400 is too large"),
    ("order.mean<\u0663", "is not a number")])
def test_every_mistake_is_told_in_words(words, message):
    assert message in problems_of(words)


def test_depth_has_a_limit_that_is_told_once():
    def nested(n):
        return "(" * n + "state=done" + ")" * n

    assert holds(nested(100))
    assert holds("(state=done)" + " and (state=done)" * 200), "none is in another"
    assert holds("state=done" + " and state=done" * 10_000), "a long chain is not deep"
    for words in (nested(101), nested(200_000), "(" * 200_000, "not " * 101 + "state=done"):
        problem, = Condition(words).problems
        assert "more than 100" in problem.message


def _made(draw, depth):
    """(an expression, its truth as a function of a row), worked out along the way."""
    kind = draw.randrange(5) if depth else 0
    if kind == 0 and draw.random() < 0.25:
        sign, value = draw.choice(["=", "==", "!="]), draw.choice(["done", "queued", "failed"])
        return f"state{sign}{value}", lambda row: "state" in row.fields and (
            row.fields["state"] == value) == (sign[0] == "=")
    if kind == 0:
        name, tenths = draw.choice(["rods.length", "order.mean", "n_rods"]), draw.randrange(-3, 4)
        sign, value = draw.choice(["=", "==", "!=", "<", "<=", ">", ">="]), f"{tenths}e-1"
        if name == "rods.length":
            value = draw.choice([value, f"{tenths}00 um", f"{tenths}e-2cm"])
        truths = {"=": lambda d: d == 0, "==": lambda d: d == 0, "!=": lambda d: d != 0, "<": lambda d: d < 0,
                  "<=": lambda d: d <= 0, ">": lambda d: d > 0, ">=": lambda d: d >= 0}
        return (name + draw.choice(["", " "]) + sign + draw.choice(["", "  "]) + value,
                lambda row: name in row.fields and truths[sign](round(row.fields[name] * 10) - tenths))
    left, is_left = _made(draw, depth - 1)
    if kind == 1:
        return f"not ({left})", lambda row: not is_left(row)
    if kind == 2:
        return f"( {left} )", is_left
    right, is_right = _made(draw, depth - 1)
    if kind == 3:
        return f"({left}) and ({right})", lambda row: is_left(row) and is_right(row)
    return f"{left} or {right}", lambda row: is_left(row) or is_right(row)


def test_conditions_agree_with_an_independent_evaluator():
    draw = random.Random(7)
    for _ in range(500):
        words, truth = _made(draw, 4)
        some = [{"state": draw.choice(["done", "queued", "failed"]), **{
            name: draw.randrange(-3, 4) / 10 for name in ("rods.length", "order.mean", "n_rods")}} for _ in range(3)]
        made = [rows.Row({}, "", {name: value for name, value in one.items() if draw.random() < 0.75}) for one in some]
        made.append(row_with(state="x", rods__length=9, order__mean=9, n_rods=9))
        condition = Condition(words)
        assert not condition.problems and not condition.bind(made), words
        assert [condition(row) for row in made] == [truth(row) for row in made], words


def test_any_text_is_read_or_refused_with_places_in_it():
    draw, words = random.Random(8), ["(", ")", "and", "or", "not", "state", "order.mean", "=", "<=", "!", "done", "0.5",
                                     "mm", "'", '"', " ", "\udcff", "\n"]
    for _ in range(2000):
        made = "".join(draw.choice(words) + draw.choice(["", " "]) for _ in range(draw.randrange(12)))
        condition = Condition(made)
        assert all(0 <= problem.at <= len(made) for problem in condition.problems)
        if not condition.problems and not condition.bind([DONE, QUEUED]):
            condition(DONE)


def answer(length, replica, s, version="0.1.0", **summary):
    """A row as the daemon sends it; without a summary for an order below 0."""
    done = {"n_rods": 100, "order": {"mean": s, "sem": 0.125}, "collisions": {"rod_rod": 7}, "defects": None,
            "versions": {"shaken": version} if version else {}}
    return {"job": f"1f0c00000000000{replica}", "sweep": "s1", "state": "queued" if s < 0 else "done",
            "label": f"rods.length={length}", "parameters": {"rods.length": length}, "replica": replica,
            "summary": None if s < 0 else done | summary}


def points_of(*answers):
    return rows.aggregated([rows.row_of(one) for one in answers])


def judged(replica, steady, theta_m_steady=None, theta_m=8.5):
    """An answer whose summary says whether it came to rest."""
    return answer(2.5, replica, 0.5, steady=steady, order={
        "mean": 0.5, "sem": 0.125, "steady": steady, "n_effective": 20.0}, measured={"theta_m_deg": {
            "value": theta_m, "sem": 0.5, "n_effective": 10.0, "steady": theta_m_steady}})


def test_a_row_is_flat_and_keeps_dotted_parameters():
    row = rows.row_of({**answer(2.5, 1, 0.75), "directory": "/data/runs/1f0c"})
    assert [row.number(name) for name in ("rods.length", "order.mean", "collisions.rod_rod")] == [2.5, 0.75, 7]
    assert row.fields["versions.shaken"] == "0.1.0" and "defects" not in row.fields and math.isnan(row.number("state"))
    assert row.fields["directory"] == "/data/runs/1f0c"
    assert "directory" not in rows.aggregated([row])[0].fields, "of several runs there is none"
    assert row_with(box__gap="1.2 mm").number("box.gap") == 1.2


def test_replicas_of_a_point_are_put_together():
    points = points_of(answer(2.5, 1, 0.25), answer(4.5, 1, 0.75), answer(2.5, 2, 0.5), answer(4.5, 2, 0.75))
    assert [point.fields["rods.length"] for point in points] == [2.5, 4.5]
    first = points[0].fields
    assert (first["n_replicas"], first["n_done"], first["state"], first["order.mean"]) == (2, 2, "done", 0.375)
    assert first["order.sem"] == 0.125 and "order.mean:sem" not in first, "one name, in rows of runs and of points"
    # two runs that happen to agree are no better than their own errors make them
    assert points[1].fields["order.sem"] == pytest.approx(0.125 / math.sqrt(2))
    assert points_of(answer(2.5, 1, 0.25))[0].fields["order.sem"] == 0.125


def test_every_mean_has_its_standard_error():
    point, = points_of(answer(2.5, 1, 0.25, cpu_seconds=3.0), answer(2.5, 2, 0.5, cpu_seconds=5.0))
    for name, value in point.fields.items():
        if isinstance(value, float) and name not in point.parameters and not name.endswith(("sem", ":sem")):
            assert point.number(rows.error_field(name)) >= 0, name
    # no errors of their own: |5 - 3| / 2, widened to what 68 % of two runs are within
    assert point.fields["cpu_seconds:sem"] == student_factor(2)


def test_versions_are_curves_of_their_own():
    sweeps = pytest.importorskip("shaken.plots.sweeps")
    made = [answer(length, 1, length / 10, versions={"shaken": "0.1.0", "physics": physics})
            for physics in (2, 3) for length in (2.5, 4.5)]
    name, sheet = sweeps.sweep_figure(rows.aggregated(list(map(rows.row_of, made))))
    assert [(drawn.curve, list(drawn.x)) for drawn in sheet[0].drawn[:2]] == [
        ("shaken 0.1.0, physics 2", [2.5, 4.5]), ("shaken 0.1.0, physics 3", [2.5, 4.5])]


def test_versions_are_never_averaged():
    assert [point.fields["order.mean"] for point in points_of(answer(2.5, 1, 0.25), answer(2.5, 2, 0.75, "0.2.0"))] == [
        0.25, 0.75]
    made = [answer(2.5, replica, order, versions={"shaken": "0.1.0", "physics": physics})
            for replica, order, physics in ((1, 0.25, 3), (2, 0.75, 4), (3, 0.5, 4))]
    points = points_of(*made)
    assert [point.fields["order.mean"] for point in points] == [0.25, 0.625] and points[1].version == ("0.1.0", 4)
    assert "versions.physics:sem" not in points[1].fields, "a name, not a number"
    assert rows.has_several_versions(map(rows.row_of, made))
    assert not rows.has_several_versions(map(rows.row_of, made[1:]))
    # what no version is known of is a point of its own, and what has yet to run belongs to the newest
    points = points_of(answer(2.5, 1, 0.25, ""), answer(2.5, 2, 0.75), answer(2.5, 3, -1))
    assert [(point.fields["order.mean"], point.fields["n_replicas"]) for point in points] == [(0.25, 1), (0.75, 2)]


def test_keys_of_the_scenes_are_not_averaged():
    made = [rows.row_of(answer(2.5, replica, 0.5)) for replica in (1, 2)]
    for seed, row in enumerate(made):
        row.scene = {"box.gap": 1.2, "time.seed": seed}
        row.fields |= row.scene
    point, = rows.aggregated(made)
    assert point.fields["box.gap"] == 1.2 and "box.gap:sem" not in point.fields
    assert "time.seed" not in point.fields, "each has its own"


def test_unfinished_runs_count_but_do_not_enter_the_mean():
    fields = points_of(answer(2.5, 1, 0.25), answer(2.5, 2, -1), answer(2.5, 3, 0.5))[0].fields
    assert (fields["n_replicas"], fields["n_done"], fields["order.mean"], fields["state"]) == (3, 2, 0.375, "partial")


def test_a_run_that_goes_on_for_longer_still_counts():
    held = {**judged(1, True), "state": "held"}
    assert points_of(held)[0].fields["n_done"] == 0
    held["summary"]["exit"] = {"state": "stopped", "done_before_s": 20.0}
    point, = points_of(held, judged(2, True))
    assert point.fields["n_done"] == 2 and point.state == "partial"
    running = {**judged(1, True), "state": "running"}
    running["summary"]["exit"] = {"state": "done"}
    assert points_of(running)[0].fields["n_done"] == 1


def test_a_run_that_is_listed_twice_counts_once():
    once = judged(1, True)
    point, = points_of(once, once, once)
    assert (point.fields["n_replicas"], point.fields["n_done"], point.fields["order.n_effective"]) == (1, 1, 20)
    assert points_of(once, judged(2, True), once)[0].fields["n_replicas"] == 2


def test_a_mean_is_of_the_runs_that_have_a_value_and_says_how_many():
    point, = points_of(judged(1, True), judged(2, True, theta_m=None), judged(3, True, theta_m=None))
    assert point.fields["measured.theta_m_deg.value"] == 8.5 and point.fields["measured.theta_m_deg.value:n"] == 1
    assert "order.mean:n" not in point.fields, "all have one"
    nobody = [judged(replica, True, theta_m=None) for replica in (1, 2)]
    assert points_of(*nobody)[0].fields["measured.theta_m_deg.value"] is None, "asked for, and no value"
    assert rows.resolved([rows.row_of(one) for one in nobody], "theta_m_deg") == "measured.theta_m_deg.value"
    over = judged(1, True), judged(2, True)
    for one in over:
        one["summary"]["measured"]["velocity_rms_mm_s"] = {"value": 1.0, "over_s": 0.4}
    fields = points_of(*over)[0].fields
    assert fields["measured.velocity_rms_mm_s.over_s"] == 0.4, "a setting, which replicas share"
    assert "measured.velocity_rms_mm_s.over_s:sem" not in fields


def test_steadiness_is_its_own_then_that_of_the_run():
    relaxing, at_rest = rows.row_of(judged(1, False)), rows.row_of(judged(2, True, False))
    assert relaxing.steady("order.mean") is False and relaxing.steady("measured.theta_m_deg.value") is False
    assert relaxing.steady("cpu_seconds") is True, "no average"
    assert at_rest.steady("order.mean") is True and at_rest.steady("measured.theta_m_deg.value") is False
    assert rows.row_of(judged(1, None)).steady("order.mean") is None
    assert rows.row_of(answer(2.5, 1, 0.5)).steady("order.mean") is True, "of an older version: nothing is known"
    for pair in itertools.permutations([judged(1, True, True), judged(2, False, True)]):
        mixed, = points_of(*pair)
        assert mixed.steady("order.mean") is False and mixed.steady("measured.theta_m_deg.value") is True
    both, = points_of(judged(1, True), judged(2, True))
    assert both.fields["order.steady"] is True and both.fields["measured.theta_m_deg.steady"] is None, "nobody knows"
    assert both.fields["order.n_effective"] == 40 and both.fields["measured.theta_m_deg.sem"] == pytest.approx(
        0.5 / math.sqrt(2))


def test_measured_numbers_go_by_their_names():
    made = [rows.row_of(judged(1, True))]
    errors = ("theta_m_deg.sem", "theta_m_deg:sem", "measured.theta_m_deg.sem")
    for word, field in (("order.mean", "order.mean"), ("theta_m_deg", "measured.theta_m_deg.value"),
                        ("S", "order.mean"), ("order.sem", "order.sem"),
                        *((word, "measured.theta_m_deg.sem") for word in errors)):
        assert rows.resolved(made, word) == rows.resolved(rows.aggregated(made), word) == field
    for slip, hint in (("theta_m", "theta_m_deg"), ("tehta_m_deg", "theta_m_deg"), ("order.maen", "order.mean")):
        with pytest.raises(ShakenError, match=f"did you mean {hint}?"):
            rows.resolved(made, slip)
    assert rows.swept({"rods.length": length, "box.gap": 1.2} for length in (2.5, 3.5)) == [
        "rods.length"]


def test_the_nearest_name_is_a_slip_away():
    assert nearest("LENGHT", ["width", "length"]) == "; did you mean length?", "neighbours swapped, whatever the case"
    assert nearest("no", ["order"]) == nearest("x", ["y"]) == nearest("a" * 101, ["a" * 101]) == nearest("a", []) == ""


def test_quantities_are_read_in_decimals():
    assert quantity("4.1us", "time") == 4.1e-6 and quantity("0.3 um", "length") == 0.0003
    with pytest.raises(ShakenError, match="too large"):
        quantity("1e999999999999999999us", "time")


class FakeDaemon:
    def __init__(self, root=None):
        self.answers = [answer(4.5, 1, 0.75), answer(2.5, 1, 0.25), {**answer(2.5, 2, -1), "label": "a \x1b, \"b\""}]

    def sweeps(self):
        return [{"id": "s1", "name": "phases"}]

    def ask(self, method, path):
        if path == "/v1/jobs/1f":
            raise ShakenError("'1f' fits several jobs: 1f0c, 1f0d")
        if path != "/v1/sweeps/s1":
            raise NotFound(f"no such thing: {path}; did you mean s1?")
        return {"sweep": {"id": "s1", "name": "phases"}, "jobs": [{"id": one["job"]} for one in self.answers]}

    def rows(self, sweep):
        return self.answers


@pytest.fixture
def said(monkeypatch, capsys):
    monkeypatch.setattr(results, "Daemon", FakeDaemon)

    def run(*words, verb="results"):
        code = app.main([verb, *words])
        return (code, *capsys.readouterr())

    return run


@pytest.mark.parametrize("words, out, err", [
    (["--where=rods.length>3"], "JOB       STATE    N     S    SEM\n1f0c0000  done   100  0.75  0.125\n",
     "sweep s1 (phases)\n"),
    (["--aggregate", "--columns=rods.length,n_done,S", "--", "s1"],
     "rods.length  n_done  order.mean\n        4.5       1        0.75\n        2.5       1        0.25\n", ""),
    (["--csv", "--columns=state,S", "--where=order.mean>0.1", "--where=order.mean<0.5", "--", "s1"],
     "state,order.mean\ndone,0.25\n", "1 of 3 runs lack order.mean: comparisons with it are false for them\n"),
    (["--csv", "--columns=label", "--where=state=queued", "--", "s1"], 'label\n"a \\u001b, ""b"""\n', ""),
    (["--aggregate", "--where=state=nothing", "--", "s1"], "No rows.\n", "")])
def test_tables(said, words, out, err):
    assert said(*words) == (0, out, err)


def test_json_is_as_the_daemon_sent_it(said):
    code, out, _ = said("--json", "--", "s1")
    assert code == 0 and json.loads(out)["rows"] == FakeDaemon().answers and "\x1b" not in out


@pytest.mark.parametrize("words, why", [
    (["--columns=order.maen,nothing", "--", "s1"], ["did you mean order.mean?", "'nothing'"]),
    (["--where=order.mean>", "--where=(state=done"], ["a value is missing", "never closed"]),
    (["--where=no.such_field=1"], ["no row has a field", "`shaken results --csv` shows all names"]),
    (["--csv", "--json"], ["exclude each other"]),
    (["--", "s2"], ["no sweep or job is called 's2'; did you mean s1?"]),
    (["--", "\udcff"], ["no sweep or job is called '\\xff'"]),
    (["--", "1f"], ["'1f' fits several jobs: 1f0c, 1f0d"])])
def test_bad_input_is_exit_code_two_with_all_that_is_wrong(said, words, why):
    code, out, err = said(*words)
    assert code == 2 and err.startswith("shaken: ") and all(part in err for part in why)
    assert (json.loads(out)["exit_code"] == 2) if "--json" in words else out == ""


def test_a_full_disk_is_told_in_one_line(said, monkeypatch):
    with open("/dev/full", "w") as full:
        monkeypatch.setattr(sys, "stdout", full)
        assert said("--json", "--", "s1") == (1, "", "shaken: [Errno 28] No space left on device\n")


def test_tables_fit_the_terminal():
    columns = [text.Column("JOB", ["1f0c"]), text.Column("LABEL", ["a long text in it"]),
               text.Column("N", ["1234"], True, 2), text.Column("S", ["0.5"], True), text.Column("M", ["1"], True, 2)]
    lines, left_out = text.table(columns, 34)
    assert lines == "JOB   LABEL                 N    S\n1f0c  a long text in it  1234  0.5\n" and left_out == ["M"]
    lines, left_out = text.table(columns, 20)
    assert lines == "JOB   LABEL        S\n1f0c  a long t…  0.5\n" and left_out == ["N", "M"]
    assert text.table([columns[0]], 2)[0] == "JOB\n1f0c\n", "the first column is never cut"
    assert [text.number_text(value) for value in (0.95, 271.0, 123456, 241.71, 1.2e7, math.nan, 0.00092341)] == [
        "0.95", "271", "123456", "241.7", "1.2e+07", "-", "0.0009234"]


def test_results_need_nothing_but_pythons_own_library(tmp_path):
    program = Path(app.__file__).parent / "__main__.py"
    done = subprocess.run([sys.executable, "-I", "-S", program, "results", f"--root={tmp_path}"], capture_output=True,
                          text=True)
    assert done.returncode == 3 and "start one with `shakend --root" in done.stderr, done.stderr


def test_the_inset_of_pictures_has_the_sweep_and_where_its_jobs_are(said):
    code, out, _ = said("--job=1f0c000000000001", "--", "s1", verb="inset")
    assert code == 0 and json.loads(out) == {
        "x": "rods.length", "y": "", "points": [[4.5, None, 0.75], [2.5, None, 0.25]], "here": [[2.5, None]]}
    assert said("--job=2a", "--", "s1", verb="inset") == (2, "", "shaken: job 2a does not belong to sweep s1\n")


def test_the_axes_of_a_diagram_are_two_numbers_that_say_more_than_one():
    def axes(*swept):
        return rows.axes_of([rows.Row(parameters, "", dict(parameters)) for parameters in swept])

    zipped = [{"walls.shape": shape, "rods.length": f"{length} mm", "rods.count": 9 * length, "box.gap": gap}
              for shape, length, gap in (("disc", 2, 1.2), ("ring", 3, 1.2), ("disc", 3, 1.4))]
    assert axes(*zipped) == ["rods.length", "box.gap"] and axes(*zipped[:2]) == ["rods.length"]
    with pytest.raises(ShakenError, match="no number is swept"):
        axes({"walls.shape": "disc"}, {"walls.shape": "ring"})


def plotted(monkeypatch, answers, *words):
    """What `shaken plot` of a sweep with these rows ends with, and what it has said."""
    plot = pytest.importorskip("shaken.tables.plot")
    daemon = FakeDaemon()
    daemon.answers = answers
    monkeypatch.setattr(plot, "Daemon", lambda root: daemon)
    return app.main(["plot", *words, "--", "s1"])


def test_plots_say_what_they_are_made_of_and_what_is_left_out(tmp_path, monkeypatch, capsys):
    h5py = pytest.importorskip("h5py")
    with h5py.File(tmp_path / "observables.h5", "w") as file:
        for name, values in {"/order/time_s": [0.0, 1.0], "/order/order": [1.0, 0.5]}.items():
            file[name] = values
    (tmp_path / "summary.json").write_text(json.dumps({"run_id": "1f0c59d16ab8b7d7", "steady": True,
                                                       "versions": {"shaken": "0.1.0", "physics": 3}}))
    (tmp_path / "scene.json").write_text("{}")
    assert app.main(["plot", f"--out={tmp_path}/out", "--format=svg", "--", str(tmp_path)]) == 0
    assert capsys.readouterr() == (f"{tmp_path}/out/order_time.svg\n", "")
    assert (tmp_path / "out/order_time.csv").read_text().startswith(
        "# Software: shaken plot 0.1.0\n# Computed by: shaken 0.1.0, physics 3\n# Runs: 1f0c59d16ab8b7d7\n")
    (tmp_path / "observables.h5").unlink()
    assert app.main(["plot", "--", str(tmp_path)]) == 1
    said = capsys.readouterr().err
    assert "left out: no observables.h5 there" in said and "shaken: there is nothing to plot yet" in said
    assert plotted(monkeypatch, [answer(2.5, 1, 0.5)], "--y=S") == 1
    assert "no numeric parameter is swept" in capsys.readouterr().err
    assert plotted(monkeypatch, [answer(2.5, 1, 0.5)], "--y=S", "--map") == 2
    assert "--map goes with neither --x nor --y" in capsys.readouterr().err
    windowed = [answer(length, k, 0.5, measured={"velocity_rms_mm_s": {"value": 1.0, "over_s": 0.4}})
                for k, length in enumerate((2.5, 4.5))]
    assert plotted(monkeypatch, windowed, "--y=velocity_rms_mm_s", f"--out={tmp_path}/v.svg") == 0
    assert "over 0.4 s (mm/s)" in (tmp_path / "v.csv").read_text()


@pytest.mark.parametrize("case", json.loads((VECTORS / "points.json").read_text()), ids=lambda case: case["why"])
def test_points_are_those_of_the_page(case):
    points = rows.aggregated([rows.row_of(row) for row in case["rows"]])
    newest = max(points, key=lambda point: rows.newness(point.version))
    assert newest.number(case["value"]) == case["mean"] and newest.fields["n_done"] == case["n"]
    steady = rows.row_of(case["rows"][0]).steady(case["value"])
    assert STEADINESS[steady]["mark"] == case["mark"]


def test_a_run_that_is_not_done_belongs_to_the_newest_version():
    done = [{"job": version, "state": "done", "parameters": {"x": 1}, "summary": {
        "versions": {"shaken": version, "physics": 3}, "exit": {"state": "done"}}} for version in ("0.9.0", "0.10.0")]
    waits = {"job": "w", "state": "queued", "parameters": {"x": 1}, "summary": None}
    points = rows.aggregated([rows.row_of(row) for row in (*done, waits)])
    assert {point.version[0]: point.fields["n_replicas"] for point in points} == {"0.9.0": 1, "0.10.0": 2}
