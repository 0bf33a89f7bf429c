"""What is said of an explanation, made by hand and found in a run."""

import re
from dataclasses import replace

import numpy as np
import pytest
import shapely

from ekfsim.files.scenes.load import load_scene
from ekfsim.student.own.bring import bring
from ekfsim.views.why.answer import answer, cause, sentence, shares
from ekfsim.views.why.changes import put_right
from ekfsim.views.why.mechanisms import because, told_noise
from ekfsim.views.why.met import met, told
from ekfsim.why import Change, Explanation, Mechanism, Shares, Tried, explain

SCENE = load_scene("diverge-02c-laser-distrusted")
RATIO = Change("noise", "the told rangeSigmaRatio", "0.08 told, 0.02 true")
BEAM = Change("reading", "the beam of step 13", "left out", 13)
MOVE = Change("move", "the move of step 6", "made exact", 6)
SHARES = Shares(1000, 0.378, 0.005, -0.403, -0.344, BEAM)


def lost(*cures, tried=(BEAM, MOVE, RATIO), **more):
    """An explanation of a lost run, of which these changes cure."""
    tested = tuple(
        Tried(one, one in cures, 2.0 if one in cures else 4e4, None if one in cures else 13,
              "consistent" if one in cures else "lost")
        for one in tried
    )  # fmt: skip
    facts = {"tried": tested, "cure": cures[:1], "others": cures[1:], "replays": len(tried),
             "budget": 400} | more  # fmt: skip
    return Explanation(SCENE, "lost", 13, **facts)


@pytest.fixture(scope="module")
def wrong_wall():
    return explain(load_scene("diverge-01-wrong-wall"), runs=200)


def test_one_cure_and_the_others_do_not():
    found = lost(BEAM, parts_at=13, shares=SHARES)
    assert sentence(found) == (
        "Lost since step 13. Without the beam of step 13 the run ends consistent. None of the 2 "
        "other changes cures it. The two estimates part at step 13. Of 1000 runs 38 % are lost as "
        "they stand, 0.5 % without the beam of step 13 [−37.3 points, −40.3 to −34.4]."
    )


def test_others_that_cure_as_well_are_named():
    assert "Of the 2 other changes 1 cures it as well: the move of step 6." in sentence(
        lost(BEAM, MOVE)
    )


def test_a_cure_that_leaves_a_run_over_confident_is_not_told_to_be_more():
    found = lost(BEAM)
    halfway = replace(found.tried[0], outcome="over-confident")
    found = replace(found, tried=(halfway, *found.tried[1:]))
    assert "the run is no longer lost, but over-confident." in sentence(found)


def test_more_than_one_cause_is_told_with_all_that_it_takes():
    causes = (Mechanism.LASER_DISTRUSTED, Mechanism.RANGE_BIAS)
    found = lost(tried=(RATIO, BEAM), cure=(RATIO, BEAM), causes=causes)
    assert cause(found) == "more than one: laser distrusted and range bias"
    assert (
        "Only together they cure it: with the told rangeSigmaRatio made true and without the beam "
        "of step 13 the run ends consistent."
    ) in sentence(found)
    assert "0.5 % with all of these put right [" in sentence(replace(found, shares=SHARES))


def test_what_is_not_found_is_told_with_what_was_tried():
    found = lost()
    assert cause(found) == "not found"
    assert sentence(found).endswith("Not one of the 3 changes that were tried cures it.")
    spent = replace(found, budget=3)
    assert "the budget of replays is spent" in sentence(spent)
    assert "3 of at most 3 replays, which did not do for all" in answer(spent)
    assert "3 changes tried on the same draws" in answer(found)
    assert "3 of at most 400 replays" in answer(found)


def test_of_a_consistent_run_there_is_nothing_to_explain():
    found = Explanation(SCENE, "consistent", None)
    assert cause(found) == "nothing to explain"
    assert sentence(found) == "The run ends consistent: nothing to explain."


def test_over_cautious_is_not_lost():
    found = explain(SCENE, runs=100)
    assert cause(found) == "laser distrusted"
    assert sentence(found).startswith(
        "Over-cautious, not lost: told four times the laser's noise "
        "(rangeSigmaRatio 0.08 told, 0.02 true). With the told rangeSigmaRatio made true the run "
        "ends consistent."
    )


