"""World and commands files → World and Scene; all mistakes of a file at once."""

import os
from collections.abc import Sequence
from dataclasses import dataclass, field, replace
from pathlib import Path
from typing import Generic, TypeVar

from ekfsim.errors import InputError, Mistake, UsageError
from ekfsim.files.keys.commands import WAYS, WITH_LANDMARKS, CommandsKeys, RecordingKeys
from ekfsim.files.keys.world import WorldKeys
from ekfsim.files.packaged import resolve, source_name, world_beside
from ekfsim.files.scenes.building import scene_of, world_of
from ekfsim.files.scenes.checks import (
    kidnap_warnings,
    perfect_beam_warnings,
)
from ekfsim.files.scenes.drive_checks import check_fit
from ekfsim.files.scenes.filter_checks import check_filter_settings, filter_warnings
from ekfsim.files.scenes.one_file import File, in_order_of_place, read
from ekfsim.files.scenes.overruling import (
    idle_on_log,
    of_log,
    refusal,
)
from ekfsim.files.scenes.settings import Setting
from ekfsim.files.scenes.system_checks import system_warnings
from ekfsim.files.source import bytes_of
from ekfsim.scene import Scene
from ekfsim.systems.document import DocumentReading
from ekfsim.world import World

T = TypeVar("T")


@dataclass
class Loaded(Generic[T]):
    """What a file holds, or the mistakes in it; and the warnings."""

    value: T | None = None
    mistakes: list[Mistake] = field(default_factory=list)
    warnings: list[str] = field(default_factory=list)
    refusal: UsageError | None = None  # of the log that was named, which is no file's mistake

    def get(self) -> T:
        """The value. Raises InputError with all mistakes, or what the log was refused with."""
        if self.refusal is not None:
            raise self.refusal
        if self.value is None or self.mistakes:
            raise InputError(self.mistakes)
        return self.value


def load_world(path: str | Path) -> World:
    """The world that a file describes, or one that comes along by its bare name.

    Raises UsageError where there is no such file, InputError with all its mistakes.
    """
    return read_world(resolve(path, "worlds")).get()


def load_scene(
    path: str | Path,
    world: str | Path | None = None,
    log: str | Path | None = None,
    reading: DocumentReading = "corrected",
) -> Scene:
    """The scene that a commands file describes, in its own world or the one given.

    A packaged file is found by its bare name. `log` stands in place of the one that the file's
    recording names; `reading` is that of the system's document.
    Raises UsageError where a file is missing, InputError with all mistakes of both files.
    """
    world = None if world is None else resolve(world, "worlds")
    return read_scene(resolve(path, "commands"), world, log, reading).get()


def read_world(
    path: str | Path,
    shown: str | None = None,
    logged: bool = False,
    settings: Sequence[Setting] = (),
) -> Loaded[World]:
    """A world file, with its mistakes and warnings; `shown` is how messages name it. A log may
    bring its landmarks.

    Raises UsageError where there is no such file.
    """
    return world_in(read(Path(path), shown or str(path), "world", settings), logged)


def world_in(file: File, logged: bool = False) -> Loaded[World]:
    """The world that was found in a file."""
    loaded = Loaded[World](mistakes=file.mistakes, warnings=file.warnings)
    if isinstance(file.keys, WorldKeys) and file.sound is not None and not file.mistakes:
        loaded.value = world_of(file.keys)
        loaded.warnings += system_warnings(file.sound, loaded.value, logged)
        loaded.warnings += perfect_beam_warnings(file.sound, loaded.value)
    return loaded


def read_scene(
    path: str | Path,
    world: str | Path | None = None,
    log: str | Path | None = None,
    reading: DocumentReading = "corrected",
    settings: Sequence[Setting] = (),
) -> Loaded[Scene]:
    """A commands file, its world and its log, with the mistakes and warnings of all.

    `settings` overrule both files. Raises UsageError where there is no such file,
    or where the settings make a mistake of what was none.
    """
    loaded = _read_scene(path, world, log, reading)
    if not settings or loaded.mistakes or loaded.refusal:
        return loaded
    on_log = loaded.value is not None and loaded.value.log is not None
    meant = of_log(settings) if on_log else settings
    loaded = _read_scene(path, world, log, reading, meant)
    if loaded.mistakes:
        raise refusal(loaded.mistakes, meant)
    if loaded.value is not None:
        if loaded.value.log is not None:
            loaded.warnings += idle_on_log(settings)
        loaded.value = replace(loaded.value, settings=tuple(map(str, settings)))
    return loaded


