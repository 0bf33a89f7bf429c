import math
from dataclasses import replace

import numpy as np
import pytest
import shapely
from numerics import covariance

from ekfsim.diagnostics.ambiguity import GRAZING, remark, sighting
from ekfsim.files.packaged import packaged
from ekfsim.files.scenes.load import load_scene, load_world
from ekfsim.geometry.angles import wrap
from ekfsim.localization import play
from ekfsim.models.sensors.frozen import Frozen
from ekfsim.models.sensors.laser import Laser
from ekfsim.models.sensors.yaw import Yaw
from ekfsim.raycast.walls import Walls

ROOM = np.array([[0, 0], [10, 0], [10, 8], [0, 8.0]])
KITE = np.array([[4, 3], [6, 2.5], [6.5, 4], [5, 5.5]])
WALLS = Walls.of({"boundary": ROOM, "kite": KITE})


def laser(bearing=0.0, walls=WALLS):
    return Laser(walls, bearing, 0.01)


def only(*points):
    return Walls.of({"wall": np.array(points, float)})


WALLED = [
    name
    for name, path in packaged("worlds").items()
    if (told := load_world(path).told.map).boundary is not None and told.obstacles
]


@pytest.mark.parametrize("axes", [(1,), (4,), (3, 2), (200,)])
def test_a_batch_equals_its_runs(axes):
    random = np.random.default_rng(4)
    x, P = random.uniform((0, 0, -3), (12, 8, 3), (*axes, 3)), covariance(random, *axes, 3) * 0.01
    sensor = laser(0.4)
    seen = sighting(sensor, x, P)
    for k in np.ndindex(axes):
        one = sighting(sensor, x[k], P[k])
        assert (seen.wall[k], seen.ambiguous[k]) == (one.wall, one.ambiguous)
        assert seen.incidence[k] == pytest.approx(float(one.incidence), nan_ok=True)
        assert seen.probe_ranges[k] == pytest.approx(one.probe_ranges, abs=1e-9, nan_ok=True)
        assert (seen.probe_walls[k] == one.probe_walls).all()
        assert (seen.astray[k] == one.astray).all()
        assert seen.probes[k] == pytest.approx(one.probes, abs=1e-12)


def test_of_other_sensors_nothing_is_to_be_said():
    x, P = np.array([3.0, 3.0, 0.3]), np.eye(3)
    assert remark(Yaw(0.0, 0.1), x, P) is None
    assert remark(Frozen(Yaw(0.0, 0.1), x), x, P) is None
    ours, frozen = remark(laser(), x, P), remark(Frozen(laser(), x + 1), x, P)
    assert (ours.probes == frozen.probes).all()  # from where the robot is believed to be


def test_incidence_is_the_angle_between_beam_and_wall():
    sensor = laser(walls=only((90, 8), (-90, 8), (0, 9)))
    for degrees in (90, 60, 15.1, 14.9, 3):
        seen = sighting(sensor, np.array([3.0, 7.0, math.radians(degrees)]), np.zeros((3, 3)))
        assert seen.wall == 0
        assert math.degrees(seen.incidence) == pytest.approx(degrees)
        assert seen.grazing == (degrees < 15)
    assert math.degrees(GRAZING) == pytest.approx(15)


def ambiguous(x, P, walls=WALLS, bearing=0.0):
    return bool(sighting(laser(bearing, walls), np.array(x, float), np.array(P, float)).ambiguous)


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
    assert sighting(laser(walls=room), np.array([1.0, 7.0, 0.0]), P).probes[
        :, 1
    ].max() == pytest.approx(7.999)
    # in the desk it would meet the desk
    assert not ambiguous((4.5, 2.5, 0), np.diag([0, 0.3**2, 0]), room)
    assert ambiguous((4.5, 2.5, math.pi), np.diag([0, 0.6**2, 0.9**2]), room)
    σ = np.array([0, 0.2, 0.1])  # 3σ away, at y = 3.1, the beam would be inside the desk
    x = np.array([4.5, 2.5, 0.0])
    (drawn,) = [p for p in sighting(laser(walls=room), x, np.outer(σ, σ)).probes if p[1] > 2.5]
    assert drawn[1] == pytest.approx(3, abs=1e-3)
    assert drawn[2] == pytest.approx(0.25, abs=1e-3)


