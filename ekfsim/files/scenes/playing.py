"""What a commands file does in a world → a scene: what is driven, and what a study must find."""

from collections.abc import Callable, Iterable, Iterator
from typing import TYPE_CHECKING

import numpy as np

from ekfsim.commands import Command, Kidnap, Move, Repeat, Say, Sense
from ekfsim.files.keys.commands import CommandKeys, CommandsKeys, ExpectKeys
from ekfsim.files.scenes.building import pose
from ekfsim.filters.tuning import Tuning
from ekfsim.scene import Expect, Scene
from ekfsim.systems.drive import Drive
from ekfsim.world import World

if TYPE_CHECKING:
    from ekfsim.files.keys.drive import PathKeys, StretchKeys


def scene_of(keys: CommandsKeys, world: World, world_source: str, commands_source: str) -> Scene:
    """The scene that a commands file plays in a world."""
    return Scene(
        world=world,
        commands=tuple(commands_of(keys.commands or ())),
        drive=None if keys.drive is None else drive_of(keys.drive),
        seed=keys.seed,
        filter=keys.filter,
        tuning=Tuning(**dict(keys.filter_settings)) if keys.filter_settings else Tuning(),
        gate=keys.gate,
        guard=keys.guard,
        description=keys.description,
        expect=expect(keys.expect) if keys.expect else None,
        world_source=world_source,
        commands_source=commands_source,
    )


def drive_of(keys: "PathKeys | list[StretchKeys]") -> Drive:
    """The way that a robot is driven, each number the document's where the file tells no other."""
    from ekfsim.files.keys.drive import PathKeys
    from ekfsim.systems.drives import DRIVES, Stretch, Stretches

    if isinstance(keys, PathKeys):
        given = keys.given()
        made: Callable[..., Drive] = DRIVES[given.pop("path")]
        if keys.path == "square" and keys.laps is not None:
            given["laps"] = int(keys.laps)
        return made(**given)
    return Stretches(
        tuple(
            Stretch(item.speed, float(np.radians(item.turn_rate)), item.duration) for item in keys
        )
    )


def expect(keys: ExpectKeys) -> Expect:
    """What a study must find."""
    lost = (keys.lost[0], keys.lost[1]) if keys.lost else None
    coverage = (keys.coverage[0], keys.coverage[1]) if keys.coverage else None
    return Expect(lost, keys.nis, keys.nees, coverage, keys.runs)


def commands_of(items: Iterable[CommandKeys]) -> Iterator[Command]:
    """The commands of a list, angles in radians; repetitions of nothing are left out."""
    for item in items:
        if item.move is not None:
            yield Move(
                float(item.move.distance), float(np.radians(item.move.angle)), float(item.move.slip)
            )
        elif item.sense is not None:
            yield Sense(float(np.radians(item.sense.angle)))
        elif item.kidnap is not None:
            yield Kidnap(*pose(item.kidnap).tolist())
        elif item.say is not None:
            yield Say(item.say)
        elif item.repeat is not None:
            repeated = tuple(commands_of(item.repeat.commands))
            if item.repeat.times and repeated:
                yield Repeat(item.repeat.times, repeated)
