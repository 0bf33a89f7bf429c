"""A simulated run → the files of a recorded log,
from which the filter makes the same numbers again.
"""

from collections.abc import Iterable
from dataclasses import replace
from pathlib import Path

import numpy as np

from ekfsim.errors import UsageError
from ekfsim.files.keys.recorded.recording import ANY
from ekfsim.files.logs.writing import named
from ekfsim.files.logs.writing.handed_out import hand_out
from ekfsim.files.logs.writing.own import WRITERS
from ekfsim.files.logs.writing.ticks import Run
from ekfsim.files.logs.writing.told_world import refuse_start
from ekfsim.files.results.writing import whole_folder
from ekfsim.provenance import told_in_a_line
from ekfsim.records import Entry
from ekfsim.scene import Scene

ALL_FILES = ("*.csv", "*.txt", "world.yaml")  # what `--force` may replace
CLASSROOM = "classroom"
OWN = "own"  # the format of the robot's own logs, whatever it is called
CHOICES = (ANY, OWN, *WRITERS, CLASSROOM)


def write_log(
    scene: Scene,
    entries: Iterable[Entry],
    out: Path,
    force: bool,
    with_truth: bool = False,
    format: str | None = None,
) -> list[str]:
    """Write a simulated run into a folder, and return the sentences that its reader should know.

    format : of CHOICES; where none is named, that of a classroom, and `log` of all that drives
    Raises UsageError where the scene is no simulation, has no such format, or the folder may not be
    written.
    """
    if scene.log is not None:
        raise UsageError(f"{scene.commands_source}: is a recorded log already; name a simulation")
    format = format_of(scene, format)
    if format == CLASSROOM:
        hand_out(scene, entries, out, force, with_truth)
        return []
    if with_truth:
        wrong = f"--truth: a log of the system '{scene.world.system}' holds the truth in any case"
        raise UsageError(f"{wrong}; leave this out")
    if format == ANY:
        refuse_start(scene)
    with whole_folder(out, *ALL_FILES, force=force) as folder:
        run = Run.of(entries)
        own = named.files_of(scene, run) if format == ANY else WRITERS[format](scene, run, out)
        about = f"A recorded log: {told_in_a_line(_as_told(scene))}\n"
        for name, text in {**own, "about.txt": about}.items():
            (folder / name).write_text(text, encoding="utf-8")
    return named.differences(scene, run) if format == ANY else _differences(scene, run)


def format_of(scene: Scene, asked: str | None) -> str:
    """The format in which a run is written. Raises UsageError where it has not the one asked."""
    system = scene.world.system
    own = CLASSROOM if scene.commanded else system if system in WRITERS else None
    if asked is None:
        return CLASSROOM if scene.commanded else ANY
    if asked == ANY and scene.commanded:
        wrong = "what a classroom's robot does has no time, and every row of this format has one"
        raise UsageError(f"--format {ANY}: {wrong}; leave this out")
    if asked == ANY or (own is not None and asked in (OWN, own)):
        return ANY if asked == ANY or own is None else own
    if own is None:
        wrong = f"logs of the system '{system}' have no format of their own that is written"
        raise UsageError(f"--format {asked}: {wrong}; write --format {ANY}, or leave this out")
    wrong = f"a run of the system '{system}' is written as"
    if scene.commanded:
        raise UsageError(f"--format {asked}: {wrong} {own}; write this, or leave it out")
    right = "write one of these, or leave this out"
    raise UsageError(f"--format {asked}: {wrong} {ANY} or {own}; {right}")


def _as_told(scene: Scene) -> Scene:
    """The scene without the settings that no one knows of:
    its faults, and what the filter is told otherwise.
    """
    told = scene.world.told
    hidden = [
        "faults.",
        *(["robot."] if told.robot else ()),
        *(["sensors."] if told.instruments else ()),
    ]
    return replace(
        scene, settings=tuple(one for one in scene.settings if not one.startswith(tuple(hidden)))
    )


def _differences(scene: Scene, run: Run) -> list[str]:
    """What the log cannot hold of the run."""
    told, system = scene.world.told, scene.world.system
    if system == "mower" and scene.reading == "coded":
        return [
            "the listing begins with the mean heading of the first second: the log's numbers "
            "differ from the run's"
        ]
    starts_elsewhere = system in ("gnss", "pioneer") and not np.array_equal(told.start, run.truth)
    if not starts_elsewhere and not np.any(told.sigma):
        return []
    return [
        "the filter of this run began otherwise than the log says: its numbers come again only in "
        "a world with the same belief.start and belief.sigma"
    ]