def test_a_pose_behind_an_obstacle_is_possible():
    """A robot may be mistaken for one on the other side of a thin wall."""
    fence = Walls.of({"boundary": ROOM, "fence": np.array([[0, 4], [9, 4], [9, 4.1], [0, 4.1]])})
    seen = sighting(laser(-math.pi / 2, fence), np.array([5.0, 3.5, 0.0]), np.diag([0, 0.3**2, 0]))
    assert seen.ambiguous
    assert seen.probes[seen.astray][:, 1] == pytest.approx(3.5 + 0.9)


def test_from_an_impossible_mean_the_possible_poses_are_asked_alone():
    desk = only((4, 3), (5, 3), (5, 4), (4, 4))
    for σ, asked in ((0.1, 0), (0.2, 1)):  # the desk ends 0.5 m to the west
        seen = sighting(laser(walls=desk), np.array([4.5, 3.5, 0.0]), np.diag([σ**2, 0, 0]))
        assert np.count_nonzero(np.abs(seen.probes[:, 0] - 4.5) > 0) == 2 * asked
        assert seen.ambiguous == bool(asked)


def test_along_each_eigenvector_to_both_sides():
    room = Walls.of({"boundary": ROOM})
    for y in (1, 7):
        turned = 3 * 0.3 / math.sqrt(2)
        P = 0.09 * np.array([[0.5, 0.5, 0], [0.5, 0.5, 0], [0, 0, 0]])  # σ 0.3 along the diagonal
        seen = sighting(laser(walls=room), np.array([5.0, y, 0.0]), P)
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


def possible(floor, poses):
    """Whether a robot can stand at poses (n, 3): in the room, or on its wall, and in no
    obstacle."""
    points = shapely.points(poses[:, :2])
    inside = [shapely.Polygon(o.points).contains(points) for o in floor.obstacles]
    indoors = floor.boundary is None or shapely.Polygon(floor.boundary).intersects(points)
    return indoors & ~np.any([*inside, np.zeros(len(poses), bool)], axis=0)


@pytest.mark.parametrize("name", WALLED)
def test_no_alarm_rests_on_an_impossible_pose(name):
    """Shapely tells where a robot cannot be."""
    floor, random = load_world(packaged("worlds")[name]).told.map, np.random.default_rng(7)
    x = random.uniform(
        (*floor.boundary.min(axis=0), -np.pi), (*floor.boundary.max(axis=0), np.pi), (300, 3)
    )
    x = x[possible(floor, x)]
    A = random.normal(size=(len(x), 3, 3)) * [[[0.2], [0.2], [0.1]]]
    seen = sighting(Laser(floor.walls, 0.5, 0.01), x, A @ A.mT)
    assert possible(floor, seen.probes.reshape(-1, 3)).all()
    assert 0.1 < seen.ambiguous.mean() < 1
    λ, V = np.linalg.eigh(A @ A.mT)
    ends = x[:, None] + np.concatenate([arms := (V * 3 * np.sqrt(λ)[:, None, :]).mT, -arms], axis=1)
    kept = possible(floor, ends.reshape(-1, 3)).reshape(-1, 6)
    assert seen.probes[kept] == pytest.approx(ends[kept])  # who can stand there is asked there
    assert np.linalg.norm(seen.probes - ends, axis=-1)[~kept].min() > 0
    share = (seen.probes - x[:, None]) / np.where(ends == x[:, None], 1, ends - x[:, None])
    assert np.ptp(share, axis=-1).max() < 1e-6  # place and heading go back together


@pytest.mark.parametrize(
    "name", ["tour", "diverge-12-close-to-the-wall", "diverge-03c-slip", "diverge-01-wrong-wall"]
)
def test_whole_runs(name):
    scene, asked, alarms = replace(load_scene(name), guard="skip"), 0, 0
    for step in play(scene, np.arange(64)):
        if step.remark is not None:
            places = step.remark.probes[step.remark.astray]
            assert possible(scene.world.told.map, places).all()
            asked, alarms = asked + 64, alarms + int(step.remark.ambiguous.sum())
    assert alarms < 0.1 * asked


def test_leaving_out_ambiguous_beams_of_the_tour_costs_little():
    tour = load_scene("tour")
    error = {}
    for guard in ("warn", "skip"):
        *_, last = play(replace(tour, guard=guard), np.arange(2000))
        away = last.posterior.mean - last.entry.truth
        error[guard] = np.hypot(away[:, 0], away[:, 1]).mean()
        assert np.abs(wrap(away[:, 2])).mean() < 0.05
    assert error["skip"] - error["warn"] < 0.005
