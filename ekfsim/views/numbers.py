"""Numbers as a person reads them: six digits, degrees, no noise of the last bit."""

import math
from collections.abc import Iterable

NOISE = 1e-15  # what is smaller is a rounding error of metres, radians or their squares


def fill(template: str, *values: float) -> str:
    """A template with a number in the place of each %.6g.

    >>> fill("x=%.6g, y=%.6g, z=%.6g", 1 / 3, 6.1e-17, -0.0)
    'x=0.333333, y=0, z=0'
    """
    return template % tuple([0.0 if -NOISE < value < NOISE else value for value in values])


def number(value: float) -> str:
    """Six significant digits.

    >>> number(1 / 3), number(6.1e-17)
    ('0.333333', '0')
    """
    return fill("%.6g", value)


def turn(angle: float) -> str:
    """An angle turned by, in degrees; it may be more than a full turn, and −180 is not 180.

    >>> turn(-math.pi), turn(4 * math.pi)
    ('-180', '720')
    """
    return number(math.degrees(angle))


def heading(angle: float) -> float:
    """A heading in degrees, in (−180, 180] also when six digits of it are read.

    >>> number(heading(math.pi / 2)), number(heading(-math.pi + 1e-9))
    ('90', '180')
    """
    degrees = math.degrees(angle)
    return degrees + 360 if degrees <= -179.9995 else degrees


def pose(state: Iterable[float]) -> tuple[float, float, float]:
    """x and y in m, θ in degrees.

    >>> pose([1.0, 2.5, math.pi])
    (1.0, 2.5, 180.0)
    """
    x, y, θ = state
    return x, y, heading(θ)
