"""Study files and commands files → what is asked of a study."""

import os
from collections.abc import Iterator, Sequence
from dataclasses import dataclass, replace
from pathlib import Path

from pydantic import ValidationError

from ekfsim.errors import InputError, Mistake, Place, UsageError
from ekfsim.files.marked import Node, field_of, parse
from ekfsim.files.marked import Path as Route
from ekfsim.files.packaged import packaged, resolve
from ekfsim.files.settings import OF_COMMANDS, Setting, fault_of, filters_in, repeated, setting, swept
from ekfsim.files.source import text_of
from ekfsim.files.study_file import StudyKeys
from ekfsim.files.telling import at, tell
from ekfsim.filters import FILTERS
from ekfsim.systems.document import DocumentReading

SIDES = ("a", "b")  # of a comparison
FILTER = "filter"  # a key that only they have


@dataclass(frozen=True)
class Request:
    """What is asked of a study. What is None the commands file decides."""

    commands: Path
    world: Path | None = None
    runs: int = 10_000
    seed: int | None = None
    filters: tuple[str, ...] = ()
    settings: tuple[Setting, ...] = ()  # for all cells
    sweep: tuple[tuple[Setting, ...], ...] = ()  # for each swept key one setting for each of its values
    reading: DocumentReading = "corrected"
    fast: bool = False  # by code that Numba compiles: alike but for the last digits
    a: tuple[Setting, ...] = ()  # of a comparison: what one side sets, its filter included
    b: tuple[Setting, ...] = ()
    written_by: str = ""  # the version that wrote the study file
    name: str = ""  # of the file that asks, as it was given
    commands_name: str = ""  # as a person writes them on a command line
    world_name: str | None = None

    def overruled(self, settings: tuple[Setting, ...], sweep: tuple[tuple[Setting, ...], ...]) -> "Request":
        """The same with more settings, which win over those of one key that were there before."""
        keys = {one.key for one in settings} | {values[0].key for values in sweep}
        kept = tuple(one for one in self.settings if one.key not in keys)
        swept = tuple(values for values in self.sweep if values[0].key not in keys)
        return replace(self, settings=kept + settings, sweep=swept + sweep)

    def checked(self) -> "Request":
        """The same request. Raises UsageError where a key is set twice, or set and swept."""
        seen: dict[str, str] = {}
        for one in (*self.settings, *(values[0] for values in self.sweep)):
            if one.key in seen:
                raise UsageError(f"{one.told}: '{one.key}' is told already by {seen[one.key]}; keep one of them")
            seen[one.key] = one.told
        return self


def asked(
    commands: str, world: str | None, runs: int | None, seed: int | None, filters: str | None, sweeps: Sequence[str],
    settings: Sequence[str], gate: float | str | None, guard: str | None,
    reading: DocumentReading | None, fast: bool,
) -> Request:  # fmt: skip
    """What the command line asks for: a file, overruled by its options. Raises UsageError or InputError."""
    request = read_request(commands)
    if world is not None:
        request = replace(request, world=resolve(world, "worlds"), world_name=world)
    set_apart = [(key, value) for key, value in (("gate", gate), ("guard", guard)) if value is not None]
    own = [*(setting(text) for text in settings), *(Setting(k, str(v), f"--{k} {v}") for k, v in set_apart)]
    request = request.overruled(tuple(own), tuple(map(swept, sweeps)))
    watching = request.filters if filters is None else filters_in(filters)
    return replace(
        request, filters=watching, runs=request.runs if runs is None else runs,
        seed=request.seed if seed is None else seed, reading=reading or request.reading,
        fast=fast or request.fast,
    ).checked()  # fmt: skip


def read_request(name: str) -> Request:
    """What a study file asks for, or a study of a commands file as it stands.

    Raises UsageError where there is no such file, InputError with all mistakes of a study file.
    """
    path = resolve(name, "commands")
    root, mistakes = parse(text_of(path, str(path)), str(path))
    if "study" not in root.keys:
        return Request(path, name=name, commands_name=name)
    try:
        keys = StudyKeys.model_validate(root.plain())
    except ValidationError as error:
        mistakes += tell(error, "study", root, str(path))
    else:
        mistakes += setting_mistakes(root, keys, str(path))
        mistakes += side_mistakes(root, str(path))
    if mistakes:
        raise InputError(sorted(mistakes, key=lambda mistake: (mistake.place.line, mistake.place.column)))
    commands, commands_name = beside(path, keys.study, "commands", root)
    world, world_name = (None, None) if keys.world is None else beside(path, keys.world, "worlds", root)
    a, b = (tuple(side_of(root, side, str(path))) for side in SIDES)
    return Request(
        commands, world, keys.runs, keys.seed, tuple(keys.filters or ()), tuple(settings_of(root, keys, str(path))),
        tuple(map(tuple, sweep_of(root, keys, str(path)))), keys.reading, keys.fast, a, b, keys.ekfsim,
        name, commands_name, world_name,
    )  # fmt: skip


