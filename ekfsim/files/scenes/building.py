"""Models → the world that a run is made in:
degrees become radians, lists arrays, and belief what the filter is told.
"""

from collections.abc import Callable, Iterable
from dataclasses import fields, replace
from typing import TYPE_CHECKING, Any, TypeVar, overload

import numpy as np

from ekfsim.files.keys.fields import PartKeys, Pose, aliases, keys_of_kind
from ekfsim.files.keys.worlds.floor import LineKeys, ObstacleKeys
from ekfsim.files.keys.worlds.world import BeliefKeys, BelievedStartKeys, SigmaKeys, WorldKeys
from ekfsim.floor import Map, Obstacle, RoundObstacle, WallLine, wall_name
from ekfsim.geometry import Array
from ekfsim.geometry.angles import wrap
from ekfsim.systems.faults import DriveFaults, SensorFaults
from ekfsim.systems.instrument import Carried, Instrument
from ekfsim.systems.robot import Robot
from ekfsim.world import Axes, Faults, Landmark, Noise, Told, World

if TYPE_CHECKING:
    from ekfsim.files.keys.worlds.faults import FaultKeys, FaultySensorsKeys
    from ekfsim.files.keys.worlds.sensors import SensorKeys
    from ekfsim.files.keys.worlds.told import ToldSensorsKeys

P = TypeVar("P", Robot, Instrument)
NO_NOISE = Noise(0.0, 0.0, 0.0, 0.0, 0.0)  # of the classroom's robot, where another one drives


def world_of(keys: WorldKeys) -> World:
    """The world that a file describes."""
    floor_plan = Map(ring(keys.boundary), obstacles_of(keys.obstacles), lines_of(keys.walls))
    start, noise = pose(keys.start), Noise(**dict(keys.noise)) if keys.noise else NO_NOISE
    return World(
        name=keys.name,
        map=floor_plan,
        start=start,
        start_sigma=sigma(keys.start.sigma),
        noise=noise,
        told=told(keys, floor_plan, start, noise),
        faults=faults_of(keys.faults),
        drive_faults=drive_faults_of(keys),
        landmarks=tuple(Landmark(mark.id, mark.x, mark.y) for mark in keys.landmarks),
        description=keys.description,
        system=keys.system,
        robot=robot_of(keys),
        instruments=instruments_of(keys),
        expected_path=ring(keys.expected_path),
    )


def robot_of(keys: WorldKeys) -> Robot | None:
    """The robot of a system, each number the document's where the file tells no other;
    None in the classroom.
    """
    if keys.system == "classroom":
        return None
    from ekfsim.systems import SYSTEMS  # whose import no classroom waits for

    robot = SYSTEMS[keys.system].robot
    return robot if keys.robot is None else changed(robot, keys.robot)


def told_robot_of(keys: WorldKeys, belief: BeliefKeys) -> Robot | None:
    """The robot as the filter is told, None where that is as it is."""
    robot = robot_of(keys)
    if robot is None:
        return None
    told = robot if belief.robot is None else changed(robot, belief.robot)
    estimates = {
        name: one
        for robot_keys in (keys.robot, belief.robot)
        if robot_keys is not None and robot_keys.estimate is not None
        for name, one in robot_keys.estimate.given().items()
    }
    if estimates:
        from ekfsim.systems.estimating import Estimate, Estimating

        return Estimating(told, tuple((name, Estimate(**one)) for name, one in estimates.items()))
    return None if belief.robot is None else told


def changed(part: P, keys: PartKeys) -> P:
    """The same robot or instrument with other numbers."""
    anew: Callable[..., P] = replace
    given = keys.given()
    given.pop("estimate", None)  # what the filter finds out is no number of the robot
    if "mount" in given:
        assert isinstance(part, Carried)
        given["mount"] = part.mount._replace(**given["mount"])
    return anew(part, **given)


def instruments_of(keys: WorldKeys) -> tuple[Instrument, ...]:
    """The sensors of a file, or those of its system."""
    if keys.system == "classroom":
        return ()
    from ekfsim.systems import SYSTEMS

    return (
        SYSTEMS[keys.system].instruments
        if keys.sensors is None
        else tuple(map(instrument_of, keys.sensors))
    )


def told_instruments_of(keys: WorldKeys, belief: BeliefKeys) -> tuple[Instrument, ...] | None:
    """The sensors as the filter is told, None where that is as they are."""
    if belief.sensors is None:
        return None
    return tuple(
        one if (told := said_of(one, belief.sensors)) is None else changed(one, told)
        for one in instruments_of(keys)
    )


def said_of(one: Instrument, sensors: "ToldSensorsKeys | FaultySensorsKeys") -> Any:
    """What a mapping of sensors by their names says of one, by the keys of its kind; None where it
    says nothing.
    """
    kinds = {alias: name for name, alias in aliases(type(sensors)).items()}
    if one.called in kinds:
        return getattr(sensors, kinds[one.called])
    named = (sensors.model_extra or {}).get(one.called)
    if named is None:
        return None
    written = named.model_dump(by_alias=True, exclude_unset=True)
    return keys_of_kind(type(sensors), one.name).model_validate(written)


def faults_of(keys: "FaultKeys | None") -> Faults:
    """What is wrong with the classroom's robot."""
    return Faults(**_of_record(Faults, keys))


