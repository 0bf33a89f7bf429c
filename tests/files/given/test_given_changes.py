"""with_ means what --set means, and is refused as --set is."""

import dataclasses
import warnings
from dataclasses import replace

import numpy as np
import pytest

import ekfsim
from ekfsim.errors import UsageError
from ekfsim.files.packaged import resolve
from ekfsim.files.scenes.load import read_scene
from ekfsim.files.scenes.settings import setting

SQUARE = ekfsim.load_scene("square")
LOG = "../shared/data/mower_gnss"


def on_the_command_line(name, *settings):
    return read_scene(resolve(name, "commands"), settings=list(map(setting, settings))).get()


def beliefs(scene):
    return [step.posterior.mean for step in ekfsim.play(scene)]


@pytest.mark.parametrize(
    ("name", "told"),
    [
        ("square", {"noise.rangeSigmaRatio": 0.1}),
        ("square", {"noise.rangeSigmaRatio": "0.1", "gate": 0.9, "guard": "skip"}),
        (
            "square",
            {"start.sigma.x": np.float32(0.5), "belief.start.y": 1, "faults.rangeBias": 0.1},
        ),
        ("diverge-02a-odometry-overtrusted", {"belief.noise.odometryDstSigmaRatio": 0.2}),
        ("pioneer", {"sensors.ultrasonic.range": 2.5, "robot.rate": 5}),
    ],
)
def test_it_makes_the_scene_that_set_makes(name, told):
    ours = ekfsim.load_scene(name).with_(**told)
    theirs = on_the_command_line(name, *(f"{key}={value}" for key, value in told.items()))
    assert (ours.gate, ours.guard, ours.tuning) == (theirs.gate, theirs.guard, theirs.tuning)
    steps = zip(beliefs(ours), beliefs(theirs), strict=True)
    assert all(np.array_equal(our, their) for our, their in steps)
    assert not all(map(np.array_equal, beliefs(ours), beliefs(ekfsim.load_scene(name))))


def test_truth_and_filter_are_told_alike_and_the_scene_itself_stays_as_it_is():
    other = SQUARE.with_("noise.rangeSigmaRatio", 0.3)
    assert (other.world.noise.range, other.world.told.noise.range) == (0.3, 0.3)
    assert other.settings == ("noise.rangeSigmaRatio=0.3",)
    assert SQUARE.world.noise.range != 0.3
    assert SQUARE.settings == ()


def test_later_numbers_win_and_earlier_ones_stay():
    once = SQUARE.with_("noise.rangeSigmaRatio", 0.3, "noise.odometryDstSigmaRatio", 0.2)
    twice = replace(once, seed=5).with_("noise.rangeSigmaRatio", 0.4)
    told = twice.world.told.noise
    assert (told.range, told.odometry_distance, twice.seed) == (0.4, 0.2, 5)
    assert set(twice.settings) == {"noise.odometryDstSigmaRatio=0.2", "noise.rangeSigmaRatio=0.4"}
    assert once.world.with_("noise.rangeSigmaRatio", 0.5).noise.odometry_distance == 0.2


def test_what_is_a_scenes_own():
    scene = SQUARE.with_(seed=np.int64(3), run=2, filter=["ukf", "pf"], gate=0.5)
    scene = scene.with_("filter.particles", 50, "filter.alpha", 0.5)
    assert (scene.seed, scene.run, scene.watching) == (3, 2, ("ukf", "pf"))
    assert (scene.tuning.particles, scene.tuning.alpha) == (50, 0.5)
    assert (scene.gate, scene.with_(gate=None).gate, scene.with_(gate="off").gate) == (
        0.5,
        None,
        None,
    )


def test_a_filter_that_was_brought_may_be_named():
    ekfsim.bring(lambda x, P, u, motion: (x, P), lambda x, P, z, sensor: (x, P), name="lazy")
    assert SQUARE.with_(filter="lazy").filter == "lazy"


