import gc
import weakref
from dataclasses import replace

import numpy as np
import pytest
from recordings import recording, speeds
from scenes import rich, scene, unbounded

from ekfsim.commands import Kidnap, Move, Repeat, Say, Sense
from ekfsim.diagnostics.nees import nees
from ekfsim.diagnostics.verdict import Evidence
from ekfsim.files.scenes.load import load_scene
from ekfsim.filters.belief import posed
from ekfsim.localization import play
from ekfsim.records import Control, Reading
from ekfsim.views.playback.kept import kept
from ekfsim.views.playback.playback import GATHERED, Playback, Tally, views

COURSE = (
    Sense(0.0),
    Move(1.0, 0.5),
    Sense(0.2),
    Sense(0.4),
    Say("word"),
    Move(0.5, 0.0),
    Kidnap(2, 2, 0),
    Sense(1.0),
)


def all_views(scene):
    return list(views(play(scene)))


def test_a_sense_is_two_presses_and_everything_else_one():
    told = [
        ("start" if v.step.entry.command is None else type(v.step.entry.command).__name__, v.beam)
        for v in all_views(scene(*COURSE))
    ]
    assert told == [
        ("start", False),
        ("Sense", True), ("Sense", False),
        ("Move", False),
        ("Sense", True), ("Sense", False),
        ("Sense", True), ("Sense", False),
        ("Say", False),
        ("Move", False),
        ("Kidnap", False),
        ("Sense", True), ("Sense", False),
    ]  # fmt: skip


def test_views_are_numbered_from_the_world_before_the_first_command():
    assert [view.number for view in all_views(rich())] == list(range(len(all_views(rich()))))
    assert [view.number for view in all_views(scene())] == [0]


def test_repetitions_are_stepped_through_one_by_one():
    assert len(all_views(scene(Repeat(3, (Move(0.1, 0), Sense(0)))))) == 1 + 3 * 3


def test_while_the_beam_is_shown_the_estimate_is_the_old_one():
    for view in all_views(rich()):
        assert view.belief is (view.step.prior if view.beam else view.step.posterior)


def test_a_move_adds_a_corner_to_the_path_and_a_sense_moves_the_last():
    seen = all_views(scene(*COURSE))
    estimates = [v.belief.mean[:2] for v in seen]
    for view, estimate in zip(seen, estimates, strict=True):
        moves = sum(isinstance(v.step.entry.command, Move) for v in seen[: view.number + 1])
        path = view.path()
        assert path.shape == (moves + 1, 2)
        assert (path[-1] == estimate).all()
    before_first, before_second = seen[2], seen[8]
    assert (seen[-1].path()[0] == before_first.step.posterior.mean[:2]).all()
    assert (seen[-1].path()[1] == before_second.step.posterior.mean[:2]).all()


def test_a_path_stays_that_of_its_view_when_the_run_goes_on():
    """Paths share their corners; what came later must not show on the way back."""
    lazily = [view.path() for view in views(play(rich()))]
    for view, path in zip(all_views(rich()), lazily, strict=True):
        np.testing.assert_array_equal(view.path(), path)


def counted(steps, computed):
    for step in steps:
        computed.append(step.entry.index)
        yield step


def test_a_step_is_computed_when_the_view_before_it_is_asked_for_and_only_once():
    """One ahead: whether a view is the last is to be known when it is shown."""
    computed = []
    playback = Playback(counted(play(scene(*COURSE)), computed))
    assert computed == []
    assert playback.view(0).number == 0
    assert computed == [0, 1]
    third = playback.view(3)
    assert computed == [0, 1, 2, 3]
    assert playback.view(3) is third
    assert playback.view(1).step is playback.view(2).step
    assert computed == [0, 1, 2, 3]


def test_after_the_last_view_there_is_none():
    playback = Playback(play(scene(*COURSE)))
    assert playback.view(12).number == 12
    assert playback.view(13) is None
    assert playback.view(999) is None
    assert playback.view(12).number == 12


def test_motion_inputs_that_follow_each_other_share_a_view():
    shown = [(v.step.entry.index, v.beam, v.inputs, v.since) for v in all_views(recording())]
    assert shown == [
        (0, False, 1, 10.0),
        (2, False, 2, 10.5),
        (3, True, 1, None), (3, False, 1, 11.0),
        (4, True, 1, None), (4, False, 1, 11.0),
        (5, False, 1, 11.5),
        (6, True, 1, None), (6, False, 1, 11.6),
        (7, True, 1, None), (7, False, 1, 12.0),
        (8, False, 1, 12.5),
    ]  # fmt: skip


