import math
from dataclasses import replace

import numpy as np
import pytest
from scenes import ROOM, rich, scene, told, unbounded

from ekfsim.commands import Kidnap, Move
from ekfsim.filters.belief import Gaussian
from ekfsim.localization import play
from ekfsim.views.picture import limits
from ekfsim.views.picture.limits import Limits, including
from ekfsim.views.playback.playback import views


@pytest.mark.parametrize(
    "run", [rich(), unbounded(), scene(Kidnap(500.0, -3.0, 0.0)), scene(boundary=None)]
)
def test_hold_both_maps_and_every_estimate_and_truth(run):
    extent = limits.of(run, play(run))
    points = [step.posterior.mean[:2] for step in play(run)] + [
        step.entry.truth[:2] for step in play(run)
    ]
    for plan in (run.world.map, run.world.told.map):
        points += [corner for _, ring in plan.rings() for corner in ring]
    assert extent.hold(np.array(points))
    assert min(extent.width, extent.height) > 0


def test_an_ellipse_larger_than_the_world_enlarges_the_picture_to_twice_the_world_at_most():
    small, large = scene(), told(scene(), sigma=np.array([1000.0, 1000.0, 3.0]))
    small, large = limits.of(small, play(small)), limits.of(large, play(large))
    assert 10 < small.width < 12
    assert 19 < large.width < 23


def test_hold_a_moderate_ellipse_whole():
    run = told(scene(), sigma=np.array([0.8, 0.8, 0.1]))  # the start is 1 m from two walls
    assert limits.of(run, play(run)).left < 1 - 2.48 * 0.8


def test_have_the_shape_of_the_box_and_cut_nothing():
    wide = Limits(0.0, 0.0, 100.0, 1.0).shaped(0.5)
    assert wide.width / wide.height == pytest.approx(0.5)
    assert wide.joined(Limits(0.0, 0.0, 100.0, 1.0)) == wide


def test_grow_where_a_view_leaves_them_and_only_there():
    run = scene(Kidnap(60.0, 5.0, 0.0))
    first, last = views(play(run))
    extent = limits.of(run, [first.step])
    assert including(extent, first) == extent
    assert including(extent, last).hold(np.array([[60.0, 5.0]]))


def test_leave_out_what_is_not_finite():
    run = scene()
    step = next(play(run))
    lost = replace(step, posterior=Gaussian(np.full(3, math.inf), np.full((3, 3), math.nan)))
    assert limits.of(run, [lost]) == limits.of(run, [step])


def test_do_not_keep_the_steps():
    run = scene(*[Move(0.01, 0.1)] * 50)
    assert limits.of(run, iter(play(run))) == limits.of(run, list(play(run)))


def test_are_wider_for_a_filter_with_a_wider_map():
    run = scene()
    wider = told(run, map=replace(run.world.map, boundary=2 * ROOM))
    assert limits.of(wider, play(wider)).right > 20
