"""The numbers by which a filter is told of noise: ratios, standard deviations, densities."""

import math
from collections.abc import Callable, Iterator, Mapping, Sequence
from dataclasses import dataclass, fields, replace
from typing import Any, NamedTuple, cast

from ekfsim.files.keys.fields import PartKeys, aliases, keys_of_kind
from ekfsim.models.motions.move_turn import MoveTurn
from ekfsim.models.protocols import Motion, Sensor
from ekfsim.models.sensors.laser import Laser
from ekfsim.models.sensors.mounted import Mounted
from ekfsim.records import Control, Entry, Log, Reading
from ekfsim.scene import Scene
from ekfsim.systems.estimating import Estimating
from ekfsim.world import World

WORDS = ("sigma", "density", "ratio", "floor")  # by which a number of noise is known
OF_CLASSROOM = {
    "odometry_distance": "odometryDstSigmaRatio",
    "odometry_angle": "odometryAngSigmaRatio",
    "range": "rangeSigmaRatio",
}
WHEELS_AT_REST = "floor"


@dataclass(frozen=True, slots=True)
class NoiseNumber:
    """One of them, by its key in a world file, told to the filter alone."""

    key: str  # "robot.turnDensity", "sensors.gnss.sigma", "noise.rangeSigmaRatio"
    name: str  # of the field, as the program has it
    part: str  # "noise", "robot", or what the sensor is called
    value: float  # as the filter is told: m, rad
    is_angle: bool  # degrees in a file

    @property
    def route(self) -> tuple[str, ...]:
        """Where a world file tells it to the filter alone."""
        return ("belief", *self.key.split("."))

    def in_file(self, value: float) -> float:
        """A value of it as a file has it."""
        return math.degrees(value) if self.is_angle else value


def noises_of(scene: Scene) -> tuple[NoiseNumber, ...]:
    """All that the filter of a scene is told of noise, of what occurs in its log."""
    return tuple(_noises(scene.world, sensors_in(scene)))


def sensors_in(scene: Scene) -> set[str]:
    """The names of what was read."""
    entries = () if scene.log is None else scene.log.entries
    return {entry.given.name for entry in entries if isinstance(entry.given, Reading)}


def told_by_readings(scene: Scene) -> set[str]:
    """The sensors each of whose readings tells by itself how sure it is, so that no number of the
    sensor's own says anything.
    """
    world, log = scene.world, scene.log
    if world.told_robot is None or log is None:
        return set()
    targets = world.targets(scene.reading)
    own = {target.name: (part.called, target.sensor) for part, target in targets}
    read, as_sure = set[str](), set[str]()
    for entry in log.entries:
        if isinstance(given := entry.given, Reading) and given.name in own:
            called, sensor = own[given.name]
            read.add(called)
            if _as_sure(given.sensor, sensor):
                as_sure.add(called)
    return read - as_sure


def _noises(world: World, read: set[str]) -> Iterator[NoiseNumber]:
    robot = world.told_robot
    if robot is None:
        for name, alias in OF_CLASSROOM.items():
            value = getattr(world.told.noise, name)
            yield NoiseNumber(f"noise.{alias}", name, "noise", value, False)
        return
    from ekfsim.files.keys.worlds.robot import ToldRobotKeys
    from ekfsim.files.keys.worlds.told import ToldSensorsKeys

    own = robot.robot if isinstance(robot, Estimating) else robot
    yield from _of_part(own, ToldRobotKeys, "robot", "robot")
    names = {id(one): set[str]() for one in world.told_instruments}
    for instrument, target in world.targets("corrected"):
        names[id(instrument)].add(target.name)
    for instrument in world.told_instruments:
        if names[id(instrument)] & read:
            keys = keys_of_kind(ToldSensorsKeys, instrument.name)
            called = instrument.called
            yield from _of_part(instrument, keys, f"sensors.{called}", called)


def _of_part(part: Any, keys: type[PartKeys], start: str, called: str) -> Iterator[NoiseNumber]:
    alias = aliases(keys)
    for one in fields(part):
        if one.name in alias and any(word in one.name for word in WORDS):
            value = getattr(part, one.name)
            key = f"{start}.{alias[one.name]}"
            yield NoiseNumber(key, one.name, called, float(value), one.name in keys.angles)


