"""The nominal trajectory: where a robot would be that does what it is asked to, from where it is
believed to start.
"""

from collections.abc import Iterable

import numpy as np

from ekfsim.commands import Command, Move, expand
from ekfsim.errors import UsageError
from ekfsim.geometry import Array
from ekfsim.geometry.angles import wrap
from ekfsim.models.motions.move_turn import MoveTurn
from ekfsim.scene import Scene
from ekfsim.simulation.driver import ticks_of
from ekfsim.systems.drive import Course
from ekfsim.systems.robot import Robot

NO_PLAN = (
    "a recording does not tell the way that was planned, which it is linearised about; take "
    "kf or ekf"
)


def nominal_trajectory(scene: Scene) -> Array:
    """States before, between and after all motion inputs of a scene that is simulated : (T + 1, n)

    Raises UsageError where the scene was recorded.
    """
    if scene.log is not None:
        raise UsageError(f"{scene.commands_source}: {scene.filter}: {NO_PLAN}")
    world, robot = scene.world, scene.world.told_robot
    if world.robot is None or robot is None:
        return _commanded(scene.commands, world.told.start)
    assert scene.drive is not None
    dt = 1 / world.robot.rate
    return _driven(scene.drive.course(dt), dt, world.told.start, robot)


def _commanded(commands: Iterable[Command], start: Array) -> Array:
    """The classroom's robot after each `move`; it goes through walls, and is not carried away."""
    poses, motion = [start], MoveTurn(0.0, 0.0)
    for command in expand(commands):
        if isinstance(command, Move):
            poses.append(motion.f(poses[-1], np.array([command.distance, command.angle])))
    return np.array(poses)


def _driven(course: Course, dt: float, start: Array, robot: Robot) -> Array:
    """A driven robot on its course. What in its state is no pose is what one motion input makes of
    it, from rest.
    """
    poses = course.poses(start, dt)
    poses[:, 2] = wrap(poses[:, 2])
    states = robot.layout.state(poses)
    inputs = robot.ideal(ticks_of(course, poses, dt))
    states[1:] = robot.motion("corrected").f(states[:-1], inputs)
    states[:, robot.layout.places] = poses
    return states
