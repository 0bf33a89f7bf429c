"""Numbers as a page holds them: short, and fine enough for what is drawn and told of them."""

import math
from collections.abc import Iterable

import numpy as np

from ekfsim.geometry import Array

Number = float | int | None

FINE = 6  # digits after the point of a length in m, of an angle in rad
DIGITS = 6  # of a number in a matrix, as the narrative has it
NOISE = 1e-15  # what is smaller is a rounding error


def short(value: float) -> Number:
    """Six significant digits; None where there is no number.

    >>> short(1 / 3), short(2.0), short(math.nan), short(6.1e-17)
    (0.333333, 2, None, 0)
    """
    return _plain(0.0 if abs(value) < NOISE else float(f"{value:.{DIGITS}g}"))


def length(value: float) -> Number:
    """A length or an angle to a millionth.

    >>> length(1.23456789), length(-0.0), length(math.inf)
    (1.234568, 0, None)
    """
    return _plain(round(value, FINE)) if math.isfinite(value) else None


def points(places: Array, origin: Array) -> list[Number]:
    """x and y of places (n, 2) in m from the origin, one after another; None where a way breaks."""
    return [length(value) for value in (places - origin).ravel().tolist()]


def row(values: Iterable[float]) -> list[Number]:
    """The numbers of a vector."""
    return [short(value) for value in values]


def rows(A: Array) -> list[list[Number]]:
    """The numbers of a matrix (n, m), row by row."""
    return [row(each) for each in np.atleast_2d(A).tolist()]


def triangle(P: Array) -> list[Number]:
    """The lower half of a symmetric matrix (n, n), row by row."""
    return row(P[np.tril_indices(len(P))].tolist())


def _plain(value: float) -> Number:
    """Without a point where it needs none."""
    if not math.isfinite(value):
        return None
    return int(value) if value == int(value) and abs(value) < 1e15 else value
