"""Pictures show a run's world, and more from where on the estimate or the truth has left it."""

import math
from dataclasses import replace
from itertools import pairwise

import numpy as np
import pytest
from scenes import ROOM, rich, scene, told, unbounded

from ekfsim.commands import Kidnap, Move, Repeat
from ekfsim.files.scenes.load import load_scene
from ekfsim.filters.belief import Gaussian
from ekfsim.localization import play
from ekfsim.views.picture.extent import scope as scopes
from ekfsim.views.picture.extent.limits import Limits
from ekfsim.views.playback.playback import views

ALL_ROUND = Repeat(40, (Move(1.0, math.radians(90)), Move(0.5, 0.1)))


def drawn(view):
    """What must be seen of a view : (n, 2) m"""
    truth = view.step.entry.truth
    places = [view.path(), view.true.points(), *([] if truth is None else [truth[None, :2]])]
    return np.vstack([np.array(place).reshape(-1, 2) for place in places])


@pytest.mark.parametrize(
    "run", [rich(), unbounded(), scene(Kidnap(500.0, -3.0, 0.0)), scene(boundary=None)]
)
def test_hold_both_maps_and_every_estimate_and_truth(run):
    scope = scopes.of(run, play(run))
    for plan in (run.world.map, run.world.told.map):
        for _, ring in plan.rings():
            assert scope.base.hold(ring)
    for view in views(play(run)):
        assert scope.at(view).hold(drawn(view))
        assert scope.at(view).joined(scope.base) == scope.at(view)


def test_are_those_of_the_room_until_the_estimate_leaves_it():
    run = load_scene("diverge-01-wrong-wall")
    scope, every = scopes.of(run, play(run)), list(views(play(run)))
    fatal = next(view for view in every if view.step.entry.index == 13)
    last = every[-1]
    assert scope.at(fatal) == scope.base == scope.at(every[0])
    assert scope.base.width < 1.25 * 8
    assert scope.at(last).width > 16
    assert scope.at(last).hold(drawn(last))
    changes = {scope.at(view) for view in every}
    assert 2 <= len(changes) <= 5


def test_are_the_same_whichever_way_a_view_is_reached():
    run = scene(*[Kidnap(10.0 + 3 * i, 5.0, 0.0) for i in range(20)])
    every = list(views(play(run)))
    shown = [scopes.of(run, play(run)).at(view) for view in every]
    scope = scopes.of(run, play(run))
    assert [scope.at(view) for view in reversed(every)][::-1] == shown
    assert [scope.at(view) for view in every[::5]] == shown[::5]


def test_never_shrink_and_grow_by_much():
    run = scene(*[Kidnap(10.0 + 0.5 * i, 3.0, 0.0) for i in range(100)])
    scope, every = scopes.of(run, play(run)), list(views(play(run)))
    shown = [scope.at(view) for view in every]
    assert all(b.joined(a) == b for a, b in pairwise(shown))
    assert 3 <= len(set(shown)) <= 8


def test_an_ellipse_larger_than_the_world_enlarges_the_picture_to_twice_the_world_at_most():
    small, large = scene(), told(scene(), sigma=np.array([1000.0, 1000.0, 3.0]))
    small, large = (scopes.of(run, play(run)).whole for run in (small, large))
    assert 10 < small.width < 12
    assert 13 < large.width < 23


def test_hold_a_moderate_ellipse_whole():
    run = told(scene(), sigma=np.array([0.8, 0.8, 0.1]))  # the start is 1 m from two walls
    assert scopes.of(run, play(run)).whole.left < 1 - 2.48 * 0.8


def test_a_corridor_is_not_lost_in_its_margins():
    corridor = np.array([[0, 0], [40, 0], [40, 3], [0, 3.0]])
    run = scene(boundary=corridor)
    run = told(run, map=run.world.map)
    base = scopes.of(run, play(run)).base
    assert base.width < 45
    assert 3 < base.height < 6


@pytest.mark.parametrize(
    ("part", "shown"),
    [
        (Limits(0.0, 0.0, 4.0, 3.0), (4.0, 3.0)),
        (Limits(0.0, 0.0, 100.0, 1e-300), (100.0, 8.0)),
        (Limits(5e6, 0.0, 5e6 + 1e-6, 1e9), (8e7, 1e9)),
        (Limits(0.0, 0.0, 1e-6, 1e-9), (1e-6, 8e-8)),
    ],
)
def test_a_strip_that_is_too_narrow_is_shown_with_what_lies_beside_it(part, shown):
    base = scopes.showing(part).base
    assert (base.width, base.height) == pytest.approx(shown)
    assert base.joined(part) == base


def test_have_the_shape_of_the_box_and_cut_nothing():
    wide = Limits(0.0, 0.0, 100.0, 1.0).shaped(0.5)
    assert wide.width / wide.height == pytest.approx(0.5)
    assert wide.joined(Limits(0.0, 0.0, 100.0, 1.0)) == wide


def test_what_is_seen_later_than_was_looked_ahead_is_held_the_same_whichever_way():
    run = scene(*[Kidnap(10.0 + 3 * i, 5.0, 0.0) for i in range(20)])
    every, steps = list(views(play(run))), list(play(run))
    ahead = scopes.of(run, steps[:2])
    for view in (every[-1], every[7], every[1], every[-1]):
        assert ahead.at(view).hold(drawn(view))
    assert ahead.at(every[0]) == ahead.base
    assert ahead.at(every[7]).width < ahead.at(every[-1]).width


def test_leave_out_what_is_not_finite():
    run = scene()
    step = next(play(run))
    lost = replace(step, posterior=Gaussian(np.full(3, math.inf), np.full((3, 3), math.nan)))
    assert scopes.of(run, [lost]).whole == scopes.of(run, [step]).whole


def test_do_not_keep_the_steps():
    run = scene(ALL_ROUND)
    assert scopes.of(run, iter(play(run))) == scopes.of(run, list(play(run)))


def test_are_wider_for_a_filter_with_a_wider_map():
    run = scene()
    wider = told(run, map=replace(run.world.map, boundary=2 * ROOM))
    assert scopes.of(wider, play(wider)).base.right > 20


def test_without_walls_they_are_those_of_the_way_that_was_driven_and_not_of_a_lost_estimate():
    run = load_scene("landmarks")
    scope, every = scopes.of(run, play(run)), list(views(play(run)))
    assert all(scope.at(view).hold(drawn(view)) for view in every)
    lost = [
        replace(step, posterior=Gaussian(step.posterior.mean + 1e4, step.posterior.covariance))
        for step in play(run)
    ]
    assert scopes.of(run, lost).base.width < 2 * scope.base.width


def test_following_the_estimate_moves_a_part_of_one_size_before_it_is_left():
    run = load_scene("tour")
    scope, base = scopes.following(run, play(run)), scopes.of(run, play(run)).base
    centers = set()
    for view in views(play(run)):
        shown = scope.at(view)
        assert (shown.width, shown.height) == pytest.approx(
            (scopes.FOLLOWED * base.width, scopes.FOLLOWED * base.height)
        )
        center = np.array([shown.left + shown.width / 2, shown.bottom + shown.height / 2])
        off = np.abs(view.pose.mean[:2] - center) / [shown.width / 2, shown.height / 2]
        assert (off <= scopes.MIDDLE + 1e-9).all()
        centers.add(tuple(center))
    assert 3 < len(centers) < 25
