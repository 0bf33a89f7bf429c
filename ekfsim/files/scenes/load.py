"""World and commands files → World and Scene; all mistakes of a file at once."""

import os
import warnings
from collections.abc import Iterator, Mapping, Sequence
from dataclasses import replace
from pathlib import Path

from ekfsim.errors import InputError, LogRemark, Mistake, UsageError
from ekfsim.files.given.given import Given, called, given_in
from ekfsim.files.keys.commands import (
    WAYS,
    CommandsKeys,
)
from ekfsim.files.keys.recorded.recording import WITH_LANDMARKS, RecordingKeys
from ekfsim.files.keys.worlds.world import WorldKeys
from ekfsim.files.packaged import packaged, resolve, source_name, world_beside
from ekfsim.files.scenes.building import world_of
from ekfsim.files.scenes.checking.doubts import kidnap_warnings, perfect_beam_warnings
from ekfsim.files.scenes.checking.drive_checks import check_fit
from ekfsim.files.scenes.checking.filter_checks import (
    check_filter_settings,
    filter_beside,
    filter_warnings,
    missing,
)
from ekfsim.files.scenes.checking.sound import Sound
from ekfsim.files.scenes.checking.system_checks import system_warnings
from ekfsim.files.scenes.logged import CLASSROOM, brought, with_log, world_of_log
from ekfsim.files.scenes.one_file import File, Loaded, in_order_of_place, read
from ekfsim.files.scenes.overruling import idle_on_log, is_about, of_log, refusal
from ekfsim.files.scenes.playing import scene_of
from ekfsim.files.scenes.settings import OF_LOGS, Setting, kind_of
from ekfsim.files.source import bytes_of
from ekfsim.files.yaml.telling import nearest
from ekfsim.printable import quoted
from ekfsim.scene import Scene
from ekfsim.systems.document import DocumentReading
from ekfsim.world import World


def load_world(world: str | Path | Mapping[str, object]) -> World:
    """The world that a file describes, or one that comes along by its bare name; or what a file
    would hold, as text of YAML or as a dict.

    Raises UsageError where there is no such file, InputError with all its mistakes.
    """
    return read_world(given_in(world) or resolve(path_in(world), "worlds")).get()


def load_scene(
    commands: str | Path | Mapping[str, object],
    world: str | Path | Mapping[str, object] | World | None = None,
    log: str | Path | None = None,
    reading: DocumentReading = "corrected",
) -> Scene:
    """The scene that a commands file describes, in its own world or the one given.

    A packaged file is found by its bare name. In place of a file stands what it would hold, as text
    of YAML or as a dict, whose `world` may be a World; what it names lies in the current folder.
    `log` stands in place of the one that the recording names; `reading` is that of the system's
    document.
    Raises UsageError where a file is missing, InputError with all mistakes of both files.
    """
    if isinstance(commands, Mapping) and isinstance(own := commands.get("world"), World):
        commands = {key: value for key, value in commands.items() if key != "world"}
        world = own if world is None else world
    given = given_in(commands) or resolve(path_in(commands), "commands")
    if world is not None and not isinstance(world, World):
        is_file = given_in(world) is None
        world = resolve(path_in(world), "worlds") if is_file else load_world(world)
    return _told(read_scene(given, world, log, reading)).get()


def _told(found: Loaded[Scene]) -> Loaded[Scene]:
    """The same; what is odd in a log, or was found before a mistake, as warnings of Python."""
    of_a_log = found.value is not None and found.value.log is not None
    for remark in found.warnings if of_a_log or found.value is None else ():
        warnings.warn(remark, LogRemark, stacklevel=3)
    return found


def path_in(what: object) -> str | Path:
    """The name of a file. Raises UsageError where it is no such thing."""
    if isinstance(what, str | Path):
        return what
    wrong = f"{quoted(type(what).__name__)} is neither a file nor what one holds"
    raise UsageError(f"{wrong}; give a path, a name of `ekfsim list`, text of YAML or a dict")


def read_world(
    path: str | Path | Given,
    shown: str | None = None,
    logged: bool = False,
    settings: Sequence[Setting] = (),
) -> Loaded[World]:
    """A world file, with its mistakes and warnings; `shown` is how messages name it. A log may
    bring its landmarks.

    Raises UsageError where there is no such file.
    """
    given = path if isinstance(path, Given) else Path(path)
    return world_in(read(given, shown or str(path), "world", settings), logged)


def world_in(file: File, logged: bool = False) -> Loaded[World]:
    """The world that was found in a file."""
    if not isinstance(file.keys, WorldKeys) or file.sound is None or file.mistakes:
        return Loaded(None, file.mistakes, file.warnings)
    world = world_of(file.keys)
    object.__setattr__(world, "given", file.given)
    doubts = (
        *system_warnings(file.sound, world, logged),
        *perfect_beam_warnings(file.sound, world),
    )
    return Loaded(world, [], [*file.warnings, *doubts])


