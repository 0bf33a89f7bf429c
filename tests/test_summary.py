import json
import math

import numpy as np
import pytest
from recomputation import wrapped
from scenes import rich, scene, unbounded
from scipy.stats import chi2

from ekfsim.files.outputs import Outputs
from ekfsim.localization import play
from ekfsim.records import Kidnap, Move, Say, Sense
from ekfsim.summary import Summary

FOUR = {"rmse", "mean", "sd", "max"}


def summary_of(scene):
    summary = Summary()
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
    assert table["nees"] == pytest.approx({"last": float(steps[-1].nees.value), "dof": int(steps[-1].nees.dof)})


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
    rmse = {"position": math.sqrt(np.mean(np.square(off))), "heading": math.sqrt(np.mean(np.square(turned)))}
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
    made_by = {"ekfsim", "world", "commands", "filter", "gate", "guard", "seed", "run"}
    assert set(written) >= made_by
    assert {key: written[key] for key in set(written) - made_by} == summary.table()
    assert set(written) - made_by == {
        "steps", "updates", "refused", "position", "heading", "path_rmse", "nis", "nees", "lost_from", "verdict",
        "dead_reckoning",
    }  # fmt: skip
    assert set(written["position"]) == set(written["heading"]) == FOUR
    assert set(written["nis"]) == {"mean", "sum", "dof", "low", "high"}
    assert set(written["nees"]) == {"last", "dof"}
    assert set(written["dead_reckoning"]) == {"position", "heading"}
