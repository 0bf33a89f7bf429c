"""The steps in which a mistake can be made."""

import numpy as np

from ekfsim.commands import Move
from ekfsim.models.motions.move_turn import MoveTurn
from ekfsim.models.protocols import angles
from ekfsim.models.sensors.laser import Laser
from ekfsim.records import Control, Reading
from ekfsim.student.asked import Asked


def everywhere(_: Asked) -> bool:
    """Any step."""
    return True


def first(asked: Asked) -> bool:
    """The first step of a run, whatever it is."""
    return asked.earlier is None


def moves(asked: Asked) -> bool:
    """A motion of any robot."""
    return isinstance(asked.given, Control)


def wandering(asked: Asked) -> bool:
    """A motion with a process noise besides that of its input."""
    given = asked.given
    return isinstance(given, Control) and bool(np.any(given.motion.Q(given.u)))


def move_turn(asked: Asked) -> bool:
    """A move of the classroom's robot."""
    return isinstance(asked.given, Control) and isinstance(asked.given.motion, MoveTurn)


def commanded(asked: Asked) -> bool:
    """A move of the classroom's robot, whose command is known."""
    return move_turn(asked) and isinstance(asked.command, Move)


def readings(asked: Asked) -> bool:
    """A reading of any sensor."""
    return isinstance(asked.given, Reading)


def of_one(asked: Asked) -> bool:
    """A reading of one number."""
    return isinstance(asked.given, Reading) and len(asked.given.z) == 1


def of_many(asked: Asked) -> bool:
    """A reading of more than one number."""
    return isinstance(asked.given, Reading) and len(asked.given.z) > 1


def of_angles(asked: Asked) -> bool:
    """A reading that has an angle in it."""
    return isinstance(asked.given, Reading) and bool(angles(asked.given.sensor.outputs))


def beams(asked: Asked) -> bool:
    """A beam of the classroom's laser."""
    return isinstance(asked.given, Reading) and isinstance(asked.given.sensor, Laser)


def after_a_move(asked: Asked) -> bool:
    """A reading whose call before was a motion."""
    return readings(asked) and asked.earlier is not None and moves(asked.earlier)


def after_a_reading(asked: Asked) -> bool:
    """A reading whose call before was a reading."""
    return readings(asked) and asked.earlier is not None and readings(asked.earlier)
