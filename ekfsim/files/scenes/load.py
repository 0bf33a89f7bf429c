"""World and commands files → World and Scene; all mistakes of a file at once."""

import os
from collections.abc import Iterator, Sequence
from dataclasses import dataclass, field, replace
from pathlib import Path
from typing import Generic, TypeVar

from ekfsim.errors import InputError, Mistake, UsageError
from ekfsim.files.keys.commands import (
    WAYS,
    WITH_LANDMARKS,
    CommandsKeys,
    LogFormat,
    RecordingKeys,
)
from ekfsim.files.keys.world import WorldKeys
from ekfsim.files.packaged import resolve, source_name, world_beside
from ekfsim.files.scenes.building import scene_of, world_of
from ekfsim.files.scenes.checks import Sound, kidnap_warnings, perfect_beam_warnings
from ekfsim.files.scenes.drive_checks import check_fit
from ekfsim.files.scenes.filter_checks import (
    check_filter_settings,
    filter_beside,
    filter_warnings,
    missing,
)
from ekfsim.files.scenes.one_file import File, in_order_of_place, read
from ekfsim.files.scenes.overruling import idle_on_log, of_log, refusal
from ekfsim.files.scenes.settings import Setting
from ekfsim.files.scenes.system_checks import system_warnings
from ekfsim.files.source import bytes_of
from ekfsim.scene import Scene
from ekfsim.systems.document import DocumentReading
from ekfsim.world import World

T = TypeVar("T")
CLASSROOM: LogFormat = "classroom"  # whose logs bring their world


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
    if not isinstance(file.keys, WorldKeys) or file.sound is None or file.mistakes:
        return Loaded(None, file.mistakes, file.warnings)
    world = world_of(file.keys)
    doubts = (
        *system_warnings(file.sound, world, logged),
        *perfect_beam_warnings(file.sound, world),
    )
    return Loaded(world, [], [*file.warnings, *doubts])


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
    if loaded.value is None:
        return loaded
    idle = idle_on_log(settings) if loaded.value.log is not None else ()
    scene = replace(loaded.value, settings=tuple(map(str, settings)))
    return replace(loaded, value=scene, warnings=[*loaded.warnings, *idle])


def _read_scene(
    path: str | Path,
    world: str | Path | None,
    log: str | Path | None,
    reading: DocumentReading,
    settings: Sequence[Setting] = (),
) -> Loaded[Scene]:
    """The same, whatever mistakes the settings make."""
    file = read(Path(path), str(path), "commands", settings)
    keys = file.keys if isinstance(file.keys, CommandsKeys) else None
    handed_out = log is not None and keys is not None and keys.commands is not None
    if handed_out and log is not None and world is None:
        world = _brought(Path(log))
    loaded = scene_in(file, Path(path), world, settings, log)
    if loaded.value is not None:
        loaded = replace(loaded, value=replace(loaded.value, reading=reading))
    if handed_out:
        return with_log(loaded, file, RecordingKeys(format=CLASSROOM), Path(path), log)
    if keys is not None and keys.recording is not None:
        return with_log(loaded, file, keys.recording, Path(path), log)
    if keys is not None and log is not None and file.sound is not None:
        way = next(way for way in WAYS if way in file.sound.root.keys)
        wrong = f"the file has '{way}', not a recording"
        mistake = file.sound.mistake((way,), wrong, "--log has nothing to replace")
        return replace(loaded, mistakes=[*loaded.mistakes, mistake])
    return loaded


def with_log(
    loaded: Loaded[Scene],
    file: File,
    recording: RecordingKeys,
    path: Path,
    log: str | Path | None,
) -> Loaded[Scene]:
    """A scene with its log: entries, landmarks where it tells any, mistakes and warnings."""
    sound, scene = file.sound, loaded.value
    assert sound is not None
    if log is None and recording.path is None:
        wrong = "the recording names no path"
        mistake = sound.mistake(("recording",), wrong, "give one with --log")
        return replace(loaded, mistakes=[*loaded.mistakes, mistake])
    if scene is None or loaded.mistakes:
        return loaded
    from ekfsim.files.logs import read_log

    source = os.path.normpath(log if log is not None else path.parent / (recording.path or ""))
    warnings = list(loaded.warnings)
    try:
        found = read_log(recording.format, Path(source), scene.world, scene.reading, warnings)
    except InputError as error:
        return replace(loaded, mistakes=list(error.mistakes), warnings=warnings)
    except UsageError as error:
        if log is not None:
            return replace(loaded, warnings=warnings, refusal=error)
        wrong, _, right = str(error).partition("; ")
        right = right or "write its path relative to this file, or give one with --log"
        mistake = sound.mistake(("recording", "path"), wrong, right)
        return replace(loaded, mistakes=[mistake], warnings=warnings)
    world = scene.world
    if found.landmarks is not None:
        world = replace(world, landmarks=found.landmarks)
    scene = replace(scene, commands=(), world=world, log=found.log, log_source=source_name(source))
    return replace(loaded, value=scene, warnings=warnings)


