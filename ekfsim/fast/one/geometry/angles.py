"""`wrap` of geometry/angles.py for one number, which the twins of one robot call."""

import math


def wrap_one(angle: float) -> float:
    """The same direction in (−π, π], without the cost of an array.

    >>> wrap_one(-math.pi) == math.pi
    True
    """
    if -math.pi < angle <= math.pi:
        return angle
    rest = math.fmod(angle, 2 * math.pi)
    if rest > math.pi:
        return rest - 2 * math.pi
    return rest + 2 * math.pi if rest <= -math.pi else rest
