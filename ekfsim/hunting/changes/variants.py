"""What may be changed of a scene in a hunt. Each is small enough to be sent to a process."""

from collections.abc import Mapping
from dataclasses import dataclass, replace
from typing import Protocol

import numpy as np

from ekfsim.commands import Command
from ekfsim.scene import Scene


class Variant(Protocol):
    """One change of a scene."""

    @property
    def size(self) -> int:
        """Of two that do as much the smaller one is better."""

    def of(self, scene: Scene) -> Scene:
        """The scene with it."""


@dataclass(frozen=True, slots=True)
class Commanded:
    """Other commands."""

    commands: tuple[Command, ...]

    @property
    def size(self) -> int:
        """How many commands."""
        return len(self.commands)

    def of(self, scene: Scene) -> Scene:
        """The same world, robot and draws; the robot does something else."""
        return replace(scene, commands=self.commands)


@dataclass(frozen=True, slots=True)
class Started:
    """Another start, of which the filter is told."""

    x: float  # m
    y: float  # m
    theta: float  # rad

    @property
    def size(self) -> int:
        """All alike."""
        return 0

    def of(self, scene: Scene) -> Scene:
        """The same room and commands, begun elsewhere."""
        world, start = scene.world, np.array([self.x, self.y, self.theta])
        return replace(
            scene, world=replace(world, start=start, told=replace(world.told, start=start))
        )


@dataclass(frozen=True, slots=True)
class Told:
    """One number that the filter is told otherwise; the truth stays as it is."""

    key: str  # as in a world file, under `belief`: noise.rangeSigmaRatio, start.x
    value: float  # in the file's unit

    @property
    def size(self) -> int:
        """All alike."""
        return 0

    def of(self, scene: Scene) -> Scene:
        """The same run, watched by a filter that is told something else."""
        told, (section, name) = scene.world.told, self.key.split(".")
        if section == "noise":
            noise = replace(told.noise, **{RATIOS[name]: self.value})
            changed = replace(told, noise=noise)
        else:
            start = told.start.copy()
            start[AXES.index(name)] = np.radians(self.value) if name == "theta" else self.value
            changed = replace(told, start=start)
        return replace(scene, world=replace(scene.world, told=changed))


# those of the world's ratios that a filter makes use of, and how a world file calls them
RATIOS: Mapping[str, str] = {
    "odometryDstSigmaRatio": "odometry_distance",
    "odometryAngSigmaRatio": "odometry_angle",
    "rangeSigmaRatio": "range",
}
AXES = ("x", "y", "theta")