@pytest.mark.parametrize(
    ("told", "words"),
    [
        ({"noise.rangeSigma": 1}, "noise.rangeSigma=1: unknown key 'rangeSigma'; did you mean "
                                  "'noise.rangeSigmaRatio'?"),
        ({"noise.rangeSigmaRatio": -1}, "noise.rangeSigmaRatio=-1: -1 is negative; write a number "
                                        "of 0 or more"),
        ({"noise.rangeSigmaRatio": [1, 2]}, "noise.rangeSigmaRatio: 'list' is no single value; "
                                            "write e.g. with_('noise.rangeSigmaRatio', 0.1)"),
        ({"start.x": 100}, "start.x=100: the robot starts at [100, 1.5], outside the boundary or "
                           "on its wall; start it where it can move"),
        ({"gate": 5}, "gate=5: 5 is not strictly between 0 and 1; write e.g. 0.99"),
        ({"guard": "sk"}, "guard=sk: 'sk' is not known here; did you mean 'skip'?"),
        ({"filter": "EKF"}, "filter EKF: there is no such filter; did you mean 'ekf'?"),
        ({"filter": 3}, "filter: '3' is no name of a filter; write e.g. 'ukf'"),
        ({"filter.alpha": 0.5}, "filter.alpha=0.5: no filter here (ekf) reads it; name one that "
                                "does: filter ukf or ukf-augmented"),
        ({"filter": "ukf", "filter.kappa": -3}, "filter.kappa=-3: -3 leaves no sigma points, for "
                                                "the state has 3 numbers; write more than -3"),
        ({"seed": -1}, "seed=-1: -1 is negative; write a whole number of 0 or more"),
        ({"seed": True}, "seed=true: true is a yes-or-no value where a whole number belongs; "
                         "write e.g. 7"),
        ({"run": 1.5}, "run=1.5: it is no whole number; write e.g. 3"),
        ({"run": -1}, f"run=-1: runs are numbered from 0 to {2**63 - 1}"),
        ({"sed": 1}, "sed: unknown key 'sed'; did you mean 'seed'?"),
    ],
)  # fmt: skip
def test_a_mistake_is_told_as_on_the_command_line(told, words):
    with pytest.raises(UsageError) as refused:
        SQUARE.with_(**told)
    assert str(refused.value) == words


@pytest.mark.parametrize("pairs", [("gate",), (0.9, "gate"), ({"gate": 0.9},)])
def test_keys_and_values_come_in_pairs(pairs):
    with pytest.raises(UsageError, match="a key and its value, one after the other"):
        SQUARE.with_(*pairs)


def test_a_key_is_set_once():
    with pytest.raises(UsageError, match="gate: it is set twice; keep one of them"):
        SQUARE.with_("gate", 0.9, gate=0.8)


def test_a_world_has_no_gate():
    with pytest.raises(UsageError, match=r"gate=0\.9: a world has no 'gate'; a scene has"):
        SQUARE.world.with_("gate", 0.9)


def test_what_replace_put_together_is_not_read_again_in_silence():
    by_hand = replace(SQUARE, world=replace(SQUARE.world, description="mine"))
    with pytest.raises(UsageError, match="was not read, but put together by `replace`"):
        by_hand.with_("noise.rangeSigmaRatio", 0.1)
    assert by_hand.with_("gate", 0.9).world.description == "mine"


def test_a_number_that_the_file_tells_the_filter_apart_is_warned_of_once():
    scene = ekfsim.load_scene("diverge-02a-odometry-overtrusted")
    with pytest.warns(UserWarning, match="only the truth changes") as told:
        other = scene.with_("noise.odometryDstSigmaRatio", 0.2)
    assert [warning.filename for warning in told] == [__file__]
    assert other.world.told.noise.odometry_distance != 0.2
    with warnings.catch_warnings():
        warnings.simplefilter("error")
        other.with_("noise.rangeSigmaRatio", 0.3)


def test_a_recorded_log_is_read_again_for_the_robot_as_it_is_told(tmp_path):
    from ekfsim.files.logs import write_log
    from ekfsim.simulation import simulate

    write_log(SQUARE, simulate(SQUARE), tmp_path / "log", force=False, with_truth=True)
    recording = {"recording": {"format": "classroom", "path": str(tmp_path / "log")}}
    scene = ekfsim.load_scene(recording)
    other = scene.with_("noise.odometryDstSigmaRatio", 0.4)
    given = next(step.entry.given for step in ekfsim.play(other) if step.prediction is not None)
    assert given.motion.distance_ratio == 0.4
    assert len(list(ekfsim.play(other))) == len(list(ekfsim.play(scene)))
    log = dataclasses.replace(other.log)
    with pytest.raises(UsageError, match="the log was not read, but put together by `replace`"):
        replace(other, log=log).with_("noise.odometryDstSigmaRatio", 0.3)