def drive_faults_of(keys: WorldKeys) -> DriveFaults:
    """What is wrong with a driven robot and its instruments."""
    given = _of_record(DriveFaults, keys.faults)
    faulty = given.pop("sensors", None)
    if keys.faults is None or keys.faults.sensors is None or faulty is None:
        return DriveFaults(**given)
    sensors = {
        one.called: SensorFaults(part.biases(), part.outliers, part.outlier_size, part.delay)
        for one in instruments_of(keys)
        if (part := said_of(one, keys.faults.sensors)) is not None
    }
    return DriveFaults(**given, sensors=sensors)


def _of_record(
    record: type[Faults] | type[DriveFaults], keys: "FaultKeys | None"
) -> dict[str, Any]:
    """What a file tells of the fields of a record."""
    names = {one.name for one in fields(record)}
    return (
        {}
        if keys is None
        else {name: value for name, value in keys.given().items() if name in names}
    )


def instrument_of(item: "SensorKeys") -> Instrument:
    """A sensor, each number the document's where the file tells no other."""
    from ekfsim.files.keys.worlds.sensors import SENSORS

    keys = item.part()
    return changed(SENSORS[type(keys)](), keys)


def told(keys: WorldKeys, floor_plan: Map, start: Array, noise: Noise) -> Told:
    """What the filter is told: the truth, except where `belief` differs."""
    belief = keys.belief or BeliefKeys.model_construct()
    unknown = belief.start == "unknown"
    believed = belief.start if isinstance(belief.start, BelievedStartKeys) else None
    return Told(
        start=start if believed is None else told_start(believed, keys.start),
        sigma=sigma(belief.sigma, keys.start.sigma),
        start_said=said(believed),
        sigma_said=said(belief.sigma, keys.start.sigma),
        noise=replace(noise, **{name: value for name, value in belief.noise if value is not None})
        if belief.noise
        else noise,
        map=told_map(belief, floor_plan),
        robot=told_robot_of(keys, belief),
        instruments=told_instruments_of(keys, belief),
        start_unknown=unknown,
    )


def told_map(belief: BeliefKeys, floor_plan: Map) -> Map:
    """The filter's map: the true one itself where nothing differs,
    so that its walls are built once.
    """
    own = (belief.boundary, belief.obstacles, belief.walls)
    if all(one is None for one in own) and not belief.missing:
        return floor_plan
    missing = belief.missing or []
    return Map(
        boundary=floor_plan.boundary if belief.boundary is None else ring(belief.boundary),
        obstacles=obstacles_of(belief.obstacles)
        if belief.obstacles is not None
        else tuple(obstacle for obstacle in floor_plan.obstacles if obstacle.name not in missing),
        lines=lines_of(belief.walls)
        if belief.walls is not None
        else tuple(line for line in floor_plan.lines if line.name not in missing),
    )


def obstacles_of(obstacles: Iterable[ObstacleKeys]) -> tuple[Obstacle | RoundObstacle, ...]:
    """Obstacles with their corners, or centres, as arrays."""
    return tuple(map(obstacle_of, obstacles))


def obstacle_of(keys: ObstacleKeys) -> Obstacle | RoundObstacle:
    """One of them; of none that is neither, which is told of as a mistake, it is a polygon without
    points.
    """
    if (circle := keys.circle) is not None:
        return RoundObstacle(keys.name, np.array([circle.x, circle.y]), circle.radius)
    return Obstacle(keys.name, ring(keys.points) if keys.points else np.empty((0, 2)))


def lines_of(walls: Iterable[list[list[float]] | LineKeys]) -> tuple[WallLine, ...]:
    """Walls that stand free; those without a name are called by their places in the list."""
    return tuple(
        WallLine(keys.name, array(keys.points))
        if isinstance(keys, LineKeys)
        else WallLine(wall_name(index), array(keys))
        for index, keys in enumerate(walls)
    )


@overload
def array(points: list[list[float]]) -> Array: ...
@overload
def array(points: None) -> None: ...
def array(points: list[list[float]] | None) -> Array | None:
    """points : (n, 2) m"""
    return None if points is None else still(np.array(points, dtype=float))


def still(numbers: Array) -> Array:
    """The same array, which nobody can write into: a world is shared by all that is made of it."""
    numbers.flags.writeable = False
    return numbers


@overload
def ring(points: list[list[float]]) -> Array: ...
@overload
def ring(points: None) -> None: ...
def ring(points: list[list[float]] | None) -> Array | None:
    """The corners of an outline : (n, 2) m, the first not repeated at its end"""
    if points and len(points) > 2 and points[0] == points[-1]:
        return array(points[:-1])
    return array(points)


def pose(keys: Pose) -> Array:
    """x, y, θ : (3,) m, m, rad in (−π, π]"""
    return still(np.array([keys.x, keys.y, float(wrap(np.radians(keys.theta)))]))


def told_start(told: BelievedStartKeys, start: Pose) -> Array:
    """x, y, θ : (3,) m, m, rad; each that is not told is that of the start"""
    return pose(start.model_copy(update=told.model_dump(exclude_none=True)))


def said(*choices: BelievedStartKeys | SigmaKeys | None) -> Axes:
    """Of which of x, y, θ any of the mappings says something."""
    x, y, theta = (
        any(keys is not None and getattr(keys, axis) is not None for keys in choices)
        for axis in ("x", "y", "theta")
    )
    return x, y, theta


def sigma(*choices: SigmaKeys | None) -> Array:
    """Standard deviations : (3,) m, m, rad;
    each from the first mapping that tells it, 0 where none does.
    """
    x, y, theta = (
        next(
            (value for keys in choices if keys and (value := getattr(keys, axis)) is not None), 0.0
        )
        for axis in ("x", "y", "theta")
    )
    return still(np.array([x, y, np.radians(theta)]))
