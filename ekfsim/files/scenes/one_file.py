"""One file → its keys, with all its mistakes and warnings; what it refers to is not read."""

from collections.abc import Sequence
from dataclasses import dataclass, field
from pathlib import Path
from typing import Generic, TypeVar

from pydantic import BaseModel, ValidationError

from ekfsim.errors import InputError, Mistake, Place, UsageError
from ekfsim.files.foreign import of_text
from ekfsim.files.given.given import Given
from ekfsim.files.keys.commands import WAYS
from ekfsim.files.keys.fields import aliases
from ekfsim.files.keys.worlds.world import WorldKeys
from ekfsim.files.scenes.checking.command_checks import check_commands
from ekfsim.files.scenes.checking.doubts import angle_warnings
from ekfsim.files.scenes.checking.drive_checks import check_ways
from ekfsim.files.scenes.checking.sound import Sound
from ekfsim.files.scenes.checking.system_checks import check_system
from ekfsim.files.scenes.checking.world_checks import check_world
from ekfsim.files.scenes.overruling import overruled, pinned, remark
from ekfsim.files.scenes.settings import Setting
from ekfsim.files.source import as_written
from ekfsim.files.yaml.marked import Mark, Node
from ekfsim.files.yaml.marked import Path as Route
from ekfsim.files.yaml.parsing import parse, without_collection
from ekfsim.files.yaml.schema import Kind, model_of
from ekfsim.files.yaml.telling import at, details_of, tell

T = TypeVar("T")
ONLY_IN_WORLDS = {*aliases(WorldKeys).values()} - {"description"}


@dataclass(frozen=True)
class File:
    """What was found in a file of either kind."""

    kind: Kind
    mistakes: list[Mistake]
    sound: Sound | None = None  # None where nothing in the file can be told apart
    keys: BaseModel | None = None  # None where a key is wrong
    warnings: list[str] = field(default_factory=list)
    given: Given | None = None  # what it was read from, and by which settings it is overruled


@dataclass
class Loaded(Generic[T]):
    """What a file holds, or the mistakes in it; and the warnings."""

    value: T | None = None
    mistakes: list[Mistake] = field(default_factory=list)
    warnings: list[str] = field(default_factory=list)
    refusal: UsageError | None = None  # of the log that was named, which is no file's mistake

    def get(self) -> T:
        """The value. Raises InputError with all mistakes, or what the log was refused with; what is
        odd goes with it.
        """
        if self.value is not None and not self.mistakes and self.refusal is None:
            return self.value
        error = InputError(self.mistakes) if self.refusal is None else self.refusal
        error.remarks = tuple(self.warnings)
        raise error


@without_collection()
def read(
    path: Path | Given, shown: str, kind: Kind | None, settings: Sequence[Setting] = ()
) -> File:
    """Read a file, or what stands in place of one, as one of a kind, or as what it is.

    Raises UsageError where there is none.
    """
    try:
        given = path if isinstance(path, Given) else Given.file(path, shown)
        root, mistakes = given.tree()
    except InputError as error:
        return File(kind or "world", foreign_in(path, shown) or error.mistakes)
    given = given.overruled(tuple(settings))
    shown, settings = given.shown, given.settings
    kind = kind or kind_of_tree(root)
    if other := other_kind(root, kind):
        return File(kind, foreign_in(path, shown) or [*mistakes, at(shown, *other)])
    warnings = [] if kind == "commands" else list(pinned(root, settings))
    root = overruled(root, kind, settings)
    keys, wrong = None, set[tuple[str | int, ...]]()
    try:
        keys = model_of(kind).model_validate(root.plain())
    except ValidationError as error:
        mistakes += tell(error, kind, root, shown)
        wrong = {detail["loc"] for detail in details_of(error)}
    sound = Sound(shown, root, wrong)
    mistakes += (
        (*check_world(sound), *check_system(sound))
        if kind == "world"
        else (*check_commands(sound), *check_ways(sound))
    )
    if mistakes and (plan := foreign_in(path, shown)):
        return File(kind, plan)
    warnings += [remark(warning, settings) for warning in angle_warnings(sound)]
    return File(kind, sorted(mistakes, key=in_order_of_place), sound, keys, warnings, given)


def foreign_in(path: Path | Given, shown: str) -> list[Mistake]:
    """What a file is that is none of ours, and what reads it; nothing where it may be one."""
    from ekfsim.files.maps.reading import plan_in

    if isinstance(path, Given):
        return []
    if (plan := plan_in(path, shown)) is not None:
        wrong, _, right = plan.removeprefix(f"{shown}: ").partition("; ")
        return [Mistake(Place(shown), "", wrong, right)]
    try:
        found = of_text(as_written(path, shown))
    except UsageError:
        return []
    return [Mistake(Place(shown), "", f"this is {found.what}", found.cure)] if found else []


def kind_of(path: str | Path) -> Kind:
    """Of which kind a file is. Raises UsageError or InputError where it cannot be read."""
    root, _ = parse(as_written(Path(path), str(path)), str(path))
    return kind_of_tree(root)


def other_kind(root: Node, kind: Kind) -> tuple[Mark, Route, str, str] | None:
    """Why a file is not of the kind that is wanted: place and field, what is wrong, what right."""
    if not isinstance(root.value, dict):
        held = "a list" if isinstance(root.value, list) else "no 'key: value'"
        return root.mark, (), f"the file holds {held}", "see `ekfsim new` for one to start from"
    if kind != "homework" and kind_of_tree(root) == "homework":
        right = "run it with `ekfsim grade`, or name another file here"
        return root.mark, (), "this is a homework file", right
    if kind == "homework" and kind_of_tree(root) != "homework":
        right = "its first key is homework: TITLE; see `ekfsim new homework.yaml`"
        return root.mark, (), "this is no homework file", right
    if kind != "study" and kind_of_tree(root) == "study":
        right = "run it with `ekfsim study`, or name another file here"
        return root.mark, (), "this is a study file", right
    if kind == "world" and kind_of_tree(root) == "commands":
        return root.mark, (), "this is a commands file", "name a world file here"
    if kind == "commands" and kind_of_tree(root) == "world" and root.keys.keys() & ONLY_IN_WORLDS:
        wrong = "this is a world file: it has no 'commands'"
        return root.mark, (), wrong, "name a commands file here"
    return None


def kind_of_tree(root: Node) -> Kind:
    """The kind of a file, by its keys; what names its world is none, even with nothing to do."""
    keys = root.keys.keys()
    if "homework" in keys or "parts" in keys:  # the title may be what is missing
        return "homework"
    if "study" in keys:
        return "study"
    is_world = keys.isdisjoint(WAYS) and ("world" not in keys or keys & ONLY_IN_WORLDS)
    return "world" if is_world else "commands"


def in_order_of_place(mistake: Mistake) -> tuple[int, int]:
    """Mistakes are told in the order of the file."""
    return mistake.place.line, mistake.place.column
