"""Radians or degrees: what a file's angles are in, where nobody says."""

import math

import numpy as np

from ekfsim.files.logs.tables.declared import Column
from ekfsim.geometry import Array

DEGREE = math.pi / 180
ANGLES = {"rad": 1.0, "rad/s": 1.0, "degrees": DEGREE, "degrees/s": DEGREE}
BEYOND_A_TURN = 3 * math.pi  # rad: an angle within half a turn, and a turn more or less
MANY = 0.02  # the share of numbers beyond what radians can be, from which on they are degrees
A_TURN = 400.0  # degrees that an angle of one turn may have, with some margin


def are_degrees(values: Array, column: Column) -> bool:
    """Whether numbers that would be radians can only be degrees. values : (n,)"""
    size = np.abs(values[np.isfinite(values) & (values != 0)])
    if not len(size) or math.isinf(column.most):
        return False
    return bool(np.mean(size > column.most) >= MANY and np.quantile(size, 0.99) <= A_TURN)
