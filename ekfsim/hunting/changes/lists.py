"""Short lists of moves and senses: made by chance, changed, crossed, and kept doable.

All numbers are round: distances in steps of 5 cm, angles in whole degrees. A list is mended so that
the robot, were there no noise, stays clear of every wall on its way.
"""

import itertools
import math
from collections.abc import Iterable
from dataclasses import dataclass

import numpy as np

from ekfsim.commands import Command, Move, Sense, expand
from ekfsim.geometry.angles import wrap
from ekfsim.hunting.changes.variants import Commanded, Variant
from ekfsim.raycast.walls import Walls
from ekfsim.world import World

Doing = Move | Sense
Listed = tuple[Doing, ...]

CLEAR = 0.3  # m that the robot keeps from walls ahead
FARTHEST = 5.0  # m of one move
PER_METRE = 20  # steps of a distance
FINE = 5  # degrees, of most angles
SENSES = 0.5  # share of senses in a list that is made by chance
STRAIGHT = 0.3  # share of angles that are a multiple of a right angle


@dataclass(frozen=True)
class Space:
    """The lists that are looked through."""

    world: World
    longest: int  # commands

    def by_chance(self, rng: np.random.Generator) -> Listed:
        """A list of any length."""
        return self.of_length(int(rng.integers(1, self.longest + 1)), rng)

    def of_length(self, length: int, rng: np.random.Generator) -> Listed:
        """A list of so many commands; of fewer where a wall lets one do nothing."""
        return self.mended(_command(rng) for _ in range(length))

    def changed(self, listed: Listed, rng: np.random.Generator) -> Listed:
        """The same with a command more, less, moved, or with other numbers."""
        new, at = list(listed), int(rng.integers(0, len(listed)))
        match int(rng.integers(0, 6)):
            case 0 if len(new) < self.longest:
                new.insert(int(rng.integers(0, len(new) + 1)), _command(rng))
            case 1 if len(new) > 1:
                del new[at]
            case 2 if len(new) > 1:
                new.insert(int(rng.integers(0, len(new))), new.pop(at))
            case 3:
                new[at] = _command(rng)
            case _:
                new[at] = _nudged(new[at], rng)
        return self.mended(new)

    def crossed(self, one: Listed, other: Listed, rng: np.random.Generator) -> Listed:
        """The beginning of one and the end of another."""
        head, tail = int(rng.integers(1, len(one) + 1)), int(rng.integers(0, len(other)))
        return self.mended((*one[:head], *other[tail:])[: self.longest])

    def from_file(self, commands: Iterable[Command]) -> Listed:
        """What of a file's commands may stand in a list, from its beginning: senses, and moves of
        wheels that do not slip.
        """
        kept = (
            command
            for command in expand(commands)
            if isinstance(command, Sense) or (isinstance(command, Move) and not command.slip)
        )
        return self.mended(itertools.islice(kept, self.longest))

    def mended(self, commands: Iterable[Doing]) -> Listed:
        """The same, each way cut short where a wall is ahead of it."""
        walls = self.world.told.map.walls
        x, y, θ = self.world.told.start.tolist()
        done = list[Doing]()
        for command in commands:
            if isinstance(command, Move):
                d = free_way(walls, x, y, θ, command.distance)
                x, y = x + d * math.cos(θ), y + d * math.sin(θ)
                θ += command.angle
                if d == command.angle == 0:
                    continue
                command = Move(d, command.angle)
            done.append(command)
        return tuple(done) or (Sense(0.0),)


@dataclass(frozen=True)
class Lists:
    """The same as candidates of a search."""

    space: Space

    def by_chance(self, rng: np.random.Generator) -> Commanded:
        """A list of any length."""
        return Commanded(self.space.by_chance(rng))

    def changed(self, one: Variant, rng: np.random.Generator) -> Commanded:
        """The same with another command or number."""
        return Commanded(self.space.changed(_listed(one), rng))

    def crossed(self, one: Variant, other: Variant, rng: np.random.Generator) -> Commanded:
        """The beginning of one and the end of another."""
        return Commanded(self.space.crossed(_listed(one), _listed(other), rng))


def _listed(one: Variant) -> Listed:
    assert isinstance(one, Commanded)
    return tuple(command for command in one.commands if isinstance(command, Move | Sense))


def free_way(walls: Walls, x: float, y: float, θ: float, distance: float) -> float:
    """How much of a way can be driven, in whole steps where it is cut short."""
    if distance == 0:
        return 0.0
    free, _ = walls.first(x, y, θ if distance > 0 else float(wrap(np.array(θ + math.pi))))
    if math.isnan(free) or abs(distance) <= free - CLEAR:
        return distance
    steps = max(math.floor((free - CLEAR) * PER_METRE), 0)
    return math.copysign(steps / PER_METRE, distance) if steps else 0.0


def _command(rng: np.random.Generator) -> Doing:
    if rng.random() < SENSES:
        return Sense(_angle(rng))
    backwards = -1 if rng.random() < 0.1 else 1
    steps = 2 * int(rng.integers(0, int(FARTHEST * PER_METRE) // 2 + 1))
    return Move(backwards * steps / PER_METRE if steps else 0.0, _angle(rng))


def _angle(rng: np.random.Generator) -> float:
    """An angle in rad, a right angle or a multiple of it now and then."""
    if rng.random() < STRAIGHT:
        return math.radians(90 * int(rng.integers(-1, 3)))
    return math.radians(FINE * int(rng.integers(-35, 37)))


def _nudged(command: Doing, rng: np.random.Generator) -> Doing:
    degrees = int(rng.choice([-20, -10, -5, -2, -1, 1, 2, 5, 10, 20]))
    turned = round(math.degrees(command.angle)) + degrees
    angle = math.radians((turned + 179) % 360 - 179)  # in (−180°, 180°]
    if isinstance(command, Sense):
        return Sense(angle)
    if rng.random() < 0.5:
        return Move(command.distance, angle)
    steps = round(command.distance * PER_METRE) + int(rng.choice([-20, -8, -2, -1, 1, 2, 8, 20]))
    most = int(FARTHEST * PER_METRE)
    steps = min(max(steps, -most), most)
    return Move(steps / PER_METRE, command.angle)
