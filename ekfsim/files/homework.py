"""A homework file → what is graded: its keys, and the scenes that it names."""

import hashlib
import os
from collections import Counter
from collections.abc import Iterable, Iterator, Mapping
from dataclasses import dataclass, field, replace
from pathlib import Path, PurePosixPath

from pydantic import ValidationError

from ekfsim.errors import InputError, Mistake, UsageError
from ekfsim.files.keys.commands import CommandsKeys
from ekfsim.files.keys.homework import CENTS, KINDS, HomeworkKeys, HomeworkPartKeys
from ekfsim.files.looking import exists, read_from
from ekfsim.files.packaged import resolve, world_beside
from ekfsim.files.scenes.load import read_scene
from ekfsim.files.scenes.one_file import Loaded, in_order_of_place, other_kind, read
from ekfsim.files.source import as_written
from ekfsim.files.yaml.marked import Node
from ekfsim.files.yaml.marked import Path as Route
from ekfsim.files.yaml.parsing import parse
from ekfsim.files.yaml.telling import at, tell
from ekfsim.printable import quoted
from ekfsim.scene import Scene
from ekfsim.version import VERSION

RIGHT = "write its path relative to this file, or a name that `ekfsim list` shows"


@dataclass(frozen=True)
class Homework:
    """What is graded."""

    path: Path
    keys: HomeworkKeys
    scenes: Mapping[str, Scene]  # by the names that the file has for them, seeded
    files: tuple[Path, ...]  # that it is made from, itself the first
    digest: str  # changes with what any result may depend on, but for the submission
    warnings: tuple[str, ...] = field(default=(), compare=False)


def read_homework(path: Path) -> Homework:
    """What a homework file asks for.

    Raises UsageError where there is no such file, InputError with all mistakes of it and of its
    scenes.
    """
    loaded = check_homework(path)
    return loaded.get()


def check_homework(path: Path) -> Loaded[Homework]:
    """The same, with its mistakes and warnings."""
    file = str(path)
    try:
        root, mistakes = parse(as_written(path, file), file)
    except InputError as error:
        return Loaded(mistakes=error.mistakes)
    if other := other_kind(root, "homework"):
        return Loaded(mistakes=[*mistakes, at(file, *other)])
    try:
        keys = HomeworkKeys.model_validate(root.plain())
    except ValidationError as error:
        mistakes += tell(error, "homework", root, file)
        return Loaded(mistakes=sorted(mistakes, key=in_order_of_place))
    mistakes += _between_keys(keys, root, file)
    found = _Scenes(path, root)
    for n, part in enumerate(keys.parts):
        for kind, names in _scenes_of(part):
            for k, name in enumerate(names):
                found.read(name, ("parts", n, kind, "scenes", k), kind)
    mistakes = [*sorted([*mistakes, *found.own], key=in_order_of_place), *found.others]
    if mistakes:
        return Loaded(mistakes=mistakes, warnings=found.warnings)
    scenes = {
        name: scene if keys.seed is None else replace(scene, seed=keys.seed)
        for name, scene in found.scenes.items()
    }
    files = (path, *dict.fromkeys(found.files))
    digest = digest_of(files)
    homework = Homework(path, keys, scenes, files, digest, tuple(found.warnings))
    return Loaded(homework, warnings=found.warnings)


def digest_of(files: Iterable[Path]) -> str:
    """The contents of files, and this version, as a word."""
    whole = hashlib.sha256(VERSION.encode())
    for path in files:
        whole.update(hashlib.sha256(path.read_bytes()).digest())
    return whole.hexdigest()


def _scenes_of(part: HomeworkPartKeys) -> Iterator[tuple[str, list[str]]]:
    for kind in ("steps", "jacobians", "honesty"):
        if (keys := getattr(part, kind)) is not None:
            yield kind, keys.scenes


