"""What is asked → what is to be done: every cell of the grid, watched by every filter, in blocks of
runs.
"""

import functools
import hashlib
import itertools
from collections.abc import Callable, Iterator, Mapping
from dataclasses import dataclass, replace
from pathlib import Path
from typing import Any, NamedTuple, Self

from ekfsim.errors import UsageError
from ekfsim.files.keys.commands import CommandsKeys
from ekfsim.files.packaged import world_beside
from ekfsim.files.scenes.load import read_scene
from ekfsim.files.scenes.load_study import Request
from ekfsim.files.scenes.one_file import read
from ekfsim.files.scenes.settings import Setting
from ekfsim.files.source import as_written, bytes_of
from ekfsim.files.yaml.parsing import parse
from ekfsim.filters.place import label, with_smoothed
from ekfsim.scene import Scene
from ekfsim.simulation.draws import BLOCK
from ekfsim.study.block import run_block
from ekfsim.study.code import digests, of_same_code
from ekfsim.study.running.whole_runs import by_parts
from ekfsim.study.tally import Tally
from ekfsim.twins import Way, compiles, taken
from ekfsim.version import VERSION


class Task(NamedTuple):
    """A block of runs of one case."""

    case: int  # its number in the plan
    block: int
    first: int  # run
    runs: int


@dataclass(frozen=True)
class Case:
    """One cell of the grid, watched by one filter: a row of the summary."""

    values: tuple[Setting, ...]  # of the swept keys, in their order
    scene: Scene

    @property
    def filter(self) -> str:
        """What people call the filter."""
        return label(self.scene.filter)


@dataclass(frozen=True)
class Plan:
    """A study, ready to be done."""

    request: Request
    cases: tuple[Case, ...]
    warnings: tuple[str, ...]

    @classmethod
    def of(cls, request: Request) -> Self:
        """The plan of what is asked. Raises UsageError or InputError where a cell of it is no sound
        scene.
        """
        if request.a or request.b:
            raise UsageError(
                f"{request.name}: puts two settings side by side; run it with `ekfsim compare`"
            )
        if request.fast and not compiles():
            raise UsageError("--fast needs Numba; install it with: pip install 'ekfsim[fast]'")
        if is_recorded(request):
            raise UsageError(
                f"{request.commands_name}: a recording is one run only; sweep its settings with "
                "`ekfsim study`"
            )
        cases, warnings = cases_of(request)
        parts = by_parts(case.scene for case in cases) if request.fast else ()
        return cls(request, cases, (*warnings, *parts))

    @property
    def keys(self) -> tuple[str, ...]:
        """The swept keys."""
        return tuple(values[0].key for values in self.request.sweep)

    @property
    def seed(self) -> int:
        """The seed of all cells."""
        return self.cases[0].scene.seed

    @property
    def settings(self) -> tuple[Setting, ...]:
        """What overrules the files, in all cells or in one."""
        return (*self.request.settings, *(values[0] for values in self.request.sweep))

    @property
    def filters(self) -> tuple[str, ...]:
        """The filters that watch, in their order."""
        return tuple(dict.fromkeys(case.scene.filter for case in self.cases))

    @property
    def called(self) -> tuple[str, ...]:
        """What people call them."""
        return tuple(map(label, self.filters))

    def tasks(self) -> Iterator[Task]:
        """Every block of every case, in the order in which they are put together."""
        return (task for case in range(len(self.cases)) for task in self.tasks_of(case))

    def tasks_of(self, case: int) -> Iterator[Task]:
        """Every block of one case, in order."""
        runs = self.request.runs
        return (Task(case, b, b * BLOCK, min(BLOCK, runs - b * BLOCK)) for b in range(self.blocks))

    def block(self, case: int) -> Callable[[int, int], Tally]:
        """What becomes of runs of a case: a function of the first and of how many."""
        scene = self.cases[case].scene
        block = functools.partial(run_block, scene, way=way_of(self.request))
        return of_same_code(block, self.code_of(scene.filter))

    @functools.cached_property
    def codes(self) -> Mapping[str, str]:
        """The code of each filter of one's own as a word, as it was when this was first asked."""
        return digests(self.filters)

    def code_of(self, filter: str) -> Mapping[str, str]:
        """The same of one filter alone."""
        return {name: code for name, code in self.codes.items() if name == filter}

    @property
    def blocks(self) -> int:
        """How many blocks each case has."""
        return -(-self.request.runs // BLOCK)

    def identity(self) -> dict[str, Any]:
        """All that decides the numbers of this study, by the name that a person has for it."""
        request = self.request
        return {
            "ekfsim": VERSION,
            "commands": _digest(request.commands),
            "world": _digest(world_of(request)),
            "runs": request.runs,
            "seed": self.seed,
            "filters": ",".join(self.called),
            "code": " ".join(f"{label(name)} {code}" for name, code in self.codes.items()),
            "sweep": " ".join(
                f"{values[0].key}={','.join(one.value for one in values)}"
                for values in request.sweep
            ),
            "set": " ".join(map(str, request.settings)),
            "reading": request.reading,
            "fast": way_of(request) == "compiled",
            "plain": way_of(request) == "plain",
        }


def is_recorded(request: Request) -> bool:
    """Whether it is of a recorded log, which is one run."""
    keys = read(request.commands, str(request.commands), "commands").keys
    named = isinstance(keys, CommandsKeys) and keys.recording is not None
    return named or request.log is not None


def _watching(request: Request, scene: Scene) -> tuple[str, ...]:
    """The filters that watch a scene."""
    names = request.filters or (scene.filter,)
    return with_smoothed(names) if request.smooth else names


def cases_of(request: Request) -> tuple[tuple[Case, ...], tuple[str, ...]]:
    """Every cell that is asked for, watched by every filter, and what is to be warned of.

    Raises UsageError or InputError where a cell is no sound scene.
    """
    if request.excess:
        raise UsageError("; ".join(request.excess))
    cases, warnings = list[Case](), dict[str, None]()
    if request.written_by not in ("", VERSION):
        told = (
            f"{request.name}: the study was written by ekfsim {request.written_by}, this "
            f"is {VERSION}"
        )
        warnings[f"{told}: its numbers may differ"] = None
    for values in itertools.product(*request.sweep):
        settings = (*request.settings, *values)
        loaded = read_scene(request.commands, request.world, request.log, request.reading, settings)
        scene = loaded.get()
        warnings |= dict.fromkeys(loaded.warnings)
        seeded = scene if request.seed is None else replace(scene, seed=request.seed)
        cases += [Case(values, replace(seeded, filter=name)) for name in _watching(request, scene)]
    return tuple(cases), tuple(warnings)


def way_of(request: Request) -> Way:
    """How the blocks of a study are calculated, wherever that is done: plain where all is."""
    return "compiled" if request.fast and taken() != "plain" else taken()


def as_option(way: Way) -> str:
    """How a command line asks for a way that no study file asks for: "", or " --plain"."""
    return " --plain" if way == "plain" else ""


def world_of(request: Request) -> Path:
    """The world file of a study."""
    if request.world is not None:
        return request.world
    root, _ = parse(as_written(request.commands, str(request.commands)), str(request.commands))
    named = root.at(("world",))
    if named is None:
        raise UsageError(f"{request.commands_name}: names no world; give one with --world")
    return world_beside(request.commands, named.written)


def _digest(path: Path) -> str:
    """A file's contents as a word: what differs in it makes another study."""
    return hashlib.sha256(bytes_of(path, str(path))).hexdigest()[:16]
