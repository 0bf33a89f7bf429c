"""What a robot measures of a true motion leads its own motion model along that motion."""

import math

import numpy as np
import pytest
from numpy.testing import assert_allclose

from ekfsim.files.scenes.load import load_scene
from ekfsim.geometry.angles import wrap
from ekfsim.systems import SYSTEMS
from ekfsim.systems.document import READINGS
from ekfsim.systems.robot import Tick
from ekfsim.systems.robots import GnssMower, Pioneer

ROBOTS = {name: system.robot for name, system in SYSTEMS.items()} | {
    "mid-point": Pioneer(odometry="midpoint"),
    "skid steer": Pioneer(odometry="skidSteer"),
}
EVERY = pytest.mark.parametrize("robot", ROBOTS.values(), ids=ROBOTS)
SPEED, TURN = 0.8, -0.7  # m/s, rad/s
# their documents go the whole way at the heading after the turn
AT_THE_NEW_HEADING = Pioneer, GnssMower


def ticks(robot, many=200):
    """A winding way by the mid-point rule: poses (many + 1, 3), and the ticks between them as
    one."""
    dt, k = 1 / robot.rate, np.arange(many + 1)
    distance, turn = SPEED * dt * (1 + 0.5 * np.sin(k / 9)), TURN * dt * np.cos(k / 17)
    heading = 3.0 + np.concatenate([[0.0], np.cumsum(turn[:-1])])
    steps = distance[:, None] * np.stack(
        [np.cos(heading + turn / 2), np.sin(heading + turn / 2)], axis=-1
    )
    place = np.array([5.0, -2.0]) + np.concatenate(
        [np.zeros((1, 2)), np.cumsum(steps[:-1], axis=0)]
    )
    poses = np.column_stack([place, wrap(heading)])
    return poses, Tick(
        poses[:-1], poses[1:], distance[:-1], turn[:-1], steps[:-1] / dt, steps[1:] / dt, dt
    )


def followed(robot, tick, poses):
    """The states that the robot's own model makes of its ideal inputs : (many + 1, n)"""
    motion, layout, u = robot.motion("corrected"), robot.layout, robot.ideal(tick)
    x = layout.state(poses[0])
    for name, velocity in zip(("xdot", "ydot"), tick.velocity_before[0], strict=True):
        if name in layout.names:
            x[layout.names.index(name)] = velocity
    states = [x]
    for given in u:
        states.append(motion.f(states[-1], given))
    return np.array(states)


@EVERY
def test_ideal_inputs_lead_along_the_true_way(robot):
    poses, tick = ticks(robot)
    pose = robot.layout.pose(followed(robot, tick, poses))
    assert_allclose(wrap(pose[:, 2] - poses[:, 2]), 0, rtol=0, atol=1e-9)
    if isinstance(robot, AT_THE_NEW_HEADING) and getattr(robot, "odometry", "arctan") == "arctan":
        # half a turn times the way, tick by tick
        aside = np.cumsum(tick.distance * np.abs(tick.turn) / 2)
        assert np.all(np.hypot(*(pose - poses)[1:, :2].T) <= aside + 1e-9)
    else:
        assert_allclose(pose[:, :2], poses[:, :2], rtol=0, atol=1e-9)


@pytest.mark.parametrize("reading", READINGS)
@pytest.mark.parametrize("name", ["mower", "pioneer", "gnss", "pylon", "landmarks", "ranges"])
def test_a_world_knows_in_which_readings_it_follows_other_equations(name, reading):
    """What motion and sensors say of a pose; the mower's code differs in its filter (see
    localization)."""
    world, random = load_scene(name).world, np.random.default_rng(1)
    x = random.uniform(-2, 2, len(world.layout.names))
    said = []
    for followed in (reading, "corrected"):
        motion = world.robot.motion(followed)
        u = 0.3 * np.ones(len(motion.inputs))
        sensors = [target.sensor for _, target in world.targets(followed)]
        said.append(
            [*motion.linearize(x, u), *(part for sensor in sensors for part in sensor.linearize(x))]
        )
    differ = not all(np.array_equal(a, b, equal_nan=True) for a, b in zip(*said, strict=True))
    assert world.follows(reading) == (differ or (name, reading) == ("mower", "coded"))


@EVERY
def test_a_straight_way_is_exact(robot):
    """And so is a turn on the spot."""
    for distance, turn in ((0.3, 0.0), (0.0, 0.2)):
        pose = np.array([1.0, 2.0, 0.4])
        step = distance * np.array([math.cos(0.4), math.sin(0.4)])
        after = np.array([*(pose[:2] + step), 0.4 + turn])
        velocity = step * robot.rate
        tick = Tick(pose[None], after[None], np.array([distance]), np.array([turn]), velocity[None],
        velocity[None],
                    1 / robot.rate)  # fmt: skip
        states = followed(robot, tick, np.array([pose, after]))
        assert_allclose(robot.layout.pose(states)[-1], after, rtol=0, atol=1e-12)


@EVERY
@pytest.mark.parametrize("reading", READINGS)
def test_inputs_and_covariances_have_the_shapes_of_the_models(robot, reading):
    poses, tick = ticks(robot, 4)
    motion, n = robot.motion(reading), len(robot.layout.names)
    u = robot.ideal(tick)
    assert u.shape == (4, len(motion.inputs))
    assert motion.f(robot.layout.state(poses[:-1]), u).shape == (4, n)
    P = robot.first_covariance(reading)
    assert P.shape == (n, n)
    assert np.array_equal(P, P.T)
    assert np.all(np.linalg.eigvalsh(P) > 0)


def test_the_mower_has_the_numbers_of_its_document():
    """Eqs 29 and 26, b of the listing; the text's P₀ = Q."""
    robot = ROBOTS["mower"]
    motion, u = robot.motion("corrected"), np.array([0.02, 0.03, 0.1, 0.01])
    assert_allclose(motion.Q(u), np.diag([1e-4, 1e-4, 7.62e-5]))
    assert_allclose(motion.M(u), np.diag([1e-4, 1e-4, 0, 0]))
    assert motion.width == 1.41
    assert_allclose(robot.first_covariance("corrected"), motion.Q(u))
