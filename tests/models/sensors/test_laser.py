import math

import numpy as np
import pytest
import shapely
from hypothesis import assume, given
from hypothesis import strategies as st
from numerics import covariance, jacobian

from ekfsim.geometry.walls import Walls
from ekfsim.models.sensors.laser import GRAZING, Laser

ROOM = np.array([[0, 0], [10, 0], [10, 8], [0, 8.0]])
KITE = np.array([[4, 3], [6, 2.5], [6.5, 4], [5, 5.5]])
WALLS = Walls.of({"boundary": ROOM, "kite": KITE})
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
    sighting = sensor.sight(x, np.eye(3) * 1e-10)
    assume(not sighting.ambiguous)  # the derivative of the wall it meets, not of a corner
    assume(sighting.incidence > 0.05)
    h, H, _ = sensor.linearize(x)
    assert h == pytest.approx(sensor.h(x))
    np.testing.assert_allclose(H, jacobian(sensor.h, x, step), atol=1e-4, rtol=1e-6)


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
        assert sensor.sight(x, np.zeros((3, 3))).wall == edge
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
    x, P = random.uniform((0, 0, -3), (12, 8, 3), (*axes, 3)), covariance(random, *axes, 3) * 0.01
    sensor = laser(0.4)
    h, H, R = sensor.linearize(x)
    assert (h.shape, H.shape, R.shape) == ((*axes, 1), (*axes, 1, 3), (*axes, 1, 1))
    seen = sensor.sight(x, P)
    for k in np.ndindex(axes):
        for batch, one in zip((h[k], H[k], R[k]), sensor.linearize(x[k]), strict=True):
            assert batch == pytest.approx(one, abs=1e-12, nan_ok=True)
        one = sensor.sight(x[k], P[k])
        assert (seen.wall[k], seen.ambiguous[k]) == (one.wall, one.ambiguous)
        assert seen.incidence[k] == pytest.approx(float(one.incidence), nan_ok=True)
        assert seen.probe_ranges[k] == pytest.approx(one.probe_ranges, abs=1e-9, nan_ok=True)
        assert (seen.probe_walls[k] == one.probe_walls).all()
        assert (seen.astray[k] == one.astray).all()
        assert seen.probes[k] == pytest.approx(one.probes, abs=1e-12)


def test_incidence_is_the_angle_between_beam_and_wall():
    sensor = laser(walls=only((90, 8), (-90, 8), (0, 9)))
    for degrees in (90, 60, 15.1, 14.9, 3):
        seen = sensor.sight(np.array([3.0, 7.0, math.radians(degrees)]), np.zeros((3, 3)))
        assert seen.wall == 0
        assert math.degrees(seen.incidence) == pytest.approx(degrees)
        assert seen.grazing == (degrees < 15)
    assert math.degrees(GRAZING) == pytest.approx(15)


def ambiguous(x, P, walls=WALLS, bearing=0.0):
    return bool(laser(bearing, walls).sight(np.array(x, float), np.array(P, float)).ambiguous)


def test_a_beam_is_ambiguous_within_three_sigma_of_a_corner():
    """From (5, 2) to the north-east the corner of the room lies 1 m to the north."""
    room, heading = Walls.of({"boundary": ROOM}), math.pi / 4
    assert not ambiguous((5, 2, heading), np.diag([0, 0.33**2, 0]), room)
    assert ambiguous((5, 2, heading), np.diag([0, 0.34**2, 0]), room)


def test_a_pose_outside_the_room_or_in_an_obstacle_is_no_evidence():
    """It is drawn back along its arm, place and heading, to 1 mm before the wall."""
    room = Walls.of({"boundary": ROOM, "desk": np.array([[4, 3], [5, 3], [5, 4], [4, 4.0]])})
    P = np.diag([0, 0.34**2, 0])
    assert not ambiguous((1, 7, 0), P, room)
    assert laser(walls=room).sight(np.array([1.0, 7.0, 0.0]), P).probes[
        :, 1
    ].max() == pytest.approx(7.999)
    # in the desk it would meet the desk
    assert not ambiguous((4.5, 2.5, 0), np.diag([0, 0.3**2, 0]), room)
    assert ambiguous((4.5, 2.5, math.pi), np.diag([0, 0.6**2, 0.9**2]), room)
    σ = np.array([0, 0.2, 0.1])  # 3σ away, at y = 3.1, the beam would be inside the desk
    x = np.array([4.5, 2.5, 0.0])
    (drawn,) = [p for p in laser(walls=room).sight(x, np.outer(σ, σ)).probes if p[1] > 2.5]
    assert drawn[1] == pytest.approx(3, abs=1e-3)
    assert drawn[2] == pytest.approx(0.25, abs=1e-3)


