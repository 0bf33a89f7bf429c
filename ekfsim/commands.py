"""What is asked of the classroom's robot: one command after the other, and repetitions of them."""

from collections.abc import Iterable, Iterator
from dataclasses import dataclass


@dataclass(frozen=True, slots=True)
class Move:
    """Drive `distance` m straight ahead, then turn in place by `angle` rad.

    Slipping wheels move the robot less.
    """

    distance: float
    angle: float
    slip: float = 0.0  # in [0, 1]


@dataclass(frozen=True, slots=True)
class Sense:
    """Measure the range along `angle` rad from straight ahead, counter-clockwise."""

    angle: float


@dataclass(frozen=True, slots=True)
class Kidnap:
    """Carry the true robot to x, y (m), θ (rad), and tell the filter nothing."""

    x: float
    y: float
    theta: float


@dataclass(frozen=True, slots=True)
class Say:
    """A sentence for the narrative and the picture."""

    text: str


@dataclass(frozen=True, slots=True)
class Repeat:
    """The same commands, `times` times over."""

    times: int
    commands: tuple["Command", ...]


@dataclass(frozen=True, slots=True)
class Untold:
    """A move of a recorded log, which does not tell what was commanded. None is in any file."""


Command = Move | Sense | Kidnap | Say | Repeat
Expanded = Move | Sense | Kidnap | Say  # what is left when every Repeat is expanded
Plain = Expanded | Untold  # what an entry may hold


def expand(commands: Iterable[Command]) -> Iterator[Expanded]:
    """Every command in the order of its execution, with the repetitions written out.

    >>> [c.angle for c in expand([Sense(0.0), Repeat(2, (Sense(1.0),))])]
    [0.0, 1.0, 1.0]
    """
    for command in commands:
        if isinstance(command, Repeat):
            for _ in range(command.times):
                yield from expand(command.commands)
        else:
            yield command


def expanded_length(commands: Iterable[Command]) -> int:
    """How many commands `expand` yields, counted without expanding.

    >>> expanded_length([Repeat(1000, (Repeat(1000, (Sense(0.0),)),))])
    1000000
    """
    return sum(
        c.times * expanded_length(c.commands) if isinstance(c, Repeat) else 1 for c in commands
    )


def first(commands: Iterable[Command], n: int | None) -> Iterator[Command]:
    """The first n of the commands that `expand` yields, in the repetitions that are whole; all
    where n is None.

    >>> list(first([Repeat(3, (Sense(1.0), Sense(2.0)))], 5))[1:]
    [Sense(angle=1.0)]
    """
    if n is None:
        yield from commands
        return
    for command in commands:
        if n <= 0:
            return
        if not isinstance(command, Repeat):
            yield command
            n -= 1
            continue
        length = expanded_length(command.commands)
        whole = min(command.times, n // max(length, 1))
        if whole:
            yield Repeat(whole, command.commands)
            n -= whole * length
        if whole < command.times:
            yield from first(command.commands, n)
            return
