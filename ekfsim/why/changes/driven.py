"""What may be wrong with a robot that is driven: its own numbers and those of its instruments as
the filter is told, what each measures wrongly, its start, its map, the equations that are followed.
"""

import math
from collections.abc import Callable, Iterator
from dataclasses import fields, replace
from typing import Any

from ekfsim.printable import in_a_line
from ekfsim.scene import Scene
from ekfsim.systems.estimating import Estimating
from ekfsim.systems.faults import SOUND, SensorFaults
from ekfsim.why.changes import maps, told
from ekfsim.why.changes.recorded import louder_motion
from ekfsim.why.changes.suspects import HAS_NO_LINES, Suspect, sigma_points
from ekfsim.why.records import Change, Mechanism, Outcome, together
from ekfsim.world import World

NOISES = ("sigma", "density", "ratio", "floor")  # words by which a number of noise is known
DELAYS = ("delay",)
# of DriveFaults, what scales a way, what a turn; all else is a bias of what is measured
WAYS, TURNS = ("left_scale", "right_scale", "distance_scale"), ("turn_scale",)
LESS = 1 / 2, 1 / 4, 1 / 8  # times the noise of the motion
NO_GATE = Change(
    "beams", "the gate", "taken off", of_scene=lambda scene: replace(scene, gate=None)
)  # fmt: skip


def suspects_of_drive(scene: Scene, ended: Outcome) -> list[Suspect]:
    """Everything that may be wrong with a run of a driven robot that ended so, what explains more
    first.
    """
    world = scene.world
    found = [*_motion(world), *_sensors(world), *_faults(world), *_faults_of_sensors(world)]
    if (each := tuple(told.starts(world))) and told.surer(world):
        found.append(Suspect(Mechanism.WRONG_START, together("the told start", each), each))
    if each := tuple(maps.map_changes(world)):
        found.append(Suspect(Mechanism.MISPLACED_WALL, together("the told map", each), each))
    if scene.reading != "corrected":
        found.append(Suspect(Mechanism.WRONG_EQUATIONS, _equations(scene)))
    if scene.filter not in (HAS_NO_LINES, "ukf"):
        found.append(Suspect(Mechanism.HEADING_SPREAD, sigma_points(), reckoning=True))
    if ended == "over-cautious" and not any(
        one.mechanism is Mechanism.SENSOR_DISTRUSTED for one in found
    ):
        # the noises of the readings are true, so what is too much is the motion's: the equations
        # that the filter follows may give it more than any number says
        *others, least = (louder_motion(factor) for factor in LESS)
        found.append(Suspect(Mechanism.ODOMETRY_DISTRUSTED, least, (*others,), reckoning=True))
    return found


def _equations(scene: Scene) -> Change:
    text = f"{scene.reading} told, corrected true"
    return Change(
        "number", "the equations of the filter", text,
        of_scene=lambda scene: replace(scene, reading="corrected"),
    )  # fmt: skip


def _motion(world: World) -> Iterator[Suspect]:
    """The numbers of the robot, as it is told and as it is."""
    believed, true = _own(world.told_robot), _own(world.robot)
    if type(believed) is not type(true):
        return
    names = _different(believed, true)
    noises = [name for name in names if _is_noise(name)]
    if noises:
        each = tuple(_of_robot(name, believed, true) for name in noises)
        less = _less(believed, true, noises)
        yield Suspect(
            Mechanism.ODOMETRY_OVERTRUSTED if less else Mechanism.ODOMETRY_DISTRUSTED,
            together("the told noise of the motion", each), each,
        )  # fmt: skip
    if others := tuple(_of_robot(n, believed, true) for n in names if n not in noises):
        yield Suspect(Mechanism.WRONG_ROBOT, together("the told robot", others), others)


def _sensors(world: World) -> Iterator[Suspect]:
    """The numbers of each instrument, as it is told and as it is."""
    for believed, true in zip(world.told_instruments, world.instruments, strict=False):
        if type(believed) is not type(true) or believed.called != true.called:
            continue
        names = _different(believed, true)
        noises = [name for name in names if _is_noise(name)]
        late = [name for name in names if name in DELAYS]
        less = _less(believed, true, noises)
        trust = Mechanism.SENSOR_OVERTRUSTED if less else Mechanism.SENSOR_DISTRUSTED
        others = [name for name in names if name not in (*noises, *late)]
        for mechanism, some, what in (
            (trust, noises, f"the told noise of {true.called}"),
            (Mechanism.LATE_READINGS, late, f"the told delay of {true.called}"),
            (Mechanism.WRONG_SENSOR, others, f"the told numbers of {true.called}"),
        ):
            if each := tuple(_of_sensor(name, believed, true) for name in some):
                yield Suspect(mechanism, together(what, each), each)


