import numpy as np
from scenes import rich, scene

from ekfsim.localization import play
from ekfsim.records import Kidnap, Move, Repeat, Say, Sense
from ekfsim.views.playback import Playback, views

COURSE = (Sense(0.0), Move(1.0, 0.5), Sense(0.2), Sense(0.4), Say("word"), Move(0.5, 0.0), Kidnap(2, 2, 0), Sense(1.0))


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


def test_a_step_is_computed_when_first_asked_for_and_only_once():
    computed = []
    playback = Playback(counted(play(scene(*COURSE)), computed))
    assert computed == []
    assert playback.view(0).number == 0
    assert computed == [0]
    third = playback.view(3)
    assert computed == [0, 1, 2]
    assert playback.view(3) is third
    assert playback.view(1).step is playback.view(2).step
    assert computed == [0, 1, 2]


def test_after_the_last_view_there_is_none():
    playback = Playback(play(scene(*COURSE)))
    assert playback.view(12).number == 12
    assert playback.view(13) is None
    assert playback.view(999) is None
    assert playback.view(12).number == 12
