"""What the filter is told of a world → a world file in which all is so."""

import json
from collections.abc import Iterator, Mapping
from dataclasses import fields

from ekfsim.errors import UsageError
from ekfsim.files.keys.fields import PartKeys, aliases, keys_of_kind
from ekfsim.files.keys.worlds.world import NoiseKeys
from ekfsim.files.logs.degrees import degrees
from ekfsim.files.scenes.checking.polygons import FloorPlan
from ekfsim.floor import Map, Obstacle, RoundObstacle
from ekfsim.geometry import Array
from ekfsim.models.sensors.mounted import AT_THE_POSE
from ekfsim.scene import Scene
from ekfsim.systems.estimating import Estimating
from ekfsim.systems.instrument import Carried, Instrument
from ekfsim.systems.robot import Robot
from ekfsim.version import VERSION
from ekfsim.world import Told

NAME = "classroom"  # of the world: its own may tell what is wrong in it
AXES = ("x", "y", "theta")


def refuse_start(scene: Scene) -> None:
    """Raise UsageError where no world file can have the start that the filter is told."""
    told = scene.world.told
    x, y, _ = told.start.tolist()
    for wrong in FloorPlan.of(told.map).in_the_way(x, y):
        raise UsageError(
            f"{scene.commands_source}: cannot be recorded: the filter is told a start at {wrong} "
            "of its own map; tell it one where the robot can stand"
        )


def classroom_world(told: Told) -> Iterator[str]:
    """The lines of the world file of a classroom."""
    yield from _head(NAME)
    yield from _floor(told.map)
    sigma = f", sigma: {{{_pose(told.sigma)}}}" if told.sigma.any() else ""
    yield f"start: {{{_pose(told.start)}{sigma}}}\nnoise:\n"
    for name, key in aliases(NoiseKeys).items():
        yield f"  {key}: {getattr(told.noise, name)!r}\n"


def driven_world(scene: Scene) -> Iterator[str]:
    """The lines of the world file of a robot that drives. The start is the first belief's, whatever
    a log tells of the truth.
    """
    world = scene.world
    yield from _head(world.name)
    yield f"system: {world.system}\n"
    yield from _floor(world.told.map)
    if world.expected_path is not None:
        yield f"expectedPath: {_points(world.expected_path)}\n"
    if world.landmarks:
        yield "landmarks:  # landmarks.csv goes before these\n"
    for mark in world.landmarks:
        yield f"  - {{id: {mark.id}, x: {mark.x!r}, y: {mark.y!r}}}\n"
    yield f"start: {{{_pose(world.told.start)}}}\n"
    yield f"robot: {_flow(_robot(world.believed_robot))}\n"
    yield "sensors:\n" if world.told_instruments else "sensors: []\n"
    for instrument in world.told_instruments:
        yield f"  - {{{instrument.name}: {_flow(_instrument(instrument))}}}\n"
    yield f"belief:\n  start: {{{_pose(world.told.start)}}}\n"
    sigma = zip(AXES, world.told.sigma.tolist(), world.sigma_said, strict=True)
    said = {
        axis: degrees(σ) if axis == AXES[2] else repr(σ) for axis, σ, is_said in sigma if is_said
    }
    if said:
        yield f"  sigma: {_flow(said)}\n"


def _head(name: str) -> Iterator[str]:
    yield f"# What the filter is told, as ekfsim {VERSION} recorded it: m, and angles in degrees.\n"
    yield "# The truth may differ in all of it.\n"
    yield f"name: {_text(name)}\n"


def _floor(floor: Map) -> Iterator[str]:
    """The lines of a floor plan."""
    if floor.boundary is not None:
        yield f"boundary: {_points(floor.boundary)}\n"
    if floor.obstacles:
        yield "obstacles:\n"
    for obstacle in floor.obstacles:
        yield f"  - {{name: {_text(obstacle.name)}, {_shape(obstacle)}}}\n"
    if floor.lines:
        yield "walls:\n"
    for line in floor.lines:
        yield f"  - {{name: {_text(line.name)}, points: {_points(line.points)}}}\n"


def _robot(robot: Robot) -> dict[str, str]:
    """The keys of a robot, and of what its filter is to find out."""
    from ekfsim.files.keys.worlds.estimated import EstimateKeys
    from ekfsim.files.keys.worlds.robot import RobotKeys

    if not isinstance(robot, Estimating):
        return _part(robot, RobotKeys)
    found = {}
    for name, one in robot.estimates:
        keys = keys_of_kind(EstimateKeys, name)
        found[aliases(EstimateKeys)[name]] = _flow(_written(one._asdict(), keys))
    return {**_part(robot.robot, RobotKeys), "estimate": _flow(found)}


def _instrument(instrument: Instrument) -> dict[str, str]:
    """The keys of a sensor; of its name, mount and delay those that it has."""
    from ekfsim.files.keys.worlds.carried import MountKeys
    from ekfsim.files.keys.worlds.sensors import SENSORS

    keys = next(keys for keys, kind in SENSORS.items() if kind is type(instrument))
    own = _part(instrument, keys)
    if instrument.mount != AT_THE_POSE:
        own = {"mount": _flow(_written(instrument.mount._asdict(), MountKeys)), **own}
    if instrument.delay:
        own = {"delay": repr(instrument.delay), **own}
    return own if instrument.called == instrument.name else {"name": instrument.called, **own}


def _part(part: Robot | Instrument, keys: type[PartKeys]) -> dict[str, str]:
    """The keys that a robot or an instrument has of its own, with its numbers."""
    carried = {one.name for one in fields(Carried)}
    own = [one.name for one in fields(part) if one.init and one.name not in carried]  # type: ignore[arg-type]
    return _written({name: getattr(part, name) for name in own}, keys)


def _written(values: Mapping[str, object], keys: type[PartKeys]) -> dict[str, str]:
    """Values as a file has them, by its keys: angles in degrees."""
    known = aliases(keys)
    return {known[name]: _value(one, name in keys.angles) for name, one in values.items()}


def _value(value: object, is_angle: bool) -> str:
    if isinstance(value, tuple):
        return f"[{', '.join(_value(one, is_angle) for one in value)}]"
    if isinstance(value, str):
        return value
    assert isinstance(value, int | float)
    return degrees(value) if is_angle else repr(value)


def _flow(items: Mapping[str, str]) -> str:
    return f"{{{', '.join(f'{key}: {value}' for key, value in items.items())}}}"


def _text(text: str) -> str:
    return json.dumps(text, ensure_ascii=False)


def _shape(obstacle: Obstacle | RoundObstacle) -> str:
    if isinstance(obstacle, Obstacle):
        return f"points: {_points(obstacle.points)}"
    x, y = obstacle.centre.tolist()
    return f"circle: {{x: {x!r}, y: {y!r}, radius: {obstacle.radius!r}}}"


def _points(corners: Array) -> str:
    return repr(corners.tolist())


def _pose(pose: Array) -> str:
    x, y, θ = pose.tolist()
    return f"x: {x!r}, y: {y!r}, theta: {degrees(θ)}"