def test_less_noise_than_there_is_is_told_as_a_part():
    overtrusted = load_scene("diverge-02b-laser-overtrusted")
    told_so = told_noise(overtrusted, Mechanism.LASER_OVERTRUSTED)
    assert told_so.startswith("a quarter of the laser's noise")


@pytest.mark.parametrize("mechanism", Mechanism)
def test_each_mechanism_has_its_clause(mechanism):
    for name in ("diverge-02c-laser-distrusted", "diverge-05a-misplaced-wall"):
        clause = because(Explanation(load_scene(name), "lost", 3), mechanism)
        assert re.fullmatch(r"[A-Z0-9].*[^.]", clause)
        assert "nan" not in clause


def test_the_beam_that_did_it_is_told_with_both_walls(wrong_wall):
    step = next(s for s in wrong_wall.lost_steps if s.entry.index == 13)
    beam = met(step, wrong_wall.scene)
    truth, x = step.entry.truth, step.prior.mean
    angle = step.entry.command.angle
    walls = wrong_wall.scene.world.map
    rings = [shapely.LinearRing(points) for _, points in walls.rings()]
    for pose, far in ((truth, beam.range), (x, beam.predicted)):
        ahead = pose[:2] + 100 * np.array([np.cos(pose[2] + angle), np.sin(pose[2] + angle)])
        ray = shapely.LineString([pose[:2], ahead])
        hits = shapely.intersection(ray, shapely.union_all(rings))
        assert shapely.Point(pose[:2]).distance(hits) == pytest.approx(far, abs=1e-9)
    assert beam.wrong
    assert (beam.expected, beam.actual) == ("desk", "boundary")
    assert told(beam).startswith(
        "was predicted to meet the desk at 1.11 m and met the room's wall "
    )
    assert "behind it" in told(beam)
    said = sentence(wrong_wall)
    assert said.startswith(f"Lost since step 13. The beam of step 13 {told(beam)}. ")
    assert cause(wrong_wall) == "wrong wall"


def test_a_beam_that_meets_its_wall_is_not_wrong(wrong_wall):
    beams = [met(step, wrong_wall.scene) for step in wrong_wall.lost_steps[:13]]
    assert [beam.wrong for beam in beams if beam is not None] == [False] * 9


@pytest.mark.parametrize("width", [40, 60, 80, 120])
def test_no_line_is_wider_than_the_terminal(wrong_wall, width):
    text = answer(wrong_wall, width)
    assert max(map(len, text.splitlines())) <= width
    assert " ".join(sentence(wrong_wall).split()[:8]) in " ".join(text.split())


def test_shares_are_told_with_the_interval_of_their_difference():
    turned = replace(SHARES, lost=0.0, lost_with=0.5, low=0.4, high=0.6)
    assert shares(turned).endswith("[+50.0 points, +40.0 to +60.0]")
    over = replace(SHARES, of="over-cautious")
    assert "are over-cautious as they stand" in shares(over)


def test_what_a_change_puts_right_is_said_as_it_is():
    guard = Change("beams", "the ambiguous beams", "left out, as the guard does")
    assert put_right(guard) == "with the ambiguous beams left out"
    assert put_right(MOVE) == "with the move of step 6 made exact"


def test_a_filter_of_ones_own_is_asked_as_the_built_in_one_is(wrong_wall):
    def predict(x, P, u, motion):
        F, G = motion.F(x, u), motion.G(x, u)
        return motion.f(x, u), F @ P @ F.T + G @ motion.M(u) @ G.T

    def update(x, P, z, sensor):
        H = sensor.H(x)
        K = P @ H.T @ np.linalg.inv(H @ P @ H.T + sensor.R(x))
        return x + K @ sensor.residual(z, sensor.h(x)), (np.eye(3) - K @ H) @ P

    name = bring(predict, update, name="as-the-ekf")
    found = explain(replace(wrong_wall.scene, filter=name), runs=20)
    assert found.lost_from == wrong_wall.lost_from
    ours, theirs = (
        {(one.change.kind, one.change.name): one.cures for one in each.tried}
        for each in (found, wrong_wall)
    )
    assert ours == theirs
