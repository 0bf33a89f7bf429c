"""Study files and commands files → what is asked of a study."""

import math
import os
from collections.abc import Iterator, Sequence
from dataclasses import dataclass, replace
from pathlib import Path

from pydantic import ValidationError

from ekfsim.errors import MOST_TOLD, InputError, Mistake, Place, UsageError
from ekfsim.files.keys.filters import is_filter
from ekfsim.files.keys.study import StudyKeys
from ekfsim.files.looking import is_file
from ekfsim.files.packaged import packaged, resolve
from ekfsim.files.scenes.checking.filter_checks import alike, filter_beside, missing
from ekfsim.files.scenes.settings import (
    OF_COMMANDS,
    Setting,
    fault_of,
    filters_in,
    numbers_of,
    repeated,
    setting,
    swept,
)
from ekfsim.files.source import as_written
from ekfsim.files.yaml.marked import Node, field_of
from ekfsim.files.yaml.marked import Path as Route
from ekfsim.files.yaml.parsing import parse
from ekfsim.files.yaml.telling import at, tell
from ekfsim.filters import FILTERS
from ekfsim.printable import quoted, short
from ekfsim.systems.document import DocumentReading

SIDES = ("a", "b")  # of a comparison
FILTER = "filter"  # a key that only they have
FILTERS_KEY = "filters"  # of a study
SWEEP = "sweep"
MOST_ROWS = 10_000  # of a table


@dataclass(frozen=True)
class Request:
    """What is asked of a study. What is None the commands file decides."""

    commands: Path
    world: Path | None = None
    runs: int = 10_000
    seed: int | None = None
    filters: tuple[str, ...] = ()
    settings: tuple[Setting, ...] = ()  # for all cells
    # for each swept key one setting for each of its values
    sweep: tuple[tuple[Setting, ...], ...] = ()
    reading: DocumentReading = "corrected"
    fast: bool = False  # by code that Numba compiles: alike but for the last digits
    a: tuple[Setting, ...] = ()  # of a comparison: what one side sets, its filter included
    b: tuple[Setting, ...] = ()
    written_by: str = ""  # the version that wrote the study file
    name: str = ""  # of the file that asks, as it was given
    commands_name: str = ""  # as a person writes them on a command line
    world_name: str | None = None
    log: str | None = None  # the recorded log that is studied, in place of the commands file's own
    in_python: bool = False  # of a scene that a notebook holds, not of files
    smooth: bool = False  # beside each filter the same smoothed

    def overruled(
        self, settings: tuple[Setting, ...], sweep: tuple[tuple[Setting, ...], ...]
    ) -> "Request":
        """The same with more settings, which win over those of one key that were there before."""
        keys = {one.key for one in settings} | {values[0].key for values in sweep}
        kept = tuple(one for one in self.settings if one.key not in keys)
        swept = tuple(values for values in self.sweep if values[0].key not in keys)
        return replace(self, settings=kept + settings, sweep=swept + sweep)

    @property
    def excess(self) -> tuple[str, str] | None:
        """Why its table, a row for each cell and filter, is too long, and what to do about it; None
        where it is not.
        """
        rows = math.prod(map(len, self.sweep)) * max(len(self.filters), 1)
        wrong = f"the table would have {rows} rows, more than {MOST_ROWS}"
        return (wrong, "sweep fewer values") if rows > MOST_ROWS else None

    def checked(self) -> "Request":
        """The same request. Raises UsageError where a key is set twice, or set and swept."""
        seen: dict[str, str] = {}
        for one in (*self.settings, *(values[0] for values in self.sweep)):
            if one.key in seen:
                raise UsageError(
                    f"{one.told}: '{one.key}' is told already by {seen[one.key]}; keep one of them"
                )
            seen[one.key] = one.told
        return self