def beside(path: Path, named: str, folder: str, root: Node) -> tuple[Path, str]:
    """The file that a study file names, relative to itself or by its bare name, and how one names it on a command line.

    Raises InputError where there is none.
    """
    near = Path(os.path.normpath(path.parent / named))
    known = packaged("worlds" if folder == "worlds" else "commands")
    if near.is_file() or named not in known:
        try:
            text_of(near, str(near))
        except UsageError as error:
            if isinstance(error, InputError):
                return near, str(near)
            key = "world" if folder == "worlds" else "study"
            wrong, _, right = str(error).partition("; ")
            right = right or "write its path relative to this file, or a name that `ekfsim list` shows"
            raise InputError([at(str(path), root.nearest((key,)).mark, (key,), wrong, right)]) from None
        return near, str(near)
    return known[named], named


def settings_of(root: Node, keys: StudyKeys, file: str) -> Iterator[Setting]:
    """What a study file sets for all cells."""
    for key in keys.set:
        yield setting_at(root, ("set", key), key, file)
    for key in OF_COMMANDS:
        if root.at((key,)) is not None:
            yield setting_at(root, (key,), key, file)


def sweep_of(root: Node, keys: StudyKeys, file: str) -> Iterator[list[Setting]]:
    """What a study file sweeps."""
    for key, values in keys.sweep.items():
        yield [setting_at(root, ("sweep", key, n), key, file) for n in range(len(values))]


def side_of(root: Node, side: str, file: str) -> Iterator[Setting]:
    """What a comparison's file sets for one of its sides, a or b."""
    for key in node.keys if (node := root.at((side,))) else ():
        yield setting_at(root, (side, key), key, file)


def setting_at(root: Node, path: tuple[str | int, ...], key: str, file: str) -> Setting:
    """The setting that stands at a place of a study file."""
    node = root.nearest(path)
    place = Place(file, *node.mark)
    return Setting(key, node.written, f"{place}: {field_of(path)}", place)


def setting_mistakes(root: Node, keys: StudyKeys, file: str) -> Iterator[Mistake]:
    """Keys that no file has, keys that are told twice, and values that stand twice, each at its place."""
    told: dict[str, str] = {}
    groups = [[one] for one in settings_of(root, keys, file)] + list(sweep_of(root, keys, file))
    for values, path in zip(groups, paths_of(root, keys), strict=True):
        key = values[0].key
        mark = root.nearest(path[:-1]).keys.get(str(path[-1]), root.mark)
        if fault := fault_of(values[0]):
            yield at(file, mark, path[:-1], *fault)
        if key in told:
            yield at(file, mark, path, f"'{key}' is told already by '{told[key]}'", "keep one of them")
        if (second := repeated(values)) is not None:
            place: Route = (*path, values.index(second))
            yield at(file, root.nearest(place).mark, place, f"{second.value} stands twice", "delete one")
        told[key] = field_of(path)


def side_mistakes(root: Node, file: str) -> Iterator[Mistake]:
    """Keys that no file has in what the sides of a comparison set, and filters that there are not."""
    for side in SIDES:
        for one in side_of(root, side, file):
            if one.key == FILTER and one.value not in FILTERS:
                right = f"known: {', '.join(FILTERS)}"
                yield at(file, root.nearest((side, FILTER)).mark, (side, FILTER), f"'{one.value}' is no filter", right)
            elif one.key != FILTER and (fault := fault_of(one)):
                yield at(file, root.nearest((side,)).keys[one.key], (side,), *fault)


def paths_of(root: Node, keys: StudyKeys) -> Iterator[tuple[str, ...]]:
    """Where the settings of each key stand."""
    yield from (("set", key) for key in keys.set)
    yield from ((key,) for key in OF_COMMANDS if root.at((key,)) is not None)
    yield from (("sweep", key) for key in keys.sweep)
