"""What the artists of a belief tell: what was believed before, where the truth is outside, the ways
of the truth and of odometry.
"""

from dataclasses import replace

import numpy as np
import pytest
from matplotlib.figure import Figure
from scenes import DESK, SILENT, rich, scene, told

from ekfsim.commands import Kidnap, Move, Say, Sense
from ekfsim.geometry.ellipse import outline, radius_factor
from ekfsim.localization import play
from ekfsim.views.picture.artists import empty
from ekfsim.views.picture.belief.belief import BeliefArtists
from ekfsim.views.picture.belief.shape import Shape
from ekfsim.views.picture.belief.warned import ALARM_DASHES
from ekfsim.views.picture.belief.ways import RECKONED_DASHES, TRUE_DASHES
from ekfsim.views.picture.extent import scope as scopes
from ekfsim.views.picture.extent.limits import Limits
from ekfsim.views.picture.panels import Main, reading
from ekfsim.views.playback.playback import views

SIGMA = (0.3, 0.1, 0.2)


def artist(axes, gid):
    (found,) = [child for child in axes.get_children() if child.get_gid() == gid]
    return found


def main(run):
    return Main(Figure().add_subplot(), run, scopes.of(run, play(run)).base, 0.954, False)


def seen(axes):
    return {child.get_gid() for child in axes.get_children() if not empty(child)}


def test_the_ghost_is_the_outline_of_the_prior():
    run = scene(Move(1.0, 0.5), Sense(0.3), sigma=SIGMA, obstacles=(DESK,))
    drawn, shown = main(run), list(views(play(run)))
    for view in shown:
        drawn.show(view, reading(view, run))
        ghost = artist(drawn.axes, "ghost").get_xydata()
        if view.beam or view.number == 0:
            assert len(ghost) == 0
            assert "ghost-cone" not in seen(drawn.axes)
            continue
        x, P = view.step.prior
        assert ghost == pytest.approx(outline(x, P[:2, :2], 0.954))
        cone = artist(drawn.axes, "ghost-cone").get_xydata()
        assert cone[[0, -1]] == pytest.approx(np.tile(x[:2], (2, 1)))
        edge = cone[1] - x[:2]
        assert np.arctan2(edge[1], edge[0]) == pytest.approx(x[2] - 2 * np.sqrt(P[2, 2]))
    assert [view.beam for view in shown] == [False, False, True, False]


def test_no_ghost_where_nothing_was_learned():
    run = scene(Say("x"), Kidnap(3.0, 2.0, 1.0), Sense(0.3), sigma=SIGMA, gate=1e-6)
    last = list(views(play(run)))[-1]
    assert last.step.correction.refused
    for view in views(play(run)):
        drawn = main(run)
        drawn.show(view, reading(view, run))
        assert view.earlier is None
        assert "ghost" not in seen(drawn.axes)


@pytest.mark.parametrize("ellipse", [False, True])
@pytest.mark.parametrize("cone", [False, True])
def test_ellipse_and_cone_warn_each_exactly_when_the_truth_is_outside(ellipse, cone):
    run = told(scene(), sigma=np.array(SIGMA))
    (view,) = views(play(run))
    beside = np.array([0.3 * radius_factor(0.954), 0.0, 2 * 0.2])
    off = beside * np.where([ellipse, False, cone], 1.01, 0.99)
    entry = replace(view.step.entry, truth=view.step.posterior.mean + off)
    drawn = main(run)
    drawn.show(replace(view, step=replace(view.step, entry=entry)), None)
    for what, outside in (("ellipse", ellipse), ("cone", cone)):
        assert (f"{what}-outside" in seen(drawn.axes)) is outside
        assert (what in seen(drawn.axes)) is not outside
    x, P = view.pose
    area = artist(drawn.axes, "ellipse-outside" if ellipse else "ellipse")
    assert area.get_xy()[:73] == pytest.approx(outline(x, P[:2, :2], 0.954))