def asked(
    commands: str, world: str | None, runs: int | None, seed: int | None, filters: str | None,
    sweeps: Sequence[str],
    settings: Sequence[str], gate: float | str | None, guard: str | None,
    reading: DocumentReading | None, fast: bool, particles: int | None = None,
    hypotheses: int | None = None,
    log: str | None = None, smooth: bool = False,
) -> Request:  # fmt: skip
    """What the command line asks for:
    a file, overruled by its options. Raises UsageError or InputError.
    """
    request = read_request(commands)
    if world is not None:
        request = replace(request, world=resolve(world, "worlds"), world_name=world)
    set_apart = [
        (key, value) for key, value in (("gate", gate), ("guard", guard)) if value is not None
    ]
    own = [
        *(setting(text) for text in settings),
        *(Setting(k, str(v), f"--{k} {v}") for k, v in set_apart),
    ]
    own += numbers_of(particles, hypotheses)
    request = request.overruled(tuple(own), tuple(map(swept, sweeps)))
    watching = request.filters if filters is None else filters_in(filters)
    return replace(
        request, filters=watching, runs=request.runs if runs is None else runs,
        seed=request.seed if seed is None else seed, reading=reading or request.reading,
        fast=fast or request.fast, log=log or request.log, smooth=smooth,
    ).checked()  # fmt: skip


def read_request(name: str) -> Request:
    """What a study file asks for, or a study of a commands file as it stands.

    Raises UsageError where there is no such file, InputError with all mistakes of a study file.
    """
    path = resolve(name, "commands")
    root, mistakes = parse(as_written(path, str(path)), str(path))
    if "study" not in root.keys:
        return Request(path, name=name, commands_name=name)
    try:
        keys = StudyKeys.model_validate(root.plain())
    except ValidationError as error:
        mistakes += tell(error, "study", root, str(path))
    mistakes += setting_mistakes(root, str(path))
    mistakes += side_mistakes(root, str(path))
    mistakes += filter_mistakes(root, str(path))
    if mistakes:
        raise InputError(
            sorted(mistakes, key=lambda mistake: (mistake.place.line, mistake.place.column))
        )
    commands, commands_name = beside(path, keys.study, "commands", root)
    world, world_name = (
        (None, None) if keys.world is None else beside(path, keys.world, "worlds", root)
    )
    told = list(told_in(root, str(path)))
    fixed = tuple(one for route, values in told if route[0] != SWEEP for one in values)
    sweep = tuple(tuple(values) for route, values in told if route[0] == SWEEP)
    a, b = (tuple(side_of(root, side, str(path))) for side in SIDES)
    watching = tuple(filters_of(root, str(path)).values())
    return Request(
        commands, world, keys.runs, keys.seed, watching, fixed, sweep,
        keys.reading, keys.fast, a, b,
        keys.ekfsim, name, commands_name, world_name,
        None if keys.log is None else os.path.normpath(path.parent / keys.log),
    )  # fmt: skip


def beside(path: Path, named: str, folder: str, root: Node) -> tuple[Path, str]:
    """The file that a study file names, relative to itself or by its bare name, and how one names
    it on a command line.

    Raises InputError where there is none.
    """
    near = Path(os.path.normpath(path.parent / named))
    known = packaged("worlds" if folder == "worlds" else "commands")
    if named not in known or _is_there(near):
        try:
            as_written(near, str(near))
        except UsageError as error:
            if isinstance(error, InputError):
                return near, str(near)
            key = "world" if folder == "worlds" else "study"
            wrong, _, right = str(error).partition("; ")
            right = (
                right or "write its path relative to this file, or a name that `ekfsim list` shows"
            )
            raise InputError(
                [at(str(path), root.nearest((key,)).mark, (key,), wrong, right)]
            ) from None
        return near, str(near)
    return known[named], named


def _is_there(path: Path) -> bool:
    """Whether there is a file that could be meant;
    one that may not be looked at hides no name of ours.
    """
    try:
        return is_file(path)
    except OSError:
        return False


