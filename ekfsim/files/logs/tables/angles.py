"""Radians or degrees: what a file's angles are in, where nobody says."""

import math

import numpy as np

from ekfsim.files.logs.tables.declared import Column
from ekfsim.geometry import Array

DEGREE = math.pi / 180
ANGLES = {"rad": 1.0, "rad/s": 1.0, "degrees": DEGREE, "degrees/s": DEGREE}
BEYOND_A_TURN = 3 * math.pi  # rad: an angle within half a turn, and a turn more or less
MANY = 0.02  # the share of numbers beyond what radians can be, from which on they are degrees
# the same of angles that a program may leave unwrapped over several turns, as a few are
MANY_UNWRAPPED = 0.15
ALMOST_A_TURN = 300.0  # degrees between two rows, where a heading is folded
SHORT, PARTS = 0.1, 200  # m that a piece of a way has at least, and at most so many pieces across
FEWEST = 5  # pieces
# mean cosine of headings that lead along their way, and how much less it is of others
ALONG, CLEARLY = 0.8, 0.3
A_TURN = 400.0  # degrees that an angle of one turn may have, with some margin
TURNS = 10 * A_TURN  # of one that is left unwrapped


def are_degrees(values: Array, column: Column) -> bool:
    """Whether numbers that would be radians can only be degrees. values : (n,)"""
    size = np.abs(values[np.isfinite(values) & (values != 0)])
    if not len(size) or math.isinf(column.most):
        return False
    unwrapped = column.most == BEYOND_A_TURN
    many, most = (MANY_UNWRAPPED, TURNS) if unwrapped else (MANY, A_TURN)
    return bool(np.mean(size > column.most) >= many and np.quantile(size, 0.99) <= most)


def are_degrees_of_course(x: Array, y: Array, heading: Array) -> bool:
    """Whether the headings along a way, taken as degrees, lead along it, and as radians do not;
    forwards or backwards.

    x, y : (n,) m; heading : (n,) as they stand
    """
    known = np.isfinite(x) & np.isfinite(y) & np.isfinite(heading)
    x, y, heading = x[known], y[known], heading[known]
    if not len(x) or np.max(np.abs(heading)) <= 2 * math.pi:
        return False
    jumps = np.abs(np.diff(heading))
    if np.max(np.abs(heading)) <= A_TURN and np.any(jumps > ALMOST_A_TURN):
        return True
    parts = _apart(x, y)
    if len(parts) <= FEWEST:
        return False
    course = np.arctan2(np.diff(y[parts]), np.diff(x[parts]))
    in_degrees, in_radians = (
        float(np.mean(np.cos(2 * (course - factor * heading[parts][:-1]))))
        for factor in (DEGREE, 1.0)
    )
    return in_degrees > ALONG and in_radians < ALONG - CLEARLY


def _apart(x: Array, y: Array) -> list[int]:
    """Rows of places that lie so far apart that the course between them says something."""
    away = max(SHORT, math.hypot(np.ptp(x), np.ptp(y)) / PARTS)
    parts = [0]
    for row, place in enumerate(zip(x.tolist(), y.tolist(), strict=True)):
        if math.hypot(place[0] - x[parts[-1]], place[1] - y[parts[-1]]) >= away:
            parts.append(row)
    return parts
