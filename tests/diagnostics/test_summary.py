import json
import math
from dataclasses import replace
from pathlib import Path

import numpy as np
import pytest
from recomputation import wrapped
from recordings import MOWER, entry, recording, speeds, wheels
from scenes import rich, scene, unbounded
from scipy.stats import chi2

from ekfsim.commands import Kidnap, Move, Say, Sense
from ekfsim.diagnostics.summary import Errors, Summary
from ekfsim.files.results.outputs import SUMMARY_FORMAT, Outputs
from ekfsim.files.scenes.load import load_scene
from ekfsim.geometry.outline import path_error
from ekfsim.localization import play

FOUR = {"rmse", "mean", "sd", "max"}


def summary_of(scene):
    summary = Summary.of(scene)
    for step in play(scene):
        summary.add(step)
    return summary.table()


@pytest.mark.parametrize("made", [rich(), rich(seed=9, gate=None, guard="skip"), unbounded()])
def test_it_is_what_numpy_makes_of_the_steps(made):
    steps, table = list(play(made)), summary_of(made)
    told = [s for s in steps if s.entry.given is not None]
    senses = [s for s in steps if s.correction is not None]
    assert table["steps"] == len(steps) - 1
    assert table["updates"] == sum(int(s.correction.refused) == 0 for s in senses)
    assert table["refused"] == len(senses) - table["updates"]

    e = np.array([s.posterior.mean - s.entry.truth for s in told])
    distance, heading = np.hypot(e[:, 0], e[:, 1]), np.angle(np.exp(1j * e[:, 2]))
    for name, errors in (("position", distance), ("heading", heading)):
        assert table[name] == pytest.approx(
            {
                "rmse": math.sqrt(np.mean(errors**2)),
                "mean": errors.mean(),
                "sd": errors.std(),
                "max": np.abs(errors).max(),
            }
        )

    nis = np.array([float(s.correction.nis) for s in senses])
    nis = nis[~np.isnan(nis)]
    low, high = chi2.interval(0.99, len(nis))
    assert table["nis"] == pytest.approx(
        {"mean": nis.mean(), "sum": nis.sum(), "dof": len(nis), "low": low, "high": high}
    )
    assert table["nees"] == pytest.approx(
        {"last": float(steps[-1].nees.value), "dof": int(steps[-1].nees.dof)}
    )


def test_dead_reckoning_follows_the_odometry_alone():
    made = rich()
    x, y, th = made.world.told.start.tolist()
    off, turned = [], []
    for step in play(made):
        if step.prediction is not None:
            d, a = step.entry.given.u.tolist()
            x, y, th = x + d * math.cos(th), y + d * math.sin(th), th + a
        if step.entry.given is not None:
            off.append(math.dist((x, y), step.entry.truth[:2]))
            turned.append(wrapped(th - float(step.entry.truth[2])))
    rmse = {
        "position": math.sqrt(np.mean(np.square(off))),
        "heading": math.sqrt(np.mean(np.square(turned))),
    }
    assert summary_of(made)["dead_reckoning"] == pytest.approx(rmse)


def test_words_and_carrying_are_no_instants_of_the_filter():
    quiet = summary_of(scene(Move(1.0, 0.3), Sense(0.2)))
    loud = summary_of(scene(Say("a"), Move(1.0, 0.3), Say("b"), Sense(0.2), Kidnap(5, 5, 0)))
    assert loud["steps"] == quiet["steps"] + 3
    assert loud["position"] == quiet["position"]


def test_a_kidnapped_robot_is_lost():
    table = summary_of(scene(Move(1.0, 0.3), Sense(0.2), Kidnap(8, 7, 3)))
    assert table["lost_from"] == 3
    assert table["verdict"] == "lost"


def test_a_run_without_commands():
    table = summary_of(scene())
    assert table["steps"] == table["updates"] == table["refused"] == 0
    assert set(table["position"].values()) == {None}
    assert table["nis"] == {"mean": None, "sum": 0, "dof": 0, "low": None, "high": None}
    assert table["verdict"] == "no evidence"
    assert table["dead_reckoning"] == {"position": None, "heading": None}


def test_the_keys_are_those_of_the_format(tmp_path):
    path, summary = tmp_path / "summary.json", Summary()
    with Outputs(summary=path).open(rich(), 0.954, summary) as sinks:
        for step in play(rich()):
            summary.add(step)
            for sink in sinks:
                sink.write(step)
    written = json.loads(path.read_text(), parse_constant=pytest.fail)
    assert written.pop("format") == SUMMARY_FORMAT
    made_by = {"ekfsim", "world", "commands", "filter", "gate", "guard", "seed", "run"}
    assert set(written) >= made_by
    assert {key: written[key] for key in set(written) - made_by} == summary.table()
    assert set(written) - made_by == {
        "steps", "updates", "refused", "position", "heading", "path_rmse", "nis", "nees",
        "lost_from", "verdict", "whiteness",
        "dead_reckoning",
    }  # fmt: skip
    assert set(written["position"]) == set(written["heading"]) == FOUR
    assert set(written["nis"]) == {"mean", "sum", "dof", "low", "high"}
    assert set(written["whiteness"]) == {"word", "p", "tests", "left_out", "sensors"}
    assert set(written["nees"]) == {"last", "dof"}
    assert set(written["dead_reckoning"]) == {"position", "heading"}


def rmse(errors):
    return math.sqrt(np.mean(np.square(errors)))


