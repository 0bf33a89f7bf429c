"""Angles, rays and ellipses: arrays in, arrays out. Nothing here knows what a robot is."""

import numpy as np
from numpy.typing import NDArray

Array = NDArray[np.float64]
Booleans = NDArray[np.bool_]
Integers = NDArray[np.int64]
