"""Numbers as a person reads them: six digits, degrees, no noise of the last bit."""

import math
from collections.abc import Iterable

from ekfsim.geometry import Array

NOISE = 1e-15  # what is smaller is a rounding error of metres, radians or their squares


def number(value: float) -> str:
    """Six significant digits.

    >>> number(1 / 3), number(6.1e-17), number(-0.0)
    ('0.333333', '0', '0')
    """
    return f"{value:.6g}" if abs(value) >= NOISE else "0"


def degrees(angle: float) -> str:
    """A heading in (−180, 180].

    >>> degrees(math.pi / 2), degrees(-math.pi + 1e-9)
    ('90', '180')
    """
    text = number(math.degrees(angle))
    return "180" if text == "-180" else text


def turn(angle: float) -> str:
    """An angle turned by, in degrees; it may be more than a full turn, and −180 is not 180.

    >>> turn(-math.pi), turn(4 * math.pi)
    ('-180', '720')
    """
    return number(math.degrees(angle))


def pose(state: Iterable[float]) -> str:
    """(x, y, θ) in m, m, degrees.

    >>> pose([1.0, 2.5, math.pi])
    '(1, 2.5, 180)'
    """
    x, y, theta = state
    return f"({number(x)}, {number(y)}, {degrees(theta)})"


def matrix(P: Array) -> list[str]:
    """A line for each row.

    >>> import numpy as np
    >>> matrix(np.eye(2))
    ['[[1 0]', '[0 1]]']
    """
    rows = ["[" + " ".join(map(number, row)) + "]" for row in P.tolist()]
    return ["[" + rows[0], *rows[1:-1], rows[-1] + "]"]