def _faults(world: World) -> Iterator[Suspect]:
    """What is wrong with what the robot measures of its motion."""
    names = [one.name for one in fields(world.drive_faults) if one.name != "sensors"]
    wrong = [name for name in names if getattr(world.drive_faults, name) != _right(name)]
    ways = [name for name in wrong if name in WAYS]
    turns = [name for name in wrong if name in TURNS]
    biases = [name for name in wrong if name not in (*ways, *turns)]
    for mechanism, some in (
        (Mechanism.WHEEL_SCALE, ways),
        (Mechanism.TURN_SCALE, turns),
        (Mechanism.MOTION_BIAS, biases),
    ):
        if each := tuple(_of_drive(world, name) for name in some):
            yield Suspect(mechanism, together("what the wheels misread", each), each)


def _faults_of_sensors(world: World) -> Iterator[Suspect]:
    """What is wrong with the readings of each instrument."""
    for called, faults in world.drive_faults.sensors.items():
        for mechanism, names, what in (
            (Mechanism.SENSOR_BIAS, ("bias",), "bias"),
            (Mechanism.OUTLIERS, ("outliers", "outlier_size"), "outliers"),
            (Mechanism.LATE_READINGS, ("delay",), "delay"),
        ):
            if getattr(faults, names[0]) != getattr(SOUND, names[0]):
                yield Suspect(mechanism, _of_faulty(called, faults, names, what))


def _own(robot: Any) -> Any:
    """The robot itself, where the filter finds out its errors besides."""
    return robot.robot if isinstance(robot, Estimating) else robot


def _different(told: Any, true: Any) -> list[str]:
    """The names of the numbers in which two parts of a kind differ."""
    return [
        one.name
        for one in fields(true)
        if one.init and getattr(told, one.name) != getattr(true, one.name)
    ]


def _is_noise(name: str) -> bool:
    return any(word in name for word in NOISES)


def _less(told: Any, true: Any, names: list[str]) -> bool:
    """Whether less noise is told than there is, of all these together."""
    told_all, true_all = (
        math.prod(max(float(getattr(one, name)), 1e-9) for name in names) for one in (told, true)
    )
    return told_all < true_all


def _of_robot(name: str, believed: Any, true: Any) -> Change:
    value = getattr(true, name)

    def right(world: World) -> World:
        robot: Any = world.told_robot
        if isinstance(robot, Estimating):
            own: Any = robot.robot
            robot = replace(robot, robot=replace(own, **{name: value}))
        else:
            robot = replace(robot, **{name: value})
        return replace(world, told=replace(world.told, robot=robot))

    return _number(name, f"the told {_words(name)} of the robot", believed, true, right)


def _of_sensor(name: str, believed: Any, true: Any) -> Change:
    value, called = getattr(true, name), true.called

    def right(world: World) -> World:
        ones: list[Any] = list(world.told_instruments)
        told = tuple(replace(one, **{name: value}) if one.called == called else one for one in ones)
        return replace(world, told=replace(world.told, instruments=told))

    return _number(name, f"the told {_words(name)} of {in_a_line(called)}", believed, true, right)


def _number(
    name: str, what: str, believed: Any, true: Any, right: Callable[[World], World]
) -> Change:
    text = f"{_said(getattr(believed, name))} told, {_said(getattr(true, name))} true"
    return Change(
        "noise" if _is_noise(name) else "number", what, text,
        of_scene=lambda scene: replace(scene, world=right(scene.world)),
    )  # fmt: skip


def _of_drive(world: World, name: str) -> Change:
    right: Any = {name: _right(name)}

    def of_scene(scene: Scene) -> Scene:
        faults = replace(scene.world.drive_faults, **right)
        return replace(scene, world=replace(scene.world, drive_faults=faults))

    text = _said(getattr(world.drive_faults, name))
    return Change("fault", f"the {_words(name)} of the robot", text, of_scene=of_scene)


def _of_faulty(called: str, faults: SensorFaults, names: tuple[str, ...], what: str) -> Change:
    def of_scene(scene: Scene) -> Scene:
        all_faults = scene.world.drive_faults
        right: Any = {name: getattr(SOUND, name) for name in names}
        sensors = {**all_faults.sensors, called: replace(all_faults.sensors[called], **right)}
        world = replace(scene.world, drive_faults=replace(all_faults, sensors=sensors))
        return replace(scene, world=world)

    value = getattr(faults, names[0])
    text = f"{100 * value:.3g} % of the readings" if what == "outliers" else _said(value)
    return Change("fault", f"the {what} of {in_a_line(called)}", text, of_scene=of_scene)


def _right(name: str) -> float:
    return 1.0 if name.endswith("_scale") else 0.0


def _words(name: str) -> str:
    return name.replace("_", " ")


def _said(value: Any) -> str:
    """A number, or several; of what is none of these its own word."""
    if isinstance(value, tuple):
        return ", ".join(map(_said, value)) or "nothing"
    return f"{value:.4g}" if isinstance(value, float) else str(value)
