"""A scene whose run was recorded: its log, and the world that a log may bring."""

import fnmatch
import os
from dataclasses import replace
from pathlib import Path
from typing import NamedTuple

from ekfsim.errors import InputError, UsageError
from ekfsim.files.given.given import Given
from ekfsim.files.keys.recorded.recording import ANY, BAG, OF_ANY_ROBOT, LogFormat, RecordingKeys
from ekfsim.files.looking import is_folder, read_from
from ekfsim.files.packaged import source_name
from ekfsim.files.scenes.checking.sound import Sound
from ekfsim.files.scenes.one_file import File, Loaded
from ekfsim.scene import Scene

CLASSROOM: LogFormat = "classroom"  # whose logs bring their world
WORLD = "world.yaml"  # of a log that has one


class LogGiven(NamedTuple):
    """Where a log was read from, and as what."""

    recording: RecordingKeys
    source: str


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
    source = os.path.normpath(log if log is not None else path.parent / (recording.path or ""))
    warnings = list(loaded.warnings)
    try:
        recording = recognised(recording, source, warnings)
        scene = read_into(scene, recording, source, warnings)
    except InputError as error:
        return replace(loaded, mistakes=list(error.mistakes), warnings=warnings)
    except UsageError as error:
        if log is not None:
            return replace(loaded, warnings=warnings, refusal=error)
        wrong, _, right = str(error).partition("; ")
        right = right or "write its path relative to this file, or give one with --log"
        mistake = sound.mistake(("recording", "path"), wrong, right)
        return replace(loaded, mistakes=[mistake], warnings=warnings)
    return replace(loaded, value=scene, warnings=warnings)


def recognised(recording: RecordingKeys, source: str, warnings: list[str]) -> RecordingKeys:
    """The recording as it is to be read: by the format `log` where the files of that lie there, and
    none of those of the format that is named. `warnings` tell.
    """
    format, place = recording.format, Path(source)
    if format in (CLASSROOM, *OF_ANY_ROBOT):
        return recording
    from ekfsim.files.logs import DECLARED

    motion, readings, *_ = (table.files[0] for table in DECLARED[ANY].tables)
    with read_from(place):
        names = os.listdir(place) if is_folder(place) else []
    needed = [table.files for table in DECLARED[format].tables if table.needed]
    own = [any(fnmatch.filter(names, pattern) for pattern in files) for files in needed]
    is_other = DECLARED[format].alone or not all(own)
    if not (is_other and fnmatch.filter(names, motion) and fnmatch.filter(names, readings)):
        return recording
    told = f"holds {motion.replace('*', '')} and no log of the format {format}: read as format: log"
    if WORLD in names:
        told += f", in the scene's world; that of the log is --world {place / WORLD}"
    warnings.append(f"{source}: {told}")
    return recording.model_copy(update={"format": ANY})


def read_into(scene: Scene, recording: RecordingKeys, source: str, warnings: list[str]) -> Scene:
    """A scene with the log that lies there, and with the landmarks that it tells.

    Raises UsageError where there is no such log, InputError with what is wrong in it.
    """
    from ekfsim.files.logs import read_log

    world = scene.world
    found = read_log(recording, Path(source), world, scene.reading, warnings)
    object.__setattr__(found.log, "given", LogGiven(recording, source))
    if found.landmarks is not None:
        world = replace(world, landmarks=found.landmarks)
        object.__setattr__(world, "given", scene.world.given)
    return replace(scene, commands=(), world=world, log=found.log, log_source=source_name(source))


def world_of_log(
    sound: Sound,
    recording: RecordingKeys | None,
    path: Path,
    log: str | Path | None,
    warnings: list[str],
) -> Path | Given | None:
    """The world that a log brings, or that is made for it, as `warnings` tell; None where there is
    neither, or no log is named.
    """
    format, named = sound.value("recording", "format"), sound.value("recording", "path")
    unread = recording is None  # for there are mistakes in its keys, which are told
    if format in OF_ANY_ROBOT and (unread or (log is None and named is None)):
        from ekfsim.files.logs.bags import made_world as of_bags
        from ekfsim.files.logs.named import made_world as of_logs

        return of_bags.any_world() if format == BAG else of_logs.any_world()
    if format not in (CLASSROOM, *OF_ANY_ROBOT) or (log is None and named is None):
        return None
    place = Path(os.path.normpath(log if log is not None else path.parent / named))
    if format == CLASSROOM:
        return brought(place)
    if format == BAG:
        from ekfsim.files.logs.bags.made_world import world_of_bag

        return world_of_bag(place, recording or RecordingKeys(format=BAG), warnings)
    from ekfsim.files.logs.named.made_world import world_brought

    return world_brought(place, recording or RecordingKeys(format=ANY), warnings)


def brought(log: Path) -> Path:
    """The world in a classroom's log. Raises UsageError where there is no such folder."""
    from ekfsim.files.logs.folder import find, folder_of
    from ekfsim.files.logs.formats.classroom import HOLDS, WORLD

    return find(folder_of(log, HOLDS), "the map and the ratios", WORLD)