def scene_in(
    file: File,
    path: Path,
    world: str | Path | None = None,
    settings: Sequence[Setting] = (),
    log: str | Path | None = None,
) -> Loaded[Scene]:
    """The scene found in a file, in its own world or the one given; its log is not yet read."""
    sound, keys = file.sound, file.keys
    if sound is None:  # nothing can be read in it, not even its world
        return Loaded(mistakes=file.mistakes)
    if world is None and sound.root.at(("world",)) is None:
        world = _world_of_log(sound, path, log)
    if world is not None:
        source, shown, missing = Path(world), str(world), list[Mistake]()
    else:
        source = world_beside(path, sound.value("world") or "")
        shown, missing = os.path.normpath(source), list(missing_world(sound, source))
    found = Loaded[World]()
    if not missing and (world is not None or sound.value("world") is not None):
        logged = sound.value("recording", "format") in WITH_LANDMARKS
        found = read_world(source, shown, logged, settings)
    misfits, kidnaps = list[Mistake](), list[str]()
    if found.value is not None:
        kidnaps += kidnap_warnings(sound, found.value.map)
    if found.value is not None and isinstance(keys, CommandsKeys):
        misfits += check_fit(sound, keys, found.value)
        misfits += check_filter_settings(sound, keys, found.value)
    own = sorted([*missing, *file.mistakes, *misfits], key=in_order_of_place)
    mistakes, warnings = [*own, *found.mistakes], [*file.warnings, *kidnaps, *found.warnings]
    if mistakes or found.value is None or not isinstance(keys, CommandsKeys):
        return Loaded(None, mistakes, warnings)
    scene = scene_of(keys, found.value, source_name(source), source_name(path))
    scene = replace(scene, filter=filter_beside(path, scene.filter), world_file=source.absolute())
    return Loaded(scene, mistakes, warnings)


def _world_of_log(sound: Sound, path: Path, log: str | Path | None) -> Path | None:
    """The world that a log brings, None where it brings none, or no log is named."""
    named = sound.value("recording", "path")
    if sound.value("recording", "format") != CLASSROOM or (log is None and named is None):
        return None
    return _brought(Path(os.path.normpath(log if log is not None else path.parent / named)))


def _brought(log: Path) -> Path:
    """The world in a classroom's log. Raises UsageError where there is no such folder."""
    from ekfsim.files.logs.folder import find, folder_of
    from ekfsim.files.logs.formats.classroom import HOLDS, WORLD

    return find(folder_of(log, HOLDS), "the map and the ratios", WORLD)


def missing_world(sound: Sound, source: Path) -> Iterator[Mistake]:
    """A commands file that names no world, or one that cannot be read."""
    named = sound.value("world")
    if named is not None:
        try:
            bytes_of(source, named)
        except UsageError as error:
            wrong, _, right = str(error).partition("; ")
            right = right or "write its path relative to this file"
            yield sound.mistake(("world",), wrong, right)
    elif sound.root.at(("world",)) is None:
        right = "write e.g. world: ../worlds/classroom.yaml, or name one with --world"
        yield sound.mistake((), "the scene has no world", right)


def check(path: str | Path) -> Loaded[World] | Loaded[Scene]:
    """All mistakes and warnings of a file of either kind, and of the world and log that it names.

    Raises UsageError where there is no such file.
    """
    file = read(Path(path), str(path), None)
    if file.kind == "world":
        return world_in(file)
    loaded, keys = scene_in(file, Path(path)), file.keys
    if not isinstance(keys, CommandsKeys) or file.sound is None:
        return loaded
    absent = missing(path, keys.filter)
    if absent is not None:
        loaded.mistakes.append(file.sound.mistake(("filter",), *absent))
    loaded = replace(loaded, warnings=[*loaded.warnings, *filter_warnings(file.sound, keys)])
    if keys.recording is None or keys.recording.path is None:
        return loaded
    return with_log(loaded, file, keys.recording, Path(path), None)
