"""Radians ↔ degrees as a person reads them, to the last bit.

A float of radians has not always one of degrees that leads back to it: those few are written with
more digits than a float has, and read with as many.
"""

import math
from decimal import Decimal

RADIAN = Decimal("0.0174532925199432957692369076848861271344")  # π/180
FEWEST, MOST = 6, 17  # digits of a float that are tried
BEYOND = 21  # digits that always lead back


def degrees(angle: float) -> str:
    """The fewest digits that are read back as this angle in rad.

    >>> degrees(math.radians(-86)), degrees(math.radians(33.3))
    ('-86', '33.3')
    """
    told = (f"{math.degrees(angle):.{digits}g}" for digits in range(FEWEST, MOST + 1))
    exact = f"{Decimal(angle) / RADIAN:.{BEYOND}g}"
    return next((text for text in told if math.radians(float(text)) == angle), exact)


def radians(text: str) -> float:
    """The angle in rad that a text of degrees says.

    >>> radians("180") == math.pi
    True
    """
    digits = len(Decimal(text).as_tuple().digits)
    return float(Decimal(text) * RADIAN) if digits > MOST else math.radians(float(text))
