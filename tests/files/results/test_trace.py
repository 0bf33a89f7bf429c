import dataclasses
import io
import json
import math

import numpy as np
import pytest
import shapely
from recomputation import Edges, believed, disagreements, true_course
from recordings import MOWER, recording, speeds
from scenes import ROOM, rich, scene, told, unbounded

from ekfsim.commands import Kidnap, Move, Say, Sense
from ekfsim.files.packaged import packaged
from ekfsim.files.results.trace import Trace
from ekfsim.files.scenes.load import load_scene
from ekfsim.localization import play
from ekfsim.world import Noise

CONFIDENCE = 0.954
PACKAGED = {
    name: path
    for name, path in packaged("commands").items()
    if "\ncommands:" in path.read_text() and name != "unknown-start"  # which no EKF can begin
}
SCENES = {
    "rich": rich(),
    "guarded": rich(seed=8, gate=None, guard="skip"),
    "late run": dataclasses.replace(rich(seed=4, gate=None, guard="off"), run=2050),
    "unbounded": unbounded(),
}

MOVE = ["type", "index", "command", "odometry", "F", "G", "M", "prior", "posterior", "truth",
    "bump", "ellipse", "nees",
        "nees_dof", "impossible"]  # fmt: skip
SENSE = ["type", "index", "command", "range", "predicted_range", "range_variance", "wall",
    "incidence", "ambiguous",
         "H", "innovation", "innovation_variance", "gain", "nis", "updated", "refused", "prior",
         "posterior", "truth",
         "ellipse", "nees", "nees_dof", "impossible"]  # fmt: skip
START = ["type", "format", "ekfsim", "world", "filter", "seed", "run", "confidence", "state",
    "mean", "covariance",
         "truth"]  # fmt: skip
MADE_BY = {"commands", "gate", "guard"}  # every output says what made it


def trace_of(scene, confidence=CONFIDENCE):
    file = io.StringIO()
    trace = Trace(file, scene, confidence)
    for step in play(scene):
        trace.write(step)
    return [json.loads(line, parse_constant=pytest.fail) for line in file.getvalue().splitlines()]


@pytest.mark.parametrize("scene", [pytest.param(made, id=name) for name, made in SCENES.items()])
@pytest.mark.parametrize("confidence", [CONFIDENCE, 0.5])
def test_every_number_follows_from_the_raw_readings(scene, confidence):
    lines = trace_of(scene, confidence)
    for line, expected in zip(lines, believed(scene, lines, confidence), strict=True):
        assert disagreements(line, expected) == [], line


@pytest.mark.parametrize("scene", [pytest.param(made, id=name) for name, made in SCENES.items()])
def test_every_reading_follows_from_the_draws(scene):
    for line, expected in zip(trace_of(scene), true_course(scene), strict=True):
        assert disagreements(line, expected, tolerance=1e-12) == [], line


@pytest.mark.parametrize("name", PACKAGED)
def test_the_packaged_scenes_follow_from_their_draws_and_readings(name):
    scene = dataclasses.replace(load_scene(PACKAGED[name]), filter="ekf")
    lines = trace_of(scene)
    for line, raw, expected in zip(
        lines, true_course(scene), believed(scene, lines, CONFIDENCE), strict=True
    ):
        assert disagreements(line, raw) == [], line
        assert disagreements(line, expected) == [], line


def test_the_scenes_hold_every_kind_of_line():
    lines = [line for scene in SCENES.values() for line in trace_of(scene)]
    assert {line["type"] for line in lines} == {"start", "move", "sense", "kidnap", "say"}
    senses = [line for line in lines if line["type"] == "sense"]
    assert {line["refused"] for line in senses} == {None, "gate", "guard", "no echo", "no wall"}
    assert {line["ambiguous"] for line in senses} == {True, False}
    assert {line["bump"] for line in lines if line["type"] == "move"} >= {None, "boundary"}
    assert {line.get("nees_dof") for line in lines} >= {3}
    assert any(line["command"]["distance"] < 0 for line in lines if line["type"] == "move")


