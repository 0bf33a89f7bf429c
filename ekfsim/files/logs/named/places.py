"""The landmarks and the true poses of a log."""

import math
from collections.abc import Mapping
from dataclasses import replace

import numpy as np

from ekfsim.errors import InputError, Mistake, Place
from ekfsim.files.logs.asked import Asked
from ekfsim.files.logs.named.files import Sources
from ekfsim.files.logs.named.motion import in_reverse
from ekfsim.files.logs.named.opening.opened import opened
from ekfsim.files.logs.named.opening.ordered import after
from ekfsim.files.logs.named.tables import Source, Table
from ekfsim.files.logs.table import Rows, Wanted, bare_table, is_number
from ekfsim.files.logs.truth import Truth, truth_of
from ekfsim.geometry import Array
from ekfsim.geometry.angles import wrap
from ekfsim.systems.instrument import Landmark

TUM = Wanted(("t", "x", "y", "qx", "qy", "qz", "qw"), (0, 1, 2, 4, 5, 6, 7), range(8, 9))
POSE = ("t", "x", "y", "theta")
MOVED = 1e-3  # m; a course is that of a way at least so long

Ids = Mapping[str, int]  # of landmarks that go by names


def landmarks_in(
    files: Sources, tables: list[Table], asked: Asked
) -> tuple[tuple[Landmark, ...] | None, Ids]:
    """What stands where, None where the log does not tell, and the numbers of those with names.
    `tables` gets what was opened. Raises InputError with what is wrong.
    """
    source = files.landmarks()
    if source is None:
        return None, {}
    table = opened(source, "id,x,y")
    tables.append(table)
    rows = table.rows(("x", "y"), asked)
    if not table.has("id"):
        raise table.lacks("'id'", "write id,x,y")
    words = table.words("id", rows)
    ids = _ids(words)
    found, mistakes = dict[int, Landmark](), list[Mistake]()
    for row, (word, (x, y)) in enumerate(zip(words, rows.values.tolist(), strict=True)):
        id, place = ids[word], Place(rows.file, int(rows.lines[row]))
        if found.setdefault(id, Landmark(id, x, y)) != (id, x, y):
            there = found[id]
            told = f"the landmark {word} stood at ({there.x:g}, {there.y:g}) above"
            mistakes.append(Mistake(place, "", told, "a landmark stays where it is"))
    if mistakes:
        raise InputError(mistakes[:20])
    named = {word: id for word, id in ids.items() if not is_number(word)}
    if named:
        told = ", ".join(f"{word} is landmark {id}" for word, id in list(named.items())[:20])
        asked.warnings.append(f"{table.file}: {told}")
    return tuple(found.values()), named


def _ids(words: list[str]) -> dict[str, int]:
    """The number of each landmark: its own where it is a whole one, else the next that is free."""
    distinct = list(dict.fromkeys(words))
    whole = {word: int(float(word)) for word in distinct if _is_whole(word)}
    free = (n for n in range(1, len(distinct) + len(whole) + 1) if n not in whole.values())
    return {word: whole[word] if word in whole else next(free) for word in distinct}


def _is_whole(word: str) -> bool:
    return is_number(word) and float(word).is_integer() and 0 <= float(word) < 2**31


def truth_in(
    files: Sources, tables: list[Table], asked: Asked, motion: Table, rows: Rows
) -> Truth | None:
    """The true poses, None where the log has none, beside a motion, a table and its rows.
    Raises InputError with what is wrong in them.
    """
    source = files.truth()
    if source is None:
        told = "the truth is unknown, and so are the errors"
        asked.warnings.append(f"{asked.path}: {files.no_truth}: {told}")
        return None
    rows = _poses(source, tables, asked, motion, rows)
    if asked.recording.turn_truth == "always":
        rows = replace(rows, values=rows.values + np.array([0, 0, 0, math.pi]))
    return truth_of(rows, asked.warnings)


def _poses(source: Source, tables: list[Table], asked: Asked, motion: Table, beside: Rows) -> Rows:
    """The rows of the truth, t, x, y, heading, by the course where no heading is told."""
    if source.path.suffix == ".tum":
        rows = bare_table(source.path, TUM, asked.warnings)
        qx, qy, qz, qw = rows.values[:, 3:].T
        θ = np.arctan2(2 * (qw * qz + qx * qy), 1 - 2 * (qy**2 + qz**2))
        return replace(rows, values=np.column_stack([rows.values[:, :3], θ]))
    table = after(opened(source, ",".join(POSE)), motion)
    tables.append(table)
    if table.has("theta"):
        return table.rows(POSE, asked, beside)
    rows = table.rows(POSE[:3], asked, beside)
    course = course_of(rows.values[:, 1:3])
    back = in_reverse(motion, beside, rows.t)
    backs = ", half a turn from it where the robot drives in reverse" if back.any() else ""
    told = (
        f"it tells no heading (theta): taken from the course{backs}, so errors of it are not to be"
    )
    asked.warnings.append(f"{table.file}: {told} taken for the robot's own where it slides")
    return replace(rows, values=np.column_stack([rows.values, wrap(course + np.pi * back)]))


def course_of(places: Array) -> Array:
    """The direction in which each place is left for the next that lies apart : (n,) rad; at the end
    that of before, 0 where nothing moves.  places : (n, 2) m
    """
    course, here, since = np.zeros(len(places)), 0, 0.0
    for k in range(1, len(places)):
        step = places[k] - places[here]
        if np.hypot(*step) >= MOVED:
            since = math.atan2(step[1], step[0])
            course[here:k] = since
            here = k
    course[here:] = since
    return course
