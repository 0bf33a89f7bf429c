"""What of the robot and the sensors of a document's system no single key can tell, and of faults.

To be imported where a world has any of them: all that the systems are made of comes along.
"""

import math
from collections.abc import Iterator

import numpy as np

from ekfsim.errors import Mistake
from ekfsim.files.keys.fields import aliases, keys_of_kind
from ekfsim.files.keys.worlds.documents import ODOMETRY, not_carried, robot_fields
from ekfsim.files.keys.worlds.estimated import EstimateKeys
from ekfsim.files.keys.worlds.faults import FaultKeys, FaultySensorsKeys
from ekfsim.files.keys.worlds.robot import RobotKeys, ToldRobotKeys
from ekfsim.files.keys.worlds.sensors import SensorKeys
from ekfsim.files.keys.worlds.told import ToldSensorsKeys
from ekfsim.files.scenes.checking.command_checks import check_items
from ekfsim.files.scenes.checking.sound import Sound
from ekfsim.files.yaml.marked import Path
from ekfsim.files.yaml.telling import nearest, one_of, quoted
from ekfsim.systems import SYSTEMS
from ekfsim.systems.estimating import estimable
from ekfsim.systems.instrument import Instrument
from ekfsim.systems.instruments import (
    Bearings,
    Infrared,
    Lidar,
    Markers,
    Pylon,
    RangeBearings,
    Ranges,
    Ultrasonic,
)
from ekfsim.world import World

BEAMS: dict[str, type[Ultrasonic] | type[Infrared]] = {
    "ultrasonic": Ultrasonic,
    "infrared": Infrared,
}
NARROW = 2 * math.pi  # degrees: no bound of a field of view is larger, where radians are written
LOOKING = (Markers, RangeBearings, Bearings, Ranges, Pylon, Lidar)
OF_LANDMARKS = tuple(kind.name for kind in LOOKING)
ALL_IN_ONE = {  # how one sensor does the work of two
    **dict.fromkeys(BEAMS, ", with the 'bearings' of both"),
    **dict.fromkeys(OF_LANDMARKS, ", with the 'views' of both"),
}


def check_driven(file: Sound, system: str) -> Iterator[Mistake]:
    """Keys that a system of the documents does not read."""
    for path in (("noise",), ("belief", "noise")):
        if file.root.at(path):
            right = f"'robot' and 'sensors' hold that of the system '{system}'"
            yield file.mistake(path, "the noise ratios belong to the classroom's robot", right)
    for path in (("robot",), ("belief", "robot")):
        yield from check_robot(file, system, path)
    yield from check_steering(file)
    yield from check_faults(file, f"the robot of the system '{system}'", faults_of(system))
    for path in (("belief", "sensors"), ("faults", "sensors")):
        yield from check_carried(file, system, path)
    yield from check_carriable(file, system)


def check_robot(file: Sound, system: str, path: Path) -> Iterator[Mistake]:
    """Keys that the robot of a system does not have,
    true or told, and a skid-steer matrix that tells nothing.
    """
    names = aliases(RobotKeys if path == ("robot",) else ToldRobotKeys)
    known = [names[name] for name in robot_fields(system) if name in names]
    robot = file.root.at(path)
    for key in robot.keys if robot else ():
        if key in names.values() and key not in known:
            wrong = f"the robot of the system '{system}' has no key '{key}'"
            yield file.mistake((*path, key), wrong, f"it has: {', '.join(known)}")
    told, may = file.root.at((*path, "estimate")), estimable(SYSTEMS[system].robot)
    errors = {key: name for name, key in aliases(EstimateKeys).items()}
    for key in told.keys if told else ():
        if key in errors and errors[key] not in may:
            wrong = f"the robot of the system '{system}' has no such error"
            right = f"it may have: {', '.join(aliases(EstimateKeys)[name] for name in may)}"
            yield file.mistake((*path, "estimate", key), wrong, right)
    odometry = file.value(*path, "odometry")
    if odometry is not None and "odometry" in known and odometry not in ODOMETRY[system]:
        wrong = f"the robot of the system '{system}' has no odometry '{odometry}'"
        yield file.mistake((*path, "odometry"), wrong, f"write {one_of(list(ODOMETRY[system]))}")
    skid = file.value(*path, "skid")
    if skid is not None and "skid" in known:
        (forward, _, turning) = skid
        if abs(forward[0] * turning[1] - forward[1] * turning[0]) < 1e-9:
            wrong = "by its rows 1 and 3, other speeds of the two sides make the same motion"
            yield file.mistake(
                (*path, "skid"), wrong, "write e.g. [[0.5, 0.5], [0, 0], [2.5, -2.5]]"
            )


def check_steering(file: Sound) -> Iterator[Mistake]:
    """A filter that is told speeds where the robot counts ways, or the other way round."""
    believed = file.value("belief", "robot", "odometry")
    true = file.value("robot", "odometry") or "arctan"
    if believed is not None and (believed == "skidSteer") != (true == "skidSteer"):
        wrong = f"a robot of the odometry '{true}' cannot be read as one of '{believed}'"
        right = "write robot: {odometry: skidSteer} as well, or skidSteer in neither"
        yield file.mistake(("belief", "robot", "odometry"), wrong, right)


def faults_of(system: str) -> list[str]:
    """The names of what may be wrong with the robot of a system."""
    return [*SYSTEMS[system].robot.faults, "sensors"]


def check_faults(file: Sound, whose: str, names: list[str]) -> Iterator[Mistake]:
    """Faults that a robot cannot have."""
    known = [aliases(FaultKeys)[name] for name in names]
    faults = file.root.at(("faults",))
    for key in faults.keys if faults else ():
        if key in aliases(FaultKeys).values() and key not in known:
            wrong = f"{whose} has no fault '{key}'"
            yield file.mistake(("faults", key), wrong, f"it may have: {', '.join(known)}")