def test_the_recomputation_casts_as_shapely_does():
    plan = rich().world.map
    walls = shapely.union_all([shapely.LinearRing(ring) for _, ring in plan.rings()])
    random = np.random.default_rng(5)
    for x, y, heading in random.uniform((0, 0, -math.pi), (10, 8, math.pi), (300, 3)).tolist():
        beam = shapely.LineString(
            [(x, y), (x + 40 * math.cos(heading), y + 40 * math.sin(heading))]
        )
        nearest = shapely.Point(x, y).distance(walls.intersection(beam))
        assert Edges(plan).first(x, y, heading)[0] == pytest.approx(nearest, abs=1e-10)


def test_the_keys_are_those_of_the_format():
    lines = trace_of(rich())
    of = {
        kind: next(line for line in lines if line["type"] == kind)
        for kind in ("start", "move", "sense")
    }
    assert set(of["start"]) == {*START, *MADE_BY}
    assert set(of["move"]) == set(MOVE)
    assert set(of["sense"]) == set(SENSE)
    assert set(of["move"]["prior"]) == set(of["move"]["posterior"]) == {"mean", "covariance"}
    assert set(of["move"]["odometry"]) == set(of["move"]["command"]) == {"distance", "angle"}
    assert set(of["move"]["ellipse"]) == {"major", "minor", "orientation"}
    assert of["start"]["format"] == 1
    assert of["start"]["state"] == ["x", "y", "theta"]


def test_commands_are_told_in_radians():
    lines = trace_of(
        scene(
            Move(1.0, math.pi / 2),
            Move(1.0, 0.0, slip=0.5),
            Sense(math.pi),
            Kidnap(1, 2, 0.3),
            Say("a – b"),
        )
    )
    assert [line.get("command") for line in lines] == [
        None,
        {"distance": 1.0, "angle": math.pi / 2},
        {"distance": 1.0, "angle": 0.0, "slip": 0.5},
        {"angle": math.pi},
        {"x": 1, "y": 2, "theta": 0.3},
        {"text": "a – b"},
    ]
    assert [line.get("index") for line in lines] == [None, 1, 2, 3, 4, 5]


def test_numbers_come_back_to_the_last_digit():
    steps, lines = list(play(rich())), trace_of(rich())
    for step, line in zip(steps, lines, strict=True):
        if "posterior" in line:
            assert (np.array(line["posterior"]["covariance"]) == step.posterior.covariance).all()


def test_what_is_undefined_is_null():
    silent = Noise(0.0, 0.0, 0.0, 0.0, 0.0)
    certain, *_ = [
        line for line in trace_of(scene(Sense(0.0), noise=silent)) if line["type"] == "sense"
    ]
    assert certain["innovation_variance"] == 0
    assert certain["nis"] is None
    assert certain["gain"] == [0, 0, 0]
    assert certain["nees"] == 0
    assert certain["nees_dof"] == 0

    nothing = trace_of(scene(Sense(0.0), boundary=None))[1]
    undefined = {key for key, value in nothing.items() if value is None}
    assert undefined == {"range", "predicted_range", "range_variance", "wall", "incidence", "H",
    "innovation",
                         "innovation_variance", "gain", "nis"}  # fmt: skip
    assert nothing["refused"] == "no echo"

    impossible = trace_of(
        told(scene(Move(1.0, 0.0), start=(1, 1, 0)), start=np.array([1, 1.1, 0]))
    )[1]
    assert impossible["impossible"] is True
    assert impossible["nees"] is None
    assert impossible["nees_dof"] == 1


def test_an_edge_is_counted_in_the_order_of_the_file():
    lines = trace_of(
        scene(*(Sense(math.radians(a)) for a in (-90, 0, 90, 180)), start=(5, 4, 0), boundary=ROOM)
    )
    assert [line["wall"] for line in lines[1:]] == [
        {"name": "boundary", "edge": k} for k in range(4)
    ]


EVERY = ["type", "index", "t", "sensor", "z", "predicted", "innovation", "S", "H", "gain", "nis",
    "updated", "refused",
         "state", "prior", "posterior", "truth", "nees", "nees_dof", "impossible"]  # fmt: skip


