"""Filters that watch beside the first are drawn beside it."""

from dataclasses import replace

import numpy as np
import pytest
from matplotlib.backends.backend_agg import FigureCanvasAgg
from matplotlib.figure import Figure
from numpy.testing import assert_allclose
from scenes import DESK, scene

from ekfsim.commands import Move, Sense
from ekfsim.diagnostics.coverage import inside_ellipse
from ekfsim.geometry.ellipse import outline
from ekfsim.localization import play
from ekfsim.views.picture.belief.others import STYLES
from ekfsim.views.picture.extent import scope as scopes
from ekfsim.views.picture.frames import Picture
from ekfsim.views.playback.playback import Playback, together, views
from ekfsim.views.terminal import drawing as terminal

COURSE = (Move(2.0, 0.9), Sense(0.3), Move(1.5, -0.7), Sense(-0.8))
RUN = replace(
    scene(*COURSE, sigma=(0.2, 0.1, 0.3), obstacles=(DESK,), gate=0.999),
    filter="ekf",
    beside=("ukf", "kf", "iekf", "pf"),
)
EVERY = list(together(play(RUN), [play(one) for one in RUN.alone()[1:]]))


def picture(run):
    figure = Figure(figsize=(9, 7), dpi=100)
    FigureCanvasAgg(figure)
    return Picture(figure, run, scopes.of_all(run, map(play, run.alone())))


def said(made, shown):
    made.show(shown[-1])
    return [text.get_text() for text in made.legend.get_texts()]


def artist(axes, gid):
    (found,) = [child for child in axes.get_children() if child.get_gid() == gid]
    return found


def test_each_view_holds_what_every_filter_makes_of_the_same_entries():
    for number, one in enumerate(RUN.alone()[1:]):
        for view, expected in zip(EVERY, views(play(one)), strict=True):
            other = view.others[number]
            assert (other.number, other.beam, other.step.entry.index) == (
                view.number,
                view.beam,
                view.step.entry.index,
            )
            assert_allclose(other.pose.mean, expected.pose.mean)
            assert_allclose(other.path(), expected.path())
    assert [view.others for view in together(play(RUN), [])] == [()] * len(EVERY)
    assert len(Playback(play(RUN), others=[play(RUN.alone()[1])]).view(3).others) == 1


@pytest.mark.parametrize("view", EVERY, ids=lambda view: f"view {view.number}")
def test_estimate_path_and_ellipse_of_each_are_drawn_in_both_axes(view):
    made = picture(RUN)
    made.show(view)
    for axes in (made.main.axes, made.close.axes):
        for name, other in zip(RUN.beside, view.others, strict=True):
            x, P = other.pose
            assert_allclose(artist(axes, f"reference-{name}").get_xydata(), [x[:2]])
            assert_allclose(artist(axes, f"path-{name}").get_xydata(), other.path())
            assert_allclose(
                artist(axes, f"ellipse-{name}").get_xydata(), outline(x, P[:2, :2], 0.954)
            )
            along = np.diff(artist(axes, f"heading-{name}").get_xydata(), axis=0)[0]
            assert np.arctan2(along[1], along[0]) == pytest.approx(x[2])


def test_the_legend_names_every_filter():
    words = said(picture(RUN), EVERY)
    assert words[0] == "ekf: estimate"
    assert [word for word in words if "ellipse, path" in word] == [
        f"{n}: estimate, ellipse, path" for n in RUN.beside
    ]
    alone = replace(RUN, beside=())
    assert "estimate" in said(picture(alone), list(views(play(alone))))


def test_none_is_told_from_another_by_colour_alone():
    assert (
        len({style.marker for style in STYLES})
        == len({style.dashes for style in STYLES})
        == len(STYLES)
    )
    assert len({style.color for style in STYLES}) == len(STYLES)


def test_what_moves_is_drawn_anew():
    made = picture(RUN)
    moving = {child.get_gid() for child in made.moving()}
    assert {
        f"{part}-{name}"
        for part in ("path", "ellipse", "heading", "reference")
        for name in RUN.beside
    } <= moving


