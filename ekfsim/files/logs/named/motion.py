"""What the robot did, by the columns that tell it → inputs of the world's motion model."""

from typing import Literal

import numpy as np

from ekfsim.files.logs.asked import Asked
from ekfsim.files.logs.named.tables import Table
from ekfsim.files.logs.ordering import apart, step_of, tell_gaps
from ekfsim.files.logs.table import Rows, some
from ekfsim.files.logs.timeline import Motions
from ekfsim.files.logs.truth import Truth
from ekfsim.geometry import Array, Booleans
from ekfsim.geometry.angles import wrap
from ekfsim.models.protocols import Motion
from ekfsim.systems.robot import Robot, Tick

Form = Literal["speeds", "wheels", "way", "inertial", "pose"]
COLUMNS: dict[Form, tuple[str, ...]] = {  # that tell a motion; the first that are there count
    "wheels": ("left", "right"),
    "speeds": ("v", "omega"),
    "way": ("distance", "turn"),
    "inertial": ("ax", "ay", "yaw"),
    "pose": ("x", "y", "theta"),
}
WANTED = "t,v,omega or t,left,right or t,distance,turn or t,ax,ay,yaw or t,x,y,theta"


def form_of(table: Table) -> Form:
    """How a table tells the motion. Raises InputError where it does not."""
    for form, columns in COLUMNS.items():
        if table.has(*columns):
            return form
    raise table.lacks("as a motion's are", f"write {WANTED}")


ADDABLE = ("speeds", "wheels", "way")  # 0 is standstill in each column


def motions_of(table: Table, asked: Asked, truth: Truth | None) -> Motions:
    """The motion inputs, each over its time: v and omega hold until the next row, wheels, ways and
    accelerations are since the row before.

    Raises InputError with what is wrong in the table.
    """
    _, world, reading, recording, warnings = asked
    form = form_of(table)
    rows = some(table.rows(("t", *COLUMNS[form]), warnings), "what the robot did")
    meant = recording.same_time or (None if form in ADDABLE else "share")
    rows = apart(rows, warnings, meant, until_next=form == "speeds")
    tell_gaps(rows, warnings)
    begin, end, values = _spans(form, rows, truth)
    robot = world.believed_robot
    motion = robot.motion(reading)
    u = inputs_of(form, values, end - begin, robot, motion)
    return Motions(motion, begin, end, u, amounts_of(motion))


def amounts_of(motion: Motion) -> Booleans:
    """Which entries of the input grow with the time: ways, turns and dt, not speeds."""
    return np.array([one.unit in ("m", "s") or one.name == "turn" for one in motion.inputs])


def _spans(form: Form, rows: Rows, truth: Truth | None) -> tuple[Array, Array, Array]:
    """From when to when each motion was : (n,) s each, and what it was : (n, k)"""
    t, values = rows.t, rows.values[:, 1:]
    if form == "speeds":
        return t[:-1], t[1:], values[:-1]
    if form == "wheels":
        return t[:-1], t[1:], values[1:]
    if form == "pose":
        middle = values[:-1, 2] + wrap(np.diff(values[:, 2])) / 2
        step = np.diff(values[:, :2], axis=0)
        ahead = step[:, 0] * np.cos(middle) + step[:, 1] * np.sin(middle)
        return t[:-1], t[1:], np.column_stack([ahead, wrap(np.diff(values[:, 2]))])
    if form == "way" and not np.any(values[0]):
        return t[:-1], t[1:], values[1:]
    return np.concatenate([[_start(rows, truth)], t[:-1]]), t, values


def _start(rows: Rows, truth: Truth | None) -> float:
    """When the first way began: a usual step before its end, at a true pose where one is near."""
    step = step_of(rows)
    start = float(rows.t[0]) - step
    if truth is not None:
        nearest = float(truth.t[np.argmin(np.abs(truth.t - start))])
        start = nearest if abs(nearest - start) < step / 2 else start
    return start


def inputs_of(form: Form, values: Array, dt: Array, robot: Robot, motion: Motion) -> Array:
    """The inputs u : (n, m) of a robot that does what the columns tell, as they are where the
    robot's own are the same.
    """
    own = tuple(one.name for one in motion.inputs)
    if (form, own[:2]) in (("speeds", ("speed", "turn rate")), ("way", ("distance", "turn"))):
        return np.column_stack([values, dt])
    if form == "wheels" and motion.inputs[0].name == "left" and motion.inputs[0].unit == "m/s":
        return np.column_stack([values, dt])
    distance, turn = _way(form, values, dt)
    still = np.zeros((len(dt), 2))
    pose = np.zeros((len(dt), 3))
    ticks = [
        robot.ideal(Tick(pose[i], pose[i], d, a, still[i], still[i], span))
        for i, (d, a, span) in enumerate(zip(distance, turn, dt.tolist(), strict=True))
        if span > 0
    ]
    u = np.zeros((len(dt), len(own)))
    u[dt > 0] = np.array(ticks)
    return u


def _way(form: Form, values: Array, dt: Array) -> tuple[Array, Array]:
    """How far the robot drove and turned : (n,) m, (n,) rad"""
    if form == "speeds":
        return values[:, 0] * dt, values[:, 1] * dt
    return values[:, 0], values[:, 1]
