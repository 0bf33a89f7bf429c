"""What may be changed of a scene in a hunt. Each is small enough to be sent to a process."""

from dataclasses import dataclass, replace
from typing import Protocol

import numpy as np

from ekfsim.commands import Command
from ekfsim.scene import Scene


class Variant(Protocol):
    """One change of a scene."""

    def of(self, scene: Scene) -> Scene:
        """The scene with it."""


@dataclass(frozen=True, slots=True)
class Commanded:
    """Other commands."""

    commands: tuple[Command, ...]

    def of(self, scene: Scene) -> Scene:
        """The same world, robot and draws; the robot does something else."""
        return replace(scene, commands=self.commands)


@dataclass(frozen=True, slots=True)
class Started:
    """Another start, of which the filter is told."""

    x: float  # m
    y: float  # m
    theta: float  # rad

    def of(self, scene: Scene) -> Scene:
        """The same room and commands, begun elsewhere."""
        world, start = scene.world, np.array([self.x, self.y, self.theta])
        return replace(
            scene, world=replace(world, start=start, told=replace(world.told, start=start))
        )