def test_with_a_clock_errors_are_those_of_every_judged_instant_after_its_last_reading():
    steps = list(play(recording()))
    # 3 and 4 follow 2 at one instant, 6 is not judged
    last = [steps[k] for k in (0, 1, 4, 5, 7, 8)]
    e = np.array([s.posterior.mean - s.entry.truth for s in last])
    table = summary_of(recording())
    assert table["position"]["rmse"] == pytest.approx(rmse(np.hypot(e[:, 0], e[:, 1])))
    assert table["position"]["max"] == pytest.approx(np.hypot(e[:, 0], e[:, 1]).max())
    assert table["heading"]["mean"] == pytest.approx(e[:, 2].mean())
    assert table["heading"]["sd"] == pytest.approx(e[:, 2].std())
    assert (table["steps"], table["updates"], table["refused"]) == (8, 2, 2)


def test_dead_reckoning_of_a_recorded_run_follows_its_inputs_on_the_whole_state():
    made = recording()
    x, off = made.log.first.mean, {}
    for step in play(made):
        if step.prediction is not None:
            x = step.entry.given.motion.f(x, step.entry.given.u)
        if step.entry.judged:
            off[step.entry.t] = math.dist(x[:2], step.entry.truth[:2])
    assert summary_of(made)["dead_reckoning"]["position"] == pytest.approx(rmse(list(off.values())))
    known = speeds(9, 3)
    known = replace(
        known,
        log=replace(
            known.log, entries=tuple(replace(e, truth=np.zeros(3)) for e in known.log.entries)
        ),
    )
    x = known.log.first.mean
    reckoned = [x] + [
        x := e.given.motion.f(x, e.given.u) for e in known.log.entries if hasattr(e.given, "u")
    ]
    expected = rmse([math.hypot(x[2], x[3]) for x in reckoned])
    assert summary_of(known)["dead_reckoning"]["position"] == pytest.approx(expected)


def test_a_reading_makes_an_unjudged_instant_no_instant_and_belongs_to_a_judged_one():
    judged, unjudged = MOWER[:5], tuple(replace(e, judged=e.t < 11) for e in MOWER[:5])
    mixed = (*MOWER[:3], *(replace(e, judged=False) for e in MOWER[3:5]))
    assert summary_of(recording(mixed))["position"] == summary_of(recording(judged))["position"]
    assert (
        summary_of(recording(unjudged))["position"] == summary_of(recording(MOWER[:2]))["position"]
    )


def test_without_truth_there_are_no_errors_and_the_verdict_is_that_of_the_readings():
    table = summary_of(speeds(90, 10))
    assert set(table["position"].values()) == set(table["heading"].values()) == {None}
    assert table["dead_reckoning"] == {"position": None, "heading": None}
    assert table["nees"] == {"last": None, "dof": None}
    assert table["nis"]["dof"] == 18
    assert table["nis"]["mean"] == pytest.approx(table["nis"]["sum"] / 18)
    assert table["verdict"] in ("consistent", "over-confident", "over-cautious")


def test_the_distance_to_the_expected_path_is_taken_at_every_row():
    made, path = speeds(9, 3), np.array([[0.0, 1], [3, 1], [3, 4], [0, 4]])
    made = replace(made, world=replace(made.world, expected_path=path))
    after = {
        s.entry.t: made.world.layout.pose(s.posterior.mean)
        for s in play(made)
        if s.entry.given is not None
    }
    assert len(after) == 9
    assert summary_of(made)["path_rmse"] == pytest.approx(
        rmse([path_error(x[:2], path) for x in after.values()])
    )


def test_errors_of_one_instant_take_each_others_place():
    errors = Errors()
    for e, t in [(9.0, 1.0), (-3.0, 1.0), (8.0, 2.0), (4.0, 2.0)]:
        errors.add(e, t)
        assert errors.n == (1 if t == 1 else 2)
    assert errors.table() == pytest.approx(
        {"rmse": math.sqrt(12.5), "mean": 0.5, "sd": 3.5, "max": 4.0}
    )
    errors.add(math.nan, 2.0)
    assert set(errors.table().values()) == {None}


def test_the_summary_of_a_recorded_run_is_written_without_a_nan(tmp_path):
    for number, made in enumerate(
        (recording(), speeds(9, 3), recording((entry(0, 1.0, None, (1, 2, 3)),)))
    ):
        path, summary = tmp_path / f"{number}.json", Summary.of(made)
        with Outputs(summary=path).open(made, 0.954, summary):
            for step in play(made):
                summary.add(step)
        written = json.loads(path.read_text(), parse_constant=pytest.fail)
        assert {key: written[key] for key in summary.table()} == summary.table()


def test_a_clock_that_stands_still_is_one_instant():
    stands = tuple(entry(k, 5.0, wheels(0.1, 0.1, 0) if k else None, (1, 2, 10)) for k in range(4))
    summary = Summary.of(recording(stands))
    for step in play(recording(stands)):
        summary.add(step)
    assert summary.position.n == 1
    assert summary.duration == 0


def test_the_path_error_of_the_pylon_log_is_its_authors():
    log = (
        Path(__file__).resolve().parents[2]
        / "shared"
        / "data"
        / "pylon"
        / "2020_2_26__17_21_59_filtered.csv"
    )
    if not log.exists():
        pytest.skip(f"needs the recorded log {log.name} beside the checkout")
    table = summary_of(load_scene("pylon_log", log=log, reading="coded"))
    assert table["path_rmse"] == pytest.approx(0.230198957, abs=1e-8)
    assert table["updates"] == 707
