"""Mistakes of ν, J_H and C_v: of what a reading is compared with, and how it is weighed."""

import numpy as np

from ekfsim.models.sensors.laser import Laser
from ekfsim.records import Reading
from ekfsim.student.asked import Asked
from ekfsim.student.mistakes.mistake import Mistake
from ekfsim.student.mistakes.working import Piece


def readings(asked: Asked) -> bool:
    """A reading of any sensor."""
    return isinstance(asked.given, Reading)


def beams(asked: Asked) -> bool:
    """A beam of the classroom's laser."""
    return isinstance(asked.given, Reading) and isinstance(asked.given.sensor, Laser)


def _column(by: float, entry: int) -> Piece:
    """J_H with its column of x, y or θ times `by`."""
    return lambda s, right: np.where(np.arange(len(s.x)) == s.places[entry], by, 1.0) * right()


OF_READINGS = (
    Mistake(
        "innovation-sign",
        "your x is the one with the other sign of the innovation, h − z, or of all of J_H",
        "eqs 9, 10: r = z − h, and x + K r",
        readings,
        ({"innovation": lambda s, right: -right()},),
    ),
    Mistake(
        "J_H-sign-theta",
        "your step is the one with the other sign of ∂h/∂θ in J_H",
        "eq 11: the derivatives of h",
        readings,
        ({"H": _column(-1.0, 2)},),
    ),
    Mistake(
        "sigma-in-C_v",
        "your C_v holds σ where σ² belongs",
        "eq 11: C_v is a variance, (rangeSigmaRatio * predicted range)^2",
        readings,
        ({"R": lambda s, right: np.diag(np.sqrt(np.diag(right())))},),
    ),
    Mistake(
        "C_v-of-the-reading",
        "your C_v is that of the measured range",
        "eq 11: C_v is of the predicted range, (rangeSigmaRatio * h)^2",
        beams,
        ({"R": lambda s, _: np.diag((s.laser.range_ratio * s.z) ** 2)},),
    ),
)