def _between_keys(keys: HomeworkKeys, root: Node, file: str) -> Iterator[Mistake]:
    """Mistakes that no single key can tell."""

    def mistake(path: Route, wrong: str, right: str) -> Mistake:
        return at(file, root.nearest(path).mark, path, wrong, right)

    seen = Counter[str]()
    for n, part in enumerate(keys.parts):
        seen[part.name.casefold()] += 1
        if seen[part.name.casefold()] == 2:
            wrong = f"{quoted(part.name)} is the name of two parts"
            yield mistake(("parts", n, "name"), wrong, "rename one")
        given = [kind for kind in KINDS if getattr(part, kind) is not None]
        if len(given) != 1:
            wrong = f"a part has one of {', '.join(KINDS)}; this has "
            wrong += " and ".join(given) if given else "none"
            right = "make two parts of it" if given else "write e.g. steps: {scenes: [tour]}"
            yield mistake(("parts", n), wrong, right)
        if part.inputs is not None and part.inputs.files is part.inputs.exposed is None:
            yield mistake(
                ("parts", n, "inputs"), "asks for nothing", "write files: 3, or exposed: 100"
            )
        for k, name in enumerate(part.jacobians.functions if part.jacobians else ()):
            if keys.provided is None or name in keys.provided:
                handed = "everything" if keys.provided is None else name
                yield mistake(
                    ("parts", n, "jacobians", "functions", k),
                    f"{name} is to be written, and is handed out: motion and sensor provide "
                    f"{handed}",
                    f"write provided: [f, h, …] without {name}",
                )
    cents = sum(round(part.points * CENTS) for part in keys.parts)
    if cents != round(keys.total * CENTS):
        wrong = f"the points of the parts add up to {cents / CENTS:g}, not to {keys.total:g}"
        yield mistake(("total",), wrong, f"write total: {cents / CENTS:g}, or mend a part")
    if keys.filter is not None:
        parts = PurePosixPath(keys.filter).parts
        if os.path.isabs(keys.filter) or ".." in parts or not keys.filter.endswith(".py"):
            yield mistake(
                ("filter",), f"{quoted(keys.filter)} is no file of a folder", "write filter.py"
            )


class _Scenes:
    """The scenes that a homework file names, each read once."""

    def __init__(self, path: Path, root: Node) -> None:
        self.path, self.root = path, root
        self.scenes: dict[str, Scene] = {}
        self.files: list[Path] = []
        self.own: list[Mistake] = []  # of the homework file
        self.others: list[Mistake] = []  # of its scenes' files
        self.warnings: list[str] = []
        self.faulty: set[str] = set()  # names that are told of already

    def read(self, name: str, route: Route, kind: str) -> None:
        """Read a scene, once, and look whether it suits this kind of part."""
        if name in self.faulty:
            return
        try:
            if name not in self.scenes:
                self._add(name)
            if kind == "honesty" and self.scenes[name].log is not None:
                raise UsageError(f"{name}: is a recording, which is one run only; name another")
        except InputError as error:
            self.faulty.add(name)
            self.others += error.mistakes
        except UsageError as error:
            self.faulty.add(name)
            wrong, _, right = str(error).partition("; ")
            mark = self.root.nearest(route).mark
            self.own.append(at(str(self.path), mark, route, wrong, right or RIGHT))

    def _add(self, name: str) -> None:
        near = Path(os.path.normpath(self.path.parent / name))
        is_bare = not near.suffix and os.sep not in name
        with read_from(near):
            commands = resolve(name, "commands") if is_bare and not exists(near) else near
        loaded = read_scene(commands)
        self.scenes[name] = loaded.get()
        self.warnings += [told for told in loaded.warnings if told not in self.warnings]
        self.files += files_of(commands)


def files_of(commands: Path) -> list[Path]:
    """The files that a sound scene is made from: its commands, its world, those of its log."""
    keys = read(commands, str(commands), "commands").keys
    assert isinstance(keys, CommandsKeys)
    found = [commands, Path(os.path.normpath(world_beside(commands, keys.world or "")))]
    if keys.recording is not None and keys.recording.path is not None:
        log = Path(os.path.normpath(commands.parent / keys.recording.path))
        found += sorted(p for p in log.rglob("*") if p.is_file()) if log.is_dir() else [log]
    return found