def _read_scene(
    path: str | Path,
    world: str | Path | None,
    log: str | Path | None,
    reading: DocumentReading,
    settings: Sequence[Setting] = (),
) -> Loaded[Scene]:
    """The same, whatever mistakes the settings make."""
    file = read(Path(path), str(path), "commands", settings)
    loaded = scene_in(file, Path(path), world, settings)
    keys = file.keys if isinstance(file.keys, CommandsKeys) else None
    if loaded.value is not None:
        loaded.value = replace(loaded.value, reading=reading)
    if keys is not None and keys.recording is not None:
        recorded(loaded, file, keys.recording, Path(path), log)
    elif keys is not None and log is not None and file.sound is not None:
        way = next(way for way in WAYS if way in file.sound.root.keys)
        wrong = f"the file has '{way}', not a recording"
        loaded.mistakes.append(file.sound.mistake((way,), wrong, "--log has nothing to replace"))
    return loaded


def recorded(
    loaded: Loaded[Scene],
    file: File,
    recording: RecordingKeys,
    path: Path,
    log: str | Path | None,
) -> None:
    """Read the log of a scene: entries, landmarks where it tells any, mistakes and warnings."""
    sound, scene = file.sound, loaded.value
    assert sound is not None
    if log is None and recording.path is None:
        wrong = "the recording names no path"
        loaded.mistakes.append(sound.mistake(("recording",), wrong, "give one with --log"))
    if scene is None or loaded.mistakes:
        return
    from ekfsim.files.logs import read_log

    source = os.path.normpath(log if log is not None else path.parent / (recording.path or ""))
    try:
        found = read_log(
            recording.format, Path(source), scene.world, scene.reading, loaded.warnings
        )
    except InputError as error:
        loaded.mistakes += error.mistakes
        return
    except UsageError as error:
        if log is not None:
            loaded.refusal = error
            return
        wrong, _, right = str(error).partition("; ")
        right = right or "write its path relative to this file, or give one with --log"
        loaded.mistakes.append(sound.mistake(("recording", "path"), wrong, right))
        return
    world = (
        scene.world if found.landmarks is None else replace(scene.world, landmarks=found.landmarks)
    )
    loaded.value = replace(scene, world=world, log=found.log, log_source=source_name(source))


def scene_in(
    file: File, path: Path, world: str | Path | None = None, settings: Sequence[Setting] = ()
) -> Loaded[Scene]:
    """The scene found in a file, in its own world or the one given; its log is not yet read."""
    if file.sound is None:  # nothing can be read in it, not even its world
        return Loaded(mistakes=file.mistakes)
    source = (
        Path(world) if world is not None else world_beside(path, file.sound.value("world") or "")
    )
    logged = file.sound.value("recording", "format") in WITH_LANDMARKS
    if world is not None:
        found = read_world(source, logged=logged, settings=settings)
    else:
        found = own_world(file, source, logged, settings)
    if isinstance(file.keys, CommandsKeys) and found.value is not None:
        file.mistakes += check_fit(file.sound, file.keys, found.value)
        file.mistakes += check_filter_settings(file.sound, file.keys, found.value)
        file.mistakes.sort(key=in_order_of_place)
    kidnaps = kidnap_warnings(file.sound, found.value.map) if found.value is not None else ()
    warnings = [*file.warnings, *kidnaps, *found.warnings]
    loaded = Loaded[Scene](mistakes=[*file.mistakes, *found.mistakes], warnings=warnings)
    if isinstance(file.keys, CommandsKeys) and found.value is not None and not loaded.mistakes:
        loaded.value = scene_of(file.keys, found.value, source_name(source), source_name(path))
    return loaded


def own_world(
    file: File, source: Path, logged: bool, settings: Sequence[Setting] = ()
) -> Loaded[World]:
    """The world that a commands file names. A missing one is a mistake in that file."""
    sound = file.sound
    assert sound is not None
    named = sound.value("world")
    if named is None:
        if sound.root.at(("world",)) is None:
            right = "write e.g. world: ../worlds/classroom.yaml, or name one with --world"
            file.mistakes.insert(0, sound.mistake((), "the scene has no world", right))
        return Loaded()
    try:
        bytes_of(source, named)
    except UsageError as error:
        wrong, _, right = str(error).partition("; ")
        file.mistakes.append(
            sound.mistake(("world",), wrong, right or "write its path relative to this file")
        )
        file.mistakes.sort(key=in_order_of_place)
        return Loaded()
    return read_world(source, os.path.normpath(source), logged, settings)


def check(path: str | Path) -> Loaded[World] | Loaded[Scene]:
    """All mistakes and warnings of a file of either kind, and of the world and log that it names.

    Raises UsageError where there is no such file.
    """
    file = read(Path(path), str(path), None)
    if file.kind == "world":
        return world_in(file)
    loaded = scene_in(file, Path(path))
    if isinstance(file.keys, CommandsKeys) and file.sound is not None:
        loaded.warnings += filter_warnings(file.sound, file.keys)
    if (
        isinstance(file.keys, CommandsKeys)
        and file.keys.recording is not None
        and file.keys.recording.path is not None
    ):
        recorded(loaded, file, file.keys.recording, Path(path), None)
    return loaded
