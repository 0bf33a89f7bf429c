"""A scene: a world, what is done in it or was recorded of it, and how the filter is set.

`ekfsim.scene` is this module, which can be called: `ekfsim.scene('''world: room …''')` is
`ekfsim.load_scene` of a text, a dict or a file.
"""

import sys
from dataclasses import dataclass, replace
from pathlib import Path
from types import ModuleType
from typing import Any, Literal

from ekfsim.commands import Command, expanded_length
from ekfsim.filters.place import label
from ekfsim.filters.tuning import UNTUNED, Tuning
from ekfsim.printable import in_a_line
from ekfsim.records import Log
from ekfsim.shown import Shown
from ekfsim.systems.document import DocumentReading
from ekfsim.systems.drive import Drive
from ekfsim.world import World

Guard = Literal["off", "warn", "skip"]
Level = Literal["silent", "high", "low"]
Share = tuple[float, float]  # from, to; both in [0, 1]


@dataclass(frozen=True, slots=True)
class Expect:
    """What a study of this scene must find: the word that the scene keeps.

    None where it promises nothing.
    """

    lost: Share | None = None
    nis: Level | None = None
    nees: Level | None = None
    coverage: Share | None = None
    runs: int = 300


@dataclass(frozen=True, repr=False)
class Scene(Shown):
    """All that fixes a run but its number. `dataclasses.replace` makes another of it, and `with_`
    one with other numbers.
    """

    world: World
    commands: tuple[Command, ...] = ()
    drive: Drive | None = None  # in place of commands, where a robot is driven along a way
    log: Log | None = None  # in place of both, where the run was recorded
    reading: DocumentReading = "corrected"  # of the document whose system this is
    seed: int = 0
    run: int = 0  # which of the seed's runs is played
    filter: str = "ekf"  # a built-in one by its name, one's own by its place (filters/place.py)
    tuning: Tuning = UNTUNED  # the numbers that a filter alone may have
    gate: float | None = None  # probability in (0, 1)
    guard: Guard = "warn"
    description: str = ""
    expect: Expect | None = None
    world_source: str = "world"  # how outputs name the two files they were made from
    commands_source: str = "commands"
    world_file: Path | None = None  # where the world was read, to be named by another file
    log_source: str | None = None  # how outputs name the log, where the run was recorded
    settings: tuple[str, ...] = ()  # KEY=VALUE each: what overrules numbers of the two files
    # more filters that watch the same run, to be shown beside the first
    beside: tuple[str, ...] = ()

    def __repr__(self) -> str:
        done = f"{expanded_length(self.commands)} commands" if self.commands else "a drive"
        if self.log is not None:
            done = f"{len(self.log.entries)} entries of {self.log_source}"
        told = [done, ",".join(self.watching), f"seed {self.seed}", f"run {self.run}"]
        told += [] if self.gate is None else [f"gate {self.gate:g}"]
        told += [f"guard {self.guard}"] if self.guard != "warn" else []
        where = f"{self.commands_source} in {self.world_source}"
        return f"Scene({in_a_line(', '.join([where, *told, *self.settings]))})"

    @property
    def watching(self) -> tuple[str, ...]:
        """What people call the filters that watch, the first of them first."""
        return tuple(map(label, (self.filter, *self.beside)))

    @property
    def commanded(self) -> bool:
        """Whether the robot obeys commands one by one and knows no clock, as in the classroom."""
        return self.world.robot is None

    def alone(self) -> "tuple[Scene, ...]":
        """The same scene for each of the filters that watch it, by itself."""
        return tuple(replace(self, filter=name, beside=()) for name in (self.filter, *self.beside))

    def with_(self, *pairs: object, **settings: object) -> "Scene":
        """The same scene with other numbers, as `--set` sets them on the command line: truth and
        filter are told alike, unless the world's `belief` tells them apart. Keys are those of the
        files, and seed, run and filter:

            scene.with_("noise.rangeSigmaRatio", 0.1)
            scene.with_("noise.rangeSigmaRatio", 0.1, "gate", 0.99)
            scene.with_(gate=0.99, filter="ukf", seed=3, **{"filter.alpha": 0.5})

        Raises UsageError or InputError where a key or a value is wrong.
        """
        from ekfsim.files.given.changes import changed_scene  # the door to the files' checks

        return changed_scene(self, pairs, settings)


class Loading(ModuleType):
    """What the module is, so that it can be called: `ekfsim.scene` means one thing, whatever is
    imported first.
    """

    def __call__(
        self,
        commands: Any,
        world: Any = None,
        log: str | Path | None = None,
        reading: DocumentReading = "corrected",
    ) -> Scene:
        """The same as `load_scene`."""
        from ekfsim.files.scenes.load import load_scene  # the door to files

        return load_scene(commands, world, log, reading)


sys.modules[__name__].__class__ = Loading
