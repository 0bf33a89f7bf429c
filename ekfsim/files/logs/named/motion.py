"""What the robot did, by the columns that tell it → inputs of the world's motion model."""

from dataclasses import replace

import numpy as np

from ekfsim.files.keys.recorded.columns import MotionKeys
from ekfsim.files.logs.asked import Asked
from ekfsim.files.logs.named.inputs import COLUMNS, WANTED, Form, Held, amounts_of, inputs_of
from ekfsim.files.logs.named.tables import Table
from ekfsim.files.logs.ordering import apart, step_of, tell_gaps
from ekfsim.files.logs.table import Rows, some
from ekfsim.files.logs.timeline import Motions
from ekfsim.files.logs.truth import Truth
from ekfsim.geometry import Array, Booleans
from ekfsim.geometry.angles import wrap

ADDABLE = ("speeds", "wheels", "way")  # 0 is standstill in each column
SIDEWAYS = 0.2  # of the way, from which on it is told that a pose went aside


def form_of(table: Table) -> Form:
    """How a table tells the motion. Raises InputError where it does not."""
    told = [form for form, columns in COLUMNS.items() if table.told.issuperset(columns)]
    for form in (*told, *COLUMNS):
        if table.has(*COLUMNS[form]):
            return form
    raise table.lacks("as a motion's are", f"write {WANTED}")


def tells_ways(table: Table, keys: MotionKeys) -> bool:
    """Whether a table tells ways or poses, which follow one another without any time."""
    form = form_of(table)
    return form in ("way", "pose") or (form == "wheels" and keys.wheels == "ways")


def rows_of(table: Table, asked: Asked) -> Rows:
    """What a table tells of the motion. Raises InputError with what is wrong in it."""
    form = form_of(table)
    _tell_others(table, form, asked.warnings)
    gyro = ("omega",) if form == "wheels" and table.has("omega") else ()
    before = ("turn_before",) if form == "way" and table.has("turn_before") else ()
    names = (*COLUMNS[form], *gyro, *before)
    rows = table.rows(("t", *names), asked, maybe=frozenset(names))
    return some(_with_motion(rows, asked.warnings), "what the robot did")


def in_reverse(table: Table, rows: Rows, t: Array) -> Booleans:
    """Whether the robot drives backwards at some instants t : (n,), by what a table tells of its
    motion; where it stands, as it drove before.
    """
    match form_of(table):
        case "speeds" | "way":
            ahead = rows.values[:, 1]
        case "wheels":
            ahead = rows.values[:, 1] + rows.values[:, 2]
        case _:
            return np.zeros(len(t), bool)
    order = np.argsort(rows.t, kind="stable")
    order = order[ahead[order] != 0]
    if not len(order):
        return np.zeros(len(t), bool)
    row = np.searchsorted(rows.t[order], t, side="right") - 1
    return np.asarray(ahead[order][np.maximum(row, 0)] < 0)


def _with_motion(rows: Rows, warnings: list[str]) -> Rows:
    """The rows without those in which no motion, or not all of it, stands."""
    empty = np.isnan(rows.values[:, 1:])
    parts = np.flatnonzero(np.any(empty, axis=1))
    if not len(parts):
        return rows
    row, more = int(parts[0]), f", and so in {len(parts) - 1} more rows" if len(parts) > 1 else ""
    whole = bool(np.all(empty[parts]))
    what = "no motion stands" if whole else "not all of the motion stands"
    warnings.append(f"{rows.at(row)}: {what} in this row{more}: left out")
    kept, left_out = rows[~np.any(empty, axis=1)], rows.left_out + len(parts)
    return replace(kept, left_out=left_out, why=rows.why or f"{what} in them")


