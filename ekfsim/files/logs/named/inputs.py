"""What a log tells of a motion → the inputs that the world's robot takes."""

from typing import Literal, NamedTuple

import numpy as np

from ekfsim.errors import UsageError
from ekfsim.geometry import Array, Booleans
from ekfsim.models.protocols import Motion
from ekfsim.systems.robot import Robot, Tick

Form = Literal["speeds", "wheels", "way", "inertial", "pose"]
COLUMNS: dict[Form, tuple[str, ...]] = {  # that tell a motion; the first that are there count
    "wheels": ("left", "right"),
    "way": ("distance", "turn"),
    "pose": ("x", "y", "theta"),
    "speeds": ("v", "omega"),
    "inertial": ("ax", "ay", "yaw"),
}
OWN: dict[Form, str] = {  # what the first input is called of a robot that takes them as they are
    "wheels": "left",
    "way": "distance",
    "inertial": "forward acceleration",
    "speeds": "speed",
}
INERTIAL = "t,ax,ay,yaw"
DRIVEN = "t,v,omega or t,left,right or t,distance,turn or t,x,y,theta"
WANTED = f"{DRIVEN} or {INERTIAL}"


class Held(NamedTuple):
    """Motions over their times."""

    form: Form
    speeds: bool  # whether the values are speeds, else ways
    begin: Array  # (n,) s
    end: Array  # (n,) s
    values: Array  # (n, k) as the columns have them

    @property
    def dt(self) -> Array:
        """How long each lasted : (n,) s"""
        return self.end - self.begin


def amounts_of(motion: Motion) -> Booleans:
    """Which entries of the input grow with the time: ways, turns and dt, not speeds."""
    return np.array([one.unit in ("m", "s") or one.name == "turn" for one in motion.inputs])


def inputs_of(held: Held, robot: Robot, motion: Motion, width: float | None) -> Array:
    """The inputs u : (n, m) of a robot that does what the columns tell, as they are where its own
    are the same.

    width : m between the wheels, where the log tells it
    Raises UsageError where the robot cannot be told so.
    """
    form, dt = held.form, held.dt
    first = motion.inputs[0].name
    if (first == OWN["inertial"]) != (form == "inertial"):
        wrong = f"this world's robot cannot be told {','.join(COLUMNS[form])}"
        wanted = DRIVEN if form == "inertial" else INERTIAL
        raise UsageError(f"{wrong}; it takes {wanted}, or name a world of another system")
    if form == "wheels" and first == OWN[form] and width in (None, _between_wheels(robot)):
        if (u := _of_wheels(held, motion)) is not None:
            return u
    elif first == OWN.get(form):
        return np.column_stack([held.values, dt])
    distance, turn = _way(held, robot, width)
    still, pose = np.zeros(2), np.zeros(3)
    inputs = [
        robot.ideal(Tick(pose, pose, d, a, still, still, span))
        for d, a, span in zip(distance, turn, dt.tolist(), strict=True)
    ]
    return np.array(inputs).reshape(len(dt), len(motion.inputs))


def _of_wheels(held: Held, motion: Motion) -> Array | None:
    """The inputs of a robot that is told of its wheels; None where it has a gyro that is not told
    of.
    """
    both, dt = held.values[:, :2], held.dt[:, None]
    takes_speeds = motion.inputs[0].unit == "m/s"
    if takes_speeds != held.speeds:
        both = both * dt if held.speeds else both / dt
    match len(motion.inputs), held.values.shape[1]:
        case 2, _:
            return both
        case 3, _:
            return np.hstack([both, dt])
        case _, 3:
            return np.hstack([both, held.values[:, 2:], dt])
    return None


def _way(held: Held, robot: Robot, width: float | None) -> tuple[Array, Array]:
    """How far the robot drove and turned : (n,) m, (n,) rad"""
    values = held.values * held.dt[:, None] if held.speeds else held.values
    first, second = values[:, 0], values[:, 1]
    if held.form != "wheels":
        return first, second
    if held.values.shape[1] > 2:  # a gyro tells the turn
        return (first + second) / 2, held.values[:, 2] * held.dt
    between = width or _between_wheels(robot)
    if not between:
        wrong = "left and right make no turn while the way between the wheels is unknown"
        raise UsageError(f"{wrong}; write it into the recording as motion: {{width: 0.3}}, in m")
    return (first + second) / 2, (second - first) / between


def _between_wheels(robot: Robot) -> float:
    """m between the wheels of a robot that knows it, else 0."""
    own: float = getattr(robot, "width", 0.0) or 2 * getattr(robot, "half_track", 0.0)
    return own