def read_scene(
    path: str | Path | Given,
    world: str | Path | World | None = None,
    log: str | Path | None = None,
    reading: DocumentReading = "corrected",
    settings: Sequence[Setting] = (),
) -> Loaded[Scene]:
    """A commands file, its world and its log, with the mistakes and warnings of all.

    `settings` overrule both files. Raises UsageError where there is no such file,
    or where the settings make a mistake of what was none.
    """
    loaded = _read_scene(path, world, log, reading)
    of_recording = tuple(one for one in settings if one.key.startswith(f"{OF_LOGS}."))
    if of_recording and (loaded.mistakes or loaded.refusal):  # a log that is read as they say
        loaded = _read_scene(path, world, log, reading, of_recording)
        if any(is_about(mistake, of_recording) for mistake in loaded.mistakes):
            raise refusal(loaded.mistakes, of_recording)
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
    given: str | Path | Given,
    world: str | Path | World | None,
    log: str | Path | None,
    reading: DocumentReading,
    settings: Sequence[Setting] = (),
) -> Loaded[Scene]:
    """The same, whatever mistakes the settings make."""
    path = Path(given.shown if isinstance(given, Given) else given)
    file = read(given if isinstance(given, Given) else path, str(path), "commands", settings)
    keys = file.keys if isinstance(file.keys, CommandsKeys) else None
    handed_out = log is not None and keys is not None and keys.commands is not None
    if handed_out and log is not None and world is None:
        world = brought(Path(log))
    loaded = scene_in(file, path, world, settings, log)
    if loaded.value is not None:
        loaded = replace(loaded, value=replace(loaded.value, reading=reading))
    if handed_out:
        return with_log(loaded, file, RecordingKeys(format=CLASSROOM), path, log)
    if keys is not None and keys.recording is not None:
        return with_log(loaded, file, keys.recording, path, log)
    if keys is not None and log is not None and file.sound is not None:
        way = next(way for way in WAYS if way in file.sound.root.keys)
        wrong = f"the file has '{way}', not a recording"
        mistake = file.sound.mistake((way,), wrong, "--log has nothing to replace")
        return replace(loaded, mistakes=[*loaded.mistakes, mistake])
    return loaded


def scene_in(
    file: File,
    path: Path,
    world: str | Path | World | None = None,
    settings: Sequence[Setting] = (),
    log: str | Path | None = None,
) -> Loaded[Scene]:
    """The scene found in a file, in its own world or the one given; its log is not yet read."""
    sound, keys = file.sound, file.keys
    if sound is None:  # nothing can be read in it, not even its world
        return Loaded(mistakes=file.mistakes)
    told, along = list[str](), None
    if world is None and sound.root.at(("world",)) is None:
        recording = keys.recording if isinstance(keys, CommandsKeys) else None
        try:
            along = world_of_log(sound, recording, path, log, told)
        except InputError as error:
            return Loaded(None, [*file.mistakes, *error.mistakes], [*file.warnings, *told])
        except UsageError as error:
            return Loaded(None, file.mistakes, [*file.warnings, *told], error)
    logged = sound.value("recording", "format") in WITH_LANDMARKS
    missing, found = list[Mistake](), Loaded[World]()
    if isinstance(world, World):
        source, found = called(world), overruled(world, settings, logged)
    elif world is not None:
        source, found = source_name(world), read_world(world, None, logged, settings)
    elif along is not None:
        source = along.shown if isinstance(along, Given) else source_name(along)
        found = read_world(along, None, logged, settings)
    else:
        beside = world_beside(path, sound.value("world") or "")
        source, missing = source_name(beside), list(missing_world(sound, beside))
        if not missing and sound.value("world") is not None:
            found = read_world(beside, os.path.normpath(beside), logged, settings)
    misfits, kidnaps = list[Mistake](), list[str]()
    if found.value is not None:
        kidnaps += kidnap_warnings(sound, found.value.map)
    if found.value is not None and isinstance(keys, CommandsKeys):
        misfits += check_fit(sound, keys, found.value)
        misfits += check_filter_settings(sound, keys, found.value)
    own = sorted([*missing, *file.mistakes, *misfits], key=in_order_of_place)
    mistakes, warnings = [*own, *found.mistakes], [*file.warnings, *told, *kidnaps, *found.warnings]
    if mistakes or found.value is None or not isinstance(keys, CommandsKeys):
        return Loaded(None, mistakes, warnings)
    scene = scene_of(keys, found.value, source, source_name(path))
    own_filter, file_of_world = filter_beside(path, scene.filter), world_file(found.value)
    scene = replace(scene, filter=own_filter, world_file=file_of_world)
    return Loaded(scene, mistakes, warnings)


def world_file(world: World) -> Path | None:
    """The file that a world was read from; None where it was none."""
    given = world.given
    return Path(given.shown).absolute() if isinstance(given, Given) and given.is_file else None


def overruled(world: World, settings: Sequence[Setting], logged: bool = False) -> Loaded[World]:
    """A world that was read, with what the settings say of worlds; as it is, where they say
    nothing.

    Raises UsageError where it was not read, but made by `replace`.
    """
    own = [one for one in settings if kind_of(one) == "world"]
    if not own:
        return Loaded(world)
    if not isinstance(world.given, Given):
        wrong = f"the world {world.name!r} was not read, but put together by `replace`"
        right = "use with_ before `replace`, or make the world by World.of"
        raise UsageError(f"{own[0].told}: {wrong}; {right}")
    return read_world(world.given, None, logged, own)


def missing_world(sound: Sound, source: Path) -> Iterator[Mistake]:
    """A commands file that names no world, or one that cannot be read."""
    named = sound.value("world")
    if named is not None:
        try:
            bytes_of(source, named)
        except UsageError as error:
            wrong, _, right = str(error).partition("; ")
            near = nearest(named, list(packaged("worlds"))) if Path(named).name == named else ""
            right = right or (
                f"did you mean '{near}'?" if near else "write its path relative to this file"
            )
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