def motions_of(
    table: Table, rows: Rows, keys: MotionKeys, asked: Asked, truth: Truth | None
) -> Motions:
    """The motion inputs, each over its time.

    Raises InputError with what is wrong in the table, UsageError where the world's robot cannot be
    told so.
    """
    warnings, recording = asked.warnings, asked.recording
    form = form_of(table)
    speeds = form == "speeds" or (form == "wheels" and not _are_ways(table, keys, warnings))
    until_next = speeds and (keys.holds or ("next" if form == "speeds" else "before")) == "next"
    meant = recording.same_time or (None if form in ADDABLE else "share")
    rows = apart(rows, warnings, meant, until_next)
    tell_gaps(rows, warnings)
    if form == "pose":
        held = _steps(rows, warnings)
    elif speeds:
        held = _spans(form, rows, until_next)
    else:
        held = _in_turn(_since(form, rows, truth))
    robot = asked.world.believed_robot
    motion = robot.motion(asked.reading)
    u = inputs_of(held, robot, motion, keys.width)
    return Motions(motion, held.begin, held.end, u, amounts_of(motion))


def _tell_others(table: Table, form: Form, warnings: list[str]) -> None:
    """Warn where a table tells the motion in several ways."""
    others = [
        ",".join(columns)
        for other, columns in COLUMNS.items()
        if other != form and table.has(*columns)
    ]
    if others and not table.told.issuperset(COLUMNS[form]):
        told = f"the motion is taken from {','.join(COLUMNS[form])}, not from {' or '.join(others)}"
        warnings.append(f"{table.file}: {told}; name the columns in recording.motion.columns")


def _are_ways(table: Table, keys: MotionKeys, warnings: list[str]) -> bool:
    """Whether left and right are ways of the wheels."""
    unit = table.unit_of("left")
    if keys.wheels is None and unit is None:
        told = (
            "left and right are taken as speeds in m/s; say otherwise with motion: {wheels: ways}"
        )
        warnings.append(f"{table.file}: {told}")
    return keys.wheels == "ways" or (keys.wheels is None and unit in ("m", "cm", "mm"))


def _spans(form: Form, rows: Rows, until_next: bool) -> Held:
    """Speeds, each until the next row or since the row before."""
    values = rows.values[:, 1:]
    return Held(form, True, rows.t[:-1], rows.t[1:], values[:-1] if until_next else values[1:])


def _since(form: Form, rows: Rows, truth: Truth | None) -> Held:
    """What was since the row before. The first row is the start where its ways are 0; else it began
    a usual step before, at a true pose where one is near.
    """
    t, values = rows.t, rows.values[:, 1:]
    if form != "inertial" and not np.any(values[0]):
        return Held(form, False, t[:-1], t[1:], values[1:])
    step = step_of(rows)
    start = float(t[0]) - step
    if truth is not None:
        nearest = float(truth.t[np.argmin(np.abs(truth.t - start))])
        start = nearest if abs(nearest - start) < step / 2 else start
    return Held(form, False, np.concatenate([[start], t[:-1]]), t, values)


def _in_turn(held: Held) -> Held:
    """The motions, those of a turn, a way and a turn one after the other, the way half of the time:
    Thrun, Burgard & Fox, Probabilistic Robotics, 2005, Table 5.6.
    """
    if held.form != "way" or held.values.shape[1] < 3:
        return held
    way, after, before = held.values.T
    none = np.zeros_like(way)
    values = np.stack([[none, before], [way, none], [none, after]]).transpose(2, 0, 1)
    ends = held.begin[:, None] + held.dt[:, None] * np.array([0.25, 0.75, 1.0])
    ends[:, -1] = held.end
    begins = np.column_stack([held.begin, ends[:, :-1]])
    return held._replace(begin=begins.ravel(), end=ends.ravel(), values=values.reshape(-1, 2))


def _steps(rows: Rows, warnings: list[str]) -> Held:
    """How far ahead and how far round each pose of the odometry lies from the one before, seen at
    the mid heading.
    """
    t, poses = rows.t, rows.values[:, 1:]
    turn = wrap(np.diff(poses[:, 2]))
    middle = poses[:-1, 2] + turn / 2
    east, north = np.diff(poses[:, :2], axis=0).T
    ahead = east * np.cos(middle) + north * np.sin(middle)
    aside = np.sum(np.abs(north * np.cos(middle) - east * np.sin(middle)))
    if aside > SIDEWAYS * np.sum(np.abs(ahead)):
        told = f"its poses move {aside:.3g} m aside: a robot on wheels goes ahead, and that is left"
        warnings.append(f"{rows.file}: {told} out; are x, y and theta of one frame?")
    return Held("pose", False, t[:-1], t[1:], np.column_stack([ahead, turn]))
