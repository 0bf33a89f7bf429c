"""Angles, outlines and ellipses: arrays in, arrays out. Nothing here knows a robot or a wall.

angles.py    a direction in (−π, π]
circle.py    a circle as a line to be drawn
ellipse.py   from a covariance to what is drawn of it
outline.py   how far a point is from a path
soa.py       structure of arrays: how the small matrices of many runs lie in memory
"""

import numpy as np
from numpy.typing import NDArray

Array = NDArray[np.float64]
Booleans = NDArray[np.bool_]
Integers = NDArray[np.int64]
