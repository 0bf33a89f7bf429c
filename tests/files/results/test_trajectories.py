import csv
import io
import math
from dataclasses import replace
from pathlib import Path

import numpy as np
import pytest
from recordings import recording, speeds
from scenes import rich, scene
from systems_scenes import gnss, mower

from ekfsim.commands import Kidnap, Move, Say, Sense
from ekfsim.diagnostics.summary import Summary
from ekfsim.files.results.outputs import Outputs
from ekfsim.files.results.trajectories import COLUMNS, DRIVEN_COLUMNS, Table, Tum
from ekfsim.files.scenes.load import load_scene
from ekfsim.filters.belief import Refused
from ekfsim.geometry.ellipse import ellipse
from ekfsim.localization import play
from ekfsim.provenance import provenance
from ekfsim.systems.drives import Stretch, Stretches


def tum_of(scene):
    truth, estimate = io.StringIO(), io.StringIO()
    tum = Tum(truth, estimate, scene)
    for step in play(scene):
        tum.write(step)
    tum.finish()
    return truth.getvalue(), estimate.getvalue()


def test_a_line_an_instant_with_its_pose_as_a_unit_quaternion():
    truth, estimate = tum_of(rich())
    steps = [step for step in play(rich()) if step.entry.given is not None]
    for text, poses in (
        (truth, [s.entry.truth for s in steps]),
        (estimate, [s.posterior.mean for s in steps]),
    ):
        rows = np.loadtxt(io.StringIO(text))  # comments are skipped, as evo skips them
        assert rows.shape == (len(steps), 8)
        assert rows[:, 0].tolist() == [step.entry.index for step in steps]
        for row, (x, y, theta) in zip(rows, poses, strict=True):
            assert row[1:3].tolist() == [x, y]
            assert row[3:6].tolist() == [0, 0, 0]
            assert math.hypot(*row[6:]) == pytest.approx(1, abs=1e-15)
            assert math.remainder(
                2 * math.atan2(row[6], row[7]) - theta, 2 * math.pi
            ) == pytest.approx(0, abs=1e-12)


def test_they_say_what_made_them():
    for text, name in zip(tum_of(rich()), ("truth", "estimate"), strict=True):
        first = text.splitlines()[0]
        assert first.startswith(f"# {name}: ekfsim ")
        assert "seed 3, run 0" in first


def rows_of(scene, confidence=0.954):
    file = io.StringIO()
    table = Table(file, scene, confidence)
    for step in play(scene):
        table.write(step)
    return list(csv.DictReader(io.StringIO(file.getvalue())))


def test_every_row_has_every_column():
    rows = rows_of(rich())
    assert len(rows) == len(list(play(rich())))
    for row in rows:
        assert list(row) == [*COLUMNS, *provenance(rich()), "confidence", "format"]
        assert row["format"] == "1"
        assert "nan" not in row.values()
        assert row["seed"] == "3"


@pytest.mark.parametrize("guard", ["warn", "skip"])
def test_a_row_holds_the_numbers_of_its_step(guard):
    made = rich(guard=guard)
    for row, step in zip(rows_of(made, 0.9), play(made), strict=True):
        x, P = step.posterior
        drawn = ellipse(P, 0.9)
        expected = {
            **dict(zip(("x", "y", "theta"), x, strict=True)),
            **dict(zip(("true_x", "true_y", "true_theta"), step.entry.truth, strict=True)),
            **{
                "P_xx": P[0, 0],
                "P_xy": P[0, 1],
                "P_xtheta": P[0, 2],
                "P_yy": P[1, 1],
                "P_ytheta": P[1, 2],
            },
            **{
                "P_thetatheta": P[2, 2],
                "nees_dof": step.nees.dof,
                "impossible": step.nees.impossible,
            },
            **{
                f"ellipse_{name}": getattr(drawn, name)
                for name in ("major", "minor", "orientation")
            },
        }
        if not step.nees.impossible:
            expected["nees"] = step.nees.value
        if step.correction is not None:
            c = step.correction
            expected |= {
                "range": step.entry.given.z[0],
                "predicted_range": c.predicted[0],
                "nis": c.nis,
            }
            expected |= {"innovation": c.innovation[0], "innovation_variance": c.S[0, 0]}
            assert row["refused"] == (Refused(int(c.refused)).word or "")
        for name, value in expected.items():
            assert row[name] == "" if math.isnan(value) else float(row[name]) == value, name
        kind = "start" if step.entry.command is None else type(step.entry.command).__name__.lower()
        assert (int(row["index"]), row["type"]) == (step.entry.index, kind)


