"""Round walls: against closed forms with fifty digits, and every search against the text."""

import math

import mpmath
import numpy as np
import pytest
from wall_worlds import DESK, NONE, ROOM, in_every_way, stars
from ways import WAYS

from ekfsim.raycast.walls import Walls
from ekfsim.twins import taking

PILLAR = np.array([7.0, 2.0, 1.0])
ALONE = Walls.of({}, circles={"pillar": PILLAR})
AMONG = Walls.of({"boundary": ROOM, "desk": DESK}, {}, {"pillar": PILLAR})


def pillars(count, seed, side=100.0, shift=0.0):
    """Circles of all sizes, some of them across others and round others."""
    random = np.random.default_rng(seed)
    place = shift + random.uniform(0, side, (count, 2))
    radius = side * random.choice([0.002, 0.02, 0.1], (count, 1))
    return {f"pillar {i}": each for i, each in enumerate(np.hstack([place, radius]))}


def exactly(circles, x, y, heading):
    """The first circle that a beam meets, with fifty digits: its range, and how far a range moves
    for each unit by which the beam misses its mark; nan, −1 and 0 where there is none.
    """
    with mpmath.workdps(50):
        dx, dy = mpmath.cos(mpmath.mpf(heading)), mpmath.sin(mpmath.mpf(heading))
        best = (mpmath.inf, -1, 0)
        for i, (cx, cy, radius) in enumerate(circles.tolist()):
            ex, ey = mpmath.mpf(x) - cx, mpmath.mpf(y) - cy
            b, c = ex * dx + ey * dy, ex * ex + ey * ey - mpmath.mpf(radius) ** 2
            if (under := b * b - c) > 0:
                root = mpmath.sqrt(under)
                for r in (-b - root, -b + root):
                    if r >= 0:
                        best = min(best, (r, i, 1 + radius / root))
                        break
        return (float(best[0]) if best[1] >= 0 else math.nan, best[1], float(best[2]))


@in_every_way
@pytest.mark.parametrize("shift", [0.0, 5e5])
def test_ranges_are_those_of_the_closed_form(shift):
    walls = Walls.of({}, circles=pillars(40, 2, shift=shift))
    random = np.random.default_rng(4)
    origin, heading = shift + random.uniform(-20, 120, (300, 2)), random.uniform(-4, 4, 300)
    hit = walls.cast(origin, heading)
    exact = [exactly(walls.circles, *o, h) for o, h in zip(origin, heading, strict=True)]
    ranges, met, steep = (np.array(each) for each in zip(*exact, strict=True))
    np.testing.assert_array_equal(hit.wall, met)
    off = np.abs(hit.range - ranges)
    assert (off[met >= 0] <= 1e-15 * (200 + 2 * shift) * steep[met >= 0]).all()
    assert np.isnan(hit.range[met < 0]).all()
    assert 50 < np.count_nonzero(met >= 0) < 300


@pytest.mark.parametrize("rings", [{}, stars(30, 2)], ids=["alone", "among stars"])
@pytest.mark.parametrize("count", [1, 60, 500])
def test_all_searches_agree_with_the_text(rings, count):
    lines = {"long": np.array([[0.0, 0], [100, 90]]), "short": np.array([[50.0, 50], [52, 49]])}
    walls = Walls.of(rings, lines, pillars(count, 7))
    random = np.random.default_rng(1)
    origin, heading = random.uniform(-20, 120, (400, 2)), random.uniform(-4, 4, 400)
    near = 50 + 0.1 * random.normal(size=(400, 2)), 0.7 + 0.02 * random.normal(size=400)
    scan = np.tile([40.0, 61.0], (400, 1)), np.linspace(-3, 3, 400)
    odd = (
        np.where(random.random((400, 2)) < 0.3, np.nan, origin),
        np.where(random.random(400) < 0.3, np.inf, heading),
    )
    for o, h in ((origin, heading), near, scan, odd):
        with taking("plain"):
            text = walls.cast(o, h)
        for way in WAYS:
            with taking(way):
                hit = walls.cast(o, h)
                singles = [walls.first(*o[k].tolist(), float(h[k])) for k in range(40)]
            assert_same((hit.range, hit.wall), (text.range, text.wall))
            found = tuple(np.array(each) for each in zip(*singles, strict=True))
            assert_same(found, (text.range[:40], text.wall[:40]))


def assert_same(found, expected):
    """Grazing beams make much of the last digit of a cosine."""
    np.testing.assert_allclose(found[0], expected[0], rtol=1e-11, atol=1e-11)
    np.testing.assert_array_equal(found[1], expected[1])


