import math

import numpy as np
import pytest
import shapely
from hypothesis import assume, given
from hypothesis import strategies as st
from numerics import jacobian
from ways import WAYS

from ekfsim.diagnostics.ambiguity import sighting
from ekfsim.models.sensors.laser import Laser
from ekfsim.raycast.walls import Walls
from ekfsim.twins import taking

ROOM = np.array([[0, 0], [10, 0], [10, 8], [0, 8.0]])
KITE = np.array([[4, 3], [6, 2.5], [6.5, 4], [5, 5.5]])
WALLS = Walls.of({"boundary": ROOM, "kite": KITE})
PILLARS = {"pillar": np.array([5, 4, 1.0]), "post": np.array([8, 6, 0.3])}
ROUND = Walls.of({"boundary": ROOM}, circles=PILLARS)
NORTH = math.pi / 2
poses = st.tuples(st.floats(0.1, 9.9), st.floats(0.1, 7.9), st.floats(-3.14, 3.14)).map(np.array)
bearings = st.floats(-3.14, 3.14)


def laser(bearing=0.0, walls=WALLS, ratio=0.01):
    return Laser(walls, bearing, ratio)


def only(*points):
    return Walls.of({"wall": np.array(points, float)})


def shape():
    return shapely.union_all([shapely.LinearRing(ROOM), shapely.LinearRing(KITE)])


@given(poses, bearings)
def test_the_range_is_the_distance_to_the_first_wall(x, bearing):
    heading = x[2] + bearing
    beam = shapely.LineString(
        [x[:2], x[:2] + 20 * np.array([math.cos(heading), math.sin(heading)])]
    )
    expected = shapely.Point(x[:2]).distance(shape().intersection(beam))
    assert laser(bearing).h(x)[0] == pytest.approx(expected, abs=1e-9)


@given(poses, bearings)
def test_H_equals_central_differences(x, bearing):
    sensor, step = laser(bearing), 1e-6
    seen = sighting(sensor, x, np.eye(3) * 1e-10)
    assume(not seen.ambiguous)  # the derivative of the wall it meets, not of a corner
    assume(seen.incidence > 0.05)
    h, H, _ = sensor.linearize(x)
    assert h == pytest.approx(sensor.h(x))
    np.testing.assert_allclose(H, jacobian(sensor.h, x, step), atol=1e-4, rtol=1e-6)


@given(poses, bearings)
def test_H_of_a_round_wall_equals_central_differences(x, bearing):
    sensor = laser(bearing, ROUND)
    seen = sighting(sensor, x, np.eye(3) * 1e-10)
    assume(not seen.ambiguous and seen.incidence > 0.1)
    h, H, _ = sensor.linearize(x)
    assert h == pytest.approx(sensor.h(x))
    np.testing.assert_allclose(H, jacobian(sensor.h, x, 1e-6), atol=1e-4, rtol=1e-5)


def test_a_beam_past_the_middle_of_a_pillar_grazes_it_by_the_normal_where_it_is_met():
    x, ratio = np.array([0.0, 4.8, 0.0]), 0.8  # of the radius aside: 0.6 of it is half of the way
    sensor = laser(walls=Walls.of({}, circles={"pillar": np.array([5, 4, 1.0])}))
    h, H, _ = sensor.linearize(x)
    assert h == pytest.approx(4.4)
    np.testing.assert_allclose(H, [[-1, ratio / 0.6, 4.4 * ratio / 0.6]], rtol=1e-12)
    seen = sighting(sensor, x, np.zeros((3, 3)))
    assert seen.incidence == pytest.approx(math.asin(0.6))


def test_a_beam_along_the_tangent_of_a_pillar_has_no_usable_derivative():
    alone = Walls.of({}, circles={"pillar": np.array([5, 4, 1.0])})
    h, H, R = laser(walls=alone).linearize(np.array([0.0, 5.0, 0.0]))
    assert np.isnan([h[0], R[0, 0]]).all()
    assert not H.any()


@pytest.mark.parametrize(
    ("bearing", "derivatives"),
    [(0, (-1, 0, 0)), (NORTH, (0, -1, 0)), (-NORTH, (0, 1, 0)), (math.pi, (1, 0, 0))],
    ids=["ahead", "left", "right", "behind"],
)
def test_a_wall_at_right_angles_is_nearer_by_every_step_towards_it(bearing, derivatives):
    _, H, _ = Laser(Walls.of({"boundary": ROOM}), bearing, 0.01).linearize(
        np.array([3.0, 4.0, 0.0])
    )
    assert H[0] == pytest.approx(derivatives, abs=1e-12)