def test_a_pose_behind_an_obstacle_is_possible():
    """A robot may be mistaken for one on the other side of a thin wall."""
    fence = Walls.of({"boundary": ROOM, "fence": np.array([[0, 4], [9, 4], [9, 4.1], [0, 4.1]])})
    seen = laser(-math.pi / 2, fence).sight(np.array([5.0, 3.5, 0.0]), np.diag([0, 0.3**2, 0]))
    assert seen.ambiguous
    assert seen.probes[seen.astray][:, 1] == pytest.approx(3.5 + 0.9)


def test_from_an_impossible_mean_the_possible_poses_are_asked_alone():
    desk = only((4, 3), (5, 3), (5, 4), (4, 4))
    for σ, asked in ((0.1, 0), (0.2, 1)):  # the desk ends 0.5 m to the west
        seen = laser(walls=desk).sight(np.array([4.5, 3.5, 0.0]), np.diag([σ**2, 0, 0]))
        assert np.count_nonzero(np.abs(seen.probes[:, 0] - 4.5) > 0) == 2 * asked
        assert seen.ambiguous == bool(asked)


def test_along_each_eigenvector_to_both_sides():
    room = Walls.of({"boundary": ROOM})
    for y in (1, 7):
        turned = 3 * 0.3 / math.sqrt(2)
        P = 0.09 * np.array([[0.5, 0.5, 0], [0.5, 0.5, 0], [0, 0, 0]])  # σ 0.3 along the diagonal
        seen = laser(walls=room).sight(np.array([5.0, y, 0.0]), P)
        offsets = seen.probes - [5.0, y, 0.0]
        assert np.sort(offsets[:, 1]) == pytest.approx([-turned, 0, 0, 0, 0, turned], abs=1e-9)
        assert offsets[:, 0] == pytest.approx(offsets[:, 1], abs=1e-9)


def test_a_heading_alone_can_make_it_ambiguous():
    room = Walls.of({"boundary": ROOM})
    corner = math.atan2(3, 5)
    assert not ambiguous((5, 5, 0), np.diag([0, 0, (0.32 * corner) ** 2]), room)
    assert ambiguous((5, 5, 0), np.diag([0, 0, (0.34 * corner) ** 2]), room)


def test_no_covariance_no_doubt():
    assert not ambiguous((1, 7.9999999, 0), np.zeros((3, 3)))


def test_missing_the_wall_altogether_is_another_answer():
    post = only((5, -0.5), (6, -0.5), (6, 0.5), (5, 0.5))
    assert ambiguous((0, 0.4, 0), np.diag([0, 0.1, 0]), post)
    assert ambiguous((0, 0.6, 0), np.diag([0, 0.1, 0]), post)
    assert not ambiguous((0, 9, 0), np.diag([0, 0.1, 0]), post)


def test_edges_on_one_line_of_one_obstacle_are_one_wall():
    bent = only((5, -2), (5, 0), (5, 2), (6, 2), (6, -2))
    assert not ambiguous((0, 0.1, 0), np.diag([0, 0.01, 0]), bent)
    two = Walls.of(
        {"a": np.array([[5, -2], [5, 0], [6, -1]]), "b": np.array([[5, 0], [5, 2], [6, 1]])}
    )
    assert ambiguous((0, 0.1, 0), np.diag([0, 0.01, 0]), two)


def test_flat_directions_are_not_looked_into():
    post = only((5, 0), (6, 0), (6, 1), (5, 1))
    x = (0, 2e-5, 0)
    assert not ambiguous(x, np.diag([1, 0.9e-10, 0]), post)
    assert ambiguous(x, np.diag([1, 1.1e-10, 0]), post)
