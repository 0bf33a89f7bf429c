"""Names of obstacles and landmarks lie on nothing else, in the pictures of packaged scenarios."""

from itertools import islice, pairwise

import numpy as np
import pytest
import shapely
from matplotlib.collections import LineCollection
from matplotlib.lines import Line2D
from matplotlib.patches import Polygon
from matplotlib.path import Path
from scenes import DESK, scene

from ekfsim.commands import Move
from ekfsim.files.scenes.load import load_scene
from ekfsim.localization import play
from ekfsim.views.picture.extent import scope as scopes
from ekfsim.views.picture.frames import Picture
from ekfsim.views.picture.look import SCREEN
from ekfsim.views.picture.written.crossed import SQUARE, Crossed
from ekfsim.views.playback.playback import views

LONGEST = 250  # steps of a run that are looked at
NAMED = {  # with the fewest names that its pictures may show
    "tour": 6, "diverge-01-wrong-wall": 1, "diverge-06b-pillar-corridor": 20,
    "proof-every-mistake": 3, "landmarks": 10, "mower": 15, "ranges": 4, "pylon": 1,
}  # fmt: skip


def shapes(picture):
    """What moves in the main picture, in pixels."""
    to_pixels = picture.main.axes.transData.transform
    for artist in picture.main.moving:
        match artist:
            case Line2D():
                lines = [artist.get_xydata()]
            case LineCollection():
                lines = artist.get_segments()
            case Polygon():
                lines = []
                if len(artist.get_xy()) > 3:
                    yield shapely.make_valid(shapely.Polygon(to_pixels(artist.get_xy())))
            case _:
                continue
        for line in lines:
            for part in np.split(line, np.flatnonzero(np.isnan(line).any(axis=1))):
                part = to_pixels(part[np.isfinite(part).all(axis=1)])
                if len(part):
                    yield shapely.LineString(part) if len(part) > 1 else shapely.Point(part[0])


@pytest.mark.parametrize("name", NAMED)
def test_names_lie_on_nothing(name):
    run = load_scene(name)
    steps = list(islice(play(run), LONGEST))
    every = list(views(steps))
    picture = Picture.on(SCREEN, run, scopes.of(run, steps))
    beams = [view for view in every if view.beam]
    for view in (every[0], beams[len(beams) // 2], every[-1]):
        picture.show(view)
        boxes = [shapely.box(*name.box) for name in picture.names.shown]
        assert not any(a.intersects(b) for i, a in enumerate(boxes) for b in boxes[:i])
        for shape in shapes(picture):
            assert not any(shape.intersects(box) for box in boxes)
        window = shapely.box(*picture.main.axes.bbox.extents)
        assert all(window.contains(box) for box in boxes)
        if view is every[0]:
            assert len(boxes) >= NAMED[name]


def test_letters_stand_in_the_boxes_that_are_kept_free_for_them():
    run = load_scene("tour")
    picture = Picture.on(SCREEN, run, scopes.of(run, play(run)))
    picture.show(next(views(play(run))))
    letters = picture.names.artist.get_path().vertices * SCREEN.dpi
    boxes = np.array([name.box for name in picture.names.shown])
    inside = [Path(_corners(box)).contains_points(letters, radius=1.5) for box in boxes]
    assert np.any(inside, axis=0).all()
    assert all(one.sum() > 20 for one in inside)


def _corners(box):
    left, bottom, right, top = box
    return [(left, bottom), (right, bottom), (right, top), (left, top)]


def test_a_name_gives_way_and_comes_back():
    run = scene(Move(1.5, 0.0), obstacles=(DESK,), start=(1.0, 3.5, 0.0))
    start, moved = views(play(run))
    picture = Picture.on(SCREEN, run, scopes.of(run, play(run)))
    picture.show(start)
    first = [(name.text, tuple(name.center)) for name in picture.names.shown]
    picture.show(moved)
    picture.show(start)
    assert first == [(name.text, tuple(name.center)) for name in picture.names.shown]
    assert [text for text, _ in first] == ["desk"]


def test_lines_are_found_in_the_boxes_that_they_cross():
    rng = np.random.default_rng(5)
    for _ in range(30):
        points = rng.uniform(-300, 500, (4, 2))
        points[rng.integers(4)] *= rng.choice([1, np.nan, 50])
        corners = rng.uniform(0, 190, (40, 2))
        boxes = np.hstack([corners, corners + rng.uniform(4, 30, (40, 2))])
        crossed = Crossed((0.0, 0.0, 220.0, 220.0))
        crossed.add(points)
        found = crossed.inside(boxes)
        whole = [shapely.LineString(pair) for pair in pairwise(points) if np.isfinite(pair).all()]
        window = shapely.box(0, 0, 220, 220)
        for box, crosses in zip(boxes, found, strict=True):
            near = shapely.box(*box).intersection(window)
            if any(line.intersects(near) for line in whole):
                assert crosses
            if crosses:
                assert any(line.distance(near) < 2 * SQUARE for line in whole)


@pytest.mark.parametrize("name", ["proof-marker-behind", "diverge-06b-pillar-corridor", "mower"])
def test_the_axes_are_labelled_within_the_figure(name):
    run = load_scene(name)
    steps = list(islice(play(run), LONGEST))
    picture = Picture.on(SCREEN, run, scopes.of(run, steps))
    *_, last = views(steps)
    picture.show(last)
    picture.figure.canvas.draw()
    axes, figure = picture.main.axes, picture.figure.bbox
    for text in (axes.xaxis.label, axes.yaxis.label, *axes.get_yticklabels()):
        box = text.get_window_extent()
        assert figure.x0 < box.x0 < box.x1 < figure.x1