def check_carried(file: Sound, system: str, path: Path) -> Iterator[Mistake]:
    """Sensors that are told of and that the robot does not carry."""
    carried = {instrument.called: instrument.name for instrument in SYSTEMS[system].instruments}
    if file.root.at(("sensors",)):
        carried = {called: kind for _, called, kind in named_sensors(file)}
    told, model = file.root.at(path), ToldSensorsKeys if path[0] == "belief" else FaultySensorsKeys
    for name in told.keys if told else ():
        if name not in carried:
            near = nearest(name, list(carried))
            right = f"did you mean '{near}'?" if near else f"it has: {', '.join(carried) or 'none'}"
            yield file.mistake((*path, name), f"the world has no sensor {quoted(name)}", right)
        elif name != carried[name]:
            known = aliases(keys_of_kind(model, carried[name])).values()
            of_others = keys_of_all(model) - {*known}
            held = file.root.at((*path, name))
            for key in held.keys if held else ():
                if key in of_others:
                    wrong = f"unknown key {quoted(key)}"
                    right = f"known keys of a sensor {carried[name]}: {', '.join(known)}"
                    yield file.mistake((*path, name, key), wrong, right)


def keys_of_all(sensors: type[ToldSensorsKeys] | type[FaultySensorsKeys]) -> set[str]:
    """The keys that a sensor of any kind has in a mapping of them."""
    kinds = aliases(sensors).values()
    return {key for kind in kinds for key in aliases(keys_of_kind(sensors, kind)).values()}


def named_sensors(file: Sound) -> Iterator[tuple[int, str, str]]:
    """The sensors of a file that are of a kind, by their number: what each is called, and its
    kind.
    """
    for index in range(file.count("sensors")):
        item = file.root.at(("sensors", index))
        kind = next(iter(item.keys)) if item is not None and len(item.keys) == 1 else ""
        if kind in aliases(SensorKeys).values():
            name = file.value("sensors", index, kind, "name")
            yield index, name or kind, kind


def check_carriable(file: Sound, system: str) -> Iterator[Mistake]:
    """Sensors that the robot of a system cannot carry."""
    for index in range(file.count("sensors")):
        item = file.root.at(("sensors", index))
        for kind in item.keys if item and len(item.keys) == 1 else ():
            if kind in not_carried(system):
                wrong = f"the robot of the system '{system}' cannot carry the sensor '{kind}'"
                able = one_of([name for name in SYSTEMS if kind not in not_carried(name)])
                right = (
                    "write lidar, which no measured yaw has to turn"
                    if kind == Pylon.name
                    else f"the robot of {able} can"
                )
                yield file.mistake(("sensors", index, kind), wrong, right)


def check_sensors(file: Sound) -> Iterator[Mistake]:
    """Items that hold no sensor or two,
    a second sensor of a name, and beams that can measure nothing.
    """
    kinds = list(aliases(SensorKeys).values())
    yield from check_items(file, ("sensors",), kinds, "sensor")
    yield from check_names(file, kinds)
    for index in range(file.count("sensors")):
        for kind, document in BEAMS.items():
            path = ("sensors", index, kind)
            if (beams := file.value(*path)) is not None:
                near, far = (
                    beams.get("nearest", document.nearest),
                    beams.get("range", document.farthest),
                )
                if near >= far:
                    wrong = (
                        f"nothing lies between its nearest {near:g} m and its range of {far:g} m"
                    )
                    yield file.mistake(path, wrong, "write a range that is more than the nearest")


def check_names(file: Sound, kinds: list[str]) -> Iterator[Mistake]:
    """A second sensor of a name: its readings would go by the names of the first one's."""
    lines = dict[str, int]()
    for index, called, kind in named_sensors(file):
        item = file.root.at(("sensors", index))
        assert item is not None
        path: Path = ("sensors", index, kind)
        if called in lines:
            wrong = f"the sensor '{called}' on line {lines[called]} goes by the same name"
            if called == kind:
                right = f"give one a 'name', or keep one of them{ALL_IN_ONE.get(kind, '')}"
            else:
                path, right = (*path, "name"), "give each a name of its own"
            yield file.mistake(path, wrong, right)
        elif called != kind and called in kinds:
            wrong = f"'{called}' is what sensors of another kind are called"
            yield file.mistake((*path, "name"), wrong, f"write e.g. name: my-{called}")
        lines.setdefault(called, item.keys[kind][0])


def doubts(instrument: Instrument, world: World, logged: bool) -> Iterator[tuple[str, str]]:
    """Why a sensor hardly does what is meant, and the way out."""
    name, kind, robot = instrument.called, instrument.name, world.robot
    if kind in OF_LANDMARKS and not world.landmarks and not logged:
        yield (
            f"the sensor '{name}' sees landmarks, and the world has none",
            "list them under 'landmarks'",
        )
    if kind in BEAMS and not any(world.map.outlines()):
        yield (
            f"the sensor '{name}' sees walls, and the world has none",
            "write a 'boundary', 'obstacles' or 'walls'",
        )
    if isinstance(instrument, LOOKING) and np.abs(instrument.views).max() < math.radians(NARROW):
        yield (
            f"the sensor '{name}' sees a few degrees only",
            "'views' are in degrees: [-30, 30] looks ahead",
        )
    if robot is not None and instrument.rate > robot.rate:
        wrong = (
            f"the sensor '{name}' is to be read at {instrument.rate:g} Hz, the robot moves at "
            f"{robot.rate:g} Hz"
        )
        yield wrong, "it is read once at each motion"
