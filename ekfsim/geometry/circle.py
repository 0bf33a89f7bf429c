"""A circle as a line to be drawn."""

import numpy as np

from ekfsim.geometry import Array

CORNERS = 128  # no point of the line is nearer to the centre by more than 0.03 % of the radius


def circle_outline(x: float, y: float, radius: float) -> Array:
    """A circle about (x, y) m as a line that ends where it begins : (n, 2) m"""
    turn = np.linspace(0, 2 * np.pi, CORNERS + 1)
    line: Array = np.array([x, y]) + radius * np.stack([np.cos(turn), np.sin(turn)], axis=-1)
    line[-1] = line[0]
    return line