@pytest.mark.parametrize(
    "inputs", [1, GATHERED - 1, GATHERED, GATHERED + 1, 2 * GATHERED, 2 * GATHERED + 1]
)
def test_but_no_more_than_a_person_would_wait_for(inputs):
    made = speeds(inputs, fixes=10_000)
    steps, seen = list(play(made)), all_views(made)[1:]
    gathered = [v.inputs for v in seen]
    assert sum(gathered) == inputs
    assert gathered[:-1] == [GATHERED] * (len(gathered) - 1)
    ends = np.cumsum(gathered)
    assert [v.step.entry.index for v in seen] == ends.tolist()
    for view, first in zip(seen, [1, *(ends[:-1] + 1)], strict=True):
        assert (view.before.mean == steps[first].prior.mean).all()
        assert view.since == steps[first].entry.t


def test_a_view_waits_for_the_one_that_comes_after_and_no_longer():
    computed = []
    playback = Playback(counted(play(speeds(3 * GATHERED, 10_000)), computed))
    assert playback.view(1).inputs == GATHERED
    assert len(computed) == 2 * GATHERED + 1


def test_only_a_command_and_a_reading_have_no_belief_before():
    assert all(v.before is None for v in all_views(rich()))
    for view in all_views(recording()):
        assert (view.before is None) == (not isinstance(view.step.entry.given, Control))


def test_the_pose_is_that_part_of_the_state_that_is_drawn():
    made = speeds(9, 3)
    for view in all_views(made):
        expected = posed(view.step.prior if view.beam else view.step.posterior, made.world.layout)
        assert (view.pose.mean == expected.mean).all()
        assert (view.pose.covariance == expected.covariance).all()
        assert (view.path()[-1] == expected.mean[:2]).all()


def test_a_path_has_a_corner_for_each_view_of_motion():
    seen = all_views(speeds(9, 3))
    moved = [isinstance(v.step.entry.given, Control) for v in seen]
    assert [len(v.path()) for v in seen] == [1 + n for n in np.cumsum(moved)]
    last = seen[-1].path()
    revised = [v.pose.mean[:2] for v in seen if v.step.correction is not None and not v.beam]
    np.testing.assert_array_equal(last[1:], revised)


def test_steps_between_are_not_kept():
    alive = []

    def watched():
        for step in play(speeds(3 * GATHERED, 10_000)):
            prior = step.prior.mean.copy()
            alive.append(weakref.ref(prior))
            yield replace(step, prior=step.prior._replace(mean=prior))

    seen = list(views(watched()))
    gc.collect()
    assert len(seen) == 4
    # the start, and of each view the first and the last
    assert sum(ref() is not None for ref in alive) == 1 + 2 * 3


@pytest.mark.parametrize(
    "made",
    [
        scene(),
        rich(),
        unbounded(),
        recording(),
        *(speeds(n, k) for n, k in [(450, 1000), (400, 200), (45, 7)]),
    ],
)
def test_views_are_counted_as_the_steps_go_by(made):
    tally = Tally()
    assert sum(1 for _ in kept(play(made), [tally.write])) == len(list(play(made)))
    assert tally.views == len(all_views(made))


def test_every_step_is_handed_on_before_its_view_is_shown():
    handed = []
    for view in views(kept(play(recording()), [lambda step: handed.append(step.entry.index)])):
        assert view.step.entry.index in handed
    assert handed == list(range(9))
    assert sum(isinstance(step.entry.given, Reading) for step in play(recording())) == 4


def test_the_true_way_is_broken_where_the_robot_is_carried_away():
    seen = all_views(scene(*COURSE))
    way = seen[-1].true.points()
    (broken,) = np.flatnonzero(np.isnan(way[:, 0]))
    kidnapped = next(v for v in seen if isinstance(v.step.entry.command, Kidnap))
    assert (way[broken + 1] == [2, 2]).all()
    assert (kidnapped.true.points()[-1] == [2, 2]).all()
    truths = [v.step.entry.truth[:2] for v in seen if not v.beam]
    np.testing.assert_array_equal(np.delete(way, broken, axis=0), truths)


def test_odometry_alone_follows_the_inputs_from_the_first_estimate():
    """Without readings the filter's mean is nothing else."""
    seen = all_views(scene(*(each for each in COURSE if not isinstance(each, Sense))))
    for view in seen:
        np.testing.assert_allclose(view.reckoned.points()[-1], view.pose.mean[:2], atol=1e-12)


def test_a_view_is_judged_by_what_it_shows_and_the_last_one_closes():
    made = load_scene("diverge-01-wrong-wall")
    evidence, seen = Evidence(), all_views(made)
    for view in seen:
        if not view.beam:
            evidence.add(view.step)
        assert view.judged.lost_from == evidence.lost_from
        if view.step.entry.truth is not None and view.judged.nees is not None:
            value = nees(view.belief, view.step.entry.truth).value
            np.testing.assert_allclose(view.judged.nees.value, value, rtol=1e-9)
    assert [v.number for v in seen if v.judged.closing is not None] == [len(seen) - 1]
    closing = seen[-1].judged.closing
    assert closing is not None
    assert closing.verdict.value == "lost"
    assert closing == evidence
