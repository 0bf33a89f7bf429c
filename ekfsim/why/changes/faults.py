"""The faults of the classroom's robot, taken out one by one; each command keeps its draw."""

import math
from collections.abc import Iterator
from dataclasses import replace

from ekfsim.commands import Expanded, Kidnap, Move, Say, expand
from ekfsim.scene import Scene
from ekfsim.why.records import Change
from ekfsim.world import Faults

NAMES = {  # what each fault is called
    "range_bias": "the bias of the laser",
    "range_scale": "the scale of the laser",
    "short_returns": "the short returns",
    "odometry_distance_scale": "the scale of the wheels",
    "odometry_angle_scale": "the scale of the turns",
}
RIGHT = Faults()


def fault(scene: Scene, name: str) -> Change | None:
    """One of the faults taken out; None where it is not there."""
    value = getattr(scene.world.faults, name)
    right = getattr(RIGHT, name)
    if value == right:
        return None

    def of_scene(scene: Scene) -> Scene:
        world = scene.world
        faults = replace(world.faults, **{name: right})
        return replace(scene, world=replace(world, faults=faults))

    return Change("fault", NAMES[name], _said(name, value), of_scene=of_scene)


def _said(name: str, value: float) -> str:
    if name == "range_bias":
        return f"{value:g} m"
    return f"{100 * value:.3g} % of the readings" if name == "short_returns" else f"{value:g}"


def slips(scene: Scene) -> Iterator[Change]:
    """Each move on which the wheels slip, on which they do so no more."""
    for step, command in enumerate(expand(scene.commands), start=1):
        if isinstance(command, Move) and command.slip:
            yield _instead(
                step, f"the slip of step {step}", f"{100 * command.slip:.3g} % of the way",
                replace(command, slip=0.0),
            )  # fmt: skip


def kidnaps(scene: Scene) -> Iterator[Change]:
    """Each time the robot is carried away, when it is left where it is."""
    for step, command in enumerate(expand(scene.commands), start=1):
        if isinstance(command, Kidnap):
            text = f"to {command.x:g}, {command.y:g}, {math.degrees(command.theta):.4g} degrees"
            # a Kidnap takes no draw, and nor does a Say
            yield _instead(step, f"the kidnap of step {step}", text, Say("Nobody carries it."))


def _instead(step: int, name: str, told: str, command: Expanded) -> Change:
    """Another command at a step."""

    def of_scene(scene: Scene) -> Scene:
        flat = list(expand(scene.commands))
        flat[step - 1] = command
        return replace(scene, commands=tuple(flat))

    return Change("fault", name, told, step, of_scene)
