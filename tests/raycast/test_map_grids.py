"""Far from the origin, as in the grids of maps, beams and files are as right as a double can
tell."""

import math
from itertools import pairwise

import numpy as np
import pytest
import shapely

from ekfsim.files.scenes.checking.polygons import FloorPlan, fault_of
from ekfsim.files.scenes.load import check, load_scene
from ekfsim.localization import play
from ekfsim.raycast.walls import Walls
from ekfsim.views.picture.extent import scope as scopes
from ekfsim.views.picture.frames import Frame
from ekfsim.views.playback.playback import views

PLACES = [(500_000.0, 5_000_000.0), (9.9e7, -9.9e7)]
ULP = 1.5e-8  # m, at 1e8
DESK = np.array([[4.0, 3.0], [5.0, 3.0], [5.0, 4.5], [4.0, 4.0]])
ROOM = np.array([[0.0, 0.0], [10.0, 0.0], [10.0, 8.0], [0.0, 8.0]])


def oracle(rings, origin, heading):
    """The range by Shapely, in coordinates whose origin is the beam's: the differences are
    exact."""
    end = 100 * np.array([math.cos(heading), math.sin(heading)])
    walls = shapely.union_all([shapely.LinearRing(ring - origin) for ring in rings])
    return shapely.distance(
        shapely.Point(0, 0), shapely.intersection(shapely.LineString([[0, 0], end]), walls)
    )


@pytest.mark.parametrize("place", PLACES)
@pytest.mark.parametrize("many", [1, 4, 40])
def test_ranges_are_those_of_shapely(place, many):
    """many : how often the desk stands there, beside itself, so that each of the ways to search is
    taken"""
    rng = np.random.default_rng(3)
    desks = {f"desk {n}": DESK + np.array([12.0 * n, 0.0]) + place for n in range(many)}
    rings = {"boundary": ROOM * [1.2 * many, 1] + place, **desks}
    walls = Walls.of(rings)
    origins = place + rng.uniform([0.5, 0.5], [12 * many - 0.5, 2.5], (150, 2))
    headings = rng.uniform(-math.pi, math.pi, 150)
    expected = [oracle(rings.values(), *beam) for beam in zip(origins, headings, strict=True)]
    alone = [float(walls.cast(*beam).range) for beam in zip(origins, headings, strict=True)]
    # a glancing beam magnifies rounding
    assert np.allclose(alone, expected, rtol=0, atol=20 * ULP / 0.02)
    assert np.median(np.abs(np.subtract(alone, expected))) < 4 * ULP
    together = walls.cast(np.tile(origins, (4, 1)), np.tile(headings, 4)).range
    assert np.allclose(together.reshape(4, -1), alone, rtol=0, atol=1e-12 * 2e8)
    fan = walls.cast(np.broadcast_to(origins[0], (150, 2)), headings).range
    assert np.allclose(
        fan,
        [oracle(rings.values(), origins[0], heading) for heading in headings],
        rtol=0,
        atol=2e-5,
    )


@pytest.mark.parametrize("place", PLACES)
def test_polygons_are_judged_as_near_the_origin(place):
    for corners, is_right in (
        (DESK, True),
        (DESK / 100, True),
        (DESK[[0, 1, 3, 2]], False),
        (ROOM[[0, 1, 0]], False),
    ):
        assert (fault_of((corners + place).tolist()) is None) == is_right
    thin = [[0.0, 0.0], [5.0, 0.0], [10.0, 0.0]]
    assert "no area" in fault_of((np.array(thin) + place).tolist())[1]
    plan = FloorPlan((ROOM + place).tolist(), [("desk", (DESK + place).tolist())])
    x, y = place
    assert not list(plan.in_the_way(x + 1, y + 1))
    assert list(plan.in_the_way(x + 4.5, y + 3.5))
    assert list(plan.in_the_way(x + 11, y + 1))


def world_at(x, y):
    def shifted(points):
        return [[px + x, py + y] for px, py in points.tolist()]

    return (
        f"name: a\nboundary: {shifted(ROOM)}\nobstacles: [{{name: desk, points: "
        f"{shifted(DESK)}}}]\n"
        f"landmarks: [{{id: 1, x: {x}, y: {y}}}]\nstart: {{x: {x + 1}, y: {y + 1}, theta: 90}}\n"
        f"belief: {{start: {{x: {x + 1}, y: {y + 1}, theta: 90}}, boundary: {shifted(ROOM)}}}\n"
        "noise: {executionDstSigmaRatio: 0, executionAngSigmaRatio: 0, odometryDstSigmaRatio: 0, "
        "odometryAngSigmaRatio: 0, rangeSigmaRatio: 0}\n"
    )


@pytest.mark.parametrize("place", PLACES)
def test_files_may_lie_there_and_no_farther(tmp_path, place):
    (tmp_path / "w.yaml").write_text(world_at(*place))
    assert check(tmp_path / "w.yaml").mistakes == []
    x, y = place
    scene = tmp_path / "c.yaml"
    scene.write_text(
        f"world: w.yaml\ncommands: [{{kidnap: {{x: {x + 2}, y: {y + 2}, theta: 0}}}}]\n"
    )
    assert check(scene).mistakes == []
    assert check(scene).warnings == []
    scene.write_text("world: w.yaml\ncommands: [{kidnap: {x: 1.1e8, y: 0, theta: 0}}]\n")
    (mistake,) = check(scene).mistakes
    assert "1.1e8 is too large; write a number of at most 100 000 000" in str(mistake)


def test_pictures_tell_whole_coordinates(tmp_path):
    (tmp_path / "w.yaml").write_text(world_at(*PLACES[1]))
    (tmp_path / "c.yaml").write_text("world: w.yaml\ncommands: [{sense: {angle: 0}}]\n")
    scene = load_scene(tmp_path / "c.yaml")
    frame = Frame(scene, scopes.of_all(scene, [play(scene)], 0.9))
    frame.png(next(iter(views(play(scene)))), {})
    axes = frame.picture.figure.axes[0]
    for axis in (axes.xaxis, axes.yaxis):
        assert axis.get_offset_text().get_text() == ""
        labels = [
            label.get_text().replace("\N{MINUS SIGN}", "-") for label in axis.get_ticklabels()
        ]
        assert [float(label) for label in labels] == pytest.approx(axis.get_ticklocs(), abs=0.5)
    boxes = [label.get_window_extent() for label in axes.xaxis.get_ticklabels() if label.get_text()]
    assert all(a.x1 < b.x0 for a, b in pairwise(boxes))