def test_the_limits_hold_every_estimate():
    told = replace(RUN.world.told, start=RUN.world.told.start + np.array([40.0, 0, 0]))
    far = replace(
        EVERY[-1], others=tuple(views(play(replace(RUN, world=replace(RUN.world, told=told)))))[:1]
    )
    extent = scopes.of(RUN, play(RUN))
    assert not extent.at(far).hold(far.others[0].path())
    assert replace(extent, last=-1).at(far).hold(far.others[0].path())
    both = scopes.of_all(RUN, [play(RUN), play(replace(RUN, world=replace(RUN.world, told=told)))])
    assert both.at(far).hold(far.others[0].path())


def test_the_terminal_shows_the_first_letter_of_each():
    run = replace(RUN, beside=("ukf", "kf"))
    view = list(together(play(run), [play(one) for one in run.alone()[1:]]))[-1]
    box = (
        view.pose.mean[0] - 0.6,
        view.pose.mean[0] + 0.6,
        view.pose.mean[1] - 0.4,
        view.pose.mean[1] + 0.4,
    )
    text = terminal.draw(view, run, 0.954, (100, 40), box, False, True)
    assert "u ukf  k kf" in text.splitlines()[-1]
    assert "u" in "".join(text.splitlines()[1:-1])


def test_from_where_on_filters_differ_is_noted():
    names = (RUN.filter, *RUN.beside)
    told = together(play(RUN), [play(one) for one in RUN.alone()[1:]], names)
    made, since = picture(RUN), 0
    for view in told:
        made.show(view)
        noted = made.notes.get_text()
        one = view.apart[0]
        assert one.names == ("ekf", "ukf")
        assert (one.told in noted) == (one.since is not None and not view.beam)
        if view.apart[0].since is not None:
            since = since or (view.number, view.apart[0].since)
            assert view.apart[0].since == since[1]
    first, *_ = [view for view in EVERY if view.step.entry.index == since[1] and not view.beam]
    assert since[0] == first.number
    x, P = first.step.posterior
    other_x, other_P = first.others[0].step.posterior
    assert max(abs(x - other_x).max(), abs(P - other_P).max()) > 1e-9


def test_the_same_twice_does_not_differ():
    twice = together(play(RUN), [play(RUN)], ("ekf", "ekf.py"))
    *_, last = twice
    assert last.apart[0].told == "ekf.py and ekf do not differ, at no step by a millionth of σ"


@pytest.mark.parametrize("name", ["_mine.py", "a $very$ long name of a file of somebody.py"])
def test_the_legend_names_a_file_as_it_is_called(name):
    made = picture(replace(RUN, filter="ekf", beside=("ukf",)))
    own = Picture(made.figure, replace(RUN, beside=(f"/tmp/{name}",)), made._scope)
    words = [word.strip() for word in said(own, [replace(EVERY[-1], others=EVERY[-1].others[:1])])]
    assert any(word.startswith(name[:15]) and "estimate, ellipse" in word for word in words)
    made.figure.canvas.draw()


def test_the_ellipse_of_each_warns_by_itself():
    made = picture(RUN)
    for view in EVERY:
        made.show(view)
        for name, other in zip(RUN.beside, view.others, strict=True):
            within = bool(inside_ellipse(other.pose, other.step.entry.truth, 0.954))
            for axes in (made.main.axes, made.close.axes):
                warning = artist(axes, f"ellipse-{name}-outside").get_xydata()
                own = artist(axes, f"ellipse-{name}").get_xydata()
                assert np.array_equal(warning, own[:0] if within else own)
    far = replace(EVERY[-1].step.entry, truth=np.array([9.0, 7.0, 0.0]))
    other = replace(EVERY[-1].others[1], step=replace(EVERY[-1].others[1].step, entry=far))
    others = (EVERY[-1].others[0], other, *EVERY[-1].others[2:])
    made.show(replace(EVERY[-1], others=others))
    assert len(artist(made.main.axes, f"ellipse-{RUN.beside[1]}-outside").get_xydata())
