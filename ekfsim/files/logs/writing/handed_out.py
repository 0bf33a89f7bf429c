"""A simulated run of the classroom → the files that a course hands out.

They hold what the filter is given and told, and nothing else: no truth, no faults, no world as it
is. Neither do they name the scene, the seed and the run, for whoever has these can play the truth:
only beside the truth itself they stand, in about.txt.
"""

import math
from collections.abc import Iterable, Iterator
from pathlib import Path

from ekfsim.files.logs.degrees import degrees
from ekfsim.files.logs.formats.classroom import COLUMNS, ENTRIES, TRUTH, TRUTH_COLUMNS, WORLD
from ekfsim.files.logs.writing.told_world import classroom_world, refuse_start
from ekfsim.files.results.writing import whole_folder
from ekfsim.models.sensors.laser import Laser
from ekfsim.provenance import told_in_a_line
from ekfsim.records import Control, Entry, Reading
from ekfsim.scene import Scene

ABOUT = "about.txt"  # only beside the truth


def hand_out(
    scene: Scene, entries: Iterable[Entry], out: Path, force: bool, with_truth: bool
) -> None:
    """Write what the filter is given in a run, and what it is told, into a folder.

    Raises UsageError where the folder may not be written, or the filter is told a start at which no
    world file can have one.
    """
    told = scene.world.told
    refuse_start(scene)
    with whole_folder(out, ENTRIES, WORLD, TRUTH, ABOUT, force=force) as folder:
        happened = tuple(entries)
        files = {ENTRIES: _table(COLUMNS, _rows(happened)), WORLD: "".join(classroom_world(told))}
        if with_truth:
            files[TRUTH] = _table(TRUTH_COLUMNS, _poses(happened))
            files[ABOUT] = f"A recorded log: {told_in_a_line(scene)}\n"
        for name, text in files.items():
            (folder / name).write_text(text, encoding="utf-8")


def _rows(entries: Iterable[Entry]) -> Iterator[tuple[str, ...]]:
    """A row for each move and each beam; of texts and kidnappings a filter is told nothing."""
    for entry in entries:
        match entry.given:
            case Control(_, u):
                distance, angle = u.tolist()
                yield f"{entry.index}", "move", repr(distance), degrees(angle), "", ""
            case Reading(Laser() as laser, z):
                echo = "" if math.isnan(z[0]) else repr(float(z[0]))
                yield f"{entry.index}", "sense", "", "", degrees(laser.bearing), echo


def _poses(entries: Iterable[Entry]) -> Iterator[tuple[str, ...]]:
    """The true pose at the start, and after each of the same rows."""
    for entry in entries:
        if (entry.given is not None or entry.index == 0) and entry.truth is not None:
            x, y, θ = entry.truth.tolist()
            yield f"{entry.index}", repr(x), repr(y), degrees(θ)


def _table(columns: Iterable[str], rows: Iterable[Iterable[str]]) -> str:
    return "".join(f"{','.join(row)}\n" for row in (columns, *rows))