def test_a_move_has_no_reading():
    row = rows_of(scene(Move(1.0, 0.5)))[1]
    reading = ("range", "predicted_range", "innovation", "innovation_variance", "nis", "refused")
    assert {row[name] for name in reading} == {""}


def test_a_clock_has_a_line_for_each_instant_after_its_last_reading():
    truth, estimate = (np.loadtxt(io.StringIO(text)) for text in tum_of(recording()))
    steps = list(play(recording()))
    last = [0, 1, 4, 5, 7, 8]  # 6 is not judged
    assert truth[:, 0].tolist() == estimate[:, 0].tolist() == [10, 10.5, 11, 11.5, 12, 12.5]
    assert estimate[:, 1:3].tolist() == [steps[k].posterior.mean[:2].tolist() for k in last]
    assert truth[:, 1:3].tolist() == [steps[k].entry.truth[:2].tolist() for k in last]


def errors_by_hand(truth, estimate):
    """RMSE (m) and mean heading error (rad) of two TUM texts as evo finds them: the nearest stamps,
    nothing aligned."""
    true, told = (np.loadtxt(io.StringIO(text), ndmin=2) for text in (truth, estimate))
    pairs = [(row, told[abs(told[:, 0] - row[0]).argmin()]) for row in true]
    assert all(abs(one[0] - other[0]) < 0.01 for one, other in pairs)
    turns = [
        2 * (math.atan2(other[6], other[7]) - math.atan2(one[6], one[7])) for one, other in pairs
    ]
    rmse = math.sqrt(np.mean([math.dist(one[1:3], other[1:3]) ** 2 for one, other in pairs]))
    return rmse, np.mean([math.remainder(turn, 2 * math.pi) for turn in turns])


def first_of(recorded, entries):
    """The beginning of a recorded run."""
    return replace(recorded, log=replace(recorded.log, entries=recorded.log.entries[:entries]))


MRCLAM = Path(__file__).resolve().parents[4] / "shared" / "data" / "mrclam6_robot1"
RUNS = {
    "says and kidnaps": lambda: scene(
        Say("a"),
        Move(1.0, 0.3),
        Say("b"),
        Sense(0.2),
        Kidnap(5, 5, 3),
        Sense(1.0),
        Move(1.0, 2.0),
        Say("c"),
    ),
    "rich": rich,
    "certain at first": lambda: scene(Kidnap(3, 3, 0), Say("a"), Sense(0.1)),
    "unjudged instants": recording,
    "gnss": lambda: replace(gnss(), drive=Stretches((Stretch(1.0, 0.5, 3.0),))),
    "mower": lambda: replace(mower(seed=4), drive=Stretches((Stretch(1.0, 0.2, 3.0),))),
    "a log with truth": lambda: first_of(load_scene("mrclam_log", log=MRCLAM), 1500),
}


@pytest.mark.parametrize("name", RUNS)
def test_the_summary_and_evo_find_the_same_error(name):
    if name == "a log with truth" and not MRCLAM.exists():
        pytest.skip(f"needs the recorded log {MRCLAM.name} beside the checkout")
    made = RUNS[name]()
    summary = Summary.of(made)
    for step in play(made):
        summary.add(step)
    found, table = errors_by_hand(*tum_of(made)), summary.table()
    assert found == pytest.approx((table["position"]["rmse"], table["heading"]["mean"]), abs=1e-9)


def test_instants_keep_all_their_digits():
    made = speeds(3, 10, dt=1 / 3)
    _, estimate = tum_of(made)
    told = [float(line.split()[0]) for line in estimate.splitlines()[2:]]
    assert told == [step.entry.t for step in play(made)]