@in_every_way
def test_what_a_beam_meets_of_a_circle():
    assert ALONE.first(0.0, 2.0, 0.0) == pytest.approx((6.0, 0))  # the near side
    assert ALONE.first(7.0, 2.0, 0.3) == pytest.approx((1.0, 0))  # from its centre
    assert ALONE.first(6.5, 2.0, math.pi) == pytest.approx((0.5, 0))  # from inside, the far side
    assert ALONE.first(6.5, 2.0, 0.0) == pytest.approx((1.5, 0))
    assert ALONE.first(9.0, 2.0, 0.0) == NONE  # it lies behind
    assert ALONE.first(0.0, 3.1, 0.0) == NONE
    assert ALONE.first(0.0, 2.6, 0.0) == pytest.approx((6.2, 0))  # half is 0.8


@in_every_way
@pytest.mark.parametrize("heading", [0.0, 1.0, math.pi])
def test_a_beam_that_starts_on_a_circle_has_range_0(heading):
    for turn in (0.0, 0.3, 2.0):
        x, y = 7 + math.cos(turn), 2 + math.sin(turn)
        assert ALONE.first(x, y, heading) == (0.0, 0)


@in_every_way
def test_a_tangent_touches_within_reach_and_not_beyond():
    assert ALONE.first(0.0, 3.0, 0.0) == pytest.approx((7.0, 0), abs=1e-6)
    assert ALONE.first(0.0, 3.0 + 1e-15, 0.0)[1] == 0
    assert ALONE.first(0.0, 3.0 + 1e-12, 0.0) == NONE


@in_every_way
def test_of_walls_at_one_range_the_straight_one_is_met_and_else_the_lower():
    face = {"face": np.array([[6.0, 1], [6, 3.0]])}
    twice = {"one": PILLAR, "other": PILLAR}
    assert Walls.of({}, face, twice).first(0.0, 2.0, 0.0) == pytest.approx((6.0, 0))
    assert Walls.of({}, {}, twice).first(0.0, 2.0, 0.0) == pytest.approx((6.0, 0))
    behind = {"face": np.array([[6.0 + 1e-9, 1], [6 + 1e-9, 3.0]])}
    assert Walls.of({}, behind, twice).first(0.0, 2.0, 0.0) == pytest.approx((6.0, 1))


def test_circles_follow_all_straight_walls_and_are_lines_of_their_own():
    walls = Walls.of({"boundary": ROOM}, {"hook": DESK}, {"pillar": PILLAR, "post": PILLAR})
    assert [walls.name(wall) for wall in (7, 8)] == [("pillar", 0), ("post", 0)]
    assert walls.line[-2:].tolist() == [7, 8]
    assert [walls.is_round(wall) for wall in (6, 7)] == [False, True]
    np.testing.assert_allclose(np.hypot(*(walls.outline(8) - PILLAR[:2]).T), 1.0)
    np.testing.assert_array_equal(walls.outline(0), [[0, 0], [10, 0]])


def test_normals_point_outwards_where_a_circle_is_met():
    wall, place = np.array([8, 8, 0, -1]), np.array([[8, 2], [7, 1], [3, 0], [np.nan, 0]])
    np.testing.assert_array_equal(AMONG.normal_at(wall, place), [[1, 0], [0, -1], [0, 1], [0, 0]])


def test_walls_near_a_box_are_those_whose_boxes_touch_it():
    assert AMONG.near(np.array([7.5, 2.5]), np.array([8.0, 3.0])).tolist() == [8]
    assert AMONG.near(np.array([5.0, 4]), np.array([5.9, 5])).tolist() == []


@pytest.mark.parametrize("way", ["plain", *WAYS])
def test_where_a_robot_can_stand_and_how_far_it_may_be_drawn_back(way):
    ground = AMONG.ground
    with taking(way):
        places = np.array([[7, 2], [7.9, 2], [8.1, 2], [6.4, 1.1], [3, 2.5], [-1, 2]])
        assert ground.free(places).tolist() == [False, False, True, True, False, False]
        share = ground.reach(np.array([5.0, 2.0]), np.array([[2.0, 0], [4.0, 0], [2.5, 0.4]]))
    # 1 mm short of the near side; past the circle; the same along a way that is not level
    half = math.sqrt(1 - (2 * 0.4 / math.hypot(2.5, 0.4)) ** 2)
    along = 2 * 2.5 / math.hypot(2.5, 0.4) - half
    expected = [0.999 / 2, 1.0, (along - 0.001) / math.hypot(2.5, 0.4)]
    np.testing.assert_allclose(share, expected, rtol=1e-12)
