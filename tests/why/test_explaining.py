"""explain: what it counts, where the runs part, and where it names nothing."""

from dataclasses import replace

import numpy as np

from ekfsim import load_scene
from ekfsim.localization import play
from ekfsim.study.block import run_block
from ekfsim.views.why.answer import answer, sentence
from ekfsim.why import Mechanism, explain
from ekfsim.why.explaining import parted
from ekfsim.why.records import REPLAYS

RUNS = 200


def test_a_told_ratio_that_is_wrong_is_what_cures():
    found = explain(load_scene("diverge-02b-laser-overtrusted"), RUNS)
    assert (found.outcome, [one.name for one in found.cure]) == (
        "lost",
        ["the told rangeSigmaRatio"],
    )
    assert found.cure[0].told == "0.005 told, 0.02 true"


def test_the_runs_part_where_the_change_is_felt():
    found = explain(load_scene("diverge-03c-slip"), RUNS)
    assert [one.name for one in found.cure] == ["the slip of step 32"]
    assert found.parts_at == 33  # the odometry of 32 told nothing of it; the beam after it does
    before = zip(found.lost_steps[:32], found.cured_steps[:32], strict=True)
    assert all(np.array_equal(one.posterior.mean, other.posterior.mean) for one, other in before)
    assert parted(found.lost_steps, found.lost_steps) is None


def test_the_shares_are_those_of_a_study():
    scene = load_scene("diverge-01-wrong-wall")
    found = explain(scene, RUNS)
    tally = run_block(scene, 0, RUNS)
    assert found.shares is not None
    assert found.shares.lost == tally.at.above_999[-1] / RUNS
    assert found.shares.low < found.shares.lost_with - found.shares.lost < found.shares.high < 0


def test_two_causes_are_told_as_two():
    """A laser that is told wrongly and wheels that read wrongly: neither alone is all of it."""
    scene = load_scene("diverge-02b-laser-overtrusted")
    world = replace(scene.world, faults=replace(scene.world.faults, odometry_angle_scale=1.15))
    found = explain(replace(scene, world=world), RUNS)
    assert found.mechanism is None
    assert set(found.causes) == {Mechanism.LASER_OVERTRUSTED, Mechanism.TURN_SCALE}
    assert len(found.cure) == 2


def test_the_budget_is_kept_and_told():
    found = explain(load_scene("diverge-02a-odometry-overtrusted"), RUNS, budget=12)
    assert found.replays <= found.budget == 12
    heard = []
    found = explain(
        load_scene("diverge-12-close-to-the-wall"), RUNS, heard=lambda *told: heard.append(told)
    )
    assert [told for told in heard if told[2] == REPLAYS][-1] == (
        found.replays,
        found.budget,
        REPLAYS,
    )
    asked = [told[:2] for told in heard if told[2].startswith(f"{RUNS} runs")]
    last = len(found.lost_steps) - 1
    assert (0, last) in asked
    assert (last, last) in asked


def test_a_filter_that_makes_its_lines_elsewhere_is_told_so():
    """The linear filter stays with the first belief: a slip on top is a second cause."""
    scene = replace(load_scene("diverge-03c-slip"), filter="kf")
    found = explain(scene, RUNS)
    assert set(found.causes) == {Mechanism.SLIP, Mechanism.LINEARISED_ELSEWHERE}
    assert "The filter makes its straight lines about the first belief" in sentence(found)


def test_what_there_is_when_it_is_stopped_is_told():
    def stop(done, of, what):
        if what != REPLAYS:
            raise KeyboardInterrupt

    scene = load_scene("diverge-02a-odometry-overtrusted")
    found, whole = explain(scene, RUNS, heard=stop), explain(scene, RUNS)
    assert found.stopped
    assert (found.mechanism, found.causes, found.shares) == (None, (), None)
    assert found.tried == whole.tried
    assert found.cure
    assert "Ctrl-C came before many runs had been asked" in sentence(found)
    assert "Ctrl-C" not in answer(whole)


def test_the_run_that_is_explained_is_the_one_that_is_played():
    scene = load_scene("diverge-08-grazing")
    found = explain(scene, RUNS)
    for one, other in zip(found.lost_steps, play(scene), strict=True):
        assert np.array_equal(one.posterior.mean, other.posterior.mean)