def told(world: World, numbers: Sequence[NoiseNumber], values: Sequence[float]) -> World:
    """The same world, its filter told other numbers."""
    mine: dict[str, dict[str, Any]] = {}
    for number, value in zip(numbers, values, strict=True):
        mine.setdefault(number.part, {})[number.name] = value
    believed = world.told
    if noise := mine.pop("noise", None):
        believed = replace(believed, noise=replace(believed.noise, **noise))
    if robot := mine.pop("robot", None):
        anew: Any = world.told_robot
        if isinstance(anew, Estimating):
            anew = replace(anew, robot=replace(cast(Any, anew.robot), **robot))
        else:
            anew = replace(anew, **robot)
        believed = replace(believed, robot=anew)
    if mine:
        parts: list[Any] = [
            replace(one, **mine[one.called])  # type: ignore[type-var]  # all are dataclasses
            if one.called in mine
            else one
            for one in world.told_instruments
        ]
        believed = replace(believed, instruments=tuple(parts))
    return replace(world, told=believed)


@dataclass(frozen=True)
class Retold:
    """A scene of a log whose filter is told one set of numbers after another."""

    scene: Scene
    numbers: tuple[NoiseNumber, ...]

    def world(self, values: Sequence[float]) -> World:
        """The scene's world under these values."""
        return told(self.scene.world, self.numbers, values)

    def with_(self, values: Sequence[float], until: int | None = None) -> Scene:
        """The scene under these values; of its log the first `until` entries, without a truth."""
        log = self.scene.log
        assert log is not None
        world = self.world(values)
        before, after = parts_of(self.scene.world, self.scene), parts_of(world, self.scene)
        entries = tuple(
            Entry(entry.index, anew(entry.given, before, after), t=entry.t)
            if until is not None
            else replace(entry, given=anew(entry.given, before, after))
            for entry in log.entries[:until]
        )
        return replace(self.scene, world=world, log=Log(entries, log.first))


class Parts(NamedTuple):
    """The models of a log, as a filter is told."""

    motion: Motion | None
    sensors: Mapping[str, Sensor]  # by their names; none of the classroom
    laser: Callable[[Laser], Sensor]  # the classroom's, which has one for each bearing


def parts_of(world: World, scene: Scene) -> Parts:
    """The models as a world's filter is told."""
    noise = world.told.noise
    laser = lambda one: Laser(one.walls, one.bearing, noise.range)  # noqa: E731
    if world.told_robot is None:
        return Parts(MoveTurn(noise.odometry_distance, noise.odometry_angle), {}, laser)
    sensors = {target.name: target.sensor for _, target in world.targets(scene.reading)}
    return Parts(world.believed_robot.motion(scene.reading), sensors, laser)


def anew(given: Control | Reading | None, before: Parts, after: Parts) -> Control | Reading | None:
    """What the filter is given, with the model of other numbers where its own is the scene's."""
    own = before.sensors
    match given:
        case Control(motion, u):
            same = type(motion) is type(before.motion) and after.motion is not None
            return Control(after.motion, u) if same and after.motion is not None else given
        case Reading(Laser() as laser, z, name):
            return Reading(after.laser(laser), z, name)
        case Reading(sensor, z, name) if name in own and _as_sure(sensor, own[name]):
            return Reading(after.sensors[name], z, name)
    return given


def _as_sure(sensor: Sensor, own: Sensor) -> bool:
    """Whether a reading is as sure as the world's sensor says: a log may tell it of each reading,
    and that wins over all that could be fitted.
    """
    if isinstance(sensor, Mounted) and isinstance(own, Mounted):
        return _as_sure(sensor.sensor, own.sensor)
    if type(sensor) is not type(own):
        return False
    parts: Any = sensor
    return all(
        getattr(sensor, one.name) == getattr(own, one.name)
        for one in fields(parts)
        if "sigma" in one.name
    )
