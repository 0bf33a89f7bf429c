"""How many steps and views a run has, told before it is over."""

from collections.abc import Iterable
from dataclasses import dataclass

from ekfsim.commands import Command, Repeat, Sense, expanded_length
from ekfsim.scene import Scene
from ekfsim.views.playback.playback import Tally


@dataclass(frozen=True, slots=True)
class Length:
    """How long a run is. Both numbers are also those of the last step and of the last view."""

    steps: int
    views: int


def steps_of(scene: Scene) -> int | None:
    """How many steps a run has, without its views: at once, however long it is."""
    if scene.log is not None:
        return scene.log.entries[-1].index
    return None if scene.drive is not None else expanded_length(scene.commands)


def length_of(scene: Scene) -> Length | None:
    """The length of a run of commands or of a log; None of a drive, which ends where it ends."""
    steps = steps_of(scene)
    if steps is None:
        return None
    if scene.log is not None:
        tally = Tally()
        for entry in scene.log.entries:
            tally.count(entry)
        return Length(steps, tally.views - 1)
    return Length(steps, steps + _readings(scene.commands))


def _readings(commands: Iterable[Command]) -> int:
    """How many readings the commands ask for, counted without expanding."""
    return sum(
        c.times * _readings(c.commands) if isinstance(c, Repeat) else isinstance(c, Sense)
        for c in commands
    )