def test_of_a_run_without_truth_there_is_the_estimate_alone(tmp_path):
    """And no truth.tum of an earlier run beside it, of which evo would find errors."""
    made = speeds(6, 3)
    outputs = Outputs(tum=tmp_path, force=True)
    (tmp_path / "truth.tum").write_text("0 0 0 0 0 0 0 1\n")
    assert outputs.unknown_truth(made) == tmp_path / "truth.tum"
    with outputs.open(made, 0.954, Summary.of(made)) as sinks:
        for step in play(made):
            sinks[0].write(step)
    assert [file.name for file in tmp_path.iterdir()] == ["estimate.tum"]
    assert len((tmp_path / "estimate.tum").read_text().splitlines()) == 2 + 7
    assert outputs.unknown_truth(rich()) is None


@pytest.mark.parametrize("made", [recording(), speeds(9, 3)])
def test_a_row_of_a_recorded_run_holds_the_pose_and_the_numbers_of_its_reading(made):
    layout = made.world.layout
    for row, step in zip(rows_of(made), play(made), strict=True):
        assert list(row) == [*DRIVEN_COLUMNS, *provenance(made), "confidence", "format"]
        pose, P = (
            layout.pose(step.posterior.mean),
            layout.pose_covariance(step.posterior.covariance),
        )
        assert [float(row[name]) for name in ("x", "y", "theta")] == pose.tolist()
        assert float(row["P_ytheta"]) == P[1, 2]
        assert float(row["t"]) == step.entry.t
        if step.correction is not None:
            assert (row["type"], row["sensor"]) == ("update", step.entry.given.name)
            for name, numbers in (
                ("z", step.entry.given.z),
                ("predicted", step.correction.predicted),
            ):
                assert [float(number) for number in row[name].split()] == [
                    n for n in numbers.tolist() if n == n
                ]
        elif step.prediction is not None:
            assert (row["type"], row["sensor"]) == ("predict", "odometry")
            assert [float(number) for number in row["z"].split()] == step.entry.given.u.tolist()
        else:
            assert (row["type"], row["sensor"], row["z"]) == ("start", "", "")


def test_what_a_recorded_run_leaves_undefined_is_empty():
    gated, silent = rows_of(recording())[6:8]
    assert gated["refused"] == "gate"
    assert [silent[name] for name in ("z", "predicted", "innovation", "nis", "refused")] == [
        "",
        "",
        "",
        "",
        "no echo",
    ]
    blind = rows_of(speeds(6, 3))[3]
    assert [blind[name] for name in ("true_x", "true_theta", "nees", "impossible")] == [""] * 4


@pytest.mark.parametrize("filter", ["huber", "pdaf"])
def test_a_row_holds_how_far_its_reading_was_believed(filter):
    made = replace(load_scene("tour"), filter=filter)
    trusted = [float(row["trust"]) for row in rows_of(made) if row["trust"]]
    assert trusted == [float(s.correction.trust) for s in play(made) if s.correction]
    assert 0 < min(trusted) < max(trusted) <= 1
    assert {row["hypotheses"] for row in rows_of(made)} == {""}


def test_a_row_holds_what_was_learnt_of_the_noise():
    made = replace(load_scene("tour"), filter="adaptive")
    learnt = [float(row["noise_factor"]) for row in rows_of(made) if row["noise_factor"]]
    assert learnt == [float(s.correction.noise_factor) for s in play(made) if s.correction]
    assert 0 < min(learnt) < max(learnt)
    assert {row["trust"] for row in rows_of(made)} == {""}


def test_a_row_holds_every_hypothesis():
    """Their weights are one in all, and their mean is that of the row."""
    several = 0
    for row in rows_of(replace(load_scene("diverge-01-wrong-wall"), filter="mhekf")):
        if not row["hypotheses"]:
            assert int(row["index"]) < 2  # the first belief is one Gaussian
            continue
        names = "weights", "each_x", "each_y", "each_theta"
        w, x, y, theta = (np.array([float(one) for one in row[name].split()]) for name in names)
        assert len(w) == len(x) == len(y) == len(theta) == int(row["hypotheses"])
        assert w.sum() == pytest.approx(1, abs=1e-12)
        assert w.tolist() == sorted(w, reverse=True)
        assert w @ x == pytest.approx(float(row["x"]), abs=1e-12)
        assert w @ y == pytest.approx(float(row["y"]), abs=1e-12)
        assert row["trust"] == ""
        several += len(w) > 1
    assert several > 3