def told_in(root: Node, file: str) -> Iterator[tuple[Route, list[Setting]]]:
    """Where a study file tells a key, and the values it gives it;
    what is no number and no word is left out.
    """
    routes: list[tuple[Route, str]] = [(("set", key), key) for key in keys_of(root, "set")]
    routes += [((key,), key) for key in OF_COMMANDS if key in root.keys]
    routes += [((SWEEP, key), key) for key in keys_of(root, SWEEP)]
    for route, key in routes:
        node = root.nearest(route)
        places: list[Route] = (
            [(*route, n) for n in range(len(node.value))]
            if isinstance(node.value, list)
            else [route]
        )
        yield (
            route,
            [setting_at(root, place, key, file) for place in places if root.nearest(place).written],
        )


def keys_of(root: Node, name: str) -> Iterator[str]:
    """The keys of a mapping of the file; none where it has no such mapping."""
    yield from node.keys if (node := root.at((name,))) is not None else ()


def filters_of(root: Node, file: str) -> dict[int, str]:
    """The filters that watch, by their places in the list; what is no text is left out."""
    node = root.at((FILTERS_KEY,))
    listed = node.value if node is not None and isinstance(node.value, list) else []
    return {n: filter_beside(file, one.written) for n, one in enumerate(listed) if one.written}


def filter_mistakes(root: Node, file: str) -> Iterator[Mistake]:
    """Filters that stand twice, and those of one's own that are not there."""
    filters = filters_of(root, file)
    told = dict(zip(filters, alike(tuple(filters.values())), strict=True))
    for n in filters:
        route: Route = (FILTERS_KEY, n)
        node = root.nearest(route)
        if fault := told[n] or missing(file, node.written):
            yield at(file, node.mark, route, *fault)


def side_of(root: Node, side: str, file: str) -> Iterator[Setting]:
    """What a comparison's file sets for one of its sides, a or b."""
    for key in node.keys if (node := root.at((side,))) else ():
        one = setting_at(root, (side, key), key, file)
        yield replace(one, value=filter_beside(file, one.value)) if key == FILTER else one


def setting_at(root: Node, path: tuple[str | int, ...], key: str, file: str) -> Setting:
    """The setting that stands at a place of a study file."""
    node = root.nearest(path)
    place = Place(file, *node.mark)
    return Setting(key, node.written, f"{place}: {field_of(path)}", place)


def setting_mistakes(root: Node, file: str) -> Iterator[Mistake]:
    """Keys that no file has, keys that are told twice,
    and values that stand twice, each at its place.
    """
    told, faults = dict[str, str](), 0
    for route, values in told_in(root, file):
        key, mark = str(route[-1]), root.nearest(route[:-1]).keys[str(route[-1])]
        if values and (fault := fault_of(values[0], is_told=faults < MOST_TOLD)):
            faults += 1
            yield at(file, mark, route[:-1], *fault)
        if key in told:
            yield at(
                file,
                mark,
                route,
                f"{quoted(key)} is told already by '{told[key]}'",
                "keep one of them",
            )
        if (second := repeated(values)) is not None and second.place is not None:
            mark = second.place.line, second.place.column
            yield at(
                file,
                mark,
                (*route, values.index(second)),
                f"{short(second.value)} stands twice",
                "delete one",
            )
        told[key] = field_of(route)


def side_mistakes(root: Node, file: str) -> Iterator[Mistake]:
    """Keys that no file has in what the sides of a comparison set,
    and filters that there are not.
    """
    for side in SIDES:
        for one in side_of(root, side, file):
            if one.key == FILTER:
                node = root.nearest((side, FILTER))
                fault = missing(file, node.written)
                if not is_filter(node.written):
                    right = f"known: {', '.join(FILTERS)}, or one of your own: FILE.py"
                    fault = f"{quoted(node.written)} is no filter", right
                if fault:
                    yield at(file, node.mark, (side, FILTER), *fault)
            elif fault := fault_of(one):
                yield at(file, root.nearest((side,)).keys[one.key], (side,), *fault)