def test_a_warning_is_told_from_the_rest_without_colour():
    drawn = main(scene())
    styles = {
        gid: (artist(drawn.axes, gid).get_linestyle(), artist(drawn.axes, gid).get_linewidth())
        for gid in ("ellipse", "cone", "ellipse-outside", "cone-outside")
    }
    assert styles["ellipse-outside"] == styles["cone-outside"]
    assert styles["ellipse-outside"][0] == ALARM_DASHES
    assert len({style for style, _ in styles.values()}) == 3
    assert styles["ellipse-outside"][1] > max(styles["ellipse"][1], styles["cone"][1])


def test_nothing_warns_where_no_truth_is_known():
    run = scene(Move(1.0, 0.5))
    *_, view = views(play(run))
    entry = replace(view.step.entry, truth=None)
    drawn = main(run)
    drawn.show(replace(view, step=replace(view.step, entry=entry)), None)
    assert not [gid for gid in seen(drawn.axes) if gid and gid.endswith("-outside")]


def test_a_belief_that_is_certain_of_what_is_not_so_warns():
    run = scene(Kidnap(3.0, 2.0, 1.0), noise=SILENT)
    start, moved = views(play(run))
    drawn = main(run)
    drawn.show(start, None)
    assert {"ellipse", "cone"} <= seen(drawn.axes)
    drawn.show(moved, None)
    assert {"ellipse-outside", "cone-outside"} <= seen(drawn.axes)


def test_the_legend_has_one_entry_for_what_warns():
    warning, *more = [
        handle
        for handle in main(scene()).handles()
        if isinstance(handle, tuple) and handle[0].get_label() == "the truth is outside"
    ]
    assert not more
    assert {one.get_gid() for one in warning} == {"ellipse-outside", "cone-outside"}
    assert {one.get_edgecolor() for one in warning} == {warning[0].get_edgecolor()}


def test_the_ways_are_those_of_the_truth_and_of_odometry():
    run = rich()
    drawn = main(run)
    for view in views(play(run)):
        drawn.show(view, reading(view, run))
        true = artist(drawn.axes, "true-way").get_xydata()
        assert np.array_equal(true, view.true.points(), equal_nan=True)
        assert true[-1] == pytest.approx(view.step.entry.truth[:2])
        assert np.array_equal(
            artist(drawn.axes, "reckoned-way").get_xydata(), view.reckoned.points()
        )
    assert np.isnan(true).any()  # a kidnap breaks it
    below = artist(drawn.axes, "path").get_zorder()
    ways = [artist(drawn.axes, gid) for gid in ("true-way", "reckoned-way")]
    assert max(way.get_zorder() for way in ways) < below
    assert (
        len(
            {TRUE_DASHES, RECKONED_DASHES, ALARM_DASHES, artist(drawn.axes, "path").get_linestyle()}
        )
        == 4
    )
    assert {way.get_linestyle() for way in ways} == {"--"}  # which is any but an unbroken one


@pytest.mark.parametrize(("unit", "hollow"), [(0.5, True), (0.05, False)])
def test_the_robot_does_not_cover_its_ellipse(unit, hollow):
    run = told(scene(), sigma=np.array([0.1, 0.05, 0.1]))
    (view,) = views(play(run))
    axes = Figure().add_subplot()
    drawn = BeliefArtists(axes, 0.954, False, driven=False)
    drawn.show(Shape.of(view, 0.954), unit)
    gids = seen(axes)
    assert ("hollow-body" in gids, "body" in gids) == (hollow, not hollow)
    body = artist(axes, "hollow-body" if hollow else "body")
    assert (body.get_facecolor()[3] == 0) is hollow
    assert np.abs(body.get_xy()[:27] - view.pose.mean[:2]).max() == pytest.approx(unit, rel=0.01)
    assert (drawn.reference.get_markersize() < 5) is hollow


@pytest.mark.parametrize(("height", "radius"), [(10.0, 0.22 * 2), (2.0, 0.022 * 8)])
def test_a_robot_in_a_corridor_is_no_wider_than_it(height, radius):
    run = scene(sigma=SIGMA)
    drawn = main(run)
    drawn.limits = Limits(0.0, 0.0, 20.0, height)
    (view,) = views(play(run))
    drawn.show(view, None)
    gids = seen(drawn.axes)
    body = artist(drawn.axes, "body" if "body" in gids else "hollow-body")
    around = np.linalg.norm(body.get_xy()[:27] - view.pose.mean[:2], axis=1)
    assert around == pytest.approx(radius)