def test_an_oblique_wall_by_hand():
    """A beam at 60° meets the wall y = 8: r = (8 − y) / sin 60°."""
    x = np.array([3.0, 2.0, math.radians(20)])
    h, H, R = Laser(Walls.of({"boundary": ROOM}), math.radians(40), 0.02).linearize(x)
    r = 6 / math.sin(math.pi / 3)
    assert h[0] == pytest.approx(r)
    assert H[0] == pytest.approx(
        [0, -1 / math.sin(math.pi / 3), -r / math.tan(math.pi / 3)], abs=1e-12
    )
    assert R[0, 0] == pytest.approx((0.02 * r) ** 2)


def test_either_side_of_a_corner_has_the_derivative_of_its_own_wall():
    x, corner = np.array([3.0, 4.0, 0.0]), math.atan2(4, 7)
    for bearing, edge in ((corner - 1e-4, 1), (corner + 1e-4, 2)):
        sensor = Laser(Walls.of({"boundary": ROOM}), bearing, 0.01)
        assert sighting(sensor, x, np.zeros((3, 3))).wall == edge
        assert sensor.linearize(x)[1] == pytest.approx(jacobian(sensor.h, x, 1e-7), abs=1e-5)


def test_both_sides_of_a_wall_are_seen_alike():
    north, south = np.array([4.7, 9.0, -NORTH]), np.array([4.7, 1.0, NORTH])
    sensor = laser(walls=only((0, 5), (10, 5), (10, 5.0)))
    (_, from_north, _), (_, from_south, _) = sensor.linearize(north), sensor.linearize(south)
    assert from_north[0] == pytest.approx([0, 1, 0], abs=1e-12)
    assert from_south[0] == pytest.approx([0, -1, 0], abs=1e-12)


def test_the_order_of_a_ring_changes_nothing():
    random = np.random.default_rng(3)
    forth, back = laser(), laser(walls=Walls.of({"boundary": ROOM[::-1], "kite": KITE[::-1]}))
    for x in random.uniform((0, 0, -3), (10, 8, 3), (100, 3)):
        for a, b in zip(forth.linearize(x), back.linearize(x), strict=True):
            assert a == pytest.approx(b, abs=1e-12)


def test_the_noise_is_that_of_the_prediction():
    x = np.array([3.0, 4.0, 0.3])
    h, _, R = laser(ratio=0.05).linearize(x)
    assert R[0, 0] == pytest.approx((0.05 * h[0]) ** 2)
    assert laser(ratio=0.0).linearize(x)[2][0, 0] == 0


def test_no_wall_is_nan_and_has_no_derivative():
    for walls in (only((1, 1), (2, 1), (2, 2)), Walls.of({})):
        h, H, R = laser(walls=walls).linearize(np.array([-3.0, 0.0, math.pi]))
        assert np.isnan(h).all()
        assert np.isnan(R).all()
        assert (H == 0).all()


def test_a_beam_along_a_wall_has_no_usable_derivative():
    h, H, _ = laser(walls=only((5, 0), (9, 0), (9, 3))).linearize(np.array([0.0, 0.0, 0.0]))
    assert np.isnan(h).all()
    assert (H == 0).all()


@pytest.mark.parametrize("axes", [(1,), (4,), (3, 2), (200,)])
def test_a_batch_equals_its_runs(axes):
    random = np.random.default_rng(4)
    x = random.uniform((0, 0, -3), (12, 8, 3), (*axes, 3))
    sensor = laser(0.4)
    h, H, R = sensor.linearize(x)
    assert (h.shape, H.shape, R.shape) == ((*axes, 1), (*axes, 1, 3), (*axes, 1, 1))
    for k in np.ndindex(axes):
        for batch, one in zip((h[k], H[k], R[k]), sensor.linearize(x[k]), strict=True):
            assert batch == pytest.approx(one, abs=1e-12, nan_ok=True)


@pytest.mark.parametrize("name", WAYS)
def test_a_beam_along_a_wall_among_others(name):
    random = np.random.default_rng(11)
    x = random.uniform((1, 1, -3), (9, 7, 3), (200, 3))
    x[::3] = [-1.0, 0.0, 0.0]
    sensor = laser(0.0, Walls.of({"boundary": ROOM}), 0.02)
    with taking(name):
        many = sensor.linearize(x)
    assert np.isnan(many[0][::3]).all()
    for k in range(200):
        for each, one in zip(many, sensor.linearize(x[k]), strict=True):
            np.testing.assert_allclose(each[k], one, rtol=1e-12, atol=1e-12)


def test_nothing_in_a_map_without_walls_is_met():
    x = np.random.default_rng(11).uniform((1, 1, -3), (9, 7, 3), (200, 3))
    for name in WAYS:
        with taking(name):
            h, H, R = Laser(Walls.of({}), 0.1, 0.01).linearize(x)
        assert np.isnan(h).all()
        assert np.isnan(R).all()
        assert (H == 0).all()