@pytest.mark.parametrize("made", [recording(), speeds(9, 3)])
def test_a_line_of_a_recorded_run_holds_the_numbers_of_its_step(made):
    lines, steps = trace_of(made), list(play(made))
    assert lines[0]["t"] == steps[0].entry.t
    assert lines[0]["log"] == "log.csv" if made.log_source else "log" not in lines[0]
    assert lines[0]["state"] == list(made.world.layout.names)
    for line, step in zip(lines[1:], steps[1:], strict=True):
        known = set(EVERY) | ({"fix"} if step.entry.fix is not None else set())
        assert set(line) == known | ({"F", "G"} if step.prediction is not None else set())
        assert line["type"] == ("predict" if step.correction is None else "update")
        assert (line["index"], line["t"]) == (step.entry.index, step.entry.t)
        assert line["state"] == list(made.world.layout.names)
        for name, belief in (("prior", step.prior), ("posterior", step.posterior)):
            assert line[name] == {
                "mean": belief.mean.tolist(),
                "covariance": belief.covariance.tolist(),
            }
        assert line["truth"] == (None if step.entry.truth is None else step.entry.truth.tolist())
        assert line["nees"] == (None if step.nees is None else float(step.nees.value))


def test_a_motion_input_is_a_reading_of_the_odometry_of_which_none_was_predicted():
    line, step = trace_of(recording())[5], list(play(recording()))[5]
    assert (line["sensor"], line["z"]) == ("odometry", step.entry.given.u.tolist())
    assert [
        line[name] for name in ("predicted", "innovation", "S", "H", "gain", "nis", "refused")
    ] == [None] * 7
    assert line["updated"] is True
    assert line["F"] == step.prediction.F.tolist()
    assert line["G"] == step.prediction.G.tolist()
    assert line["fix"] == [2.0, 2.5]


def test_a_reading_has_all_that_the_filter_made_of_it():
    line, c = trace_of(recording())[3], list(play(recording()))[3].correction
    assert line["sensor"] == "marker 3"
    assert line["z"] == MOWER[3].given.z.tolist()
    assert line["predicted"] == c.predicted.tolist()
    assert line["innovation"] == c.innovation.tolist()
    assert (line["S"], line["H"], line["gain"]) == (c.S.tolist(), c.H.tolist(), c.K.tolist())
    assert line["nis"] == float(c.nis)
    assert (line["updated"], line["refused"]) == (True, None)


def test_what_a_recorded_run_leaves_undefined_is_null():
    *_, gated, silent, _ = trace_of(recording())
    assert (gated["sensor"], gated["updated"], gated["refused"]) == ("gnss", False, "gate")
    assert gated["nis"] > 50
    assert (silent["sensor"], silent["updated"], silent["refused"]) == (
        "ultrasonic 2",
        False,
        "no echo",
    )
    assert silent["z"] == silent["predicted"] == silent["innovation"] == [None]
    assert silent["S"] is silent["H"] is silent["gain"] is silent["nis"] is None
    assert {line["nees"] for line in trace_of(speeds(6, 3))[1:]} == {None}


@pytest.mark.parametrize("filter", ["kf", "iekf", "ukf", "pf"])
def test_every_filter_can_be_traced(filter):
    for made in (rich(), recording(), speeds(9, 3)):
        steps = len(list(play(made)))
        assert len(trace_of(dataclasses.replace(made, filter=filter))) == steps


def test_a_belief_of_several_gaussians_is_written_whole():
    """What stands beside the hypotheses is their mean, and their covariance about it."""
    several = 0
    for line in trace_of(dataclasses.replace(load_scene("diverge-01-wrong-wall"), filter="mhekf")):
        for belief in (line[key] for key in ("prior", "posterior") if key in line):
            if "hypotheses" not in belief:
                assert line["index"] < 2  # the first belief is one Gaussian
                continue
            each = belief["hypotheses"]
            weights = [one["weight"] for one in each]
            assert sum(weights) == pytest.approx(1, abs=1e-12)
            assert weights == sorted(weights, reverse=True)
            about = [np.subtract(one["mean"], belief["mean"]) for one in each]
            mean = sum(w * δ for w, δ in zip(weights, about, strict=True))
            P = sum(
                one["weight"] * (np.array(one["covariance"]) + np.outer(δ, δ))
                for one, δ in zip(each, about, strict=True)
            )
            np.testing.assert_allclose(mean[:2], 0, atol=1e-12)
            assert abs(mean[2]) < 1e-6  # that of angles is circular
            np.testing.assert_allclose(P, belief["covariance"], atol=1e-9)
            several += len(each) > 1
    assert several > 3
